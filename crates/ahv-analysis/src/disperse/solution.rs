//! One vehicle in trim, and what describes it.

use nalgebra::Complex;

use crate::linearize::{LinearSystem, LinearizeError, PATH_INPUTS, PATH_OUTPUTS, linearize};
use crate::parametric::Parametric;
use crate::poles::{Pole, PolesError, poles, zeros};
use crate::trim::{SteadyFlight, Trim, TrimError, trim};

/// Real part, in 1/s, up to which a root counts as lying on the imaginary axis: that of the altitude would be 0 but for
/// rounding.
const AXIS: f64 = 1e-6;

/// Why a vehicle has no trim with poles and zeros.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolutionError {
    /// The parameters belong to no vehicle.
    #[error("{0}")]
    Contradiction(&'static str),
    /// There is no trim.
    #[error(transparent)]
    Trim(#[from] TrimError),
    /// There is no linear system about it.
    #[error(transparent)]
    Linearize(#[from] LinearizeError),
    /// Its poles or zeros could not be found.
    #[error(transparent)]
    Poles(#[from] PolesError),
}

/// A vehicle in trim.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution<X, U> {
    /// Its trim.
    pub trim: Trim<X, U>,
    /// Deflections η of the flexible modes.
    pub deflections: Vec<f64>,
    /// The linear system about the trim, from [`PATH_INPUTS`] to [`PATH_OUTPUTS`].
    pub system: LinearSystem,
    /// Its poles, each with its mode.
    pub poles: Vec<Pole>,
    /// Its finite zeros, in 1/s.
    pub zeros: Vec<Complex<f64>>,
}

impl<X, U> Solution<X, U> {
    /// Poles to the right of the imaginary axis.
    pub fn unstable_poles(&self) -> usize {
        self.poles
            .iter()
            .filter(|pole| pole.value.re > AXIS)
            .count()
    }

    /// Whether a zero lies to the right of the imaginary axis.
    pub fn is_non_minimum_phase(&self) -> bool {
        self.zeros.iter().any(|zero| zero.re > AXIS)
    }
}

/// Trims the vehicle with these `parameters` and finds its roots.
///
/// # Errors
///
/// [`SolutionError`].
pub fn solve<M: Parametric>(
    parameters: &M::Parameters,
    flight: &SteadyFlight<M::Input>,
) -> Result<Solution<M::State, M::Input>, SolutionError> {
    if let Some(contradiction) = M::contradiction(parameters) {
        return Err(SolutionError::Contradiction(contradiction));
    }
    let model = M::with_parameters(parameters);
    let trim = trim(&model, flight)?;
    let system = linearize(
        &model,
        &trim.state,
        &trim.input,
        &PATH_INPUTS,
        &PATH_OUTPUTS,
    )?;
    Ok(Solution {
        deflections: model.deflections(&trim.state, &trim.input),
        poles: poles(&system)?,
        zeros: zeros(&system)?
            .finite
            .iter()
            .map(|zero| zero.value)
            .collect(),
        trim,
        system,
    })
}
