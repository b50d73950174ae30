//! Estimates from samples, with their confidence.

/// 97.5 % point of the standard normal distribution.
pub const Z_95: f64 = 1.959_963_984_540_054;
/// What an interval of 95 % leaves on either side.
const TAIL: f64 = 0.025;
/// Fewest numbers that the interval of a standard deviation is made of. The kurtosis of two numbers is 1 and that of three 1.5,
/// whichever they are: they say nothing of the law.
pub const FEWEST_OF_STD: f64 = 4.0;
/// 97.5 % points of Student's distribution with 1 to 8 degrees of freedom.
const STUDENT_95: [f64; 8] = [
    12.706_204_736,
    4.302_652_730,
    3.182_446_305,
    2.776_445_105,
    2.570_581_836,
    2.446_911_851,
    2.364_624_252,
    2.306_004_135,
];
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
    /// A mean of `count` numbers with standard deviation `std`, with its interval of 95 % by Student's distribution: exact for
    /// normal numbers, nearly so for many of any law with a variance.
    pub fn of_mean(mean: f64, std: f64, count: f64) -> Self {
        let half = student_95(count - 1.0) * std / count.sqrt();
        Self {
            value: mean,
            low: mean - half,
            high: mean + half,
        }
    }

    /// A standard deviation of `count` numbers that are exactly normal, with its interval of 95 %.
    ///
    /// Only for laws that are known to be normal: of others it covers as little as half of what it says. χ² quantiles by Wilson
    /// and Hilferty 1931, within 0.1 % of the exact ones from 30 numbers on.
    pub fn of_normal_std(std: f64, count: f64) -> Self {
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

/// A value with an interval of 95 % whose sides may be open (`None`): the numbers are too few to say where it ends.
///
/// Of a quantile a side is open that the sample has no rank for, of a standard deviation both are that has no kurtosis.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct OpenEstimate {
    /// The value; `None` where it is not known.
    pub value: Option<f64>,
    /// Lower end; `None` where the side is open.
    pub low: Option<f64>,
    /// Upper end; `None` where the side is open.
    pub high: Option<f64>,
}

impl OpenEstimate {
    /// A standard deviation (n − 1) of `count` numbers of any law, with its interval of 95 %; of fewer than [`FEWEST_OF_STD`]
    /// both sides are open.
    ///
    /// `kurtosis` is m₄/m₂² of the sample, 3 for normal numbers. Bonett's interval of the logarithm (Bonett 2006), about the mean
    /// in place of a trimmed mean, and with the unbiased estimate of the kurtosis where that is larger. `docs/monte-carlo.md` has
    /// its measured coverage: with few numbers of a heavy-tailed law it covers less than it says.
    pub fn of_std(std: f64, kurtosis: f64, count: f64) -> Self {
        if count < FEWEST_OF_STD {
            return Self {
                value: Some(std),
                low: None,
                high: None,
            };
        }
        let unbiased = 3.0
            + (count - 1.0) / ((count - 2.0) * (count - 3.0))
                * ((count + 1.0) * (kurtosis - 3.0) + 6.0);
        let kurtosis = kurtosis.max(unbiased);
        let centre = count / (count - Z_95);
        let error = centre * ((kurtosis - (count - 3.0) / count) / (count - 1.0)).sqrt();
        // Half, for it is the interval of a variance.
        let end = |z: f64| Some(std * (0.5 * (centre.ln() + z * error)).exp());
        Self {
            value: Some(std),
            low: end(-Z_95),
            high: end(Z_95),
        }
    }

    /// A standard deviation of a sample of any law, with its interval of 95 %, as [`Self::of_std`].
    pub fn of_sample_std(sample: &[f64]) -> Self {
        let (_, std) = mean_and_std(sample);
        // Equal numbers have no kurtosis.
        let kurtosis = if std > 0.0 { kurtosis(sample) } else { 3.0 };
        Self::of_std(std, kurtosis, sample.len() as f64)
    }

    /// The same if no side is open.
    pub fn closed(&self) -> Option<Estimate> {
        Some(Estimate {
            value: self.value?,
            low: self.low?,
            high: self.high?,
        })
    }

    /// Whether all of its numbers are finite, those that there are.
    pub fn is_finite(&self) -> bool {
        let mut numbers = [self.value, self.low, self.high].into_iter().flatten();
        numbers.all(f64::is_finite)
    }

    /// The `share` quantile of ascending numbers, with its interval by [`ranks`].
    pub fn of_sorted(sorted: &[f64], share: f64) -> Self {
        let [low, high] = ranks(share, sorted.len() as u64);
        let at = |rank: Option<u64>| sorted.get(usize::try_from(rank? - 1).ok()?).copied();
        let (low, high) = (at(low), at(high));
        // Of a handful of numbers the straight line between neighbours may lie beyond a safe rank.
        let within = |value: f64| {
            value
                .max(low.unwrap_or(f64::NEG_INFINITY))
                .min(high.unwrap_or(f64::INFINITY))
        };
        Self {
            value: quantile(sorted, share).map(within),
            low,
            high,
        }
    }

    /// Whether `value` lies in the interval.
    pub fn holds(&self, value: f64) -> bool {
        self.low.is_none_or(|low| low <= value) && self.high.is_none_or(|high| value <= high)
    }
}

impl From<Option<Estimate>> for OpenEstimate {
    fn from(estimate: Option<Estimate>) -> Self {
        Self {
            value: estimate.map(|it| it.value),
            low: estimate.map(|it| it.low),
            high: estimate.map(|it| it.high),
        }
    }
}

/// Ranks, from 1, of the ends of an interval of 95 % of the `share` quantile of `count` numbers.
///
/// The number of those below the quantile is binomial: either end is beyond the quantile with probability 2.5 % at most.
/// `None` where no rank is so safe.
pub fn ranks(share: f64, count: u64) -> [Option<u64>; 2] {
    let from_below = |share| Some(safe_rank(share, count)).filter(|&rank| rank > 0);
    [
        from_below(share),
        from_below(1.0 - share).map(|rank| count + 1 - rank),
    ]
}

/// Largest r for which fewer than r of `count` trials of probability `share` succeed with probability 2.5 % at most.
fn safe_rank(share: f64, count: u64) -> u64 {
    let n = count as f64;
    let (mean, deviation) = (n * share, (n * share * (1.0 - share)).sqrt());
    // What lies further away is less than rounding.
    let first = (mean - 10.0 * deviation - 10.0).max(0.0).floor();
    let choices = libm::lgamma(n + 1.0) - libm::lgamma(first + 1.0) - libm::lgamma(n - first + 1.0);
    let logarithm = choices + first * share.ln() + (n - first) * (-share).ln_1p();
    let (mut successes, mut probability) = (first, logarithm.exp());
    let mut below = probability;
    while below <= TAIL && successes < n {
        probability *= (n - successes) / (successes + 1.0) * share / (1.0 - share);
        successes += 1.0;
        below += probability;
    }
    successes as u64
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

/// The standard deviation of this variance: rounding may have made a small one negative, and one that is no number stays so.
pub fn deviation_of(variance: f64) -> f64 {
    if variance < 0.0 { 0.0 } else { variance.sqrt() }
}

/// Sample mean and standard deviation (n − 1) of numbers; 0 where there are too few.
pub fn mean_and_std(sample: &[f64]) -> (f64, f64) {
    let count = sample.len() as f64;
    let mean = sample.iter().sum::<f64>() / count.max(1.0);
    let squares: f64 = sample.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, (squares / (count - 1.0).max(1.0)).sqrt())
}

/// Spearman's rank correlation of paired numbers, equal ones with the mean of their ranks; `None` if all of one are equal.
pub fn rank_correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let (a, b) = (ranks_of(a), ranks_of(b));
    let ((mean_a, std_a), (mean_b, std_b)) = (mean_and_std(&a), mean_and_std(&b));
    let products = a.iter().zip(&b).map(|(a, b)| (a - mean_a) * (b - mean_b));
    let covariance = products.sum::<f64>() / (a.len() as f64 - 1.0);
    let correlation = covariance / (std_a * std_b);
    correlation
        .is_finite()
        .then(|| correlation.clamp(-1.0, 1.0))
}

/// The probability that the rank correlation of `count` pairs that have nothing to do with each other is this far from 0: its
/// standard deviation is then 1/√(n − 1), and its law nearly normal (Kendall and Gibbons 1990, section 4.14).
pub fn chance_of_rank_correlation(correlation: f64, count: usize) -> f64 {
    let spread = (count as f64 - 1.0).max(1.0).sqrt();
    libm::erfc(correlation.abs() * spread / std::f64::consts::SQRT_2)
}

/// The rank of each number, from 1.
fn ranks_of(sample: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..sample.len()).collect();
    order.sort_by(|&i, &j| sample[i].total_cmp(&sample[j]));
    let mut ranks = vec![0.0; sample.len()];
    let mut before = 0;
    for equal in order.chunk_by(|&i, &j| sample[i] == sample[j]) {
        let mean = before as f64 + 0.5 * (equal.len() as f64 + 1.0);
        for &index in equal {
            ranks[index] = mean;
        }
        before += equal.len();
    }
    ranks
}

/// Fourth standardised moment m₄/m₂²: 3 for a normal distribution, with a standard error of √(24/n).
pub fn kurtosis(sample: &[f64]) -> f64 {
    let count = sample.len() as f64;
    let (mean, _) = mean_and_std(sample);
    let moment = |power| sample.iter().map(|x| (x - mean).powi(power)).sum::<f64>() / count;
    moment(4) / moment(2).powi(2)
}

/// 97.5 % point of Student's distribution: tabulated up to eight degrees of freedom, then by the expansion about the normal
/// one (Abramowitz and Stegun 1964, 26.7.5).
pub fn student_95(freedom: f64) -> f64 {
    if let Some(&point) = STUDENT_95.get((freedom - 1.0).max(0.0) as usize) {
        return point;
    }
    let z = Z_95;
    let [z_3, z_5, z_7, z_9] = [3, 5, 7, 9].map(|power| z.powi(power));
    z + (z_3 + z) / (4.0 * freedom)
        + (5.0 * z_5 + 16.0 * z_3 + 3.0 * z) / (96.0 * freedom.powi(2))
        + (3.0 * z_7 + 19.0 * z_5 + 17.0 * z_3 - 15.0 * z) / (384.0 * freedom.powi(3))
        + (79.0 * z_9 + 776.0 * z_7 + 1482.0 * z_5 - 1920.0 * z_3 - 945.0 * z)
            / (92160.0 * freedom.powi(4))
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

#[cfg(test)]
mod tests;
