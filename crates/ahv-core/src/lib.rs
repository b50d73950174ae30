//! Traits that the flight models, the steppers and the analyses share.
//!
//! * [`Real`]: the scalar, with elementary functions that give the same bits on every machine.
//! * [`Lanes`]: several numbers side by side as one scalar; [`Branchless`]: a scalar without branches, for loops over members.
//! * [`Vector`]: a vector whose components have names and units (a state, an input, a row of a Jacobian).
//! * [`Model`], [`DifferentiableModel`], [`StochasticModel`]: what a generated model can do.
//! * [`NoInline`]: a model whose functions are called where others are inlined.
//! * [`ItoCorrected`], [`DifferentiableNoise`], [`AdditiveNoise`], [`CommutativeNoise`], [`ColouredNoise`]: what schemes
//!   for stochastic equations ask for.
//! * [`GeneratedModel`]: what a generated model and its [`Table`] say of themselves, for commands and analyses that never saw
//!   the model; [`ModelList`]: the models of a package.
//! * [`Bounds`]: an interval of validity.
//! * [`record!`], [`entries!`]: structs of numbers with names; [`Pattern`]: where the entries of a compressed matrix stand.
//! * [`NoiseClass`]: how a column of the diffusion depends on the state.
//! * [`Shown`]: a number in a text for people.
//!
//! No heap and no panic: an index out of range is an [`Option`], never an abort.
//!
//! ```
//! use ahv_core::{Model, Vector, impl_vector};
//!
//! #[derive(Clone, Copy, Debug, PartialEq)]
//! struct State<T> {
//!     angle: T,
//!     rate: T,
//! }
//!
//! #[derive(Clone, Copy, Debug, PartialEq)]
//! struct Input<T> {
//!     torque: T,
//! }
//!
//! impl_vector!(State { angle: ["rad", "rad", 1.0], rate: ["rad/s", "rad/s", 1.0] });
//! impl_vector!(Input { torque: ["1/s^2", "1/s^2", 1.0] });
//!
//! /// A satellite about one axis.
//! struct Satellite;
//!
//! impl Model for Satellite {
//!     type Scalar = f64;
//!     type State = State<f64>;
//!     type Input = Input<f64>;
//!
//!     fn drift(&self, x: &State<f64>, u: &Input<f64>) -> State<f64> {
//!         State { angle: x.rate, rate: u.torque }
//!     }
//! }
//!
//! let x = State { angle: 0.1, rate: 0.5 };
//! let slope = Satellite.drift(&x, &Input { torque: 2.0 });
//! assert_eq!(slope, State { angle: 0.5, rate: 2.0 });
//! assert_eq!(slope.find(|component| component > 1.0), Some(("rate", 2.0)));
//! assert_eq!(State::<f64>::UNITS, ["rad", "rad/s"]);
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

mod bounds;
mod branchless;
mod dual;
mod elementary;
mod generated;
mod lanes;
mod model;
mod nalgebra;
mod no_inline;
mod noise;
mod pattern;
mod provenance;
mod real;
mod record;
mod shown;
mod table;
mod vector;

pub use bounds::{Bounds, Outside, first_outside};
pub use branchless::Branchless;
pub use dual::Dual;
pub use generated::{
    Component, CountVisitor, Equation, GeneratedModel, Given, ModeOfMotion, ModelList,
    ModelVisitor, ParameterSetOf, Sought, TrimProblem,
};
pub use lanes::{Lane, Lanes};
pub use model::{
    AdditiveNoise, ColouredNoise, CommutativeNoise, DifferentiableModel, DifferentiableNoise,
    ItoCorrected, Model, StochasticModel,
};
pub use no_inline::NoInline;
pub use noise::{NoNoise, NoiseClass};
pub use pattern::Pattern;
pub use provenance::{Provenance, Status};
pub use real::Real;
pub use shown::Shown;
pub use table::{
    Choice, ChoiceOption, Entry, EntryKind, Fit, FitVariable, Interval, ParameterSet, Rule, Sign,
    Table, Term,
};
pub use vector::Vector;
