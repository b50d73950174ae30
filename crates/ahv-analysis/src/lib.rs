//! Analyses of the flight models.
//!
//! * [`trim`]: the state and input of steady flight on a straight path.
//! * [`linearize`]: the linear system about it; [`poles`]: its poles with their modes, and its zeros.
//! * [`covariance`]: of the deviations from a flight, linear and by Monte Carlo.
//! * [`disperse`]: trims and roots of vehicles whose parameters are drawn; [`parametric`]: models with other parameters.
//! * [`lqr`]: the linear-quadratic regulator of a linear system; [`actuator`]: lags and limits of what moves the inputs.
//! * [`monte_carlo`]: many flights with noise and dispersions, as fast as the machine goes; [`ordered`]: such work in parts.
//! * [`statistics`]: estimates with their confidence.
#![forbid(unsafe_code)]

pub mod actuator;
pub mod covariance;
pub mod disperse;
pub mod linearize;
pub mod lqr;
pub mod monte_carlo;
pub mod ordered;
pub mod parametric;
pub mod poles;
pub mod sensitivity;
pub mod statistics;
pub mod trim;
