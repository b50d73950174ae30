//! Which vehicle, in which condition: what every command that flies or studies a model lets choose.

use ahv_analysis::trim::{LevelFlight, SOUGHT_INPUTS, Trim, trim};
use ahv_models::dcom::{Canard, Earth, ModalNoise, Reduction};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};

use crate::assignment::Assignments;
use crate::failure::{Failure, complain};
use crate::names;
use crate::units::Units;
use crate::vehicle::{FlightModel, ModelName, for_model};

/// Velocity in ft/s of the trim.
const TRIM_VELOCITY: f64 = 7702.0808;

/// Altitude in ft of the trim.
const TRIM_ALTITUDE: f64 = 85_000.0;

/// Model, parameters, choices and units. What is not given is as the table has it.
#[derive(Args)]
pub(crate) struct Condition {
    /// Model
    #[arg(long)]
    pub(crate) model: ModelName,

    /// Set of parameters, e.g. section5.1 or section5.3 [default: the table's own]
    #[arg(long, value_name = "NAME")]
    set: Option<String>,

    /// Canard: free (delta_c is an input), slaved to the elevator by law (4), or none [default: as the table has it]
    #[arg(long, value_parser = options(Canard::ALL.map(Canard::name)))]
    canard: Option<String>,

    /// Earth: flat, or spherical with gravity that falls with altitude [default: as the table has it]
    #[arg(long, value_parser = options(Earth::ALL.map(Earth::name)))]
    earth: Option<String>,

    /// Noise of the flexible modes: each its own, or one shared by all, as (16) has it [default: as the table has it]
    #[arg(long, value_parser = options(ModalNoise::ALL.map(ModalNoise::name)))]
    noise: Option<String>,

    /// Reduction of a flexible mode to coloured noise: printed keeps decay rate and gain at zero frequency as (23) does,
    /// variance decay rate and variance, moment variance and gain [default: as the table has it]
    #[arg(long, value_parser = options(Reduction::ALL.map(Reduction::name)))]
    reduction: Option<String>,

    /// Units of inputs and results, and those in which the model is run [default: ft-slug-s-rad, as the tables are]
    #[arg(long)]
    units: Option<Units>,
}

fn options<const N: usize>(names: [&'static str; N]) -> PossibleValuesParser {
    names.into()
}

/// A model in its condition.
pub(crate) struct Vehicle<M: FlightModel> {
    pub(crate) model: M,
    pub(crate) units: Units,
    /// Set of parameters.
    pub(crate) set: &'static str,
    /// Choices that the model has, each with what is chosen; a table may hold a mixture that has no name.
    pub(crate) choices: Vec<(&'static str, Option<&'static str>)>,
    pub(crate) state_bounds: M::StateBounds,
    pub(crate) input_bounds: M::InputBounds,
}

impl Condition {
    /// The model `M`, which must be the one that `self.model` names, in this condition.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for a set, choice or system of units that the model does not have.
    pub(crate) fn vehicle<M: FlightModel>(&self) -> Result<Vehicle<M>, Failure> {
        let units = self.units::<M>()?;
        let (set, mut parameters) = self.set::<M>()?;
        for (name, option) in self.chosen() {
            let Some(option) = option else { continue };
            let choice = M::choice(name).ok_or_else(|| lacks::<M>(name))?;
            parameters = (choice.make)(parameters, option).ok_or_else(|| {
                let problem = names::unknown(name, option, &(choice.options)());
                Failure::Request(format!("--{name}: {problem}"))
            })?;
        }
        let choices = M::CHOICES.iter().filter(|choice| M::heeds(choice));
        let choices = choices.map(|choice| {
            let mut options = (choice.options)().into_iter();
            let chosen =
                options.find(|option| (choice.make)(parameters, option) == Some(parameters));
            (choice.name, chosen)
        });
        if self.model == ModelName::SdcomPrinted {
            complain(
                "note: sdcom_printed is the paper's truncated form; what it leaves out (Delta f) can exceed the exact rate \
                 itself, see generated/docs/sdcom_printed.md. The exact form is --model sdcom",
            );
        }
        Ok(Vehicle {
            model: M::with_parameters(&units.convert(parameters)),
            units,
            set,
            choices: choices.collect(),
            state_bounds: units.convert_bounds(M::STATE_BOUNDS),
            input_bounds: units.convert_bounds(M::INPUT_BOUNDS),
        })
    }

    fn units<M: FlightModel>(&self) -> Result<Units, Failure> {
        let own = Units::of_table(M::UNIT_SYSTEM);
        match self.units {
            Some(Units::FootSlug) if own == Units::Si => Err(Failure::Request(format!(
                "--units: the table of {} is in {}, and is not converted to {}",
                M::NAME,
                own.name(),
                Units::FootSlug.name()
            ))),
            chosen => Ok(chosen.unwrap_or(own)),
        }
    }

    fn set<M: FlightModel>(&self) -> Result<(&'static str, M::Parameters), Failure> {
        let name = self.set.as_deref();
        let mut sets = M::SETS.iter();
        let found = sets.find(|(own, _)| name.is_none_or(|name| name == *own));
        found.copied().ok_or_else(|| {
            let known: Vec<_> = M::SETS.iter().map(|&(known, _)| known).collect();
            let problem = names::unknown("set of parameters", name.unwrap_or_default(), &known);
            Failure::Request(format!("--set: {problem}"))
        })
    }

    fn chosen(&self) -> [(&'static str, Option<&str>); 4] {
        [
            ("canard", self.canard.as_deref()),
            ("earth", self.earth.as_deref()),
            ("noise", self.noise.as_deref()),
            ("reduction", self.reduction.as_deref()),
        ]
    }
}

fn lacks<M: FlightModel>(choice: &str) -> Failure {
    let having: Vec<_> = ModelName::value_variants()
        .iter()
        .filter_map(|&name| for_model!(name, Other => Other::choice(choice).map(|_| Other::NAME)))
        .collect();
    Failure::Request(format!(
        "--{choice}: {} has no such choice; {} have it",
        M::NAME,
        names::list(&having)
    ))
}

impl<M: FlightModel> Vehicle<M> {
    /// Level flight at the standard velocity and altitude, `inputs` held but for those that are sought.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if `inputs` move a canard that does not move, [`Failure::Numeric`] if there is no trim.
    pub(crate) fn trim(&self, inputs: &Assignments) -> Result<Trim<M::State, M::Input>, Failure> {
        self.check_canard(inputs)?;
        let [velocity, altitude] =
            [TRIM_VELOCITY, TRIM_ALTITUDE].map(|value| self.units.feet(value));
        let mut level = LevelFlight::new(velocity, altitude);
        inputs.apply(&mut level.input, &SOUGHT_INPUTS);
        trim(&self.model, &level).map_err(|error| {
            Failure::Numeric(format!(
                "{}: {error} (level flight at {velocity} {} and {altitude} {})",
                M::NAME,
                self.units.label::<M::State>("velocity"),
                self.units.label::<M::State>("altitude")
            ))
        })
    }

    /// A deflection without effect is a misunderstanding. None at all may be said, as reports do.
    fn check_canard(&self, inputs: &Assignments) -> Result<(), Failure> {
        let canard = self.choices.iter().find(|(name, _)| *name == "canard");
        let Some((_, Some(canard))) = canard else {
            return Ok(());
        };
        let moved = inputs
            .get::<M::Input>("delta_c")
            .is_some_and(|delta_c| delta_c != 0.0);
        if moved && *canard != Canard::Free.name() {
            return Err(Failure::Request(format!(
                "--input: delta_c has no effect with the canard {canard}: there is no canard to move; choose --canard free"
            )));
        }
        Ok(())
    }
}
