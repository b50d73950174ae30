//! Steppers that take the same number of steps, turn by turn.

use std::hint::black_box;
use std::time::Instant;

use ahv_core::Vector;
use ahv_integrate::StepError;
use serde::Serialize;

use super::flights::Flight;
use super::library::Step;
use crate::rounds::{Spread, interleave};

/// Steps of a turn.
pub(crate) const COUNT: usize = 1000;
/// Step size in s.
pub(crate) const DT: f64 = 1e-3;
/// Turns of each stepper in a round.
const TURNS: u32 = 20;
/// Greatest difference of the ends of two flights by one scheme, relative to the component or to 1, if that is more.
const TOLERANCE: f64 = 1e-9;

/// Time of a step.
#[derive(Serialize)]
pub(crate) struct StepTime {
    pub(crate) model: &'static str,
    pub(crate) stepper: &'static str,
    /// Part of the model, where it is not all of it.
    pub(crate) part: &'static str,
    pub(crate) nanoseconds: Spread,
    /// Over the time of CasADi's C in the same turn.
    pub(crate) ratio: Spread,
}

struct Subject<'s> {
    stepper: &'static str,
    part: &'static str,
    /// Takes all steps and gives the last state.
    run: Box<dyn FnMut() -> Result<Vec<f64>, String> + 's>,
}

/// Steppers on a model: CasADi's C first, then the one that computes the same, then the others.
pub(crate) struct Group<'s> {
    model: &'static str,
    subjects: Vec<Subject<'s>>,
}

impl<'s> Group<'s> {
    pub(crate) fn new(model: &'static str) -> Self {
        Self {
            model,
            subjects: Vec::new(),
        }
    }

    /// A stepper; `step(x, k)` is step k.
    pub(crate) fn add<X: Vector<f64> + 's>(
        &mut self,
        stepper: &'static str,
        part: &'static str,
        start: X,
        mut step: impl FnMut(&mut X, usize) -> Result<(), StepError<f64>> + 's,
    ) {
        self.add_run(stepper, part, move || {
            let mut x = black_box(start);
            for k in 0..COUNT {
                step(&mut x, k).map_err(|it| format!("error: {stepper}: {it}"))?;
            }
            Ok(values(&x))
        });
    }

    /// A step of CasADi's C; `noise` are the Wiener increments of each step, if it takes any.
    pub(crate) fn add_casadi<const N: usize>(
        &mut self,
        stepper: &'static str,
        mut step: Step,
        start: [f64; N],
        flight: &Flight,
        noise: Option<Vec<Vec<f64>>>,
    ) {
        let (u, p) = (flight.input.to_array(), flight.parameters.to_array());
        self.add_run(stepper, "", move || {
            let mut x = black_box(start);
            match &noise {
                None => (0..COUNT).for_each(|_| x = step.call([&x, &u, &p, &[DT]])),
                Some(all) => {
                    for dw in all {
                        x = step.call([&x, &u, &p, &[DT], dw]);
                    }
                }
            }
            Ok(x.to_vec())
        });
    }

    /// Anything that takes all steps and gives the last state.
    pub(crate) fn add_run(
        &mut self,
        stepper: &'static str,
        part: &'static str,
        run: impl FnMut() -> Result<Vec<f64>, String> + 's,
    ) {
        let run = Box::new(run);
        self.subjects.push(Subject { stepper, part, run });
    }

    /// Checks the first two against each other, and times all in turns.
    ///
    /// # Errors
    /// A step that fails; two flights by one scheme that end apart.
    pub(crate) fn time(mut self, rounds: u32) -> Result<Vec<StepTime>, String> {
        if let [casadi, same, ..] = &mut self.subjects[..] {
            let distance = distance(&(casadi.run)()?, &(same.run)()?);
            // Written so that NaN fails.
            if !distance.le(&TOLERANCE) {
                let (model, stepper) = (self.model, same.stepper);
                return Err(format!(
                    "error: on {model} {stepper} and CasADi's end {distance:.1e} apart"
                ));
            }
        }
        let measured = interleave(self.subjects.len(), 0, TURNS * rounds, |index, _| {
            let begin = Instant::now();
            let end = (self.subjects[index].run)();
            let nanoseconds = begin.elapsed().as_secs_f64() * 1e9 / COUNT as f64;
            black_box(end?);
            Ok(nanoseconds)
        })?;
        let timed = self.subjects.iter().zip(measured);
        let timed = timed.map(|(subject, measured)| StepTime {
            model: self.model,
            stepper: subject.stepper,
            part: subject.part,
            nanoseconds: measured.time,
            ratio: measured.ratio,
        });
        Ok(timed.collect())
    }
}

/// The components of a vector.
pub(crate) fn values<X: Vector<f64>>(x: &X) -> Vec<f64> {
    (0..X::LEN).filter_map(|index| x.get(index)).collect()
}

/// Greatest difference of two states, relative to the component or to 1, if that is more.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    let differences = a
        .iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs() / b.abs().max(1.0));
    // Written so that NaN stays.
    differences.fold(0.0, |worst, it| if it <= worst { worst } else { it })
}
