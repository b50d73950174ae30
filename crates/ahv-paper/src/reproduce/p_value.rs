//! Does a printed number belong to a distribution that is known by draws?

/// Two-sided level: a number whose p-value is smaller lies outside the 5 % and 95 % points.
pub const LEVEL: f64 = 0.1;
/// Normal quantile of the intervals of p-values, 99.9 % two-sided: thirty verdicts are given, each after a few looks.
const Z: f64 = 3.290_526_731_491_9;

/// What can be said of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The p-value is above [`LEVEL`].
    Inside,
    /// The p-value is below [`LEVEL`].
    Outside,
    /// The draws are too few.
    Undecided,
}

/// A two-sided p-value, 2 min(P(M ≤ m), P(M ≥ m)), estimated by draws of M.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct PValue {
    /// The estimate.
    pub value: f64,
    /// Its standard error; never 0.
    pub std_error: f64,
    /// Lower end of its interval of 99.9 % (Wilson 1927).
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Draws.
    pub draws: u64,
    /// The verdict: that of the whole interval.
    pub verdict: Verdict,
}

impl PValue {
    /// The p-value of `number` by the draws in `sample`.
    pub fn new(sample: &[f64], number: f64) -> Self {
        let n = sample.len().max(1) as f64;
        let share = sample.iter().filter(|&&draw| draw <= number).count() as f64 / n;
        let two_sided = |share: f64| 2.0 * share.min(1.0 - share);
        // One draw more on each side: no spread of 0 where all draws lie on one side.
        let smooth = (share * n + 1.0) / (n + 2.0);
        let scale = 1.0 + Z * Z / n;
        let middle = (share + Z * Z / (2.0 * n)) / scale;
        let half = Z / scale * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
        let (from, to) = ((middle - half).max(0.0), (middle + half).min(1.0));
        let ends = [two_sided(from), two_sided(to)];
        let low = ends[0].min(ends[1]);
        let high = if from <= 0.5 && to >= 0.5 {
            1.0
        } else {
            ends[0].max(ends[1])
        };
        Self {
            value: two_sided(share),
            std_error: 2.0 * (smooth * (1.0 - smooth) / n).sqrt(),
            low,
            high,
            draws: sample.len() as u64,
            verdict: match (low > LEVEL, high < LEVEL) {
                (true, _) => Verdict::Inside,
                (_, true) => Verdict::Outside,
                _ => Verdict::Undecided,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{PValue, Verdict};

    #[test]
    fn a_verdict_needs_an_interval_on_one_side_of_the_level() {
        let sample = |n: u32| -> Vec<f64> {
            (0..n)
                .map(|k| (f64::from(k) + 0.5) / f64::from(n))
                .collect()
        };
        for (n, number, value, verdict) in [
            (1000, 0.5, 1.0, Verdict::Inside),
            (1000, -1.0, 0.0, Verdict::Outside),
            (60, 0.05, 0.1, Verdict::Undecided),
            (60, -1.0, 0.0, Verdict::Undecided),
            (16_000, 0.07, 0.14, Verdict::Inside),
            (16_000, 0.97, 0.06, Verdict::Outside),
            (16_000, 0.0505, 0.101, Verdict::Undecided),
        ] {
            let p = PValue::new(&sample(n), number);
            assert!((p.value - value).abs() < 1e-9, "{p:?}");
            assert!(p.low <= p.value && p.value <= p.high && p.std_error > 0.0);
            assert_eq!(p.verdict, verdict, "{number}: {p:?}");
        }
    }
}
