//! Steady states: the state and input at which the rates and outputs that a model's [`TrimProblem`] names vanish.
//!
//! Some states are given, all inputs that are not sought are held. A flight on a straight path is such a state: given are
//! velocity, altitude and flight-path angle; the row of the altitude does not vanish, and that of the angle of attack repeats
//! the one of the flight path at zero pitch rate. A climb is steady at its instant only, for the air thins. An output that is
//! given, such as the bank angle of a turn, is an equation more.

mod nearest;
mod newton;
mod response;
mod system;

use ahv_core::{Bounds, Equation, GeneratedModel, Given, Shown, Sought, TrimProblem, Vector};

pub use response::{ModelChange, Shift, response};
use system::{Point, System};

use crate::values::values;

/// A steady state that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyState {
    /// The problem's given and sought, in the model's units.
    given: Vec<Given>,
    sought: Vec<Sought>,
    equations: &'static [Equation],
    moving: &'static [&'static str],
    /// Values of the given states and outputs by name.
    values: Vec<(&'static str, f64)>,
    /// Inputs that are held elsewhere than at 0.
    held: Vec<(&'static str, f64)>,
    /// Where the inputs that are sought may lie.
    bounds: Vec<(&'static str, Bounds)>,
}

impl SteadyState {
    /// What the problem gives where nothing else is asked for, in the model's units: all held inputs 0, the others without
    /// bounds.
    pub fn new(problem: &TrimProblem) -> Self {
        Self::converted(problem, |_| 1.0)
    }

    /// The same for a model in other units: `factor` gives what each state, input and output of the problem is multiplied with.
    pub fn converted(problem: &TrimProblem, factor: impl Fn(&str) -> f64) -> Self {
        let given = problem.given.iter().map(|it| {
            let factor = factor(it.name);
            Given::new(
                it.name,
                it.default * factor,
                it.above * factor,
                it.below * factor,
            )
        });
        let sought = problem.sought.iter().map(|it| {
            let factor = factor(it.name);
            Sought::new(it.name, it.start * factor, it.scale * factor)
        });
        let given: Vec<Given> = given.collect();
        Self {
            values: given.iter().map(|it| (it.name, it.default)).collect(),
            held: Vec::new(),
            bounds: Vec::new(),
            equations: problem.equations,
            moving: problem.moving,
            sought: sought.collect(),
            given,
        }
    }

    /// The same with another value of a given state or output. A name that is not given is an error of [`Self::check`].
    #[must_use]
    pub fn with(mut self, name: &'static str, value: f64) -> Self {
        self.values.retain(|&(known, _)| known != name);
        self.values.push((name, value));
        self
    }

    /// The same with an input held at `value`. One that is sought stays so.
    #[must_use]
    pub fn holding(mut self, name: &'static str, value: f64) -> Self {
        self.held.retain(|&(known, _)| known != name);
        self.held.push((name, value));
        self
    }

    /// The same with the sought inputs inside their `bounds`, a vector over the inputs.
    #[must_use]
    pub fn within<B: Vector<Bounds>>(self, bounds: &B) -> Self {
        let names = B::NAMES.iter().copied().enumerate();
        let named = names.filter_map(|(index, name)| Some((name, bounds.get(index)?)));
        self.within_named(named)
    }

    /// The same, by the names of the inputs.
    #[must_use]
    pub fn within_named(
        mut self,
        bounds: impl IntoIterator<Item = (&'static str, Bounds)>,
    ) -> Self {
        self.bounds = bounds.into_iter().collect();
        self
    }

    /// The given states and outputs by name, in the order of the problem.
    pub fn given(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        let value = |name| self.values.iter().find(|(known, _)| *known == name);
        self.given
            .iter()
            .filter_map(move |it| value(it.name).copied())
    }

    /// The states and inputs that are sought, states first.
    pub fn sought(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.sought.iter().map(|it| it.name)
    }

    /// An input: where the search starts if it is sought, else where it is held.
    pub fn input_value(&self, name: &str) -> f64 {
        let start = self.sought.iter().find(|it| it.name == name);
        let held = || self.held.iter().find(|(known, _)| *known == name);
        let value = start.map(|it| it.start);
        value.or_else(|| held().map(|it| it.1)).unwrap_or(0.0)
    }

    /// All inputs.
    pub fn input<U: Vector<f64>>(&self) -> U {
        U::from_fn(|index| {
            U::NAMES
                .get(index)
                .map_or(0.0, |name| self.input_value(name))
        })
    }

    /// Where a sought input may lie.
    fn bounds(&self, name: &str) -> Bounds {
        let found = self.bounds.iter().find(|(known, _)| *known == name);
        found.map_or(Bounds::new(f64::NEG_INFINITY, f64::INFINITY), |it| it.1)
    }

    /// Whether there may be such a state: what is given lies in the problem's domain.
    ///
    /// # Errors
    ///
    /// [`TrimError::Domain`], [`TrimError::MissingName`].
    pub fn check(&self) -> Result<(), TrimError> {
        for &(name, value) in &self.values {
            let known = self.given.iter().find(|it| it.name == name);
            let given = known.ok_or(TrimError::MissingName { name })?;
            let inside = value > given.above && value < given.below;
            if !(inside && value.is_finite()) {
                return Err(TrimError::Domain {
                    name,
                    value,
                    above: given.above,
                    below: given.below,
                });
            }
        }
        Ok(())
    }
}

/// A converged trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trim<X, U> {
    /// Trimmed state.
    pub state: X,
    /// Trimmed input.
    pub input: U,
    /// What is left of each row of the drift, 0 for states that move; each in its own unit per second.
    pub residuals: X,
    /// The largest absolute value of these, and of what outputs that are equations are off by.
    pub residual_max: f64,
    /// Steps taken.
    pub iterations: usize,
}

impl<X: Vector<f64>, U: Vector<f64>> Trim<X, U> {
    /// The same without a type for its vectors.
    pub fn erased(&self) -> Trim<Vec<f64>, Vec<f64>> {
        Trim {
            state: values(&self.state),
            input: values(&self.input),
            residuals: values(&self.residuals),
            residual_max: self.residual_max,
            iterations: self.iterations,
        }
    }
}

/// The point inside the bounds that comes nearest to a trim.
///
/// The sum of squares of the scaled residuals has a minimum there. A row's scale is its largest derivative by an
/// unknown where the search starts, times its weight in the problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// The state by name.
    pub state: Vec<(&'static str, f64)>,
    /// The input by name.
    pub input: Vec<(&'static str, f64)>,
    /// As [`Trim::residuals`], by name.
    pub residuals: Vec<(&'static str, f64)>,
    /// As [`Trim::residual_max`].
    pub residual_max: f64,
    /// The equation that is worst after scaling: a state, whose rate does not vanish, or an output.
    pub worst: &'static str,
    /// What is left of it: a rate in its own unit per second, an output in its unit.
    pub worst_residual: f64,
    /// Steps taken.
    pub iterations: usize,
}

impl Nearest {
    /// Whether the worst equation is a rate, not an output.
    pub fn worst_is_rate(&self) -> bool {
        self.state.iter().any(|(name, _)| *name == self.worst)
    }
}

/// The worst equation as the end of a sentence.
impl std::fmt::Display for Nearest {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (name, value) = (self.worst, Shown(self.worst_residual));
        if self.worst_is_rate() {
            write!(
                formatter,
                "the derivative of {name} is still {value} per second"
            )
        } else {
            write!(formatter, "{name} is still off by {value}")
        }
    }
}

/// A bound that keeps the search from a trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocking {
    /// The input.
    pub input: &'static str,
    /// Its bound, in its own unit.
    pub bound: f64,
    /// Whether it is the upper one.
    pub upper: bool,
}

impl std::fmt::Display for Blocking {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let relation = if self.upper { "<=" } else { ">=" };
        write!(formatter, "{} {relation} {}", self.input, Shown(self.bound))
    }
}

/// Why there is no trim.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrimError {
    /// There is no such state, input or output, or it is not given.
    #[error("the model has no state, input or output called {name}, or it is not given")]
    MissingName {
        /// The name that was looked for.
        name: &'static str,
    },
    /// A given state or output where there is no steady state.
    #[error(
        "{name} is {}; it must be finite, above {} and below {}",
        Shown(*value),
        Shown(*above),
        Shown(*below)
    )]
    Domain {
        /// The state or output.
        name: &'static str,
        /// Its value, in the model's unit.
        value: f64,
        /// It must be above this.
        above: f64,
        /// It must be below this.
        below: f64,
    },
    /// A rate or an output is infinite or NaN where the search starts.
    #[error("the equation of {name} is {} where the trim starts", Shown(*value))]
    NonFinite {
        /// The state whose rate it is, or the output.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// No trim inside the bounds.
    #[error("no trim inside {}: at the nearest point {nearest}", list(blocking))]
    Blocked {
        /// The bounds that the trim outside violates; where none is known, those that the search ran into. At least one.
        blocking: Vec<Blocking>,
        /// The sought inputs of a trim outside the bounds, if there is one.
        beyond: Option<Vec<(&'static str, f64)>>,
        /// The nearest point.
        nearest: Box<Nearest>,
    },
    /// No trim was found, and no bound is the reason.
    #[error("no trim after {} iterations: {nearest}", nearest.iterations)]
    NoConvergence {
        /// The nearest point.
        nearest: Box<Nearest>,
    },
}

impl TrimError {
    /// The point that comes nearest to a trim, where one is known.
    pub fn nearest(&self) -> Option<&Nearest> {
        match self {
            Self::Blocked { nearest, .. } | Self::NoConvergence { nearest } => Some(nearest),
            Self::MissingName { .. } | Self::Domain { .. } | Self::NonFinite { .. } => None,
        }
    }
}

fn list(blocking: &[Blocking]) -> String {
    let texts: Vec<String> = blocking.iter().map(Blocking::to_string).collect();
    texts.join(" and ")
}

/// Finds a steady state by a damped Newton method on the model's own Jacobians.
///
/// Rows and columns are scaled, and a step is halved until the scaled residual shrinks. Where that fails, or ends
/// outside the bounds, a Levenberg-Marquardt method inside the bounds looks for the nearest point, from which Newton's
/// method is tried again.
///
/// # Errors
///
/// [`TrimError`], with the nearest point and the bounds that block; a trim is only returned with a scaled residual
/// below 1e-12.
pub fn trim<M: GeneratedModel>(
    model: &M,
    flight: &SteadyState,
) -> Result<Trim<M::State, M::Input>, TrimError> {
    flight.check()?;
    let system = System::new(model, flight)?;
    let start = system.start(flight)?;
    let first = system.solve(start);
    if first.converged && system.inside(&first.point) {
        return Ok(system.finish(&first.point, first.iterations));
    }
    let (nearest, steps) = system.nearest(start);
    let last = system.solve(nearest);
    let iterations = first.iterations + steps + last.iterations;
    if last.converged && system.inside(&last.point) {
        return Ok(system.finish(&last.point, iterations));
    }
    let beyond = [first, last].into_iter().find(|it| it.converged);
    let violated = beyond.iter().flat_map(|it| system.violated(&it.point));
    let mut blocking: Vec<Blocking> = violated.collect();
    let met = system.blocking(&nearest);
    if blocking.is_empty() {
        blocking = met;
    } else {
        // Those first that the search ran into.
        blocking.sort_by_key(|it| met.iter().all(|met| met.input != it.input));
    }
    let beyond = beyond.map(|it| system.named_inputs(&it.point));
    let nearest = Box::new(system.describe(&nearest, iterations));
    if blocking.is_empty() {
        return Err(TrimError::NoConvergence { nearest });
    }
    Err(TrimError::Blocked {
        blocking,
        beyond,
        nearest,
    })
}
