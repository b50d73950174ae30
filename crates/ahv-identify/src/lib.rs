//! Parameters of a model from a flight record, for any model with these [`Dynamics`].
//!
//! Two methods, both of maximum likelihood. [`output_error`] is for flights without process noise: the model flies with the recorded
//! inputs, and the outputs differ from the measured ones by measurement noise. [`filter`] is for stochastic models: an extended Kalman
//! filter predicts each sample from those before it.
//!
//! A record may be cut into segments, each with an initial state of its own: an unstable airframe leaves the record within
//! seconds, whatever its parameters. The recorded inputs are given numbers; so it does not matter to output error whether a
//! controller made them, as long as the measurement noise does not reach them within a segment.
//!
//! Start reading at [`Problem`] and [`Estimate`]; it knows no model by name.
#![forbid(unsafe_code)]

mod covariance;
mod dynamics;
mod filter;
mod flight;
mod normal;
mod output_error;
mod whiteness;

use nalgebra::DMatrix;

pub use dynamics::Dynamics;
pub use filter::filter;
pub use output_error::output_error;
pub use whiteness::Whiteness;

/// Samples of a flight; a row each.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Times in s, ascending.
    pub times: Vec<f64>,
    /// All inputs of the model at each time, held until the next.
    pub inputs: Vec<Vec<f64>>,
    /// The measured outputs at each time.
    pub outputs: Vec<Vec<f64>>,
}

/// What is to be estimated, from what.
pub struct Problem<'a> {
    /// The model.
    pub model: &'a dyn Dynamics,
    /// All its parameters; those that are estimated start here.
    pub parameters: Vec<f64>,
    /// Indices of those that are estimated.
    pub free: Vec<usize>,
    /// Names of the measured states or outputs, in the order of the record.
    pub measured: Vec<&'static str>,
    /// State at the start of a segment, where it is not measured.
    pub start: Vec<f64>,
    /// Standard deviation of each state at the start of a segment, for the filter.
    pub deviation: Vec<f64>,
    /// Indices of states that output error does not estimate at the start of a segment.
    pub held: Vec<usize>,
    /// The record.
    pub record: Record,
    /// Length of a segment in s; infinite for one segment.
    pub segment: f64,
}

/// An estimated parameter, in its own unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its index among the parameters of the model.
    pub index: usize,
    /// The estimate.
    pub value: f64,
    /// The Cramér–Rao bound of its standard deviation, as if residuals were white.
    pub white_error: f64,
    /// The same corrected for coloured residuals: the standard error to use.
    pub standard_error: f64,
}

/// An outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The parameters, in the order of [`Problem::free`].
    pub parameters: Vec<Parameter>,
    /// Correlations of their errors, from the corrected covariance.
    pub correlations: DMatrix<f64>,
    /// Standard deviation of the measurement noise of each output, in its unit.
    pub noise: Vec<f64>,
    /// Test of each output's residuals.
    pub whiteness: Vec<Whiteness>,
    /// The model's outputs at each sample: flown, or predicted from the samples before.
    pub fitted: Vec<Vec<f64>>,
    /// Iterations that were made.
    pub iterations: usize,
    /// Segments.
    pub segments: usize,
    /// Logarithm of the likelihood, up to a constant.
    pub log_likelihood: f64,
}

/// Why there is no estimate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IdentifyError {
    /// Fewer numbers than unknowns.
    #[error(
        "the record has {numbers} measured numbers for {unknowns} unknowns (parameters, noise, and the states at the start of segments); more samples or longer segments are needed"
    )]
    Short {
        /// Measured numbers.
        numbers: usize,
        /// Unknowns.
        unknowns: usize,
    },
    /// What no measured output depends on, or cannot be told from each other.
    #[error("{} cannot be estimated from this record: {why}", names.join(", "))]
    Unobservable {
        /// Names of parameters or states.
        names: Vec<&'static str>,
        /// Why, in words.
        why: &'static str,
    },
    /// The model leaves its domain at the values where the search starts.
    #[error(
        "with the starting values the model diverges within the segment that begins at {time} s; use shorter segments or the filter, or start nearer"
    )]
    Diverges {
        /// Start of the segment, in s.
        time: f64,
    },
    /// The model has no process noise.
    #[error("{model} has no noise, which the filter needs; use output error")]
    NoNoise {
        /// Name of the model.
        model: &'static str,
    },
    /// The search did not end.
    #[error(
        "the search did not converge within {iterations} iterations; start nearer, or estimate fewer parameters"
    )]
    NoConvergence {
        /// Iterations that were made.
        iterations: usize,
    },
}
