//! The commands, through the real binary.
//!
//! Those that are stopped by signals, and those at the ends of what numbers can be, are programs of their own: they want the
//! machine for themselves.
#![forbid(unsafe_code)]

#[cfg(feature = "parquet")]
mod campaign;
mod closed_loop;
mod command;
mod files;
mod fit;
mod forces;
mod linearize;
mod monte_carlo;
mod poles;
mod rare;
mod reduce;
mod requests;
mod simulate;
mod table;
mod trim;
mod uncertainty;
