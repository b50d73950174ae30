//! Probabilities of rare events, by splitting.
//!
//! Levels stand between the start and a limit. Whoever passes a level is copied, and the copies fly on from there with noise
//! of their own, so that each level is passed by a fair share of those before it (Kahn and Harris 1951). As many members start
//! from each level (fixed effort, Garvels 2000): the product of the shares is an unbiased estimate of the probability for any
//! levels that were chosen beforehand. Here a pilot chooses them, as quantiles of how far its members come (Cérou and Guyader
//! 2007), and its members are not counted. Independent repetitions give the interval.

mod error;

use ahv_integrate::NormalStream;
use rayon::prelude::*;

use super::MonteCarloError;
use super::engine::{Engine, pool};
use super::experiment::{Experiment, Particle};
use super::lanes::LANES;
use super::passage::{Goal, PassageRecord};
use crate::ordered::Control;
use crate::statistics::{Estimate, Z_95, mean_and_std, student_95};
pub use error::RareError;

/// Fewest repetitions: from there on, Student's quantile is right to four digits.
pub const FEWEST_REPETITIONS: u64 = 10;
/// Share of its members by which the pilot lets a level be passed.
const SHARE: f64 = 0.2;
/// Levels that the pilot sets at most.
const MOST_LEVELS: usize = 200;

/// A state passes a limit before the flight ends.
///
/// It is looked at after every step, and at the start: the event is that of the sampled path.
#[derive(Clone, Debug, PartialEq)]
pub struct RareEvent {
    /// Number of the state.
    pub state: usize,
    /// Limit, in the unit of the state, above or below where the members start.
    pub limit: f64,
    /// Members that start from each level.
    pub effort: u64,
    /// Levels between start and limit, in the order in which they are passed; `None` if a pilot shall choose them.
    pub levels: Option<Vec<f64>>,
    /// Independent repetitions.
    pub repetitions: u64,
}

/// A level, and how it was passed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Level {
    /// The level, in the unit of the state.
    pub value: f64,
    /// Share by which it was passed, of all that started from the one before.
    pub share: f64,
}

/// The probability of a rare event.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct RareEstimate {
    /// The probability with its interval of 95 %, by Student's distribution of the mean of the repetitions.
    ///
    /// It is right for a mean that is nearly normal: with few members from each level the repetitions spread to one side, and
    /// the interval lies too low too often.
    pub probability: Estimate,
    /// The levels; the limit is the last.
    pub levels: Vec<Level>,
    /// Repetitions that the estimate is of; fewer than were asked for if the work was stopped.
    pub repetitions: u64,
    /// Steps of members, the pilot's included.
    pub member_steps: u64,
    /// Steps of members that plain sampling needs for an interval as wide: p (1 − p) (z/half)² flights.
    pub plain_member_steps: f64,
    /// Members of the repetitions that were lost before the limit; they count as not having passed it.
    pub lost: u64,
}

impl Engine<'_> {
    /// The probability that a state passes a limit before the flight ends, on `threads` threads.
    ///
    /// The same numbers whatever the threads. The limit may be some standard deviations away, and the probability 10⁻¹⁰: the
    /// work grows with the logarithm of the probability.
    ///
    /// # Errors
    ///
    /// [`RareError`], [`MonteCarloError`].
    pub fn first_passage(
        &self,
        event: &RareEvent,
        threads: usize,
        control: &Control,
    ) -> Result<RareEstimate, MonteCarloError> {
        let heights = event.check(self)?;
        let pool = pool(threads)?;
        let mut search = Search {
            engine: self,
            event,
            control,
            goal: event.goal(self.experiment),
            next: 0,
            member_steps: 0,
            lost: 0,
        };
        pool.install(|| {
            let heights = match heights {
                Some(heights) => heights,
                None => {
                    let mut set = Vec::new();
                    let done = search.pilot(&mut set);
                    done.map_err(|error| search.told(error, &set, 0))?;
                    set
                }
            };
            search.repeat(&heights)
        })
    }
}

impl RareEvent {
    /// Where the members start, in the mean.
    fn start(&self, experiment: &Experiment) -> Option<f64> {
        experiment.state[0].get(self.state).copied()
    }

    /// The limit.
    fn goal(&self, experiment: &Experiment) -> Goal {
        let start = self.start(experiment).unwrap_or(0.0);
        let sign = if self.limit > start { 1.0 } else { -1.0 };
        Goal {
            state: self.state,
            sign,
            height: sign * self.limit,
        }
    }

    /// Heights of the levels that are given, that of the limit included.
    fn check(&self, engine: &Engine<'_>) -> Result<Option<Vec<f64>>, RareError> {
        let (experiment, names) = (engine.experiment, engine.states);
        if experiment.steps() == 0 {
            return Err(RareError::Flight);
        }
        let Some((start, name)) = self.start(experiment).zip(names.get(self.state)) else {
            return Err(RareError::State {
                state: self.state,
                states: names.len(),
            });
        };
        let limit = self.limit;
        if !(limit.is_finite() && start.is_finite() && limit != start) {
            return Err(RareError::Limit {
                state: name,
                limit,
                start,
            });
        }
        if self.effort == 0 {
            return Err(RareError::Effort);
        }
        if self.repetitions < FEWEST_REPETITIONS {
            return Err(RareError::Repetitions {
                repetitions: self.repetitions,
            });
        }
        let Some(levels) = &self.levels else {
            return Ok(None);
        };
        let Goal { sign, height, .. } = self.goal(experiment);
        let mut after = start;
        for &level in levels {
            if !(sign * level > sign * after && sign * level < height) {
                return Err(RareError::Level {
                    level,
                    after,
                    limit,
                });
            }
            after = level;
        }
        let heights = levels.iter().map(|level| sign * level).chain([height]);
        Ok(Some(heights.collect()))
    }
}

/// How a level was passed.
#[derive(Clone, Copy, Default)]
struct Count {
    /// Members that started to it.
    started: u64,
    /// Those that passed it.
    passed: u64,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.started += other.started;
        self.passed += other.passed;
    }

    fn share(self) -> f64 {
        self.passed as f64 / self.started.max(1) as f64
    }
}

/// Splitting at work.
struct Search<'e> {
    engine: &'e Engine<'e>,
    event: &'e RareEvent,
    control: &'e Control,
    /// The limit.
    goal: Goal,
    /// Number of the member that comes next: no two have the same noise.
    next: u64,
    member_steps: u64,
    lost: u64,
}

impl Search<'_> {
    /// Heights of levels that a fair share of the members passes, that of the limit included.
    ///
    /// Members fly twice with the same noise: to find the level, and to pass it.
    fn pilot(&mut self, heights: &mut Vec<f64>) -> Result<(), MonteCarloError> {
        let Goal {
            sign,
            height: limit,
            ..
        } = self.goal;
        let start = self.event.start(self.engine.experiment).unwrap_or(0.0);
        let mut last = sign * start;
        let mut flying = self.starts();
        while heights.len() < MOST_LEVELS {
            let flown = self.fly(&flying, limit)?;
            // Of those that fly: who is lost tells nothing of a level.
            let flying_on = flown.iter().filter(|passed| !passed.lost);
            let mut most: Vec<f64> = flying_on.map(|passed| passed.most).collect();
            if most.is_empty() {
                return Err(RareError::Lost.into());
            }
            most.sort_by(|a, b| b.total_cmp(a));
            let place = (SHARE * most.len() as f64).ceil() as usize;
            let height = most.get(place.min(most.len() - 1)).copied().unwrap_or(last);
            if height >= limit {
                heights.push(limit);
                self.lost = 0;
                return Ok(());
            }
            if height <= last {
                break;
            }
            let entrances = entrances(self.fly(&flying, height)?);
            // Copies that came no further than where they started share one height.
            if entrances.is_empty() {
                break;
            }
            flying = self.copies(&entrances);
            heights.push(height);
            last = height;
        }
        Err(RareError::OutOfReach { level: sign * last }.into())
    }

    /// The estimate by independent repetitions with these levels; stopped, by those that were flown if they are enough.
    fn repeat(mut self, heights: &[f64]) -> Result<RareEstimate, MonteCarloError> {
        let (mut counts, mut values) = (vec![Count::default(); heights.len()], Vec::new());
        let mut stopped = None;
        for _ in 0..self.event.repetitions {
            let before = (self.member_steps, self.lost);
            match self.repetition(heights) {
                Ok((value, counted)) => {
                    values.push(value);
                    let levels = counts.iter_mut().zip(counted);
                    levels.for_each(|(count, counted)| count.add(counted));
                }
                Err(MonteCarloError::Stopped) => {
                    (self.member_steps, self.lost) = before;
                    stopped = Some(MonteCarloError::Stopped);
                    break;
                }
                Err(error) => return Err(error),
            }
        }
        let flown = values.len() as u64;
        let enough = flown >= FEWEST_REPETITIONS;
        match (stopped, self.estimate(heights, &counts, &values)) {
            (None, estimate) => estimate.map_err(MonteCarloError::from),
            (Some(_), Ok(estimate)) if enough => Ok(estimate),
            (Some(stopped), _) => Err(self.told(stopped, heights, flown)),
        }
    }

    /// One of them: the product of the shares, and the counts of the levels that it came to.
    fn repetition(&mut self, heights: &[f64]) -> Result<(f64, Vec<Count>), MonteCarloError> {
        let (mut value, mut counts) = (1.0, Vec::new());
        let mut flying = self.starts();
        for &height in heights {
            let entrances = entrances(self.fly(&flying, height)?);
            let count = Count {
                started: flying.len() as u64,
                passed: entrances.len() as u64,
            };
            counts.push(count);
            value *= count.share();
            if entrances.is_empty() {
                break;
            }
            flying = self.copies(&entrances);
        }
        Ok((value, counts))
    }

    /// What the repetitions give.
    fn estimate(
        &self,
        heights: &[f64],
        counts: &[Count],
        values: &[f64],
    ) -> Result<RareEstimate, RareError> {
        let levels = heights.iter().zip(counts).map(|(height, count)| Level {
            value: self.goal.sign * height,
            share: count.share(),
        });
        let levels: Vec<Level> = levels.collect();
        if let Some(level) = levels.iter().find(|level| level.share == 0.0) {
            return Err(RareError::OutOfReach { level: level.value });
        }
        let (mean, half) = mean_and_half(values);
        if half == 0.0 {
            return Err(RareError::NoSpread { value: mean });
        }
        let flights = mean * (1.0 - mean) * (Z_95 / half).powi(2);
        Ok(RareEstimate {
            probability: Estimate {
                value: mean,
                low: (mean - half).max(0.0),
                high: (mean + half).min(1.0),
            },
            levels,
            repetitions: values.len() as u64,
            member_steps: self.member_steps,
            plain_member_steps: flights * self.engine.experiment.steps() as f64,
            lost: self.lost,
        })
    }

    /// Of work that was stopped, what it came to.
    fn told(&self, error: MonteCarloError, heights: &[f64], repetitions: u64) -> MonteCarloError {
        if error != MonteCarloError::Stopped {
            return error;
        }
        let levels = heights.iter().map(|height| self.goal.sign * height);
        MonteCarloError::from(RareError::Stopped {
            levels: levels.collect(),
            repetitions,
            asked: self.event.repetitions,
            member_steps: self.member_steps,
        })
    }

    /// Members at the start.
    fn starts(&mut self) -> Vec<Particle> {
        let first = self.next;
        self.next += self.event.effort;
        (first..self.next)
            .map(|member| self.engine.experiment.particle(member))
            .collect()
    }

    /// As many members as start from a level, each from one of the entrances: from every one equally many, but for rounding,
    /// which one number decides for all (systematic resampling).
    fn copies(&mut self, entrances: &[Particle]) -> Vec<Particle> {
        let effort = self.event.effort;
        let normal = NormalStream::new(self.engine.experiment.seed, self.next, 0).normal(0);
        let uniform = 0.5 * libm::erfc(-normal / std::f64::consts::SQRT_2);
        let first = self.next + 1;
        self.next = first + effort;
        let spacing = entrances.len() as f64 / effort as f64;
        let copy = |index: u64| {
            let place = ((index as f64 + uniform) * spacing) as usize;
            let entrance = entrances.get(place.min(entrances.len() - 1))?;
            Some(Particle {
                member: first + index,
                ..entrance.clone()
            })
        };
        (0..effort).filter_map(copy).collect()
    }

    /// Flies members until they pass this height.
    fn fly(
        &mut self,
        flying: &[Particle],
        height: f64,
    ) -> Result<Vec<PassageRecord>, MonteCarloError> {
        let goal = Goal {
            height,
            ..self.goal
        };
        let flown: Vec<Option<Vec<PassageRecord>>> = flying
            .par_chunks(LANES)
            .map(|batch| self.engine.propagator.pass(batch, &goal, self.control))
            .collect::<Result<_, _>>()?;
        let flown: Option<Vec<Vec<_>>> = flown.into_iter().collect();
        let flown: Vec<_> = flown
            .ok_or(MonteCarloError::Stopped)?
            .into_iter()
            .flatten()
            .collect();
        self.member_steps += flown.iter().map(|passed| passed.steps).sum::<u64>();
        self.lost += flown.iter().filter(|passed| passed.lost).count() as u64;
        Ok(flown)
    }
}

/// Where a level was passed, by time: those that fly on side by side then have about as long to go.
fn entrances(flown: Vec<PassageRecord>) -> Vec<Particle> {
    let mut entrances: Vec<_> = flown.into_iter().filter_map(|passed| passed.at).collect();
    entrances.sort_by_key(|entrance| entrance.step);
    entrances
}

/// Mean, and half the width of its interval of 95 % by Student's distribution.
fn mean_and_half(values: &[f64]) -> (f64, f64) {
    let (mean, std) = mean_and_std(values);
    let count = values.len() as f64;
    (mean, student_95(count - 1.0) * std / count.sqrt())
}

#[cfg(test)]
mod tests {
    use super::mean_and_half;

    /// Student's table: two numbers have one degree of freedom, and four have three.
    #[test]
    fn the_interval_of_a_few_repetitions_is_students() {
        let (mean, half) = mean_and_half(&[1.0, 4.0]);
        assert!((mean - 2.5).abs() < 1e-15 && (half - 12.706_205 * 1.5).abs() < 1e-5);
        // Their squares about the mean are 4, 1, 0 and 9.
        let (mean, half) = mean_and_half(&[1.0, 2.0, 3.0, 6.0]);
        let error = (14.0_f64 / 3.0).sqrt() / 2.0;
        assert!((mean - 3.0).abs() < 1e-15 && (half - 3.182_446 * error).abs() < 1e-5);
    }
}
