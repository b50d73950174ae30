//! Estimates from samples, with their confidence.

/// 97.5 % point of the standard normal distribution.
pub const Z_95: f64 = 1.959_963_984_540_054;
/// 95 % point of Kolmogorov's distribution of √n·D.
const KOLMOGOROV_95: f64 = 1.358_098_7;

/// A value with an interval that holds it with a stated probability.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Estimate {
    /// A mean of `count` normal numbers with standard deviation `std`, with its interval of 95 %.
    pub fn of_mean(mean: f64, std: f64, count: f64) -> Self {
        let half = Z_95 * std / count.sqrt();
        Self {
            value: mean,
            low: mean - half,
            high: mean + half,
        }
    }

    /// A standard deviation of `count` normal numbers about their mean, with its interval of 95 %.
    ///
    /// χ² quantiles by Wilson and Hilferty 1931, within 0.1 % of the exact ones from 30 numbers on.
    pub fn of_std(std: f64, count: f64) -> Self {
        let freedom = count - 1.0;
        let spread = 2.0 / (9.0 * freedom);
        let quantile = |z: f64| freedom * (1.0 - spread + z * spread.sqrt()).powi(3);
        let end = |z: f64| std * (freedom / quantile(z)).sqrt();
        Self {
            value: std,
            low: end(Z_95),
            high: end(-Z_95),
        }
    }

    /// The probability of what was seen `count` times in `of` trials, with its interval of 95 % (Wilson 1927); without trials
    /// it is unknown: 0, between 0 and 1.
    pub fn of_share(count: u64, of: u64) -> Self {
        if of == 0 {
            return Self {
                value: 0.0,
                low: 0.0,
                high: 1.0,
            };
        }
        let (n, share) = (of as f64, count as f64 / of as f64);
        let z_2 = Z_95 * Z_95;
        let middle = (share + z_2 / (2.0 * n)) / (1.0 + z_2 / n);
        let half =
            Z_95 / (1.0 + z_2 / n) * (share * (1.0 - share) / n + z_2 / (4.0 * n * n)).sqrt();
        // Rounding must not push the ends past what they are for none and for all.
        Self {
            value: share,
            low: if count == 0 { 0.0 } else { middle - half },
            high: if count == of { 1.0 } else { middle + half },
        }
    }

    /// Whether all three numbers are finite.
    pub const fn is_finite(&self) -> bool {
        self.value.is_finite() && self.low.is_finite() && self.high.is_finite()
    }

    /// Median of `sample` with its 5 % and 95 % points; `None` of an empty sample.
    pub fn of_distribution(sample: &[f64]) -> Option<Self> {
        let mut sorted = sample.to_vec();
        sorted.sort_by(f64::total_cmp);
        Some(Self {
            value: quantile(&sorted, 0.5)?,
            low: quantile(&sorted, 0.05)?,
            high: quantile(&sorted, 0.95)?,
        })
    }

    /// Whether `value` lies in the interval.
    pub fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// The `share` quantile of ascending numbers, between neighbours by straight lines.
pub(crate) fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let place = share * sorted.len().checked_sub(1)? as f64;
    let (low, high) = (
        sorted.get(place.floor() as usize)?,
        sorted.get(place.ceil() as usize)?,
    );
    Some(low + (place - place.floor()) * (high - low))
}

/// Sample mean and standard deviation (n − 1) of numbers; 0 where there are too few.
pub fn mean_and_std(sample: &[f64]) -> (f64, f64) {
    let count = sample.len() as f64;
    let mean = sample.iter().sum::<f64>() / count.max(1.0);
    let squares: f64 = sample.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, (squares / (count - 1.0).max(1.0)).sqrt())
}

/// Fourth standardised moment less 3: 0 for a normal distribution, with a standard error of √(24/n).
pub fn excess_kurtosis(sample: &[f64]) -> f64 {
    let (mean, std) = mean_and_std(sample);
    let fourth: f64 = sample.iter().map(|x| ((x - mean) / std).powi(4)).sum();
    fourth / sample.len() as f64 - 3.0
}

/// Greatest distance between the distribution functions of two samples of equal size, and the distance that samples of
/// one distribution stay below with probability 95 % if they are independent (Kolmogorov and Smirnov).
pub fn kolmogorov_smirnov(a: &[f64], b: &[f64]) -> (f64, f64) {
    let sorted = |sample: &[f64]| {
        let mut sorted = sample.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted
    };
    let (a, b) = (sorted(a), sorted(b));
    let share =
        |sample: &[f64], x: f64| sample.partition_point(|&y| y <= x) as f64 / sample.len() as f64;
    let distance = |&x: &f64| (share(&a, x) - share(&b, x)).abs();
    let greatest = a.iter().chain(&b).map(distance).fold(0.0, f64::max);
    let (m, n) = (a.len() as f64, b.len() as f64);
    (greatest, KOLMOGOROV_95 * ((m + n) / (m * n)).sqrt())
}

/// Shares of a sample between `edges`, as densities.
pub fn densities(sample: &[f64], edges: &[f64]) -> Vec<f64> {
    let bins = edges.windows(2).map(|pair| {
        let [low, high] = [pair[0], pair[1]];
        let inside = sample.iter().filter(|&&x| low <= x && x < high).count();
        inside as f64 / (sample.len() as f64 * (high - low))
    });
    bins.collect()
}

/// Density of a normal distribution of mean 0 at `x`.
pub fn normal_density(x: f64, std: f64) -> f64 {
    let z = x / std;
    (-0.5 * z * z).exp() / (std * std::f64::consts::TAU.sqrt())
}
