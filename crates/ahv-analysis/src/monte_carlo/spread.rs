//! How a number spreads over the members, in memory that does not grow with them.

use crate::statistics::{OpenEstimate, ranks};

/// Bins between the outer two.
const BINS: usize = 2000;
/// What the bins reach beyond the first numbers, in units of their range, on either side.
const MARGIN: f64 = 0.5;
/// What of the first numbers lies farther from the middle half than so many times its width does not choose the bins: a number
/// that diverges would leave one bin for all others. Of normal numbers it is 27 standard deviations.
const REACH: f64 = 20.0;

/// Shares of the members at whose quantiles is looked.
pub const QUANTILES: [f64; 7] = [0.005, 0.05, 0.25, 0.5, 0.75, 0.95, 0.995];

/// Where the bins lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bins {
    /// Lower edge of the first one that is not open.
    pub(super) low: f64,
    /// Width of each.
    pub(super) width: f64,
}

/// The numbers of the first members as they are, and the counts of all in bins that are chosen by the first.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Spread {
    /// `None` once there are more.
    #[serde(with = "super::bits::some")]
    exact: Option<Vec<f64>>,
    #[serde(with = "super::bits::one")]
    low: f64,
    #[serde(with = "super::bits::one")]
    width: f64,
    /// The first and the last bin are open.
    counts: Vec<u64>,
    count: u64,
    #[serde(with = "super::bits::one")]
    min: f64,
    #[serde(with = "super::bits::one")]
    max: f64,
}

/// Numbers that lie between two edges.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Bin {
    /// Lower edge.
    pub low: f64,
    /// Upper edge.
    pub high: f64,
    /// How many.
    pub count: u64,
}

impl Bins {
    /// Those that these numbers choose; there may be others.
    pub(super) fn of(first: &[f64]) -> Self {
        let mut sorted = first.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| sorted.get((share * sorted.len() as f64) as usize).copied();
        let min = sorted.first().copied().unwrap_or(f64::INFINITY);
        let max = sorted.last().copied().unwrap_or(f64::NEG_INFINITY);
        let [lower, upper] = [at(0.25).unwrap_or(min), at(0.75).unwrap_or(max)];
        let reach = REACH * (upper - lower);
        // Where half of them are equal, all choose.
        let [from, to] = if reach > 0.0 {
            [min.max(lower - reach), max.min(upper + reach)]
        } else {
            [min, max]
        };
        let range = to - from;
        Self {
            low: from - MARGIN * range,
            width: (1.0 + 2.0 * MARGIN) * range / BINS as f64,
        }
    }
}

impl Spread {
    /// Of no numbers so far.
    pub(super) fn new(bins: Bins) -> Self {
        Self {
            exact: Some(Vec::new()),
            low: bins.low,
            width: bins.width,
            counts: vec![0; BINS + 2],
            count: 0,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
        }
    }

    /// Numbers more; those that are the first of all are kept as they are until others follow.
    pub(super) fn extend(&mut self, numbers: &[f64], first_of_all: bool) {
        numbers.iter().for_each(|&value| self.count(value));
        self.exact = first_of_all.then(|| numbers.to_vec());
    }

    /// What another saw with the same bins.
    pub(super) fn merge(&mut self, other: &Self) {
        for (count, other) in self.counts.iter_mut().zip(&other.counts) {
            *count += other;
        }
        self.count += other.count;
        (self.min, self.max) = (self.min.min(other.min), self.max.max(other.max));
        self.exact = None;
    }

    /// Whether its bins are these.
    pub(super) fn has(&self, bins: Bins) -> bool {
        let same = |a: f64, b: f64| a.to_bits() == b.to_bits();
        same(self.low, bins.low) && same(self.width, bins.width) && self.counts.len() == BINS + 2
    }

    /// Forgets the numbers as they are.
    pub(super) fn forget(&mut self) {
        self.exact = None;
    }

    /// One number more in its bin.
    fn count(&mut self, value: f64) {
        self.count += 1;
        (self.min, self.max) = (self.min.min(value), self.max.max(value));
        // Infinite for bins without width: then what is not equal lies in the outer ones.
        let place = ((value - self.low) / self.width).floor();
        let bin = if place < 0.0 {
            0
        } else if place < BINS as f64 {
            1 + place as usize
        } else if value == self.low {
            1
        } else {
            BINS + 1
        };
        if let Some(count) = self.counts.get_mut(bin) {
            *count += 1;
        }
    }

    /// The quantile of this share, with its interval of 95 % by the ranks (binomial); the ends are edges where there are bins.
    ///
    /// A value that lies in an outer bin is not known, nor one of no numbers.
    pub(super) fn quantile(&self, share: f64) -> OpenEstimate {
        if let Some(numbers) = self.as_they_are() {
            let mut sorted = numbers.to_vec();
            sorted.sort_by(f64::total_cmp);
            return OpenEstimate::of_sorted(&sorted, share);
        }
        let [low, high] = ranks(share, self.count);
        let edges = |rank: Option<u64>| rank.and_then(|rank| self.edges(rank));
        let value = self.binned(share);
        // Where bins are wide beside where they lie, rounding may put an edge on the other side.
        OpenEstimate {
            value,
            low: edges(low).map(|[low, _]| low.min(value.unwrap_or(low))),
            high: edges(high).map(|[_, high]| high.max(value.unwrap_or(high))),
        }
    }

    /// The numbers, where they are there as they are.
    fn as_they_are(&self) -> Option<&[f64]> {
        let none = (self.count == 0).then_some([].as_slice());
        none.or(self.exact.as_deref())
    }

    /// Numbers that the one of this rank, from 1, lies between: the edges of its bin.
    fn edges(&self, rank: u64) -> Option<[f64; 2]> {
        let mut below = 0;
        let bin = self.counts.iter().position(|&count| {
            below += count;
            below >= rank
        })?;
        let edge = |bin: usize| self.low + bin as f64 * self.width;
        let low = if bin == 0 { self.min } else { edge(bin - 1) };
        let high = if bin > BINS { self.max } else { edge(bin) };
        Some([low.max(self.min), high.min(self.max)])
            .filter(|ends| ends.iter().all(|end| end.is_finite()))
    }

    /// The quantile by straight lines within bins.
    fn binned(&self, share: f64) -> Option<f64> {
        let wanted = share * self.count as f64;
        let mut below = 0.0;
        for (bin, &count) in self.counts.iter().enumerate() {
            let count = count as f64;
            if count > 0.0 && below + count >= wanted {
                let inner = (1..=BINS).contains(&bin);
                let part = ((wanted - below) / count).clamp(0.0, 1.0);
                let value = self.low + ((bin as f64 - 1.0) + part) * self.width;
                return inner.then(|| value.clamp(self.min, self.max));
            }
            below += count;
        }
        None
    }

    /// Half of the greatest error that bins add to a quantile; 0 while the numbers are there as they are.
    pub(super) fn resolution(&self) -> f64 {
        if self.as_they_are().is_some() {
            0.0
        } else {
            self.width
        }
    }

    /// `bins` bins of equal width from the least number to the greatest.
    pub(super) fn histogram(&self, bins: usize) -> Vec<Bin> {
        if self.count == 0 {
            return Vec::new();
        }
        let edge = |index: usize| self.min + (self.max - self.min) * index as f64 / bins as f64;
        let mut histogram: Vec<Bin> = (0..bins)
            .map(|index| Bin {
                low: edge(index),
                high: edge(index + 1),
                count: 0,
            })
            .collect();
        let range = self.max - self.min;
        let mut put = |value: f64, count: u64| {
            let place = ((value - self.min) / range * bins as f64).max(0.0) as usize;
            if let Some(bin) = histogram.get_mut(place.min(bins.saturating_sub(1))) {
                bin.count += count;
            }
        };
        match self.as_they_are() {
            Some(numbers) => numbers.iter().for_each(|&value| put(value, 1)),
            None => {
                for (bin, &count) in self
                    .counts
                    .iter()
                    .enumerate()
                    .filter(|(_, count)| **count > 0)
                {
                    put(self.low + (bin as f64 - 0.5) * self.width, count);
                }
            }
        }
        histogram
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(first: &[f64]) -> Spread {
        let mut spread = Spread::new(Bins::of(first));
        spread.extend(first, true);
        spread
    }

    fn counts(histogram: &[Bin]) -> Vec<u64> {
        histogram.iter().map(|bin| bin.count).collect()
    }

    /// Of numbers that are there as they are: each bin holds those between its edges, and the last one the greatest too.
    #[test]
    fn a_histogram_counts_what_lies_between_its_edges() {
        let numbers: Vec<f64> = (0..60).map(|it| f64::from(it * it)).collect();
        let histogram = of(&numbers).histogram(7);
        assert_eq!(histogram.len(), 7);
        assert_eq!((histogram[0].low, histogram[6].high), (0.0, 3481.0));
        for (index, bin) in histogram.iter().enumerate() {
            assert!((bin.high - bin.low - 3481.0 / 7.0).abs() < 1e-9);
            let inside = |it: &&f64| bin.low <= **it && (**it < bin.high || index == 6);
            assert_eq!(bin.count, numbers.iter().filter(inside).count() as u64);
        }
        assert_eq!(of(&[]).histogram(7), []);
        assert_eq!(counts(&of(&[4.0; 5]).histogram(3)), [5, 0, 0]);
    }

    /// Of two thousand numbers that choose the bins one has diverged, and of those that follow one more.
    #[test]
    fn a_number_that_diverges_leaves_the_quantiles_of_the_others() {
        let place = |it: u32| (f64::from(it) * 0.618_033_988_749_895).fract();
        let mut first: Vec<f64> = (0..2000).map(place).collect();
        first[7] = 1e230;
        let mut spread = of(&first);
        spread.extend(&(2000..10_000).map(place).collect::<Vec<_>>(), false);
        spread.extend(&[-1e90], false);
        for (share, known) in [(0.05, 0.05), (0.5, 0.5), (0.995, 0.995)] {
            let found = spread.quantile(share);
            let value = found.value.expect("within the bins");
            assert!((value - known).abs() < 0.02, "{share}: {value}");
            assert!(found.low <= found.value && found.value <= found.high);
        }
        assert!(spread.resolution() < 0.05);
        // Who is beyond the bins is counted, but where is not known.
        assert_eq!(spread.quantile(1.0).value, None);
    }

    /// Evenly spread numbers, of which the first hundred choose the bins; then two that lie far beyond.
    #[test]
    fn a_histogram_of_many_numbers_counts_them_all() {
        let place = |it: u32| (f64::from(it) * 0.618_033_988_749_895).fract();
        let mut spread = of(&(0..100).map(place).collect::<Vec<_>>());
        spread.extend(&(100..10_000).map(place).collect::<Vec<_>>(), false);
        let even = counts(&spread.histogram(8));
        assert_eq!(even.iter().sum::<u64>(), 10_000);
        assert!(
            even.iter().all(|count| count.abs_diff(1250) <= 10),
            "{even:?}"
        );
        spread.extend(&[-9.5], false);
        spread.extend(&[10.5], false);
        let wide = spread.histogram(20);
        assert_eq!((wide[0].low, wide[19].high), (-9.5, 10.5));
        let wide = counts(&wide);
        assert_eq!(wide.iter().sum::<u64>(), 10_002);
        assert!(
            wide[9..11].iter().all(|count| count.abs_diff(5000) <= 10),
            "{wide:?}"
        );
    }
}
