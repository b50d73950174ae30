//! The flight condition: flags of every command that starts at a trim of the user's choice.

use std::f64::consts::FRAC_PI_2;

use ahv_analysis::erased::Components;
use ahv_analysis::trim::{SteadyState, Trim, TrimError};
use ahv_core::{Bounds, Given, Outside};
use clap::{Arg, ArgAction, ArgMatches, Command, Error, FromArgMatches};

use crate::assignment::Assignments;
use crate::failure::{Failure, complain};
use crate::names;
use crate::output::describe_outside;
use crate::registry::models;
use crate::show::{show, show_beside};
use crate::units::Units;
use crate::vehicle::{Vehicle, hyphenated};

/// Where in the validity box it is asked whether an input moves a state.
const SHARE: f64 = 0.618;

/// What is given of a steady state, and the inputs that are held.
pub(crate) struct FlightCondition {
    /// Given states and outputs; angles in rad.
    given: Vec<(&'static str, f64)>,
    input: Vec<String>,
}

/// A state and an input.
pub(crate) type Point = (Vec<f64>, Vec<f64>);

/// The given states and outputs of all models, each once, with their unit and SI unit.
fn all_given() -> Vec<(Given, [&'static str; 2])> {
    let mut all: Vec<(Given, [&str; 2])> = Vec::new();
    for model in models() {
        for given in model.trim_problem().given {
            if all.iter().all(|(known, _)| known.name != given.name) {
                let is_state = model.states().index_of(given.name).is_some();
                let own = if is_state {
                    model.states()
                } else {
                    model.outputs()
                };
                let unit = |units: Units| units.labels(own).unit(given.name);
                all.push((*given, [unit(Units::FootSlug), unit(Units::Si)]));
            }
        }
    }
    all
}

/// Reads what is given of a state, whose unit is not written; an angle is in deg, unless it says that it is in rad.
fn finite(text: &str, [unit, si]: [&str; 2]) -> Result<f64, String> {
    if is_angle(unit) {
        let in_rad = text.strip_suffix("rad").and_then(|it| it.parse().ok());
        return match in_rad.filter(|it: &f64| it.is_finite()) {
            Some(angle) => Ok(angle),
            None => number(text, ["deg", "deg"]).map(f64::to_radians),
        };
    }
    number(text, [unit, si])
}

fn number(text: &str, [unit, si]: [&str; 2]) -> Result<f64, String> {
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
    let (unit, said) = match (is_angle(unit), unit == si) {
        (true, _) => ("deg", " in deg".to_owned()),
        (false, true) if unit == "1" => (unit, String::new()),
        (false, true) => (unit, format!(" in {unit}")),
        (false, false) => (unit, format!(" in {unit}, with --units si in {si}")),
    };
    format!(
        "Given {name}{said}{} [default: {}]",
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
    pub(crate) fn flight(&self, vehicle: &Vehicle) -> Result<SteadyState, Failure> {
        let (flight, inputs) = self.flight_and_inputs(vehicle)?;
        let sought = vehicle.sought_inputs(&flight);
        if let Some(name) = sought.iter().find(|name| inputs.get(name).is_some()) {
            return Err(Failure::Request(format!(
                "--input: {name} is not held; the trim finds {}",
                names::list(&sought)
            )));
        }
        Ok(vehicle.within(flight))
    }

    /// The same without bounds, and all inputs that are given: those that are sought replace what the trim finds.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] where there is no steady state, and for inputs that have no effect.
    pub(crate) fn flight_and_inputs(
        &self,
        vehicle: &Vehicle,
    ) -> Result<(SteadyState, Assignments), Failure> {
        let inputs = self.inputs(vehicle)?;
        let mut flight = vehicle.steady();
        let problem = vehicle.model.trim_problem();
        for &(name, value) in &self.given {
            if problem.given.iter().all(|given| given.name != name) {
                let known: Vec<_> = problem.given.iter().map(|given| given.name).collect();
                let problem = match known.as_slice() {
                    [] => "nothing is given".to_owned(),
                    known => format!("given are {}", names::list(known)),
                };
                return Err(Failure::Request(format!(
                    "--{}: a steady state of {} does not take it; {problem}",
                    name.replace('_', "-"),
                    vehicle.name()
                )));
            }
            flight = flight.with(name, value);
        }
        for (name, value) in inputs.iter() {
            flight = flight.holding(name, value);
        }
        flight
            .check()
            .map_err(|error| outside_domain(&error, vehicle))?;
        Ok((flight, inputs))
    }

    /// The steady state that is asked for, and its trim; or the state of the assignments `texts` of --state, which is no trim, with
    /// the inputs that are given.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for bad input, [`Failure::Numeric`] if there is no trim.
    pub(crate) fn point(
        &self,
        vehicle: &Vehicle,
        texts: &[String],
    ) -> Result<(SteadyState, Point), Failure> {
        if texts.is_empty() {
            let flight = self.flight(vehicle)?;
            let trim = vehicle.trim(&flight)?;
            return Ok((flight, (trim.state, trim.input)));
        }
        let (mut flight, inputs) = self.flight_and_inputs(vehicle)?;
        let states = Assignments::parse("--state", texts, vehicle.states)?;
        if let Some(name) = self.names().find(|name| states.get(name).is_some()) {
            return Err(Failure::Request(format!(
                "--state: {name} is given twice; leave --{name} out"
            )));
        }
        let mut state = vec![0.0; vehicle.states.len()];
        let mut input = vec![0.0; vehicle.inputs.len()];
        for (name, value) in flight.given().collect::<Vec<_>>() {
            let value = states.get(name).unwrap_or(value);
            flight = flight.with(name, value);
            let index = vehicle.states.index_of(name);
            if let Some(component) = index.and_then(|index| state.get_mut(index)) {
                *component = value;
            }
        }
        states.apply(&mut state);
        inputs.apply(&mut input);
        vehicle
            .moves(&state)
            .map_err(|why| Failure::Request(format!("--state: {why}")))?;
        vehicle.warn_outside(&state, &input);
        Ok((flight, (state, input)))
    }

    /// The inputs that are given.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for one that has no effect.
    pub(crate) fn inputs(&self, vehicle: &Vehicle) -> Result<Assignments, Failure> {
        let inputs = Assignments::parse("--input", &self.input, vehicle.inputs)?;
        vehicle.check_effect("--input", &inputs)?;
        Ok(inputs)
    }
}

/// What to say of a flight condition outside the domain of steady states.
fn outside_domain(error: &TrimError, vehicle: &Vehicle) -> Failure {
    Failure::Request(match *error {
        TrimError::Domain {
            name,
            value,
            above,
            below,
        } => {
            let unit = vehicle.unit(name);
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

impl Vehicle {
    /// The trim of a steady flight; warnings say what is outside the validity box.
    ///
    /// # Errors
    ///
    /// [`Failure::Numeric`] if there is none.
    pub(crate) fn trim(&self, flight: &SteadyState) -> Result<Trim<Vec<f64>, Vec<f64>>, Failure> {
        let trim = self.model.trim(&self.parameters, flight).map_err(|error| {
            let why = self.no_trim(&error);
            let fault = self.fault_at_start(&error, flight);
            let at = self.at(flight);
            Failure::Numeric(format!("{}: {why}{fault} ({at})", self.name()))
        })?;
        self.warn_outside(&trim.state, &trim.input);
        Ok(trim)
    }

    /// Warns of every component of a point that is outside the validity box.
    pub(crate) fn warn_outside(&self, state: &[f64], input: &[f64]) {
        for outside in self.outside(state, input) {
            let outside = describe_outside(&outside, self.unit(outside.name));
            complain(&format!("warning: {}: {outside}", self.name()));
        }
    }

    /// Every component of a point that is outside the validity box.
    pub(crate) fn outside(&self, state: &[f64], input: &[f64]) -> Vec<Outside> {
        let states = self.states.outside(state, &self.state_bounds);
        states
            .chain(self.inputs.outside(input, &self.input_bounds))
            .collect()
    }

    /// What is given where nothing is asked for, in the units of the vehicle.
    pub(crate) fn steady(&self) -> SteadyState {
        let own = Units::of_table(self.model.table().unit_system);
        let of = |components: Components, name: &str| {
            let index = components.index_of(name)?;
            components.si_factors.get(index).copied()
        };
        let factor = |name: &str| {
            let state = of(self.model.states(), name);
            let input = || of(self.model.inputs(), name);
            let factor = state.or_else(input);
            let factor = factor.or_else(|| of(self.model.outputs(), name));
            let factor = factor.unwrap_or(1.0);
            self.units.factor_from(own, factor)
        };
        SteadyState::converted(&self.model.trim_problem(), factor)
    }

    /// A steady state whose sought inputs stay inside their validity box.
    fn within(&self, flight: SteadyState) -> SteadyState {
        let bounds = self.inputs.names.iter().copied();
        flight.within_named(bounds.zip(self.input_bounds.iter().copied()))
    }

    /// The same of what is given where nothing is asked for.
    #[cfg(feature = "generate")]
    pub(crate) fn steady_within(&self) -> SteadyState {
        self.within(self.steady())
    }

    /// The inputs that a trim seeks.
    pub(crate) fn sought_inputs(&self, flight: &SteadyState) -> Vec<&'static str> {
        let is_input = |name: &&str| self.inputs.index_of(name).is_some();
        flight.sought().filter(is_input).collect()
    }

    /// Whether a state can fly: outside the domain of steady states its rates are no numbers, or mean nothing.
    ///
    /// # Errors
    ///
    /// What is wrong, for a person.
    pub(crate) fn moves(&self, state: &[f64]) -> Result<(), String> {
        for given in self.model.trim_problem().given {
            let index = self.states.index_of(given.name);
            let value = index.and_then(|index| state.get(index).copied());
            // Angles are periodic; a rate at 90 deg is a number.
            if given.above.abs() == FRAC_PI_2 {
                continue;
            }
            if value.is_some_and(|value| value.is_nan() || value <= given.above) {
                let unit = self.states.unit(given.name);
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
        for (name, value) in inputs.iter() {
            if value != 0.0
                && self.inputs.index_of(name).is_some()
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
            let mut known = self.model.table().choices.iter();
            let choice = known.find(|choice| choice.name == *name)?;
            let option = choice.options.iter().find(|option| {
                let mut with = self.parameters.clone();
                option.apply_to(self.model.parameters().names, &mut with);
                self.moved_by(&with, input)
            })?;
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
    fn moved_by(&self, parameters: &[f64], input: &str) -> bool {
        let within = |bounds: &Bounds| {
            let value = bounds.min + SHARE * (bounds.max - bounds.min);
            if value.is_finite() { value } else { 1.0 }
        };
        let x: Vec<f64> = self.state_bounds.iter().map(within).collect();
        let u: Vec<f64> = self.input_bounds.iter().map(within).collect();
        let [_, by_input] = self.model.jacobians(parameters, &x, &u);
        let index = self.inputs.index_of(input);
        index.is_some_and(|index| by_input.column(index).iter().any(|&entry| entry != 0.0))
    }

    /// Where a steady state is, for a person.
    pub(crate) fn at(&self, flight: &SteadyState) -> String {
        let given = flight.given().map(|(name, value)| {
            let unit = self.unit(name);
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
                        let unit = self.inputs.unit(name);
                        format!("{name} = {}", show_beside(value, bound, unit))
                    })
                    .collect();
                format!("without bounds the trim is at {}", values.join(", "))
            }
            None => "nor was one found beyond".to_owned(),
        };
        let left = show(nearest.worst_residual, self.unit(nearest.worst));
        let left = match nearest.worst_is_rate() {
            true => format!("still changes by {left} a second"),
            false => format!("is still off by {left}"),
        };
        format!(
            "no trim with {}; {instead}; at the nearest point {} {left}",
            self.blocking(error).join(" and "),
            nearest.worst
        )
    }

    /// What the model says of the point where a trim starts, if it has no forces there; else nothing.
    pub(crate) fn fault_at_start(&self, error: &TrimError, flight: &SteadyState) -> String {
        if !matches!(error, TrimError::NonFinite { .. }) {
            return String::new();
        }
        let value = |name: &&'static str| {
            let given = flight.given().find(|(known, _)| known == name);
            given.map_or_else(|| flight.input_value(name), |it| it.1)
        };
        let [x, u] =
            [self.states, self.inputs].map(|it| it.names.iter().map(value).collect::<Vec<f64>>());
        self.fault_after(&x, &u)
    }

    /// `: ` and why the model has no forces at a point; nothing if it has some.
    pub(crate) fn fault_after(&self, x: &[f64], u: &[f64]) -> String {
        let fault = self.model.fault(&self.parameters, x, u);
        fault.map_or_else(String::new, |fault| format!(": {fault}"))
    }

    /// The bounds that block a trim, for a person; none if it is not for bounds.
    pub(crate) fn blocking(&self, error: &TrimError) -> Vec<String> {
        let TrimError::Blocked { blocking, .. } = error else {
            return Vec::new();
        };
        let bounds = blocking.iter().map(|it| {
            let relation = if it.upper { "<=" } else { ">=" };
            let bound = show(it.bound, self.inputs.unit(it.input));
            format!("{} {relation} {bound}", it.input)
        });
        bounds.collect()
    }
}
