//! Runs with steps as long as tolerances allow.

use ahv_core::{Model, Outside, Vector};

use crate::controller::{Controller, error_norm, farthest, first_step, units};
use crate::events::{check_start, search};
use crate::method::non_finite;
use crate::{
    Anywhere, Attempt, Dense, Event, Failure, InputSource, Leaving, Located, Method, Start,
    Validity,
};

/// What is integrated.
pub struct Problem<'a, M: Model, I, V = Anywhere> {
    model: &'a M,
    input: &'a I,
    validity: V,
    events: &'a [&'a dyn Event<M>],
}

impl<'a, M: Model, I: InputSource<M>> Problem<'a, M, I> {
    /// `model` driven by `input`.
    pub const fn new(model: &'a M, input: &'a I) -> Self {
        Self {
            model,
            input,
            validity: Anywhere,
            events: &[],
        }
    }

    /// Checks every accepted step against a validity box.
    pub fn validity<V>(self, validity: V) -> Problem<'a, M, I, V> {
        Problem {
            model: self.model,
            input: self.input,
            validity,
            events: self.events,
        }
    }
}

impl<'a, M: Model, I, V> Problem<'a, M, I, V> {
    /// Looks for these events in every accepted step.
    #[must_use]
    pub fn events(mut self, events: &'a [&'a dyn Event<M>]) -> Self {
        self.events = events;
        self
    }
}

/// Where a run stands: the last good time and state, also after a failure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<X> {
    /// Time in s.
    pub time: f64,
    /// The state.
    pub state: X,
    /// The step to try next, in s; none lets the method find one.
    pub step: Option<f64>,
    /// Steps that met the tolerances.
    pub accepted: u32,
    /// Steps that did not, and were tried again with a shorter one.
    pub refused: u32,
}

impl<X> Progress<X> {
    /// The beginning of a run.
    pub const fn new(time: f64, state: X) -> Self {
        Self {
            time,
            state,
            step: None,
            accepted: 0,
            refused: 0,
        }
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending<X> {
    /// At the time that was asked for.
    Time,
    /// At an event.
    Event(Located<X>),
}

/// Is told of what happens during a run.
pub trait Observer<X> {
    /// Whether [`accepted`](Self::accepted) wants the dense output, which costs more than a comparison.
    const DENSE: bool = true;

    /// A step was accepted.
    fn accepted(&mut self, _step: &Dense<X>) {}

    /// An event happened that does not end the run.
    fn event(&mut self, _event: &Located<X>) {}

    /// A component has left the validity box, or another one is now the first outside.
    fn outside(&mut self, _time: f64, _outside: &Outside) {}

    /// At the end of a step a limit holds an input back.
    fn saturated(&mut self, _time: f64, _command: &Outside) {}
}

/// Nobody is told.
impl<X> Observer<X> for () {
    const DENSE: bool = false;
}

/// A method with control of the step size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive<S, X> {
    method: S,
    relative: f64,
    absolute: X,
    longest: f64,
    most_steps: u32,
}

impl<S, X> Adaptive<S, X> {
    /// `method` with a tolerance of `absolute` + `relative` |x| for the local error of each component x, of which the
    /// root mean square counts.
    pub const fn new(method: S, relative: f64, absolute: X) -> Self {
        Self {
            method,
            relative,
            absolute,
            longest: f64::INFINITY,
            most_steps: 1_000_000,
        }
    }

    /// No step longer than `longest`, in s.
    #[must_use]
    pub fn longest_step(mut self, longest: f64) -> Self {
        self.longest = longest;
        self
    }

    /// No more than `most` steps in a run, refused ones included; a million by default.
    #[must_use]
    pub fn most_steps(mut self, most: u32) -> Self {
        self.most_steps = most;
        self
    }

    /// Integrates from `progress` to `end`, in s, or to the first event that ends the run.
    ///
    /// # Errors
    ///
    /// [`Failure`]; `progress` then holds the last good time and state.
    pub fn run<M, I, V, O>(
        &self,
        problem: &Problem<'_, M, I, V>,
        progress: &mut Progress<M::State>,
        end: f64,
        observer: &mut O,
    ) -> Result<Ending<M::State>, Failure>
    where
        M: Model<State = X>,
        M::Scalar: Into<f64>,
        X: Vector<M::Scalar>,
        I: InputSource<M>,
        V: Validity<M::Scalar, X>,
        S: Method<M>,
        O: Observer<X>,
    {
        self.check::<M>(progress, end)?;
        let begin = progress.time;
        let mut run = Run {
            settings: self,
            problem,
            progress,
            controller: Controller::new(S::ERROR_ORDER),
            outside: None,
            least: 16.0 * f64::EPSILON * end.abs().max(begin.abs()),
        };
        let mut slope = Some(run.begin(observer)?);
        for _ in 0..self.most_steps {
            let time = run.progress.time;
            if time >= end {
                return Ok(Ending::Time);
            }
            let next_break = problem.input.next_break(time);
            let until = if next_break > time {
                end.min(next_break)
            } else {
                end
            };
            let start = Start {
                time,
                state: run.progress.state,
                slope,
            };
            let (step, reaches) = run.length(until);
            let mut attempt = self
                .method
                .attempt(problem.model, problem.input, &start, step);
            if !run.judge(&attempt, reaches)? {
                slope = attempt.first_slope;
                continue;
            }
            let arrival = if reaches { until } else { time + step };
            if let Some(event) = run.advance(&mut attempt, arrival, observer)? {
                return Ok(Ending::Event(event));
            }
            // A break may change the input, and the slope with it.
            slope = if reaches { None } else { attempt.last_slope };
        }
        if run.progress.time >= end {
            return Ok(Ending::Time);
        }
        Err(Failure::TooManySteps {
            time: run.progress.time,
            steps: self.most_steps,
        })
    }

    fn check<M>(&self, progress: &Progress<X>, end: f64) -> Result<(), Failure>
    where
        M: Model<State = X>,
        M::Scalar: Into<f64>,
        X: Vector<M::Scalar>,
    {
        let setting = |name, value: f64, good| {
            if good {
                Ok(())
            } else {
                Err(Failure::Setting { name, value })
            }
        };
        let positive = |value: f64| value > 0.0 && value.is_finite();
        setting("relative tolerance", self.relative, positive(self.relative))?;
        setting("longest step", self.longest, self.longest > 0.0)?;
        setting("time", progress.time, progress.time.is_finite())?;
        setting("end", end, end.is_finite() && end >= progress.time)?;
        if let Some(step) = progress.step {
            setting("step", step, positive(step))?;
        }
        match self.absolute.find(|value| !positive(value.into())) {
            Some((_, value)) => setting("absolute tolerance", value.into(), false),
            None => Ok(()),
        }
    }
}

/// A run between two calls.
struct Run<'a, S, X, M: Model, I, V> {
    settings: &'a Adaptive<S, X>,
    problem: &'a Problem<'a, M, I, V>,
    progress: &'a mut Progress<X>,
    controller: Controller,
    /// Name of the component that the observer was told to be outside.
    outside: Option<&'static str>,
    /// A shorter step, in s, is lost in the rounding of the time.
    least: f64,
}

impl<S, X, M, I, V> Run<'_, S, X, M, I, V>
where
    M: Model<State = X>,
    M::Scalar: Into<f64>,
    X: Vector<M::Scalar>,
    I: InputSource<M>,
    V: Validity<M::Scalar, X>,
    S: Method<M>,
{
    /// Checks where the run begins, and returns the slope there.
    fn begin<O: Observer<X>>(&mut self, observer: &mut O) -> Result<X, Failure> {
        let Problem { model, input, .. } = self.problem;
        let (time, x) = (self.progress.time, self.progress.state);
        if let Some((name, value)) = non_finite::<M::Scalar, _>(&x) {
            return Err(Failure::NonFinite { time, name, value });
        }
        let slope = model.drift(&x, &input.at(time, time, &x));
        if let Some((name, value)) = non_finite::<M::Scalar, _>(&slope) {
            return Err(Failure::NonFinite { time, name, value });
        }
        self.check_validity(time, &x, observer)?;
        check_start(self.problem.events, time, &x)?;
        input.saturations(time, &x, &mut |command| observer.saturated(time, &command));
        if self.progress.step.is_none() {
            let start = Start {
                time,
                state: x,
                slope: Some(slope),
            };
            self.progress.step = Some(first_step(
                *model,
                *input,
                &start,
                &slope,
                self.settings.relative,
                &self.settings.absolute,
                S::ERROR_ORDER,
            ));
        }
        Ok(slope)
    }

    /// The length of the next step in s, and whether it reaches `until`.
    fn length(&self, until: f64) -> (f64, bool) {
        let rest = until - self.progress.time;
        let wanted = self
            .progress
            .step
            .unwrap_or(rest)
            .min(self.settings.longest);
        // Two middling steps rather than a long and a tiny one.
        if wanted >= rest {
            (rest, true)
        } else if 2.0 * wanted > rest {
            (0.5 * rest, false)
        } else {
            (wanted, false)
        }
    }

    /// Whether the step meets the tolerances; sets the length of the next one.
    fn judge(&mut self, attempt: &Attempt<X, S::Stages>, reaches: bool) -> Result<bool, Failure> {
        let Adaptive {
            method,
            relative,
            absolute,
            ..
        } = self.settings;
        let ends = [&attempt.state, &attempt.next];
        let units = units::<M::Scalar, _>(ends, *relative, absolute);
        let norm = method.error_size(attempt, |error| error_norm::<M::Scalar, _>(error, &units));
        let bad = non_finite::<M::Scalar, _>(&attempt.next).or_else(|| {
            let slope = attempt.last_slope.as_ref()?;
            non_finite::<M::Scalar, _>(slope)
        });
        if norm <= 1.0 && bad.is_none() {
            let next = attempt.step * self.controller.accept(norm);
            // A step cut short by a break says little about the next one.
            let planned = self.progress.step.filter(|_| reaches).unwrap_or(next);
            self.progress.step = Some(next.max(planned).min(self.settings.longest));
            return Ok(true);
        }
        self.progress.refused = self.progress.refused.saturating_add(1);
        let norm = if bad.is_some() { f64::INFINITY } else { norm };
        let step = attempt.step * self.controller.refuse(norm);
        self.progress.step = Some(step);
        let time = attempt.time;
        if step > self.least {
            return Ok(false);
        }
        self.progress.step = None;
        Err(match bad {
            Some((name, value)) => Failure::NonFinite { time, name, value },
            None => {
                let index = farthest::<M::Scalar, _>(&attempt.error, &units).unwrap_or(0);
                Failure::StepUnderflow {
                    time,
                    step,
                    name: X::NAMES.get(index).copied().unwrap_or_default(),
                    value: attempt.state.get(index).map_or(f64::NAN, Into::into),
                }
            }
        })
    }

    /// Moves to the end of a good step, or to the event that ends the run.
    fn advance<O: Observer<X>>(
        &mut self,
        attempt: &mut Attempt<X, S::Stages>,
        arrival: f64,
        observer: &mut O,
    ) -> Result<Option<Located<X>>, Failure> {
        let events = self.problem.events;
        let (mut time, mut state) = (arrival, attempt.next);
        let mut ending = None;
        if O::DENSE || !events.is_empty() {
            let Problem { model, input, .. } = self.problem;
            let dense = self.settings.method.dense(*model, *input, attempt);
            let mut dense = dense.until(arrival);
            ending = search(events, &dense, &state, |event| observer.event(event))?;
            if let Some(event) = &ending {
                (time, state) = (event.time, event.state);
                dense = dense.until(time);
            }
            self.check_validity(time, &state, observer)?;
            observer.accepted(&dense);
        } else {
            self.check_validity(time, &state, observer)?;
        }
        self.progress.time = time;
        self.progress.state = state;
        self.progress.accepted = self.progress.accepted.saturating_add(1);
        let input = self.problem.input;
        input.saturations(time, &state, &mut |command| {
            observer.saturated(time, &command);
        });
        Ok(ending)
    }

    fn check_validity<O: Observer<X>>(
        &mut self,
        time: f64,
        x: &X,
        observer: &mut O,
    ) -> Result<(), Failure> {
        let Some(outside) = self.problem.validity.outside(x) else {
            self.outside = None;
            return Ok(());
        };
        if self.problem.validity.leaving() == Leaving::Stop {
            return Err(Failure::OutsideValidity { time, outside });
        }
        if self.outside != Some(outside.name) {
            self.outside = Some(outside.name);
            observer.outside(time, &outside);
        }
        Ok(())
    }
}
