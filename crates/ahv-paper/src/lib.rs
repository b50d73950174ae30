//! What is about the paper, and about one controller.
//!
//! * [`reduce`]: a flexible mode and its reduction to coloured noise in closed form; [`ensemble`]: the same by Monte Carlo.
//! * [`track`]: closed loops, with [`backstepping`] on SDCOM's strict-feedback form and a linear-quadratic regulator.
//! * [`reproduce`]: section 5 of the paper, computed again.
//! * [`commands`]: the commands of `ahv` for them.
//!
//! ```
//! use ahv_paper::reduce::{ReducedMode, Reduction, section_5_1};
//!
//! // The first flexible mode of (36) and its reduction of the same stationary variance.
//! let [first, ..] = section_5_1();
//! let reduced = ReducedMode::new(first, Reduction::Variance)?;
//! assert!((reduced.variance_ratio() - 1.0).abs() < 1e-12);
//! # Ok::<(), ahv_paper::reduce::ReduceError>(())
//! ```
#![forbid(unsafe_code)]

pub mod backstepping;
pub mod commands;
pub mod compare;
pub mod ensemble;
pub mod reduce;
pub mod reproduce;
pub mod track;
