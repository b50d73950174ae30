//! The first-principles model (FPM) of an air-breathing hypersonic vehicle: geometry in, forces out.
//!
//! Every number comes from the geometry table `vehicle.toml`; what is assumed beside it stands in `docs/first-principles.md`. The flow is
//! computed surface by surface from shocks, expansions, heat addition and area changes, a file each. Two clamped beams bend
//! under the pressures. [`Model`] is an [`ahv_core::GeneratedModel`] like those that are generated, so that it trims, linearises and
//! flies; derivatives come from [`ahv_core::Dual`]. It may depend on `ahv-core`, draws with `ahv-plot` and gives `ahv-fit` samples; of other models it
//! knows the curve fits that it has samples for ([`SOURCE`]).
//! Start with [`Model::forces`] and `flow.rs`.
//!
//! ```
//! use ahv_fpm::{Fault, Input, Model, NOMINAL, State, Surface};
//!
//! let model = Model::new(&NOMINAL);
//! let level = State { velocity: 7702.08, altitude: 85_000.0, alpha: 0.026, ..State::from_array([0.0; 9]) };
//! let flow = model.forces(&level, &Input { phi: 0.25, delta_e: 0.2 })?;
//! // Behind the bow shock, and along the forebody.
//! assert!((flow.bow.mach - 6.17).abs() < 0.01);
//! assert!(flow.loads[Surface::Forebody as usize].normal > 5000.0);
//!
//! // Too much fuel chokes the combustor: an error that says so, never a NaN.
//! let slow = State { velocity: 7000.0, alpha: 0.17, ..level };
//! let fault = model.forces(&slow, &Input { phi: 1.2, delta_e: 0.0 }).unwrap_err();
//! assert!(matches!(fault, Fault::ThermalChoking { .. }));
//! # Ok::<(), Fault>(())
//! ```
#![forbid(unsafe_code)]

pub mod area;
pub mod atmosphere;
mod batch;
pub mod beam;
pub mod canard;
mod description;
pub mod drawing;
mod fault;
mod flow;
pub mod free;
mod model;
pub mod oblique_shock;
mod outputs;
pub mod prandtl_meyer;
pub mod propulsion;
pub mod rayleigh;
mod source;
pub mod structure;
pub mod surfaces;
mod table;

pub use batch::Total;
pub use fault::Fault;
pub use flow::Flow;
pub use model::{INPUT_BOUNDS, Input, Model, Noise, STATE_BOUNDS, State};
pub use outputs::Outputs;
pub use source::SOURCE;
pub use surfaces::{Load, Surface};
pub use table::{NOMINAL, PROVENANCE, Parameters, TABLE};
