//! The flight condition: flags of every command that starts at a trim of the user's choice.

use std::f64::consts::FRAC_PI_2;

use ahv_analysis::trim::{SteadyState, Trim, TrimError, trim};
use ahv_core::{Bounds, GeneratedModel, Given, Vector, all_outside};
use clap::{Arg, ArgAction, ArgMatches, Command, Error, FromArgMatches};

use crate::assignment::{Assignments, show, show_beside};
use crate::failure::{Failure, complain};
use crate::names;
use crate::output::describe_outside;
use crate::registry::models;
use crate::units::Units;
use crate::vehicle::{Vehicle, hyphenated};

/// Where in the validity box it is asked whether an input moves a state.
const SHARE: f64 = 0.618;

/// What is given of a steady state, and the inputs that are held.
pub(crate) struct FlightCondition {
    /// Given states, as they stand on the command line.
    given: Vec<(&'static str, f64)>,
    input: Vec<String>,
}

/// The given states of all models, each once, with their unit and SI unit.
fn all_given() -> Vec<(Given, [&'static str; 2])> {
    let mut all: Vec<(Given, [&str; 2])> = Vec::new();
    for model in models() {
        for given in model.trim.given {
            if all.iter().all(|(known, _)| known.name != given.name) {
                all.push((*given, model.units(given.name)));
            }
        }
    }
    all
}

/// Reads what is given of a state, whose unit is not written.
fn finite(text: &str, [unit, si]: [&str; 2]) -> Result<f64, String> {
    let unit = if is_angle(unit) { "deg" } else { unit };
    let written = [unit, si]
        .into_iter()
        .find_map(|unit| text.strip_suffix(unit));
    match (text.parse::<f64>(), written.map(str::trim)) {
        (Ok(number), _) if number.is_finite() => Ok(number),
        (Err(_), Some(number)) if number.parse::<f64>().is_ok() => {
            Err(format!("write it without its unit: {number}"))
        }
        _ => Err("not a finite number".to_owned()),
    }
}

/// An angle is given in deg, whatever the units.
fn is_angle(unit: &str) -> bool {
    unit == "rad"
}

/// What to say of a flag for a given state.
fn help(given: &Given, [unit, si]: [&str; 2]) -> String {
    let name = given.name.replace('_', " ");
    let (unit, other) = match (is_angle(unit), unit == si) {
        (true, _) => ("deg", String::new()),
        (false, true) => (unit, String::new()),
        (false, false) => (unit, format!(", with --units si in {si}")),
    };
    format!(
        "Given {name} in {unit}{other}{} [default: {}]",
        domain(given, unit),
        show(given.default, unit)
    )
}

/// What a given state must be, as the end of a sentence.
fn domain(given: &Given, unit: &str) -> String {
    let end = |value: f64| {
        if unit == "deg" {
            show(value, "rad")
        } else {
            show(value, unit)
        }
    };
    match (given.above.is_finite(), given.below.is_finite()) {
        (true, true) => format!(", between {} and {}", end(given.above), end(given.below)),
        (true, false) => format!(", above {}", end(given.above)),
        (false, true) => format!(", below {}", end(given.below)),
        (false, false) => String::new(),
    }
}

impl FromArgMatches for FlightCondition {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let given = all_given().into_iter();
        let given =
            given.filter_map(|(given, _)| Some((given.name, *matches.get_one(given.name)?)));
        let input = matches.get_many::<String>("input");
        Ok(Self {
            given: given.collect(),
            input: input.into_iter().flatten().cloned().collect(),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl clap::Args for FlightCondition {
    fn augment_args(command: Command) -> Command {
        let given = all_given().into_iter().map(|(given, units)| {
            let help = help(&given, units);
            let name = if is_angle(units[0]) { "DEG" } else { "VALUE" };
            Arg::new(given.name)
                .long(hyphenated(given.name))
                .value_name(name)
                .value_parser(move |text: &str| finite(text, units))
                .allow_negative_numbers(true)
                .help(help)
        });
        let input = Arg::new("input").long("input").value_name("NAME=VALUE");
        let input = input.value_delimiter(',').action(ArgAction::Append);
        command.args(given).arg(
            input.help(
                "Held inputs, e.g. delta_c=2deg; those that are not given and not sought are 0",
            ),
        )
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FlightCondition {
    /// The names of the states that are given here.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.given.iter().map(|&(name, _)| name)
    }

    /// The steady state that is asked for, its sought inputs inside their validity box.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] where there is no steady state, and for inputs that are not held, or have no effect.
    pub(crate) fn flight<M: GeneratedModel>(
        &self,
        vehicle: &Vehicle<M>,
    ) -> Result<SteadyState<M::Input>, Failure> {
        let (flight, inputs) = self.flight_and_inputs(vehicle)?;
        let sought: Vec<&str> = flight.sought_inputs().collect();
        if let Some(name) = sought
            .iter()
            .find(|name| inputs.get::<M::Input>(name).is_some())
        {
            return Err(Failure::Request(format!(
                "--input: {name} is not held; the trim finds {}",
                names::list(&sought)
            )));
        }
        Ok(flight.within(&vehicle.input_bounds))
    }

    /// The same without bounds, and all inputs that are given: those that are sought replace what the trim finds.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] where there is no steady state, and for inputs that have no effect.
    pub(crate) fn flight_and_inputs<M: GeneratedModel>(
        &self,
        vehicle: &Vehicle<M>,
    ) -> Result<(SteadyState<M::Input>, Assignments), Failure> {
        let units = vehicle.units;
        let inputs = self.inputs(vehicle)?;
        let mut flight = vehicle.steady();
        for &(name, value) in &self.given {
            if M::TRIM.given.iter().all(|given| given.name != name) {
                let known: Vec<_> = M::TRIM.given.iter().map(|given| given.name).collect();
                let problem = match known.as_slice() {
                    [] => "no state is given".to_owned(),
                    known => format!("given are {}", names::list(known)),
                };
                return Err(Failure::Request(format!(
                    "--{}: a steady state of {} does not take it; {problem}",
                    name.replace('_', "-"),
                    M::NAME
                )));
            }
            let is_angle = is_angle(units.label::<M::State>(name));
            flight = flight.with(name, if is_angle { value.to_radians() } else { value });
        }
        let sought: Vec<&str> = flight.sought_inputs().collect();
        inputs.apply(&mut flight.input, &sought);
        flight
            .check()
            .map_err(|error| outside_domain::<M>(&error, units))?;
        Ok((flight, inputs))
    }

    /// The inputs that are given.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for one that has no effect.
    pub(crate) fn inputs<M: GeneratedModel>(
        &self,
        vehicle: &Vehicle<M>,
    ) -> Result<Assignments, Failure> {
        let inputs = Assignments::parse::<M::Input>("--input", &self.input, vehicle.units)?;
        vehicle.check_effect("--input", &inputs)?;
        Ok(inputs)
    }
}

/// What to say of a flight condition outside the domain of steady states.
fn outside_domain<M: GeneratedModel>(error: &TrimError, units: Units) -> Failure {
    Failure::Request(match *error {
        TrimError::Domain {
            name,
            value,
            above,
            below,
        } => {
            let unit = units.label::<M::State>(name);
            let given = Given::new(name, 0.0, above, below);
            let must = domain(&given, if is_angle(unit) { "deg" } else { unit });
            let must = must.strip_prefix(", ").unwrap_or("a finite number");
            format!(
                "--{}: {} is outside the domain of steady states; it must be {must}",
                name.replace('_', "-"),
                show(value, unit)
            )
        }
        ref other => other.to_string(),
    })
}

impl<M: GeneratedModel> Vehicle<M> {
    /// The trim of a steady flight; a warning says if it is outside the validity box.
    ///
    /// # Errors
    ///
    /// [`Failure::Numeric`] if there is none.
    pub(crate) fn trim(
        &self,
        flight: &SteadyState<M::Input>,
    ) -> Result<Trim<M::State, M::Input>, Failure> {
        let trim = trim(&self.model, flight).map_err(|error| {
            let why = self.no_trim(&error);
            Failure::Numeric(format!("{}: {why} ({})", M::NAME, self.at(flight)))
        })?;
        self.warn_outside(&trim.state, &trim.input);
        Ok(trim)
    }

    /// Warns of every component of a point that is outside the validity box.
    pub(crate) fn warn_outside(&self, state: &M::State, input: &M::Input) {
        let states = all_outside(state, &self.state_bounds);
        for outside in states.chain(all_outside(input, &self.input_bounds)) {
            let outside = describe_outside(&outside, self.unit(outside.name));
            complain(&format!("warning: {}: {outside}", M::NAME));
        }
    }

    /// What is given where nothing is asked for, in the units of the vehicle.
    pub(crate) fn steady(&self) -> SteadyState<M::Input> {
        let factor = |name: &str| {
            let state = M::State::index_of(name).and_then(|index| M::State::SI_FACTORS.get(index));
            let input = M::Input::index_of(name).and_then(|index| M::Input::SI_FACTORS.get(index));
            let factor = state.or(input).copied().unwrap_or(1.0);
            self.units
                .factor_from(Units::of_table(M::TABLE.unit_system), factor)
        };
        SteadyState::converted(&M::TRIM, factor)
    }

    /// Whether a state can fly: outside the domain of steady states its rates are no numbers, or mean nothing.
    ///
    /// # Errors
    ///
    /// What is wrong, for a person.
    pub(crate) fn moves(&self, state: &M::State) -> Result<(), String> {
        for given in M::TRIM.given {
            let value = M::State::index_of(given.name).and_then(|index| state.get(index));
            // Angles are periodic; a rate at 90 deg is a number.
            if given.above.abs() == FRAC_PI_2 {
                continue;
            }
            if value.is_some_and(|value| value.is_nan() || value <= given.above) {
                let unit = self.units.label::<M::State>(given.name);
                return Err(format!(
                    "{} must be above {}, not {}",
                    given.name,
                    show(given.above, unit),
                    show(value.unwrap_or(f64::NAN), unit)
                ));
            }
        }
        Ok(())
    }

    /// Refuses an input other than 0 that changes nothing at any point of the validity box: it is a misunderstanding. None at
    /// all may be said, as reports do.
    pub(crate) fn check_effect(&self, option: &str, inputs: &Assignments) -> Result<(), Failure> {
        for name in M::Input::NAMES {
            let moved = inputs.get::<M::Input>(name);
            if moved.is_some_and(|value| value != 0.0)
                && let Some(why) = self.idle(name)
            {
                return Err(Failure::Request(format!("{option}: {why}")));
            }
        }
        Ok(())
    }

    /// What to say of an input that moves no state, and by which option it would; `None` if it moves one.
    pub(crate) fn idle(&self, input: &str) -> Option<String> {
        if self.moved_by(&self.parameters, input) {
            return None;
        }
        let choices = self.choices.iter().filter_map(|(name, chosen)| {
            let mut known = M::TABLE.choices.iter();
            let choice = known.find(|choice| choice.name == *name)?;
            let mut options = choice.options.iter();
            let option = options.find(|it| self.moved_by(&it.apply(self.parameters), input))?;
            let chosen = chosen.unwrap_or("of the table");
            Some(format!(
                " with the {name} {chosen}; choose --{name} {}",
                option.name
            ))
        });
        let advice = choices.take(1).collect::<String>();
        Some(format!("{input} has no effect{advice}"))
    }

    /// Whether an input moves a state of the model with these parameters, at a point of the validity box with nothing special.
    fn moved_by(&self, parameters: &M::ParametersOf<f64>, input: &str) -> bool {
        let within = |bounds: &Bounds| {
            let value = bounds.min + SHARE * (bounds.max - bounds.min);
            if value.is_finite() { value } else { 1.0 }
        };
        let x = M::map_state(&self.state_bounds, within);
        let u = M::map_input(&self.input_bounds, within);
        let (_, by_input) = M::with_parameters(parameters).jacobians(&x, &u);
        let mut rows = (0..M::State::LEN).filter_map(|row| by_input.get(row));
        M::Input::index_of(input).is_some_and(|index| rows.any(|row| row.get(index) != Some(0.0)))
    }

    /// Where a steady state is, for a person.
    pub(crate) fn at(&self, flight: &SteadyState<M::Input>) -> String {
        let given = flight.given().map(|(name, value)| {
            let unit = self.units.label::<M::State>(name);
            format!("{name} {}", show_beside(value, 0.0, unit))
        });
        let given: Vec<String> = given.collect();
        match given.as_slice() {
            [] => "at rest".to_owned(),
            given => given.join(", "),
        }
    }

    /// Why there is no trim, for a person.
    pub(crate) fn no_trim(&self, error: &TrimError) -> String {
        let TrimError::Blocked {
            blocking,
            beyond,
            nearest,
        } = error
        else {
            return error.to_string();
        };
        let instead = match beyond {
            Some(values) => {
                let values: Vec<String> = values
                    .iter()
                    .map(|&(name, value)| {
                        let mut bounds = blocking.iter().filter(|it| it.input == name);
                        let bound = bounds.next().map_or(f64::NAN, |it| it.bound);
                        let unit = self.units.label::<M::Input>(name);
                        format!("{name} = {}", show_beside(value, bound, unit))
                    })
                    .collect();
                format!("without bounds the trim is at {}", values.join(", "))
            }
            None => "nor was one found beyond".to_owned(),
        };
        let rate = self.units.label::<M::State>(nearest.worst);
        format!(
            "no trim with {}; {instead}; at the nearest point {} still changes by {} a second",
            self.blocking(error).join(" and "),
            nearest.worst,
            show(nearest.worst_residual(), rate)
        )
    }

    /// The bounds that block a trim, for a person; none if it is not for bounds.
    pub(crate) fn blocking(&self, error: &TrimError) -> Vec<String> {
        let TrimError::Blocked { blocking, .. } = error else {
            return Vec::new();
        };
        let bounds = blocking.iter().map(|it| {
            let relation = if it.upper { "<=" } else { ">=" };
            let bound = show(it.bound, self.units.label::<M::Input>(it.input));
            format!("{} {relation} {bound}", it.input)
        });
        bounds.collect()
    }
}
