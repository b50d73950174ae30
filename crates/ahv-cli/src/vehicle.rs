//! Which vehicle: model, parameters, choices and units, which every command that flies or studies a model lets choose.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use ahv_analysis::erased::AnyModel;
use ahv_core::{Bounds, Choice, ChoiceOption};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Arg, ArgMatches, Command, Error, FromArgMatches, value_parser};
use serde::Serialize;

use crate::failure::{Failure, complain};
use crate::labels::Labels;
use crate::names;
use crate::output::Pairs;
use crate::registry::{heeded, models};
use crate::table::{self, Values};
use crate::units::Units;

/// Model, parameters, choices and units. What is not given is as the table has it.
pub(crate) struct VehicleArgs {
    model: String,
    table: Option<PathBuf>,
    set: Option<String>,
    /// Choices that are made.
    choices: Vec<(&'static str, String)>,
    units: Option<Units>,
}

/// A name as flags have it, for as long as the program runs: clap takes no other text than a static one.
pub(crate) fn hyphenated(name: &'static str) -> &'static str {
    match name.contains('_') {
        true => Box::leak(name.replace('_', "-").into_boxed_str()),
        false => name,
    }
}

/// The choices of all models, each once, with all that some model has to choose from.
fn all_choices() -> Vec<(&'static Choice, Vec<&'static ChoiceOption>)> {
    let mut all: Vec<(&Choice, Vec<&ChoiceOption>)> = Vec::new();
    for choice in models().flat_map(|model| model.table().choices) {
        let known = all.iter().position(|(known, _)| known.name == choice.name);
        let known = known.unwrap_or_else(|| {
            all.push((choice, Vec::new()));
            all.len() - 1
        });
        let (_, options) = &mut all[known];
        for option in choice.options {
            if options.iter().all(|known| known.name != option.name) {
                options.push(option);
            }
        }
    }
    all
}

impl FromArgMatches for VehicleArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let chosen = all_choices().into_iter().filter_map(|(choice, _)| {
            let option = matches.get_one::<String>(choice.name)?;
            Some((choice.name, option.clone()))
        });
        Ok(Self {
            // It is required.
            model: matches
                .get_one::<String>("model")
                .cloned()
                .unwrap_or_default(),
            table: matches.get_one("table").cloned(),
            set: matches.get_one("set").cloned(),
            choices: chosen.collect(),
            units: matches.get_one("units").copied(),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl clap::Args for VehicleArgs {
    fn augment_args(command: Command) -> Command {
        let names = models().map(|model| {
            let value = PossibleValue::new(model.name()).help(model.title());
            value.alias(hyphenated(model.name()))
        });
        let model = Arg::new("model").long("model");
        let model = model.help("Model").value_name("MODEL");
        let model = match (models().next(), models().nth(1)) {
            // A program over one model needs no name for it.
            (Some(only), None) => model.default_value(only.name()),
            _ => model.required(true),
        };
        let table = Arg::new("table").long("table").value_name("FILE");
        let table = table.value_parser(value_parser!(PathBuf)).help(
            "Table whose values, choices, sets and validity box take the place of those that the models were generated with",
        );
        let set = Arg::new("set").long("set").value_name("NAME");
        let set = set.help("Set of parameters [default: the table's own]");
        let choices = all_choices().into_iter().map(|(choice, options)| {
            let values = options
                .iter()
                .map(|it| PossibleValue::new(it.name).help(it.doc));
            Arg::new(choice.name)
                .long(choice.name)
                .value_name("OPTION")
                .value_parser(PossibleValuesParser::new(values))
                .help(format!(
                    "What is chosen as {} [default: as the table has it]",
                    choice.doc
                ))
        });
        let units = Arg::new("units").long("units").value_name("UNITS");
        let units = units.value_parser(value_parser!(Units)).help(
            "Units of inputs and results, and those in which the model is run [default: those of the table]",
        );
        command
            .arg(model.value_parser(PossibleValuesParser::new(names)))
            .arg(table)
            .arg(set)
            .args(choices)
            .arg(units)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

/// A model in its condition.
pub struct Vehicle {
    /// The model.
    pub model: &'static dyn AnyModel,
    /// The system in which it is run.
    pub units: Units,
    /// Table that the values come from, if they are not those that the model was generated with.
    pub table: Option<PathBuf>,
    /// Set of parameters.
    pub set: Cow<'static, str>,
    /// Choices that the model has, each with what is chosen; a table may hold a mixture that has no name.
    pub choices: Vec<(&'static str, Option<&'static str>)>,
    /// The parameters of the model.
    pub parameters: Vec<f64>,
    /// Their relative uncertainties.
    pub uncertainty: Vec<f64>,
    /// Where its curve fits are meant to be used.
    pub state_bounds: Vec<Bounds>,
    /// The same of the inputs.
    pub input_bounds: Vec<Bounds>,
    /// Names and units of its states.
    pub states: Labels,
    /// Of its inputs.
    pub inputs: Labels,
    /// Of the quantities that people look at.
    pub outputs: Labels,
}

/// Which model an outcome is of: what the JSON of every command that takes a vehicle begins with.
#[derive(Serialize)]
pub(crate) struct Heading<'a> {
    pub(crate) model: &'static str,
    table: Option<&'a Path>,
    set: &'a str,
    choices: Pairs<Option<&'static str>>,
    unit_system: &'static str,
}

/// A point of a flight, by name.
#[derive(Serialize)]
pub(crate) struct PointJson {
    pub(crate) state: Pairs<f64>,
    pub(crate) input: Pairs<f64>,
    pub(crate) outputs: Pairs<f64>,
    pub(crate) units: Pairs<&'static str>,
}

impl VehicleArgs {
    /// A model with a table, and all else as that has it.
    #[cfg(feature = "generate")]
    pub(crate) fn of(model: &dyn AnyModel, table: &Path) -> Self {
        Self {
            model: model.name().to_owned(),
            table: Some(table.to_owned()),
            set: None,
            choices: Vec::new(),
            units: None,
        }
    }

    /// The table that is given.
    pub(crate) fn table(&self) -> Option<&Path> {
        self.table.as_deref()
    }

    /// Whether a model is asked for; only a command that needs none has it otherwise.
    pub(crate) fn is_given(&self) -> bool {
        !self.model.is_empty()
    }

    /// The model that is asked for.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if there is none; the command line has refused such a name before.
    pub(crate) fn model(&self) -> Result<&'static dyn AnyModel, Failure> {
        let name = self.model.replace('-', "_");
        let found = models().find(|model| model.name() == name);
        found.ok_or_else(|| Failure::Request(format!("--model: there is no model {name}")))
    }

    /// The vehicle that is asked for.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for a set, choice or system of units that the model does not have.
    pub(crate) fn vehicle(&self) -> Result<Vehicle, Failure> {
        let model = self.model()?;
        let units = self.units(model)?;
        let Values {
            set,
            mut parameters,
            uncertainty,
            mut state_bounds,
            mut input_bounds,
        } = self.values(model)?;
        let names = model.parameters().names;
        let heeded = heeded(model);
        let own = || {
            let choices = model.table().choices.iter();
            choices.filter(|choice| heeded.contains(&choice.name))
        };
        for (name, option) in &self.choices {
            let choice = own().find(|choice| choice.name == *name);
            let choice = choice.ok_or_else(|| lacks(model, name))?;
            let chosen = choice.option(option).ok_or_else(|| {
                let known: Vec<_> = choice.options.iter().map(|option| option.name).collect();
                let problem = names::unknown(name, option, &known);
                Failure::Request(format!("--{name}: {problem}"))
            })?;
            chosen.apply_to(names, &mut parameters);
        }
        let choices = own().map(|choice| {
            let chosen = choice.options.iter().find(|option| {
                let mut with = parameters.clone();
                option.apply_to(names, &mut with);
                with == parameters
            });
            (choice.name, chosen.map(|option| option.name))
        });
        if let Some(note) = model.note() {
            complain(&format!("note: {note}"));
        }
        let choices = choices.collect();
        units.convert(model.parameters(), &mut parameters);
        units.convert_bounds(model.states(), &mut state_bounds);
        units.convert_bounds(model.inputs(), &mut input_bounds);
        Ok(Vehicle {
            model,
            units,
            table: self.table.clone(),
            set,
            choices,
            parameters,
            uncertainty,
            state_bounds,
            input_bounds,
            states: units.labels(model.states()),
            inputs: units.labels(model.inputs()),
            outputs: units.labels(model.outputs()),
        })
    }

    fn units(&self, model: &dyn AnyModel) -> Result<Units, Failure> {
        let own = Units::of_table(model.table().unit_system);
        match self.units {
            Some(Units::FootSlug) if own == Units::Si => Err(Failure::Request(format!(
                "--units: the table of {} is in {}, and is not converted to {}",
                model.name(),
                own.name(),
                Units::FootSlug.name()
            ))),
            chosen => Ok(chosen.unwrap_or(own)),
        }
    }

    /// The values of the table, or those that the model was generated with.
    fn values(&self, model: &dyn AnyModel) -> Result<Values, Failure> {
        let name = self.set.as_deref();
        if let Some(path) = &self.table {
            return table::values(model, path, name);
        }
        let sets = model.sets();
        let known: Vec<_> = sets.iter().map(|set| set.name).collect();
        let mut sets = sets.into_iter();
        let found = sets.find(|set| name.is_none_or(|name| name == set.name));
        let set = found.ok_or_else(|| {
            let problem = names::unknown("set of parameters", name.unwrap_or_default(), &known);
            Failure::Request(format!("--set: {problem}"))
        })?;
        Ok(Values {
            set: set.name.into(),
            parameters: set.parameters,
            uncertainty: set.uncertainty,
            state_bounds: model.state_bounds(),
            input_bounds: model.input_bounds(),
        })
    }
}

fn lacks(model: &dyn AnyModel, choice: &str) -> Failure {
    let having = models().filter(|model| heeded(*model).contains(&choice));
    let having: Vec<_> = having.map(AnyModel::name).collect();
    Failure::Request(format!(
        "--{choice}: {} has no such choice; {} have it",
        model.name(),
        names::list(&having)
    ))
}

impl Vehicle {
    /// Its model's name.
    pub(crate) fn name(&self) -> &'static str {
        self.model.name()
    }

    /// Model, parameters and choices, for a program.
    pub(crate) fn heading(&self) -> Heading<'_> {
        Heading {
            model: self.name(),
            table: self.table.as_deref(),
            set: &self.set,
            choices: Pairs(self.choices.clone()),
            unit_system: self.units.name(),
        }
    }

    /// State, input and outputs by name with their units, for a program.
    pub(crate) fn point(&self, state: &[f64], input: &[f64]) -> PointJson {
        let outputs = self.model.output_values(&self.parameters, state, input);
        let all = [self.states, self.inputs, self.outputs];
        PointJson {
            state: self.states.pairs(state.iter().copied()),
            input: self.inputs.pairs(input.iter().copied()),
            outputs: self.outputs.pairs(outputs),
            units: Pairs(all.into_iter().flat_map(Labels::iter).collect()),
        }
    }

    /// Units of states and inputs by name.
    pub(crate) fn point_units(&self) -> Pairs<&'static str> {
        Pairs(self.states.iter().chain(self.inputs.iter()).collect())
    }

    /// A state, an input or another quantity of a point.
    pub(crate) fn value(&self, name: &str, state: &[f64], input: &[f64]) -> Option<f64> {
        let of = |labels: Labels, values: &[f64]| values.get(labels.index_of(name)?).copied();
        let outputs = || self.model.output_values(&self.parameters, state, input);
        of(self.states, state)
            .or_else(|| of(self.inputs, input))
            .or_else(|| of(self.outputs, &outputs()))
    }

    /// The unit of a state, an input or another quantity.
    pub(crate) fn unit(&self, name: &str) -> &'static str {
        let all = [self.states, self.inputs, self.outputs];
        let own = all.into_iter().find(|it| it.index_of(name).is_some());
        own.map_or("1", |labels| labels.unit(name))
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
}
