//! Steppers for models that implement the traits of `ahv-core`.
//!
//! * [`Euler`], [`Heun`], [`Rk4`]: deterministic models, fixed step, orders 1, 2, 4.
//! * [`DormandPrince54`], [`Tsit5`]: explicit pairs of orders 5 and 4; [`DormandPrince853`]: explicit, of order 8;
//!   [`Rodas4`]: L-stable pair of orders 4 and 3 for stiff models. [`Adaptive`] runs them with control of the step size, dense output and events, [`Fixed`] with a
//!   fixed step. A [`TimeGrid`] numbers fixed steps and tells the time of a failure.
//! * [`Exponential`]: linear flexible modes exactly, the rest with order 4.
//! * [`Constant`], [`Held`], [`Interpolated`], [`Feedback`], [`Saturated`]: what drives a run.
//!
//! Stochastic models, each scheme in the sense that its name says:
//!
//! | scheme | noise | strong order | weak order |
//! |---|---|---|---|
//! | [`ItoEulerMaruyama`] | any | 1/2, additive 1 | 1 |
//! | [`StratonovichHeun`], [`ItoHeun`] | any | 1/2, commutative 1 | 1, additive 2 |
//! | [`ItoMilstein`] | commutative | 1 | 1 |
//! | [`ItoSra1`] | additive | 3/2 | 2 |
//! | [`ItoDri1`] | any | none | 2 |
//! | [`ItoStrangSplitting`] | coloured noise exact, else the inner scheme's | none | 2 with an inner scheme of weak order 2, else 1 |
//! | [`LinearTransition`] | linear equations with additive noise | exact in law | exact |
//!
//! All of them but the last implement [`SdeScheme`], which takes a step from normal numbers: code over it runs every scheme.
//!
//! Noise comes from the caller: [`WienerSource`], [`NormalStream`], [`KeyedNormals`], [`NormalLanes`], a [`BrownianPath`]
//! that can be refined, and, by the feature `rand`, `RandNormals`; in the shape of [`WienerIntegrals`] and
//! [`WeakIncrements`] too. A scheme that needs additive or commutative noise asks for it by a trait; [`AdditiveChannels`] and
//! [`CommutativeChannels`] check it at run time.
//!
//! A step allocates nothing and does not panic. A step whose result is not finite is an error that
//! names the component, and leaves the state as it was.
//!
//! ```
//! use ahv_integrate::prelude::*;
//!
//! #[derive(Clone, Copy, Debug, PartialEq)]
//! struct State<T> {
//!     speed: T,
//! }
//!
//! #[derive(Clone, Copy, Debug, PartialEq)]
//! struct Input<T> {
//!     thrust: T,
//! }
//!
//! impl_vector!(State { speed: ["m/s", "m/s", 1.0] });
//! impl_vector!(Input { thrust: ["m/s^2", "m/s^2", 1.0] });
//!
//! /// v̇ = u − v/2
//! struct Sledge;
//!
//! impl Model for Sledge {
//!     type Scalar = f64;
//!     type State = State<f64>;
//!     type Input = Input<f64>;
//!
//!     fn drift(&self, x: &State<f64>, u: &Input<f64>) -> State<f64> {
//!         State { speed: u.thrust - 0.5 * x.speed }
//!     }
//! }
//!
//! // With steps of 10 ms, the last one shorter if needed.
//! let (mut run, held) = (Progress::new(0.0, State { speed: 0.0 }), Input { thrust: 1.0 });
//! let grid = TimeGrid::new(0.0, 2.0, 0.01)?;
//! while grid.step(&mut run, |x, _, dt| Rk4::new(dt).step(&Sledge, x, &held))? {}
//! assert!((run.state.speed - 2.0 * (1.0 - (-1.0_f64).exp())).abs() < 1e-9);
//!
//! // From there to the event that the speed is 1.5 m/s, with steps under control of the error.
//! let fast = When::new("fast", Crossing::Rising, |_, x: &State<f64>| x.speed - 1.5);
//! let (events, input): ([&dyn Event<Sledge>; 1], _) = ([&fast], Constant(held));
//! let problem = Problem::new(&Sledge, &input).events(&events);
//! Adaptive::new(DormandPrince853, 1e-9, State::splat(1e-9)).run(&problem, &mut run, 60.0, &mut ())?;
//! assert!((run.time - 2.0 * 4.0_f64.ln()).abs() < 1e-8);
//! # Ok::<(), Failure>(())
//! ```
//!
//! The folder `examples` has a model, a scheme and a method of one's own, events and dense output, a refined Brownian path,
//! DRI1 and the splitting.
#![no_std]
#![forbid(unsafe_code)]

mod adaptive;
mod brownian;
mod channels;
mod controller;
mod dense;
mod dormand_prince_853;
mod embedded;
mod error;
mod euler_maruyama;
mod events;
mod exponential;
mod failure;
mod fixed;
mod grid;
mod heun;
mod input;
mod linear;
mod method;
mod milstein;
mod noise;
mod ornstein_uhlenbeck;
mod rosenbrock;
mod scheme;
mod splitting;
mod sra;
mod vector;
mod weak;

pub mod prelude;

pub use adaptive::{Adaptive, Ending, Observer, Problem, Progress};
pub use brownian::{BrownianPath, NormalSource, WienerIntegrals, bisect};
pub use channels::{AdditiveChannels, CommutativeChannels, NoiseError};
pub use dense::Dense;
pub use dormand_prince_853::DormandPrince853;
pub use embedded::{DormandPrince54, EmbeddedPair, Tableau, Tsit5};
pub use error::StepError;
pub use euler_maruyama::ItoEulerMaruyama;
pub use events::{ComponentLimit, Crossing, Event, Located, When};
pub use exponential::{Exponential, FlexibleMode};
pub use failure::{Anywhere, Failure, Leaving, Validity, Within};
pub use fixed::{Euler, Heun, Rk4};
pub use grid::TimeGrid;
pub use heun::{ItoHeun, StratonovichHeun};
pub use input::{Constant, Feedback, Held, InputSource, Interpolated, Saturated, saturate};
pub use method::{Attempt, Fixed, Method, Start};
pub use milstein::ItoMilstein;
#[cfg(feature = "rand")]
pub use noise::RandNormals;
pub use noise::{KeyedNormals, NormalLanes, NormalStream, Precision, WienerSource};
pub use ornstein_uhlenbeck::LinearTransition;
pub use rosenbrock::{Rodas4, RosenbrockTableau};
pub use scheme::{Admits, Checked, SdeScheme, Sense};
pub use splitting::{HeldColoured, ItoStrangSplitting};
pub use sra::ItoSra1;
pub use weak::{ItoDri1, WeakIncrements};
