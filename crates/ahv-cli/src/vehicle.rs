//! The generated models behind one trait, so that a command is written once for all of them.

use ahv_analysis::parametric::Parametric;
use ahv_core::{Bounds, Vector};
use ahv_models::{com, com_rigid, dcom, sdcom, sdcom_gust, sdcom_printed};
use clap::ValueEnum;

/// A model by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub(crate) enum ModelName {
    /// Control-oriented model with a flexible forebody and aftbody
    Com,
    /// Control-oriented model, rigid
    #[value(alias = "com-rigid")]
    ComRigid,
    /// Decoupled control-oriented model
    Dcom,
    /// Its stochastic reduction, exact
    Sdcom,
    /// Its stochastic reduction as the paper prints it: truncated, far from the exact one
    #[value(alias = "sdcom-printed")]
    SdcomPrinted,
    /// Its stochastic reduction with a band-limited gust
    #[value(alias = "sdcom-gust")]
    SdcomGust,
}

/// A model with noise by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub(crate) enum NoisyModel {
    /// Decoupled control-oriented model
    Dcom,
    /// Its stochastic reduction, exact
    Sdcom,
    /// Its stochastic reduction as the paper prints it: truncated, far from the exact one
    #[value(alias = "sdcom-printed")]
    SdcomPrinted,
    /// Its stochastic reduction with a band-limited gust
    #[value(alias = "sdcom-gust")]
    SdcomGust,
}

/// A model by name that has loops over many members.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub(crate) enum FlownModel {
    /// Decoupled control-oriented model
    Dcom,
    /// Its stochastic reduction, exact
    Sdcom,
}

/// Evaluates an expression with `$model` standing for the generated model called `$name`.
macro_rules! for_model {
    ($name:expr, $model:ident => $run:expr) => {
        for_model!(@match $name, $model => $run;
            Com: com, ComRigid: com_rigid, Dcom: dcom, Sdcom: sdcom, SdcomPrinted: sdcom_printed, SdcomGust: sdcom_gust)
    };
    (@match $name:expr, $model:ident => $run:expr; $($variant:ident: $module:ident),+) => {
        match $name {
            $($crate::vehicle::ModelName::$variant => {
                type $model = ::ahv_models::$module::Model<f64>;
                $run
            })+
        }
    };
}
pub(crate) use for_model;

/// What can be chosen by name.
pub(crate) struct Choice<P> {
    /// Its name in tables and on command lines.
    pub(crate) name: &'static str,
    /// Names of what there is to choose from.
    pub(crate) options: fn() -> Vec<&'static str>,
    /// The parameters with the option of this name; `None` if there is no such option.
    pub(crate) make: fn(P, &str) -> Option<P>,
}

/// A generated model that can fly, with what its table says of it.
pub(crate) trait FlightModel:
    Parametric<Parameters: PartialEq + 'static> + PartialEq
{
    /// Intervals of the states.
    type StateBounds: Vector<Bounds>;
    /// Intervals of the inputs.
    type InputBounds: Vector<Bounds>;

    /// Its name on command lines.
    const NAME: &'static str;
    /// Units of its table.
    const UNIT_SYSTEM: &'static str;
    /// Sets of parameters by name, the table's own first.
    const SETS: &'static [(&'static str, Self::Parameters)];
    /// Relative uncertainties of the parameters, in the order of [`Self::SETS`].
    const UNCERTAINTIES: &'static [fn() -> Self::Parameters];
    /// What its table lets choose. A model may ignore some of it.
    const CHOICES: &'static [Choice<Self::Parameters>];
    /// Where its curve fits are meant to be used.
    const STATE_BOUNDS: Self::StateBounds;
    /// Where its curve fits are meant to be used.
    const INPUT_BOUNDS: Self::InputBounds;

    /// Whether `choice` changes anything in this model: DCOM has no coloured noise to reduce a mode to.
    fn heeds(choice: &Choice<Self::Parameters>) -> bool {
        let Some(&(_, nominal)) = Self::SETS.first() else {
            return false;
        };
        let model = Self::with_parameters(&nominal);
        (choice.options)()
            .into_iter()
            .filter_map(|option| (choice.make)(nominal, option))
            .any(|parameters| Self::with_parameters(&parameters) != model)
    }

    /// The choice called `name`, if this model has it.
    fn choice(name: &str) -> Option<&'static Choice<Self::Parameters>> {
        let choice = Self::CHOICES.iter().find(|choice| choice.name == name)?;
        Self::heeds(choice).then_some(choice)
    }
}

/// Implements [`FlightModel`] for the models of a table with these choices.
macro_rules! flight_models {
    ($($module:ident),+ => $choices:tt) => {
        $(flight_models!(@one $module $choices);)+
    };
    (@one $module:ident { $($name:literal: $with:ident($choice:ident)),+ $(,)? }) => {
        impl FlightModel for $module::Model<f64> {
            type StateBounds = $module::State<Bounds>;
            type InputBounds = $module::Input<Bounds>;

            const NAME: &'static str = stringify!($module);
            const UNIT_SYSTEM: &'static str = $module::UNIT_SYSTEM;
            const SETS: &'static [(&'static str, Self::Parameters)] = &$module::SETS;
            const UNCERTAINTIES: &'static [fn() -> Self::Parameters] = &[
                || $module::PROVENANCE.map_into(|it| it.uncertainty),
                || $module::SECTION5_3_PROVENANCE.map_into(|it| it.uncertainty),
            ];
            const CHOICES: &'static [Choice<Self::Parameters>] = &[$(Choice {
                name: $name,
                options: || $module::$choice::ALL.map($module::$choice::name).to_vec(),
                make: |parameters, name| Some(parameters.$with($module::$choice::from_name(name)?)),
            }),+];
            const STATE_BOUNDS: Self::StateBounds = $module::STATE_BOUNDS;
            const INPUT_BOUNDS: Self::InputBounds = $module::INPUT_BOUNDS;
        }
    };
}

flight_models!(com, com_rigid => { "earth": with_earth(Earth) });
flight_models!(dcom, sdcom, sdcom_printed, sdcom_gust => {
    "canard": with_canard(Canard),
    "earth": with_earth(Earth),
    "noise": with_noise(ModalNoise),
    "reduction": with_reduction(Reduction),
});
