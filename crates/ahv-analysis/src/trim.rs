//! Steady flight on a straight path: the state and input at which velocity, flight path and pitch rate stay.
//!
//! Given are velocity, altitude, flight-path angle and the inputs other than `phi` and `delta_e`. The pitch rate is 0.
//! Unknown are `alpha`, `phi`, `delta_e` and every flexible state. The equations are all rows of the drift but two:
//! `altitude`, which is V sin γ whatever the unknowns, and `alpha`, which is −γ̇ at zero pitch rate and repeats the row
//! `gamma`. That leaves as many equations as unknowns. A climb is steady at its instant only, for the air thins.

mod nearest;
mod newton;
mod response;
mod system;

use std::f64::consts::FRAC_PI_2;

use ahv_core::{Bounds, DifferentiableModel, Shown, Vector};

pub use response::{Shift, response};
use system::{Point, System};

/// Inputs that are sought; all others are held.
pub const SOUGHT_INPUTS: [&str; 2] = ["phi", "delta_e"];

/// Where to trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyFlight<U> {
    /// Velocity, in the model's unit.
    pub velocity: f64,
    /// Altitude, in the model's unit.
    pub altitude: f64,
    /// Flight-path angle, rad.
    pub gamma: f64,
    /// Inputs: `phi` and `delta_e` are where the search starts, all others are held.
    pub input: U,
    /// Where `phi` and `delta_e` may lie, in the order of [`SOUGHT_INPUTS`].
    pub bounds: [Bounds; 2],
}

impl<U: Vector<f64>> SteadyFlight<U> {
    /// Level flight at `velocity` and `altitude`, in the model's units, all other inputs 0, with the customary cold
    /// start and without bounds.
    pub fn new(velocity: f64, altitude: f64) -> Self {
        let start = |name| match name {
            "phi" => 0.25,
            "delta_e" => 0.2,
            _ => 0.0,
        };
        let input = U::from_fn(|index| U::NAMES.get(index).map_or(0.0, |name| start(name)));
        Self {
            velocity,
            altitude,
            gamma: 0.0,
            input,
            bounds: [Bounds::new(f64::NEG_INFINITY, f64::INFINITY); 2],
        }
    }

    /// The same on a path that climbs by `gamma`, in rad.
    pub fn climbing(self, gamma: f64) -> Self {
        Self { gamma, ..self }
    }

    /// Whether there may be a steady flight: the velocity is above 0 and the path is not vertical.
    ///
    /// # Errors
    ///
    /// [`TrimError::Domain`]
    pub fn check(&self) -> Result<(), TrimError> {
        let fault = |name, value, must| Err(TrimError::Domain { name, value, must });
        if !(self.velocity > 0.0 && self.velocity.is_finite()) {
            return fault("velocity", self.velocity, "above 0");
        }
        if !self.altitude.is_finite() {
            return fault("altitude", self.altitude, "a finite number");
        }
        // The double next to π/2 is not vertical, but an angle in deg that is rounds to it.
        if self.gamma.is_nan() || self.gamma.abs() >= FRAC_PI_2 {
            return fault("gamma", self.gamma, "between -90 deg and 90 deg");
        }
        Ok(())
    }

    /// The same with `phi` and `delta_e` inside their `bounds`, a vector over the inputs.
    pub fn within<B: Vector<Bounds>>(self, bounds: &B) -> Self {
        let of = |(name, unbounded)| {
            let found = B::index_of(name).and_then(|index| bounds.get(index));
            found.unwrap_or(unbounded)
        };
        let [phi, delta_e] = self.bounds;
        let [first, second] = SOUGHT_INPUTS;
        Self {
            bounds: [of((first, phi)), of((second, delta_e))],
            ..self
        }
    }
}

/// A converged trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trim<X, U> {
    /// Trimmed state.
    pub state: X,
    /// Trimmed input.
    pub input: U,
    /// What is left of each row of the drift, of `altitude` less V sin γ; each in its own unit per second.
    pub residuals: X,
    /// The largest of their absolute values.
    pub residual_max: f64,
    /// Steps taken.
    pub iterations: usize,
}

/// The point inside the bounds that comes nearest to a trim.
///
/// The sum of squares of the scaled residuals has a minimum there. A row's scale is its largest derivative by an
/// unknown where the search starts, with 0.1 for a unit of `alpha`, `phi` and `delta_e`; the row `velocity` weighs as V γ̇,
/// and those of the modes a hundred times as much, so that they rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// The state by name.
    pub state: Vec<(&'static str, f64)>,
    /// The input by name.
    pub input: Vec<(&'static str, f64)>,
    /// As [`Trim::residuals`], by name.
    pub residuals: Vec<(&'static str, f64)>,
    /// The largest of their absolute values.
    pub residual_max: f64,
    /// The row that is worst after scaling.
    pub worst: &'static str,
    /// Steps taken.
    pub iterations: usize,
}

impl Nearest {
    /// What is left of the worst row, in its own unit per second.
    pub fn worst_residual(&self) -> f64 {
        let mut rows = self.residuals.iter();
        rows.find(|(name, _)| *name == self.worst)
            .map_or(f64::NAN, |&(_, value)| value)
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
    /// The model lacks a state or input that steady flight is defined by.
    #[error("the model has no state or input called {name}")]
    MissingName {
        /// The name that was looked for.
        name: &'static str,
    },
    /// A flight condition at which there is no steady flight.
    #[error("{name} is {}; it must be {must}", Shown(*value))]
    Domain {
        /// The quantity, a field of [`SteadyFlight`].
        name: &'static str,
        /// Its value: in the model's unit, an angle in rad.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// A derivative is infinite or NaN where the search starts.
    #[error("the derivative of {name} is {} where the trim starts", Shown(*value))]
    NonFinite {
        /// Row of the drift.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// No trim inside the bounds.
    #[error(
        "no trim inside {}: at the nearest point the derivative of {} is {} per second",
        list(blocking),
        nearest.worst,
        Shown(nearest.worst_residual())
    )]
    Blocked {
        /// The bounds that the search ran into, then others that the trim outside violates; at least one.
        blocking: Vec<Blocking>,
        /// `phi` and `delta_e` of a trim outside the bounds, if there is one.
        beyond: Option<[f64; 2]>,
        /// The nearest point.
        nearest: Box<Nearest>,
    },
    /// No trim was found, and no bound is the reason.
    #[error(
        "no trim after {} iterations: the derivative of {} is still {} per second",
        nearest.iterations,
        nearest.worst,
        Shown(nearest.worst_residual())
    )]
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

/// Finds steady flight by a damped Newton method on the model's own Jacobians.
///
/// Rows and columns are scaled, and a step is halved until the scaled residual shrinks. Where that fails, or ends
/// outside the bounds, a Levenberg-Marquardt method inside the bounds looks for the nearest point, from which Newton's
/// method is tried again.
///
/// # Errors
///
/// [`TrimError`], with the nearest point and the bounds that block; a trim is only returned with a scaled residual
/// below 1e-12.
pub fn trim<M>(
    model: &M,
    flight: &SteadyFlight<M::Input>,
) -> Result<Trim<M::State, M::Input>, TrimError>
where
    M: DifferentiableModel<Scalar = f64>,
{
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
    let mut blocking = system.blocking(&nearest);
    for violated in beyond.iter().flat_map(|it| system.violated(&it.point)) {
        if blocking.iter().all(|it| it.input != violated.input) {
            blocking.push(violated);
        }
    }
    let beyond = beyond.map(|it| system.sought_inputs(&it.point));
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
