//! Analyses of models that it never saw: of their names it knows what [`ahv_core::GeneratedModel`] says.
//!
//! * [`trim`]: the state and input of steady flight, or of another steady state.
//! * [`linearize`]: the linear system about it; [`poles`]: its poles with their modes, and its zeros.
//! * [`covariance`]: of the deviations from a flight, linear and by Monte Carlo.
//! * [`disperse`]: trims and roots of vehicles whose parameters are drawn.
//! * [`erased`]: all of it for any model, behind one interface.
//! * [`dual`]: exact derivatives of a model's outputs.
//! * [`lqr`]: the linear-quadratic regulator of a linear system; [`actuator`]: lags and limits of what moves the inputs.
//! * [`monte_carlo`]: many flights with noise and dispersions, as fast as the machine goes; [`ordered`]: such work in parts.
//! * [`statistics`]: estimates with their confidence.
#![forbid(unsafe_code)]

pub mod actuator;
pub mod covariance;
pub mod disperse;
pub mod dual;
pub mod erased;
pub mod linearize;
pub mod lqr;
pub mod monte_carlo;
pub mod ordered;
pub mod poles;
pub mod sensitivity;
pub mod statistics;
pub mod trim;
