//! Analyses of models that it never saw: of their names it knows what [`ahv_core::GeneratedModel`] says.
//!
//! * [`trim`]: the state and input of steady flight, or of another steady state.
//! * [`linearize`]: the linear system about it; [`poles`]: its poles with their modes, and its zeros.
//! * [`covariance`]: of the deviations from a flight, linear and by Monte Carlo.
//! * [`disperse`]: trims and roots of vehicles whose parameters are drawn.
//! * [`erased`]: all of it for any model, behind one interface.
//! * [`dual`]: exact derivatives of a model's outputs.
//! * [`reduction`]: a smaller linear system in the place of a large one, with its errors.
//! * [`lqr`]: the linear-quadratic regulator of a linear system; [`margins`]: gain and phase margins of a feedback;
//!   [`actuator`]: lags and limits of what moves the inputs.
//! * [`monte_carlo`]: many flights with noise and dispersions, as fast as the machine goes; [`ordered`]: such work in parts.
//! * [`statistics`]: estimates with their confidence.
//!
//! ```
//! use ahv_analysis::{linearize::linearize, poles::poles, trim::{SteadyState, trim}};
//! use ahv_core::{GeneratedModel, Vector};
//! use ahv_models::dcom::{self, Model};
//!
//! // Level flight at the model's own velocity and altitude, its poles, and the mode of the slowest one.
//! let model = Model::new(&dcom::NOMINAL);
//! let flight = SteadyState::new(&Model::<f64>::TRIM).within(&dcom::INPUT_BOUNDS);
//! let level = trim(&model, &flight)?;
//! let states = dcom::State::<f64>::NAMES;
//! let system = linearize(&model, &level.state, &level.input, &["delta_e"], &states)?;
//! let poles = poles(&system, Model::<f64>::MODES)?;
//! assert_eq!(poles.len(), 11);
//! assert!(poles.iter().any(|pole| pole.mode == Some("phugoid")));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

pub mod actuator;
pub mod covariance;
pub mod disperse;
pub mod dual;
pub mod erased;
pub mod linearize;
pub mod lqr;
pub mod margins;
pub mod monte_carlo;
pub mod ordered;
pub mod poles;
pub mod reduction;
pub mod sensitivity;
pub mod statistics;
pub mod trim;
mod values;
