//! Parameters from records: against known coefficients, and against SciPy.
#![forbid(unsafe_code)]

mod common;
mod coverage;
mod scipy;
