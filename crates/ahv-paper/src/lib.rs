//! What is about the paper, and about one controller.
//!
//! * [`reduce`]: a flexible mode and its reduction to coloured noise in closed form; [`ensemble`]: the same by Monte Carlo.
//! * [`track`]: closed loops, with [`backstepping`] on SDCOM's strict-feedback form and a linear-quadratic regulator.
//! * [`reproduce`]: section 5 of the paper, computed again.
//! * [`commands`]: the commands of `ahv` for them.
#![forbid(unsafe_code)]

pub mod backstepping;
pub mod commands;
pub mod ensemble;
pub mod reduce;
pub mod reproduce;
pub mod track;
