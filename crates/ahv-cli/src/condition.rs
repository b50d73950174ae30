//! Which vehicle, in which condition: what every command that flies or studies a model lets choose.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use ahv_analysis::trim::{SOUGHT_INPUTS, SteadyFlight};
use ahv_models::dcom::{Canard, Earth, ModalNoise, Reduction};
use ahv_models::sdcom_printed;
use clap::builder::{EnumValueParser, PossibleValuesParser};
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::assignment::Assignments;
use crate::failure::{Failure, complain};
use crate::names;
use crate::output::Pairs;
use crate::place;
use crate::table::Table;
use crate::units::Units;
use crate::vehicle::{FlightModel, ModelName, for_model};

/// Model, parameters, choices and units. What is not given is as the table has it. `N` is the models that the command takes.
#[derive(Args)]
pub(crate) struct Condition<N: ValueEnum + Clone + Send + Sync + 'static = ModelName> {
    /// Model
    #[arg(long, value_parser = EnumValueParser::<N>::new())]
    pub(crate) model: N,

    /// Table whose values, choices, sets and validity box take the place of those that the models were generated with
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,

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
    /// Table that the values come from, if they are not those that the model was generated with.
    pub(crate) table: Option<PathBuf>,
    /// Set of parameters.
    pub(crate) set: Cow<'static, str>,
    /// Choices that the model has, each with what is chosen; a table may hold a mixture that has no name.
    pub(crate) choices: Vec<(&'static str, Option<&'static str>)>,
    /// The parameters of the model.
    pub(crate) parameters: M::Parameters,
    /// Their relative uncertainties.
    pub(crate) uncertainty: M::Parameters,
    pub(crate) state_bounds: M::StateBounds,
    pub(crate) input_bounds: M::InputBounds,
}

/// Which model an outcome is of: what the JSON of every command that takes a condition begins with.
#[derive(Serialize)]
pub(crate) struct Heading<'a> {
    pub(crate) model: &'static str,
    table: Option<&'a Path>,
    set: &'a str,
    choices: Pairs<Option<&'static str>>,
    unit_system: &'static str,
}

/// What a table says of a model, in the units that the model was generated with.
pub(crate) struct Values<M: FlightModel> {
    /// Set of parameters.
    pub(crate) set: Cow<'static, str>,
    pub(crate) parameters: M::Parameters,
    /// Relative uncertainties of the parameters.
    pub(crate) uncertainty: M::Parameters,
    pub(crate) state_bounds: M::StateBounds,
    pub(crate) input_bounds: M::InputBounds,
}

impl<N: ValueEnum + Clone + Send + Sync + 'static> Condition<N> {
    /// The model `M`, which must be the one that `self.model` names, in this condition.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for a set, choice or system of units that the model does not have.
    pub(crate) fn vehicle<M: FlightModel>(&self) -> Result<Vehicle<M>, Failure> {
        let units = self.units::<M>()?;
        let Values {
            set,
            mut parameters,
            uncertainty,
            state_bounds,
            input_bounds,
        } = self.values::<M>()?;
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
        if M::NAME == <sdcom_printed::Model<f64> as FlightModel>::NAME {
            complain(
                "note: sdcom_printed is the paper's truncated form; what it leaves out (Delta f) can exceed the exact rate \
                 itself, see generated/docs/sdcom_printed.md. The exact form is --model sdcom",
            );
        }
        let choices = choices.collect();
        let parameters = units.convert(parameters);
        Ok(Vehicle {
            model: M::with_parameters(&parameters),
            units,
            table: self.table.clone(),
            set,
            choices,
            parameters,
            uncertainty,
            state_bounds: units.convert_bounds(state_bounds),
            input_bounds: units.convert_bounds(input_bounds),
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

    /// The values of the table, or those that the model was generated with.
    fn values<M: FlightModel>(&self) -> Result<Values<M>, Failure> {
        if let Some(path) = &self.table {
            return Table::read(path)?.values(self.set.as_deref());
        }
        let name = self.set.as_deref();
        let mut sets = M::SETS.iter().zip(M::UNCERTAINTIES);
        let found = sets.find(|((own, _), _)| name.is_none_or(|name| name == *own));
        let (&(set, parameters), uncertainty) = found.ok_or_else(|| {
            let known: Vec<_> = M::SETS.iter().map(|&(known, _)| known).collect();
            let problem = names::unknown("set of parameters", name.unwrap_or_default(), &known);
            Failure::Request(format!("--set: {problem}"))
        })?;
        Ok(Values {
            set: set.into(),
            parameters,
            uncertainty: uncertainty(),
            state_bounds: M::STATE_BOUNDS,
            input_bounds: M::INPUT_BOUNDS,
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
    /// [`Failure::Request`] if `inputs` move a canard that does not move.
    pub(crate) fn standard(&self, inputs: &Assignments) -> Result<SteadyFlight<M::Input>, Failure> {
        self.check_canard(inputs)?;
        let [velocity, altitude] =
            [place::VELOCITY, place::ALTITUDE].map(|value| self.units.feet(value));
        let mut level = SteadyFlight::new(velocity, altitude);
        inputs.apply(&mut level.input, &SOUGHT_INPUTS);
        Ok(level)
    }

    /// Model, parameters and choices, for a program.
    pub(crate) fn heading(&self) -> Heading<'_> {
        Heading {
            model: M::NAME,
            table: self.table.as_deref(),
            set: &self.set,
            choices: Pairs(self.choices.clone()),
            unit_system: self.units.name(),
        }
    }

    /// Parameters and choices, for a person.
    pub(crate) fn described(&self) -> String {
        let mut text = match &self.table {
            Some(path) => format!("table {}, set {}", path.display(), self.set),
            None => format!("set {}", self.set),
        };
        for (name, chosen) in &self.choices {
            // Writing into a String cannot fail.
            let _ = write!(text, ", {name} {}", chosen.unwrap_or("of the table"));
        }
        text
    }

    /// A deflection without effect is a misunderstanding. None at all may be said, as reports do.
    pub(crate) fn check_canard(&self, inputs: &Assignments) -> Result<(), Failure> {
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
