//! Whether residuals are white.

use nalgebra::DVector;

/// Lags of the test, where the record is long enough; an even number has a closed form.
const LAGS: usize = 20;

/// The test of Ljung and Box (1978): autocorrelations of an output's normalised residuals up to some lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whiteness {
    /// The statistic.
    pub statistic: f64,
    /// Lags, the degrees of freedom of its χ² distribution.
    pub lags: usize,
    /// Probability of a statistic as large if the residuals are white.
    pub p: f64,
}

/// The test of component `output` of normalised residuals, of each segment apart; `None` where segments are too short.
pub(crate) fn test(residuals: &[Vec<DVector<f64>>], output: usize) -> Whiteness {
    let longest = residuals.iter().map(Vec::len).max().unwrap_or(0);
    let lags = (2 * (longest / 8)).min(LAGS);
    let pairs = |lag: usize| {
        let of = residuals.iter().flat_map(move |segment| {
            let later = segment.iter().skip(lag);
            segment
                .iter()
                .zip(later)
                .map(move |(a, b)| a[output] * b[output])
        });
        of.fold((0.0, 0), |(sum, count), it| (sum + it, count + 1))
    };
    let (power, count) = pairs(0);
    let n = f64::from(count);
    let mut statistic = 0.0;
    for lag in 1..=lags {
        let (sum, count) = pairs(lag);
        if count > 0 && power > 0.0 {
            let correlation = sum / power;
            // Its variance is that of so many products; of one segment that is (n − lag)/(n (n + 2)).
            statistic += correlation * correlation * n * (n + 2.0) / f64::from(count);
        }
    }
    Whiteness {
        statistic,
        lags,
        p: exceeded(statistic, lags),
    }
}

/// Probability that χ² of an even number of degrees of freedom exceeds a value: e^(−x/2) Σ (x/2)ⁱ/i!.
fn exceeded(value: f64, freedom: usize) -> f64 {
    let half = 0.5 * value;
    let mut term = 1.0;
    let mut sum = 0.0;
    for index in 0..freedom / 2 {
        if index > 0 {
            term *= half / index as f64;
        }
        sum += term;
    }
    if freedom == 0 {
        1.0
    } else {
        ((-half).exp() * sum).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::exceeded;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        // scipy.stats.chi2.sf
        for (value, freedom, p) in [
            (31.410_432_844_230_92, 20, 0.05),
            (37.566_234_786_625_05, 20, 0.01),
            (5.991_464_547_107_979, 2, 0.05),
            (9.487_729_036_781_154, 4, 0.05),
        ] {
            assert!((exceeded(value, freedom) - p).abs() < 1e-12);
        }
    }
}
