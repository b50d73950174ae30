//! Analyses of the flight models.
//!
//! * [`trim`]: the state and input of steady flight on a straight path.
//! * [`linearize`]: the linear system about it; [`poles`]: its poles with their modes, and its zeros.
//! * [`covariance`]: of the deviations from a flight, linear and by Monte Carlo.
//! * [`disperse`]: trims and roots of vehicles whose parameters are drawn; [`parametric`]: models with other parameters.
//! * [`reduce`]: a flexible mode and its reduction to coloured noise in closed form; [`ensemble`]: the same by Monte Carlo;
//!   [`statistics`]: estimates with their confidence.
//! * [`track`]: closed loops, with [`backstepping`] on SDCOM's strict-feedback form and the linear-quadratic regulator of [`lqr`].
//! * [`monte_carlo`]: many flights with noise and dispersions, as fast as the machine goes.
//! * [`reproduce`]: section 5 of the paper, computed again.
#![forbid(unsafe_code)]

pub mod backstepping;
pub mod covariance;
pub mod disperse;
pub mod ensemble;
pub mod linearize;
pub mod lqr;
pub mod monte_carlo;
mod ordered;
pub mod parametric;
pub mod poles;
pub mod reduce;
pub mod reproduce;
pub mod sensitivity;
pub mod statistics;
pub mod track;
pub mod trim;
