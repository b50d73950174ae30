//! Reviews a table of coefficients: [`lint()`] finds what is wrong or suspicious, [`laid_out`] aligns its columns, and
//! [`Overview`] shows each number with its share of the quantity that it is part of.
//!
//! What a table may hold comes from the models that were generated from such a table ([`ahv_table::Family`]) or from their
//! IR ([`Subject::of_ir`]). This crate names no section, parameter or model, and it computes no model: it reads tables.
//! It prints nothing and writes no file. Start with [`lint()`].
//!
//! ```
//! use ahv_review::{Limits, Subject, faults, lint};
//! use ahv_table::{Family, Text};
//!
//! let subject = Subject::new(Family::of::<ahv_models::dcom::Model<f64>>());
//! let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../generator/tables/dcom.toml");
//! let own = std::fs::read_to_string(path)?;
//!
//! // An elevator slope per degree where one per radian belongs: the canard's slope betrays it.
//! let slip = own.replace("\"delta_e\" = { value = -1.2897", "\"delta_e\" = { value = -0.022509");
//! let slip = Text::parse(slip)?;
//! let found = lint(&slip, &subject, &Limits::default(), faults(&slip, &subject));
//! assert!(found.iter().any(|it| it.rule == "degrees"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod contents;
mod difference;
mod layout;
mod lint;
mod overview;
mod page;
mod report;
mod sarif;
mod subject;

pub use contents::models;
pub use difference::{Change, Difference, QuantityChange, Side};
pub use layout::{NotTheSame, laid_out};
pub use lint::{Finding, LINTS, Limits, Lint, Severity, faults, lint, unreadable};
pub use overview::Overview;
pub use page::page;
pub use report::{Reviewed, json, rendered};
pub use sarif::sarif;
pub use subject::{Condition, Reference, Subject};
