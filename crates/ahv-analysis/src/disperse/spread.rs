//! How a number spreads over members.

use crate::statistics::{OpenEstimate, kurtosis, mean_and_std, quantile};

/// Range, relative to the largest number, that rounding explains: it is no spread.
const ROUNDING: f64 = 1e-12;

/// The distribution of a number over members.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Spread {
    /// Members that have the number.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation (n − 1).
    pub std: f64,
    /// Standard error of the standard deviation, by the fourth moment of the sample: for any distribution. `None` of numbers
    /// that are too few to say.
    pub std_error: Option<f64>,
    /// Lower end of the interval of 95 % of the standard deviation; `None` as well.
    pub std_low: Option<f64>,
    /// Its upper end.
    pub std_high: Option<f64>,
    /// Least value.
    pub min: f64,
    /// 5 % point.
    pub p05: f64,
    /// Median.
    pub p50: f64,
    /// 95 % point.
    pub p95: f64,
    /// Greatest value.
    pub max: f64,
}

impl Spread {
    /// The distribution of `sample`; `None` for fewer than two numbers.
    pub fn of(sample: &[f64]) -> Option<Self> {
        if sample.len() < 2 {
            return None;
        }
        let mut sorted = sample.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (mean, std) = mean_and_std(sample);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let std = if max - min > ROUNDING * max.abs().max(min.abs()) {
            std
        } else {
            0.0
        };
        let count = sample.len();
        // Equal numbers have no kurtosis.
        let kurtosis = if std > 0.0 { kurtosis(sample) } else { 3.0 };
        let interval = OpenEstimate::of_std(std, kurtosis, count as f64);
        let error = 0.5 * std * ((kurtosis - 1.0).max(0.0) / count as f64).sqrt();
        Some(Self {
            count,
            mean,
            std,
            std_error: interval.closed().map(|_| error),
            std_low: interval.low,
            std_high: interval.high,
            min,
            p05: quantile(&sorted, 0.05)?,
            p50: quantile(&sorted, 0.5)?,
            p95: quantile(&sorted, 0.95)?,
            max,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Spread;

    /// What rounding parts has no spread; what is a little more has.
    #[test]
    fn rounding_is_no_spread() {
        let std = |step: f64| Spread::of(&[-47.4, -47.4 - step, -47.4 + step]).map(|it| it.std);
        assert_eq!(std(2e-14), Some(0.0));
        assert!(std(1e-10).is_some_and(|std| std > 5e-11));
    }
}
