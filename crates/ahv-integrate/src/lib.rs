//! Steppers for models that implement the traits of `ahv-core`.
//!
//! * [`Rk4`]: deterministic models, order 4.
//! * [`EulerMaruyama`]: stochastic models in the Itô sense, strong order 1/2, weak order 1.
//!
//! A step allocates nothing and does not panic. A step whose result is not finite is an error that
//! names the component, and leaves the state as it was.
#![no_std]
#![forbid(unsafe_code)]

mod error;
mod euler_maruyama;
mod rk4;

pub use error::StepError;
pub use euler_maruyama::EulerMaruyama;
pub use rk4::Rk4;
