//! One vehicle in trim, and what describes it.

use ahv_core::{GeneratedModel, Vector};
use nalgebra::Complex;

use crate::linearize::{LinearSystem, LinearizeError, linearize};
use crate::poles::{Pole, PolesError, poles, zeros};
use crate::trim::{SteadyState, Trim, TrimError, trim};

/// Real part, in 1/s, up to which a root counts as lying on the imaginary axis: that of the altitude would be 0 but for
/// rounding.
const AXIS: f64 = 1e-6;

/// Why a vehicle has no trim with poles and zeros.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolutionError {
    /// The parameters break a rule of their table.
    #[error("{0}")]
    Rule(&'static str),
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
pub struct Solution {
    /// Its trim.
    pub trim: Trim<Vec<f64>, Vec<f64>>,
    /// Names of states and inputs.
    names: [&'static [&'static str]; 2],
    /// Other quantities of the trim by name: those of [`GeneratedModel::OutputsOf`].
    pub outputs: Vec<(&'static str, f64)>,
    /// The linear system about the trim, from the model's default inputs to its default outputs.
    pub system: LinearSystem,
    /// Its poles, each with its mode.
    pub poles: Vec<Pole>,
    /// Its finite zeros, in 1/s.
    pub zeros: Vec<Complex<f64>>,
}

impl Solution {
    /// A state, an input or another quantity of the trim by its name.
    pub fn trim_value(&self, name: &str) -> Option<f64> {
        let of = |names: &[&str], values: &[f64]| {
            let index = names.iter().position(|own| *own == name)?;
            values.get(index).copied()
        };
        let ([states, inputs], trim) = (self.names, &self.trim);
        let output = || self.outputs.iter().find(|(known, _)| *known == name);
        of(states, &trim.state)
            .or_else(|| of(inputs, &trim.input))
            .or_else(|| output().map(|&(_, value)| value))
    }

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
pub fn solve<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    flight: &SteadyState,
) -> Result<Solution, SolutionError> {
    if let Some(rule) = M::broken_rule(parameters) {
        return Err(SolutionError::Rule(rule.reason));
    }
    let model = M::with_parameters(parameters);
    let trim = trim(&model, flight)?;
    let (inputs, outputs) = (M::DEFAULT_INPUTS, M::DEFAULT_OUTPUTS);
    let system = linearize(&model, &trim.state, &trim.input, inputs, outputs)?;
    let values = M::outputs(&M::generic(parameters), &trim.state, &trim.input);
    let names = M::OutputsOf::<f64>::NAMES.iter().enumerate();
    Ok(Solution {
        outputs: names
            .filter_map(|(index, &name)| Some((name, values.get(index)?)))
            .collect(),
        poles: poles(&system, M::MODES)?,
        zeros: zeros(&system)?
            .finite
            .iter()
            .map(|zero| zero.value)
            .collect(),
        trim: trim.erased(),
        names: [M::State::NAMES, M::Input::NAMES],
        system,
    })
}
