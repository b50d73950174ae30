//! Least squares of quantities that are sums of monomials.
//!
//! [`Design`] reads samples once, in blocks, by Householder reflections: it never forms normal equations, and it keeps one small
//! triangle for each fold of the cross-validation. Everything else is computed from these triangles: [`Problem::solve`] gives
//! coefficients with errors, condition and cross-validated residual, under [`Constraint`]s; [`search`] finds monomials worth adding or
//! dropping. [`latin_hypercube`] draws designed samples. Any [`Source`] can supply samples of a table's quantities.
//!
//! The crate depends on nalgebra and rayon. It knows no table, no model and no unit. Start with [`Design::of`].
//!
//! ```
//! use ahv_fit::{Design, Problem, Samples};
//!
//! // y = 2 + 3 x² at eleven points.
//! let x: Vec<f64> = (0..=10).map(|k| f64::from(k) / 10.0).collect();
//! let y: Vec<f64> = x.iter().map(|x| 2.0 + 3.0 * x * x).collect();
//! let samples = Samples { variables: &[x], responses: &[y], weights: None };
//! let design = Design::of(&samples, &[vec![0], vec![2]], 5)?;
//! let found = Problem::new(&design, 0, &[0, 1]).solve(&[])?;
//! assert!((found.values[0] - 2.0).abs() < 1e-14 && (found.values[1] - 3.0).abs() < 1e-14);
//! # Ok::<(), ahv_fit::FitError>(())
//! ```
#![forbid(unsafe_code)]

mod constraint;
mod design;
mod draw;
mod problem;
mod residual;
mod search;
mod source;

pub use constraint::Constraint;
pub use design::{Design, FOLDS, Monomial, Samples, value};
pub use draw::latin_hypercube;
pub use problem::{Estimate, FitError, Problem};
pub use residual::Residuals;
pub use search::{Move, Step, search};
pub use source::{Ask, Sampler, Source, Variable};
