//! What a generated model says of itself: all that a command or an analysis needs to know of a model that it never saw.

use core::fmt::{Debug, Display};

use crate::{
    Bounds, ColouredNoise, DifferentiableModel, DifferentiableNoise, ParameterSet, Provenance,
    Real, Table, Vector,
};

/// What a component of a vector may be.
pub trait Component: Copy + Send + Sync + 'static {}

impl<T: Copy + Send + Sync + 'static> Component for T {}

/// A set of parameters of a model.
pub type ParameterSetOf<M> = ParameterSet<
    <M as GeneratedModel>::ParametersOf<f64>,
    <M as GeneratedModel>::ParametersOf<Provenance>,
>;

/// A model as it is generated, with `f64`, and all that its table and its family say of it.
///
/// Vectors over its bases have components of any type: `StateOf<Bounds>` is a state's validity box, `StateOf<Lanes<f64, 8>>`
/// the states of eight members side by side.
pub trait GeneratedModel:
    DifferentiableModel
    + DifferentiableNoise<
        Scalar = f64,
        State = <Self as GeneratedModel>::StateOf<f64>,
        Input = <Self as GeneratedModel>::InputOf<f64>,
        Noise = <Self as GeneratedModel>::NoiseOf<f64>,
    > + ColouredNoise
    + Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
{
    /// Its name: that of its module, and on command lines.
    const NAME: &'static str;
    /// What it is, in a few words.
    const TITLE: &'static str;
    /// What who uses it should know first.
    const NOTE: Option<&'static str>;
    /// Its table.
    const TABLE: &'static Table;
    /// Sets of parameters, the table's own first.
    const SETS: &'static [ParameterSetOf<Self>];
    /// Where its curve fits are meant to be used.
    const STATE_BOUNDS: Self::StateOf<Bounds>;
    /// Where its curve fits are meant to be used.
    const INPUT_BOUNDS: Self::InputOf<Bounds>;
    /// What a steady state of it is.
    const TRIM: TrimProblem;
    /// Its modes of motion, by the states that take part in them.
    const MODES: &'static [ModeOfMotion];
    /// Inputs for zeros and gains, where none are asked for; empty for all.
    const DEFAULT_INPUTS: &'static [&'static str];
    /// Outputs for zeros and gains, where none are asked for; empty for all states.
    const DEFAULT_OUTPUTS: &'static [&'static str];
    /// Deviations of states and inputs that cost 1 in a regulator where none are asked for. One that is not listed costs
    /// nothing, or is not for the regulator.
    const DEVIATIONS: &'static [(&'static str, f64)];
    /// Names of the boundaries where its drift goes over to another formula; empty where the drift is smooth.
    const BOUNDARIES: &'static [&'static str] = &[];

    /// A vector over the parameters of its table.
    type ParametersOf<T: Component>: Vector<T> + Send + Sync + 'static;
    /// A vector over its states.
    type StateOf<T: Component>: Vector<T> + Send + Sync + 'static;
    /// A vector over its inputs.
    type InputOf<T: Component>: Vector<T> + Send + Sync + 'static;
    /// A vector over its Wiener processes.
    type NoiseOf<T: Component>: Vector<T> + Send + Sync + 'static;
    /// A vector over the quantities that people look at.
    type OutputsOf<T: Component>: Vector<T> + Send + Sync + 'static;
    /// The same model with another scalar.
    type With<R: Real>: DifferentiableModel
        + DifferentiableNoise<
            Scalar = R,
            State = Self::StateOf<R>,
            Input = Self::InputOf<R>,
            Noise = Self::NoiseOf<R>,
        > + ColouredNoise
        + Copy
        + Send
        + Sync
        + 'static;

    /// The model of these parameters.
    fn with_parameters(parameters: &Self::ParametersOf<f64>) -> Self;

    /// The model of parameters with another scalar.
    fn generic<R: Real>(parameters: &Self::ParametersOf<R>) -> Self::With<R>;

    /// This model with another scalar; its prepared values are constants there.
    fn with_scalar<R: Real>(&self) -> Self::With<R>;

    /// The model with another scalar: `f` applied to every prepared value.
    fn map_model<R: Real, U: Real>(model: &Self::With<R>, f: impl FnMut(&R) -> U) -> Self::With<U>;

    /// Shows the visitor how many states are coloured noise; `None`, and no visit, if none is.
    fn coloured<V: CountVisitor>(visitor: V) -> Option<V::Output>;

    /// How many states are coloured noise.
    fn coloured_states() -> usize {
        struct Count;

        impl CountVisitor for Count {
            type Output = usize;

            fn visit<const N: usize>(self) -> usize {
                N
            }
        }

        Self::coloured(Count).unwrap_or(0)
    }

    /// The first rule of the table that these parameters break. A rule on a parameter that the model has no use for is none of
    /// its own.
    fn broken_rule(parameters: &Self::ParametersOf<f64>) -> Option<&'static crate::Rule> {
        Self::TABLE.rules.iter().find(|rule| {
            let terms = || rule.terms.iter().flat_map(|term| term.parameters);
            !rule.holds(parameters) && terms().all(|name| Self::uses(name))
        })
    }

    /// Whether the model depends on the parameter of this name.
    fn uses(parameter: &str) -> bool {
        let Some(ParameterSet { parameters, .. }) = Self::SETS.first() else {
            return false;
        };
        let mut other = *parameters;
        let changed = Self::ParametersOf::<f64>::index_of(parameter).and_then(|index| {
            let value = other.get(index)?;
            other.set(index, value + 1.0)
        });
        changed.is_some() && Self::with_parameters(&other) != Self::with_parameters(parameters)
    }

    /// Why the model has no rates at (x, u), where there is more to say than that they are not numbers.
    fn fault(&self, x: &Self::State, u: &Self::Input) -> Option<impl Display> {
        let _ = (x, u);
        None::<&'static str>
    }

    /// The function of the boundary of this index at (x, u): 0 where the drift has a kink or jumps, in the unit of what is
    /// compared there. NaN without such a boundary.
    fn boundary(&self, index: usize, x: &Self::State, u: &Self::Input) -> f64 {
        let _ = (index, x, u);
        f64::NAN
    }

    /// ∂f/∂p at (x, u): a vector over the rows of f, each a vector over the parameters. The unit of an entry is that of its
    /// row per second, over that of its column.
    fn parameter_jacobian(
        &self,
        x: &Self::State,
        u: &Self::Input,
    ) -> Self::StateOf<Self::ParametersOf<f64>>;

    /// The quantities that people look at, at (x, u).
    fn outputs<R: Real>(
        model: &Self::With<R>,
        x: &Self::StateOf<R>,
        u: &Self::InputOf<R>,
    ) -> Self::OutputsOf<R>;

    /// Parameters with other components.
    fn map_parameters<T: Component, U: Component>(
        p: &Self::ParametersOf<T>,
        f: impl FnMut(&T) -> U,
    ) -> Self::ParametersOf<U>;

    /// Applies `f` to each component and the one of `q` in its place.
    fn update_parameters<T: Component, U: Component>(
        p: &mut Self::ParametersOf<T>,
        q: Self::ParametersOf<U>,
        f: impl FnMut(&mut T, U),
    );

    /// The state with other components.
    fn map_state<T: Component, U: Component>(
        x: &Self::StateOf<T>,
        f: impl FnMut(&T) -> U,
    ) -> Self::StateOf<U>;

    /// Tells `f` of each component and the one of `y` in its place.
    fn zip_state<T: Component, U: Component>(
        x: &Self::StateOf<T>,
        y: &Self::StateOf<U>,
        f: impl FnMut(&T, &U),
    );

    /// Applies `f` to each component and the one of `y` in its place.
    fn update_state<T: Component, U: Component>(
        x: &mut Self::StateOf<T>,
        y: Self::StateOf<U>,
        f: impl FnMut(&mut T, U),
    );

    /// The input with other components.
    fn map_input<T: Component, U: Component>(
        u: &Self::InputOf<T>,
        f: impl FnMut(&T) -> U,
    ) -> Self::InputOf<U>;

    /// Applies `f` to each component and the one of `v` in its place.
    fn update_input<T: Component, U: Component>(
        u: &mut Self::InputOf<T>,
        v: Self::InputOf<U>,
        f: impl FnMut(&mut T, U),
    );

    /// The increments with other components.
    fn map_noise<T: Component, U: Component>(
        w: &Self::NoiseOf<T>,
        f: impl FnMut(&T) -> U,
    ) -> Self::NoiseOf<U>;
}

/// The functions of [`GeneratedModel`] that make a model of its parameters or change the components of its vectors, in terms of
/// its `new` and of what [`impl_vector!`](crate::impl_vector) makes. To be used inside the `impl`.
#[macro_export]
macro_rules! model_functions {
    () => {
        fn with_parameters(parameters: &Self::ParametersOf<f64>) -> Self {
            Self::new(parameters)
        }

        fn generic<R: $crate::Real>(parameters: &Self::ParametersOf<R>) -> Self::With<R> {
            <Self::With<R>>::new(parameters)
        }

        fn with_scalar<R: $crate::Real>(&self) -> Self::With<R> {
            self.map_ref(|&it| R::from_f64(it))
        }

        #[inline(always)]
        fn map_model<R: $crate::Real, U: $crate::Real>(
            model: &Self::With<R>,
            f: impl FnMut(&R) -> U,
        ) -> Self::With<U> {
            model.map_ref(f)
        }

        $crate::model_functions!(@map map_parameters ParametersOf);
        $crate::model_functions!(@map map_state StateOf);
        $crate::model_functions!(@map map_input InputOf);
        $crate::model_functions!(@map map_noise NoiseOf);
        $crate::model_functions!(@update update_parameters ParametersOf);
        $crate::model_functions!(@update update_state StateOf);
        $crate::model_functions!(@update update_input InputOf);

        #[inline(always)]
        fn zip_state<T: $crate::Component, U: $crate::Component>(
            x: &Self::StateOf<T>,
            y: &Self::StateOf<U>,
            f: impl FnMut(&T, &U),
        ) {
            x.zip_ref(y, f);
        }
    };
    (@map $name:ident $vector:ident) => {
        #[inline(always)]
        fn $name<T: $crate::Component, U: $crate::Component>(
            vector: &Self::$vector<T>,
            f: impl FnMut(&T) -> U,
        ) -> Self::$vector<U> {
            vector.map_ref(f)
        }
    };
    (@update $name:ident $vector:ident) => {
        #[inline(always)]
        fn $name<T: $crate::Component, U: $crate::Component>(
            vector: &mut Self::$vector<T>,
            other: Self::$vector<U>,
            f: impl FnMut(&mut T, U),
        ) {
            vector.update(other, f);
        }
    };
}

/// What a steady state is: the rates and outputs that vanish, what is given and what is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrimProblem {
    /// States and outputs that are given. An output is an equation: it has the value that is given.
    pub given: &'static [Given],
    /// States and inputs that are sought, states first. A state that is neither given nor sought is 0; an input that is not
    /// sought is held.
    pub sought: &'static [Sought],
    /// Rows of the drift and outputs that vanish; with the outputs that are given as many as there are unknowns.
    pub equations: &'static [Equation],
    /// States that move all the same, such as the altitude of a climb.
    pub moving: &'static [&'static str],
    /// States, inputs and outputs of a steady state that people look at.
    pub shown: &'static [&'static str],
}

/// A state or an output that is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given {
    /// The state or output.
    pub name: &'static str,
    /// Its value where none is asked for.
    pub default: f64,
    /// It must be above this.
    pub above: f64,
    /// It must be below this.
    pub below: f64,
}

impl Given {
    /// From its fields.
    pub const fn new(name: &'static str, default: f64, above: f64, below: f64) -> Self {
        Self {
            name,
            default,
            above,
            below,
        }
    }
}

/// A state or input that is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sought {
    /// The state or input.
    pub name: &'static str,
    /// Where the search starts.
    pub start: f64,
    /// A change that counts as 1.
    pub scale: f64,
}

impl Sought {
    /// From its fields.
    pub const fn new(name: &'static str, start: f64, scale: f64) -> Self {
        Self { name, start, scale }
    }
}

/// A row of the drift, or an output, that vanishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equation {
    /// The state whose rate it is, or the output.
    pub name: &'static str,
    /// How much it weighs where not all rows can vanish.
    pub weight: f64,
    /// A row and a given state: this row is measured by the scale of that row over the state's value, for V̇ is to weigh as
    /// V γ̇. Without them by its own largest derivative.
    pub like: Option<(&'static str, &'static str)>,
}

impl Equation {
    /// From its fields.
    pub const fn new(
        name: &'static str,
        weight: f64,
        like: Option<(&'static str, &'static str)>,
    ) -> Self {
        Self { name, weight, like }
    }
}

/// A mode of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModeOfMotion {
    /// Its name.
    pub name: &'static str,
    /// The states that take part.
    pub states: &'static [&'static str],
    /// Name of the slowest of its real poles where their number is odd.
    pub slowest: Option<&'static str>,
}

impl ModeOfMotion {
    /// From its fields.
    pub const fn new(
        name: &'static str,
        states: &'static [&'static str],
        slowest: Option<&'static str>,
    ) -> Self {
        Self {
            name,
            states,
            slowest,
        }
    }
}

/// What is done with a number that a model knows when it is compiled.
pub trait CountVisitor {
    /// What comes of it.
    type Output;

    /// Does it with `N`.
    fn visit<const N: usize>(self) -> Self::Output;
}

/// The models of a package.
pub trait ModelList {
    /// Shows the visitor each model.
    fn visit(visitor: &mut impl ModelVisitor);
}

/// What is done with each model of a [`ModelList`].
pub trait ModelVisitor {
    /// Does it with the model `M`.
    fn visit<M: GeneratedModel>(&mut self);
}
