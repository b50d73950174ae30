//! What it takes to write a model and to step it: `use ahv_integrate::prelude::*;`.
//!
//! The traits of `ahv-core` are among it, and [`impl_vector!`](ahv_core::impl_vector), which makes a struct with named
//! components the state of a model.

pub use ahv_core::{
    AdditiveNoise, ColouredNoise, CommutativeNoise, DifferentiableModel, DifferentiableNoise,
    ItoCorrected, Model, NoiseClass, Pattern, Real, StochasticModel, Vector, impl_vector,
};

pub use crate::{
    Adaptive, Admits, Attempt, BrownianPath, Checked, ComponentLimit, Constant, Crossing, Dense,
    DormandPrince54, DormandPrince853, Ending, Euler, Event, Exponential, Failure, Feedback, Fixed,
    Heun, InputSource, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1,
    ItoStrangSplitting, KeyedNormals, Located, Method, NoiseError, NormalSource, NormalStream,
    Observer, Problem, Progress, Rk4, Rodas4, SdeScheme, Sense, Start, StepError, StratonovichHeun,
    TimeGrid, Tsit5, WeakIncrements, When, WienerIntegrals, WienerSource,
};
