//! Interleaved rounds: in each, every candidate has a turn at every subject.

use std::time::Instant;

use serde::Serialize;

use crate::candidates::{Candidate, REFERENCE};
use crate::points::Points;
use crate::subject::SUBJECTS;

/// Rounds before those that count.
const WARM_UP: u32 = 20;
/// Passes over the points in one turn.
const PASSES: usize = 3;

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
}

/// A candidate's times for one subject.
#[derive(Serialize)]
pub(crate) struct Timing {
    pub(crate) function: &'static str,
    pub(crate) candidate: &'static str,
    pub(crate) built: String,
    /// Nanoseconds an evaluation.
    pub(crate) nanoseconds: Spread,
    /// Time over that of the reference in the same round.
    pub(crate) ratio: Spread,
}

/// Times all candidates, by subject and then in the order of the candidates.
pub(crate) fn measure(candidates: &mut [Candidate], points: &[Points], rounds: u32) -> Vec<Timing> {
    let empty = vec![Vec::with_capacity(rounds as usize); candidates.len()];
    let mut times = vec![empty; SUBJECTS.len()];
    for round in 0..WARM_UP + rounds {
        for (subject, points) in points.iter().enumerate() {
            for turn in 0..candidates.len() {
                // Another one begins each round, so that none always follows the same one.
                let index = (turn + round as usize) % candidates.len();
                candidates[index].kernels[subject].move_outputs(round);
                let time = turn_of(&mut candidates[index], subject, points);
                if round >= WARM_UP {
                    times[subject][index].push(time);
                }
            }
        }
    }
    let mut timings = Vec::new();
    for (subject, times) in SUBJECTS.iter().zip(times) {
        let reference = candidates.iter().position(|it| it.name == REFERENCE);
        let reference = reference
            .map(|index| times[index].clone())
            .unwrap_or_default();
        for (candidate, times) in candidates.iter().zip(times) {
            let ratios = times.iter().zip(&reference).map(|(time, base)| time / base);
            timings.push(Timing {
                function: subject.symbol,
                candidate: candidate.name,
                built: candidate.built.clone(),
                ratio: Spread::of(ratios.collect()),
                nanoseconds: Spread::of(times),
            });
        }
    }
    timings
}

/// Nanoseconds an evaluation.
fn turn_of(candidate: &mut Candidate, subject: usize, points: &Points) -> f64 {
    let kernel = &mut candidate.kernels[subject];
    let start = Instant::now();
    for _ in 0..PASSES {
        kernel.sweep(points);
    }
    start.elapsed().as_secs_f64() * 1e9 / (PASSES * points.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::Spread;

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
}
