//! The first-principles model (FPM) of an air-breathing hypersonic vehicle: geometry in, forces out.
#![forbid(unsafe_code)]

pub mod area;
pub mod atmosphere;
pub mod beam;
mod fault;
mod flow;
mod model;
pub mod oblique_shock;
pub mod prandtl_meyer;
pub mod propulsion;
pub mod rayleigh;
pub mod structure;
pub mod surfaces;
mod table;

pub use fault::Fault;
pub use flow::Flow;
pub use model::{INPUT_BOUNDS, Input, Model, Noise, STATE_BOUNDS, State};
pub use surfaces::Surface;
pub use table::{NOMINAL, PROVENANCE, Parameters, TABLE};
