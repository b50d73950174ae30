//! Interleaved rounds: in each, every candidate has a turn.

use serde::Serialize;

/// Order statistics of many measurements.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Spread {
    pub(crate) min: f64,
    pub(crate) lower_quartile: f64,
    pub(crate) median: f64,
    pub(crate) upper_quartile: f64,
}

impl Spread {
    /// Of at least one value; all NaN for none.
    pub(crate) fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let last = values.len().saturating_sub(1);
        let at = |share: f64| {
            let index = (share * last as f64).round() as usize;
            values.get(index).copied().unwrap_or(f64::NAN)
        };
        Self {
            min: at(0.0),
            lower_quartile: at(0.25),
            median: at(0.5),
            upper_quartile: at(0.75),
        }
    }

    /// Lower quartile, median and upper quartile of `scale` over the values, which are positive.
    pub(crate) fn rates(&self, scale: f64) -> [f64; 3] {
        [self.upper_quartile, self.median, self.lower_quartile].map(|it| scale / it)
    }
}

/// What the turns of a candidate took.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct Measured {
    /// What a turn says of itself.
    pub(crate) time: Spread,
    /// Over that of the first candidate in the same round.
    pub(crate) ratio: Spread,
}

/// Gives each of `count` candidates its turn in each round; `turn(candidate, round)` tells its time.
///
/// # Errors
/// The first error of a turn.
pub(crate) fn interleave(
    count: usize,
    warm_up: u32,
    rounds: u32,
    mut turn: impl FnMut(usize, u32) -> Result<f64, String>,
) -> Result<Vec<Measured>, String> {
    let mut times = vec![Vec::with_capacity(rounds as usize); count];
    for round in 0..warm_up + rounds {
        for place in 0..count {
            // Another one begins each round, so that none always follows the same one.
            let index = (place + round as usize) % count;
            let time = turn(index, round)?;
            if round >= warm_up {
                times[index].push(time);
            }
        }
    }
    let base = times.first().cloned().unwrap_or_default();
    let measured = times.into_iter().map(|times| {
        let ratios = times.iter().zip(&base).map(|(own, base)| own / base);
        Measured {
            ratio: Spread::of(ratios.collect()),
            time: Spread::of(times),
        }
    });
    Ok(measured.collect())
}

#[cfg(test)]
mod tests {
    use super::{Spread, interleave};

    #[test]
    fn spread_is_by_rank() {
        let spread = Spread::of(vec![5.0, 1.0, 4.0, 2.0, 3.0]);
        let expected = Spread {
            min: 1.0,
            lower_quartile: 2.0,
            median: 3.0,
            upper_quartile: 4.0,
        };
        assert_eq!(spread, expected);
    }

    #[test]
    fn ratios_are_taken_within_a_round() -> Result<(), String> {
        // The machine gets slower, the second stays twice as slow as the first.
        let time = |index: usize, round: u32| f64::from(round + 1) * [1.0, 2.0][index];
        let measured = interleave(2, 1, 3, |index, round| Ok(time(index, round)))?;
        assert_eq!(measured[0].time.min, 2.0);
        assert_eq!(measured[1].ratio.min, 2.0);
        assert_eq!(measured[1].ratio.upper_quartile, 2.0);
        Ok(())
    }
}
