//! Ways to do the same work, turn by turn.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

use serde::Serialize;

use crate::arrays::{self, Turn};
use crate::rounds::{Measured, Spread, interleave};
use crate::service::Service;

/// The candidate that is not compiled.
pub(crate) const NUMPY: &str = "NumPy";

/// The outcome of a turn.
pub(crate) struct Outcome {
    /// Seconds a unit of work.
    pub(crate) seconds: f64,
    /// What all runners of a race must agree in.
    pub(crate) values: Vec<f64>,
    /// Seconds until it had run for the first time, where it is compiled then.
    pub(crate) first: f64,
}

/// A way to do the work.
pub(crate) struct Runner<'r> {
    pub(crate) name: &'static str,
    /// How it was built and what it computes with.
    pub(crate) how: &'static str,
    /// A turn with a seed.
    pub(crate) run: Box<dyn FnMut(u64) -> Result<Outcome, String> + 'r>,
}

impl<'r> Runner<'r> {
    /// Work of `units` in this process: `work` is timed, and `values` of what it gives are compared.
    pub(crate) fn new<T>(
        name: &'static str,
        how: &'static str,
        units: f64,
        mut work: impl FnMut(u64) -> Result<T, String> + 'r,
        values: impl Fn(&T) -> Vec<f64> + 'r,
    ) -> Self {
        let run = move |seed| {
            let start = Instant::now();
            let done = work(seed)?;
            let seconds = start.elapsed().as_secs_f64() / units;
            Ok(Outcome {
                seconds,
                values: values(&done),
                first: 0.0,
            })
        };
        Self {
            name,
            how,
            run: Box::new(run),
        }
    }

    /// A job of `units` of a service.
    pub(crate) fn service(
        name: &'static str,
        how: &'static str,
        units: f64,
        service: &Rc<RefCell<Service>>,
        job: &'static str,
    ) -> Self {
        let service = Rc::clone(service);
        let run = move |seed| {
            let turn = Turn {
                values: true,
                ..Turn::of(seed)
            };
            let answer = arrays::ask(&service, job, turn)?;
            Ok(Outcome {
                seconds: answer.seconds / units,
                values: answer.values,
                first: answer.first,
            })
        };
        Self {
            name,
            how,
            run: Box::new(run),
        }
    }
}

/// How a runner did.
#[derive(Serialize)]
pub(crate) struct Finish {
    pub(crate) candidate: &'static str,
    pub(crate) how: &'static str,
    pub(crate) threads: usize,
    /// Seconds a unit of work.
    pub(crate) seconds: Spread,
    /// Over those of the first runner in the same round.
    pub(crate) ratio: Spread,
    /// Seconds until it had run for the first time, where it is compiled then.
    pub(crate) first: f64,
    /// The values of each turn.
    #[serde(skip)]
    pub(crate) values: Vec<Vec<f64>>,
}

/// Lets all runners warm up once, and then run in turns.
///
/// # Errors
/// A turn that fails.
pub(crate) fn race(
    mut runners: Vec<Runner<'_>>,
    threads: usize,
    rounds: u32,
) -> Result<Vec<Finish>, String> {
    let mut values = vec![Vec::new(); runners.len()];
    let mut first = vec![0.0; runners.len()];
    let measured = interleave(runners.len(), 1, rounds, |index, round| {
        let outcome = (runners[index].run)(u64::from(round))?;
        first[index] = outcome.first;
        values[index].push(outcome.values);
        Ok(outcome.seconds)
    })?;
    let all = runners.iter().zip(measured).zip(values).zip(first);
    let finish =
        |(((runner, measured), values), first): (((&Runner<'_>, Measured), _), _)| Finish {
            candidate: runner.name,
            how: runner.how,
            threads,
            seconds: measured.time,
            ratio: measured.ratio,
            first,
            values,
        };
    Ok(all.map(finish).collect())
}
