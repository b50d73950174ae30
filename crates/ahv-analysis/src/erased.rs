//! Every generated model behind one interface: for commands and bindings, where speed does not need a type.
//!
//! [`AnyModel`] says what [`GeneratedModel`] says, and does what this crate does, with vectors that are slices in the order of
//! their names. It is compiled once for a model; what is written over it is compiled once for all.

mod adaptive;
mod model;
mod rows;
mod steppers;

use ahv_core::{
    Bounds, GeneratedModel, ModeOfMotion, ModelList, ModelVisitor, Table, TrimProblem, Vector,
};
use nalgebra::DMatrix;

use crate::covariance::{CovarianceError, Flight, Spreading};
use crate::disperse::{Draws, Member, Nominal, Slopes, SolutionError};
use crate::linearize::{LinearSystem, LinearizeError};
use crate::monte_carlo::{Engine, Experiment, Feedback, MonteCarloError, Scheme, Unsteady};
use crate::ordered::Control;
use crate::trim::{SteadyState, Trim, TrimError};

pub use crate::values::{values, vector};
pub use adaptive::{Fly, Passage};
pub use steppers::{Advance, DeterministicScheme, StepperError};

/// Names and units of the components of a vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Components {
    /// Names, in order.
    pub names: &'static [&'static str],
    /// Units; `1` where there is none.
    pub units: &'static [&'static str],
    /// The same in metre, kilogram, second and radian.
    pub si_units: &'static [&'static str],
    /// What each component is multiplied with to be in its SI unit.
    pub si_factors: &'static [f64],
}

impl Components {
    /// Those of a type of vectors.
    pub const fn of<T: Copy, V: Vector<T>>() -> Self {
        Self {
            names: V::NAMES,
            units: V::UNITS,
            si_units: V::SI_UNITS,
            si_factors: V::SI_FACTORS,
        }
    }

    /// Number of components.
    pub const fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Index of the component called `name`.
    pub fn index_of(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|&own| own == name)
    }
}

/// A set of parameters of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterValues {
    /// Its name.
    pub name: &'static str,
    /// Values, in order.
    pub parameters: Vec<f64>,
    /// Relative uncertainties.
    pub uncertainty: Vec<f64>,
}

/// A model, whichever it is; p, x and u stand for parameters, state and input in the order of their names.
pub trait AnyModel: Send + Sync {
    /// Its name: that of its module, and on command lines.
    fn name(&self) -> &'static str;
    /// What it is, in a few words.
    fn title(&self) -> &'static str;
    /// What who uses it should know first.
    fn note(&self) -> Option<&'static str>;
    /// Its table.
    fn table(&self) -> &'static Table;
    /// Sets of parameters, the table's own first.
    fn sets(&self) -> Vec<ParameterValues>;
    /// Where its curve fits are meant to be used.
    fn state_bounds(&self) -> Vec<Bounds>;
    /// Where its curve fits are meant to be used.
    fn input_bounds(&self) -> Vec<Bounds>;
    /// What a steady state of it is.
    fn trim_problem(&self) -> TrimProblem;
    /// Its modes of motion.
    fn modes(&self) -> &'static [ModeOfMotion];
    /// Inputs for zeros and gains, where none are asked for; all where the model names none.
    fn default_inputs(&self) -> &'static [&'static str];
    /// Outputs for zeros and gains, where none are asked for; all states where the model names none.
    fn default_outputs(&self) -> &'static [&'static str];
    /// Deviations of states and inputs that cost 1 in a regulator where none are asked for.
    fn deviations(&self) -> &'static [(&'static str, f64)];
    /// Its parameters.
    fn parameters(&self) -> Components;
    /// Its states.
    fn states(&self) -> Components;
    /// Its inputs.
    fn inputs(&self) -> Components;
    /// The quantities that people look at.
    fn outputs(&self) -> Components;
    /// Its Wiener increments.
    fn increments(&self) -> Components;
    /// Number of its Wiener processes.
    fn channels(&self) -> usize;
    /// How many states are coloured noise.
    fn coloured_states(&self) -> usize;
    /// Whether two vectors of parameters make the same model.
    fn is_same(&self, p: &[f64], q: &[f64]) -> bool;

    /// As [`GeneratedModel::fault`].
    fn fault(&self, p: &[f64], x: &[f64], u: &[f64]) -> Option<String>;
    /// The drift f(x, u).
    fn drift(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64>;
    /// The drift at many points: writes that of each row of `x` into the row of `rates` in its place, with the bits of
    /// [`Self::drift`]. `u` has one row for all, or one for each.
    fn drifts(&self, p: &[f64], x: &[f64], u: &[f64], rates: &mut [f64]);
    /// ∂f/∂x and ∂f/∂u.
    fn jacobians(&self, p: &[f64], x: &[f64], u: &[f64]) -> [DMatrix<f64>; 2];
    /// ∂f/∂p.
    fn parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64>;
    /// The diffusion G(x, u), with a column for each Wiener process.
    fn diffusion(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64>;
    /// The quantities that people look at.
    fn output_values(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64>;
    /// The derivatives of the outputs by the parameters.
    fn output_parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64>;
    /// As [`crate::trim::trim`].
    ///
    /// # Errors
    ///
    /// Those of [`crate::trim::trim`].
    fn trim(&self, p: &[f64], steady: &SteadyState) -> Result<Trim<Vec<f64>, Vec<f64>>, TrimError>;
    /// As [`crate::linearize::with_outputs`].
    ///
    /// # Errors
    ///
    /// Those of [`crate::linearize::with_outputs`].
    fn linearize(
        &self,
        p: &[f64],
        point: (&[f64], &[f64]),
        inputs: &[String],
        outputs: &[String],
    ) -> Result<LinearSystem, LinearizeError>;

    /// As [`Flight::covariance`].
    ///
    /// # Errors
    ///
    /// Those of [`Flight::covariance`].
    fn covariance(
        &self,
        p: &[f64],
        flight: &Flight,
        times: &[f64],
    ) -> Result<Vec<Spreading>, CovarianceError>;
    /// As [`Flight::stationary`].
    ///
    /// # Errors
    ///
    /// Those of [`Flight::stationary`].
    fn stationary(&self, p: &[f64], flight: &Flight) -> Result<DMatrix<f64>, CovarianceError>;

    /// As [`crate::disperse::nominal`].
    ///
    /// # Errors
    ///
    /// Those of [`crate::disperse::nominal`].
    fn nominal(&self, p: &[f64], steady: SteadyState) -> Result<Nominal, SolutionError>;
    /// As [`crate::disperse::disperse`].
    fn disperse(
        &self,
        draws: &Draws,
        nominal: &Nominal,
        members: u64,
        control: &Control,
    ) -> Vec<Member>;
    /// As [`crate::disperse::slopes`].
    ///
    /// # Errors
    ///
    /// Those of [`crate::disperse::slopes`].
    fn slopes(&self, draws: &Draws, nominal: &Nominal) -> Result<Slopes, SolutionError>;

    /// As [`Scheme::default_for`].
    fn default_scheme(&self, p: &[f64]) -> Scheme;
    /// As [`Feedback::unsteady`].
    fn unsteady(&self, p: &[f64], feedback: &Feedback) -> Option<Unsteady>;
    /// The steps of a single flight without noise.
    ///
    /// # Errors
    ///
    /// [`StepperError::FlexibleModes`]
    fn deterministic(
        &self,
        p: &[f64],
        stepper: DeterministicScheme,
    ) -> Result<Advance, StepperError>;
    /// A single flight without noise, with steps as long as `tolerance` allows: the error of a step, of each state in units of its value
    /// and of the width of its validity box. Boundaries of the drift are located, and no step holds one.
    ///
    /// # Errors
    ///
    /// [`StepperError::NoErrorEstimate`]
    fn adaptive(
        &self,
        p: &[f64],
        stepper: DeterministicScheme,
        tolerance: f64,
    ) -> Result<Fly, StepperError>;
    /// The steps of a single flight with the noise of `seed`: that of member 0 of an ensemble.
    ///
    /// # Errors
    ///
    /// [`StepperError::NoColouredNoise`], [`StepperError::Noise`]
    fn stochastic(&self, p: &[f64], scheme: Scheme, seed: u64) -> Result<Advance, StepperError>;
    /// As [`Experiment::engine`].
    ///
    /// # Errors
    ///
    /// Those of [`Experiment::engine`].
    fn engine<'e>(&self, experiment: &'e Experiment) -> Result<Engine<'e>, MonteCarloError>;
}

/// The model `M`.
pub fn erased<M: GeneratedModel>() -> Box<dyn AnyModel> {
    Box::new(model::Erased::<M>::new())
}

/// The models of a package, in its order.
pub fn all<L: ModelList>() -> Vec<Box<dyn AnyModel>> {
    struct Collector(Vec<Box<dyn AnyModel>>);

    impl ModelVisitor for Collector {
        fn visit<M: GeneratedModel>(&mut self) {
            self.0.push(erased::<M>());
        }
    }

    let mut collector = Collector(Vec::new());
    L::visit(&mut collector);
    collector.0
}
