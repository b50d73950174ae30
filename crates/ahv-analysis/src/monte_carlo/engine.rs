//! Flies the members of an experiment, whatever the model.

use std::ops::Range;
use std::time::Instant;

use ahv_core::{GeneratedModel, Vector};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::MonteCarloError;
use super::companion::Companion;
use super::experiment::{Experiment, MemberRecord, row};
use super::lanes::LANES;
use super::outcome::{Outcome, Tally};
use super::propagator::{Propagator, propagator};
use super::sums::{BLOCK, Part, Reference};
use crate::ordered::{Control, in_order};

/// Steps of a member that are worth a task of their own.
const TASK_STEPS: u64 = 1000;
/// Most batches of [`LANES`] members that one task flies.
const MOST_BATCHES: u64 = 8;

/// A member at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Time, in s.
    pub time: f64,
    /// State.
    pub state: Vec<f64>,
    /// Input.
    pub input: Vec<f64>,
}

/// An experiment with what flies its members.
pub struct Engine<'e> {
    pub(super) experiment: &'e Experiment,
    pub(super) propagator: Box<dyn Propagator + 'e>,
    companion: Option<Companion>,
    /// Names of the states.
    pub(super) states: &'static [&'static str],
}

impl Experiment {
    /// What flies its members as those of the model `F`.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError::Scheme`], [`MonteCarloError::NoColouredNoise`] for a scheme that is not for this model's noise,
    /// [`MonteCarloError::StepSize`], [`MonteCarloError::Normals`].
    pub fn engine<F: GeneratedModel>(&self) -> Result<Engine<'_>, MonteCarloError> {
        let propagator = propagator::<F>(self)?;
        let companion = self
            .control_variate
            .then(|| Companion::new(self, &*propagator));
        Ok(Engine {
            experiment: self,
            propagator,
            companion,
            states: F::StateOf::<f64>::NAMES,
        })
    }
}

/// So many threads.
pub(super) fn pool(threads: usize) -> Result<ThreadPool, MonteCarloError> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| MonteCarloError::Threads(error.to_string()))
}

impl<'e> Engine<'e> {
    /// Flies members 0 to `members` − 1 on `threads` threads.
    ///
    /// The same numbers whatever the threads. Stopped by `control`, it reports the members that were flown so far, 0 to some
    /// number, with the bits of a run of so many.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError`].
    pub fn run(
        &self,
        members: u64,
        threads: usize,
        control: &Control,
    ) -> Result<Outcome, MonteCarloError> {
        self.run_and_list(members, threads, control, |_, _| ())
    }

    /// As [`Self::run`]; `list` is given what was seen of the members, in their order and many at a time, after the number of
    /// the first.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError`].
    pub fn run_and_list(
        &self,
        members: u64,
        threads: usize,
        control: &Control,
        mut list: impl FnMut(u64, &[MemberRecord]),
    ) -> Result<Outcome, MonteCarloError> {
        let pool = pool(threads)?;
        let started = Instant::now();
        let mut tally: Option<Tally<'_>> = None;
        self.blocks(0..members, &pool, control, |first, seen| {
            list(first, seen);
            let new = || {
                let reference = Reference::of(self.experiment, seen);
                Tally::new(self.experiment, reference).beside(self.companion.as_ref())
            };
            pool.install(|| tally.get_or_insert_with(new).add(seen));
        })?;
        let tally = tally.ok_or(MonteCarloError::Stopped)?;
        Ok(tally.outcome(members, started.elapsed()))
    }

    /// What the sums over `members` members are taken about: their first block is flown for it.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError`]; `Stopped` if it was stopped.
    pub fn reference(
        &self,
        members: u64,
        threads: usize,
        control: &Control,
    ) -> Result<Reference, MonteCarloError> {
        let members = members.min(BLOCK);
        let pool = pool(threads)?;
        let mut reference = None;
        self.blocks(0..members, &pool, control, |_, seen| {
            let whole = seen.len() as u64 == members;
            let of = || Reference::of(self.experiment, seen);
            reference = whole.then(|| pool.install(of));
        })?;
        reference.ok_or(MonteCarloError::Stopped)
    }

    /// Flies members in a row, the first of which is a multiple of [`BLOCK`]; `list` as in [`Self::run_and_list`].
    ///
    /// Parts that are joined in their order ([`Tally::join`]) show what a run of all members shows, to the bit, wherever each
    /// was flown.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError`]; `Stopped` if it was stopped.
    pub fn part(
        &self,
        members: Range<u64>,
        reference: &Reference,
        threads: usize,
        control: &Control,
        mut list: impl FnMut(u64, &[MemberRecord]),
    ) -> Result<Part, MonteCarloError> {
        let mut part = Part::new(self.experiment, reference, members.start);
        let pool = pool(threads)?;
        let asked = members.end - members.start;
        self.blocks(members, &pool, control, |first, seen| {
            list(first, seen);
            pool.install(|| part.add(self.experiment, reference, seen));
        })?;
        let whole = part.members() == asked;
        whole.then_some(part).ok_or(MonteCarloError::Stopped)
    }

    /// Flies members block by block; stopped, the last block is a part of one, or none.
    fn blocks(
        &self,
        members: Range<u64>,
        pool: &ThreadPool,
        control: &Control,
        mut take: impl FnMut(u64, &[MemberRecord]),
    ) -> Result<(), MonteCarloError> {
        let mut next = members.start;
        while next < members.end {
            let end = members.end.min(next + BLOCK);
            let seen = pool.install(|| self.group(next..end, control))?;
            let whole = seen.len() as u64 == end - next;
            if !seen.is_empty() {
                take(next, &seen);
            }
            if !whole {
                break;
            }
            next = end;
        }
        Ok(())
    }

    /// Flies members, at most [`LANES`]; `None` if the work was stopped.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError::Scheme`] for drawn parameters that the scheme is not for.
    pub fn fly(
        &self,
        members: &[u64],
        control: &Control,
    ) -> Result<Option<Vec<MemberRecord>>, MonteCarloError> {
        let experiment = self.experiment;
        let Some(mut seen) = self
            .propagator
            .fly(members, &experiment.snapshots, control)?
        else {
            return Ok(None);
        };
        if let Some(companion) = &self.companion {
            let Some(flown) = companion.fly(experiment, members, control) else {
                return Ok(None);
            };
            for (seen, states) in seen.iter_mut().zip(flown) {
                seen.companion = states;
            }
        }
        Ok(Some(seen))
    }

    /// State and input of one member at the start and after every `stride` steps, as long as it is not lost.
    /// The bits are those that the member has among others.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError`].
    pub fn trajectory(&self, member: u64, stride: u64) -> Result<Vec<Point>, MonteCarloError> {
        let steps: Vec<u64> = (0..=self.experiment.steps())
            .step_by(stride.max(1) as usize)
            .collect();
        let seen = self
            .propagator
            .fly(&[member], &steps, &Control::default())?;
        let Some(seen) = seen.into_iter().flatten().next() else {
            return Ok(Vec::new());
        };
        let inputs = self.experiment.input[0].len();
        let points = (0..).zip(steps).map_while(|(index, step)| {
            Some(Point {
                time: step as f64 * self.experiment.dt,
                state: seen.state(index)?.to_vec(),
                input: row(&seen.inputs, inputs, index)?.to_vec(),
            })
        });
        Ok(points.collect())
    }

    /// Flies members; stopped, it returns those before the first that was not flown.
    fn group(
        &self,
        members: Range<u64>,
        control: &Control,
    ) -> Result<Vec<MemberRecord>, MonteCarloError> {
        let batches = (TASK_STEPS / self.experiment.steps().max(1)).clamp(1, MOST_BATCHES);
        let task = batches * LANES as u64;
        let end = members.end;
        let parts = in_order(members.step_by(task as usize), |first| {
            let members: Vec<u64> = (first..end.min(first + task)).collect();
            let batches = members.chunks(LANES);
            let flown = batches.map(|batch| self.fly(batch, control));
            // Of a task all members or none.
            let flown: Option<Vec<_>> = flown.collect::<Result<_, MonteCarloError>>()?;
            let flown = flown.map(|seen| seen.into_iter().flatten().collect::<Vec<_>>());
            Ok::<_, MonteCarloError>(flown)
        })?;
        Ok(parts.into_iter().flatten().collect())
    }
}
