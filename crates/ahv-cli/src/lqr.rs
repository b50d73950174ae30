//! `ahv lqr`: a linear-quadratic regulator at a trim, as a file of gains.

use std::fmt::Write;
use std::path::PathBuf;

use ahv_analysis::erased::Components;
use ahv_analysis::lqr::{Regulator, bryson};
use ahv_analysis::trim::{SteadyState, Trim};
use clap::Args;
use nalgebra::DMatrix;

use crate::assignment::Assignments;
use crate::failure::{Failure, print};
use crate::flight_condition::FlightCondition;
use crate::gains::{Gains, GainsFile, LAW};
use crate::named::Named;
use crate::number::Shown;
use crate::output;
use crate::vehicle::{Vehicle, VehicleArgs};

/// Designs a linear-quadratic regulator at a trim.
///
/// The law is u = input - gain (x - state - state_rate t): in a climb the altitude of the reference moves with the flight. It
/// minimises the integral of the squares of the deviations of states and
/// inputs, each over the deviation that costs 1. The model says which are customary; other states cost nothing, other inputs
/// are held.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// Deviations of states that cost 1, e.g. altitude=50ft,gamma=0.5deg; they replace the customary ones
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    state_deviation: Vec<String>,

    /// Deviations of inputs that cost 1, e.g. delta_e=3deg; an input that is named here is moved
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    input_deviation: Vec<String>,

    /// File of gains to write, in JSON
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Print what the file of gains holds
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] without trim or regulator.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle = arguments.vehicle.vehicle()?;
    let flight = arguments.condition.flight(&vehicle)?;
    let trim = vehicle.trim(&flight)?;
    let (own, given) = (vehicle.model.states(), &arguments.state_deviation);
    let states = costs("--state-deviation", given, &vehicle, own)?;
    let (own, given) = (vehicle.model.inputs(), &arguments.input_deviation);
    let inputs = costs("--input-deviation", given, &vehicle, own)?;
    let gains = gains(&vehicle, &flight, &trim, &states, &inputs)?;
    let file = GainsFile {
        condition: &gains.condition,
        gains: &gains,
    };
    if let Some(path) = &arguments.out {
        output::write(path, output::json(&file)? + "\n")?;
    }
    if arguments.json {
        output::print_json(&file)
    } else {
        let place = format!("{}\n{}", vehicle.at(&flight), vehicle.described());
        let trim = format!(
            "{}\n{}",
            vehicle.states.describe(&trim.state),
            vehicle.inputs.describe(&trim.input)
        );
        print(&text(&gains, &place, &trim))
    }
}

/// The deviations that cost 1: the customary ones, with those of `texts` in their place.
fn costs(
    option: &str,
    texts: &[String],
    vehicle: &Vehicle,
    components: Components,
) -> Result<Vec<f64>, Failure> {
    let labels = vehicle.units.labels(components);
    let given = Assignments::parse(option, texts, labels)?;
    vehicle.check_effect(option, &given)?;
    let listed = vehicle.model.deviations();
    let customary = |name: &&str| {
        let found = listed.iter().find(|(own, _)| own == name);
        found.map_or(f64::INFINITY, |it| it.1)
    };
    let mut costs: Vec<f64> = components.names.iter().map(customary).collect();
    vehicle.units.convert(components, &mut costs);
    given.apply(&mut costs);
    if !costs.iter().any(|deviation| deviation.is_finite()) {
        let example = components.names.first().copied().unwrap_or_default();
        return Err(Failure::Request(format!(
            "{option}: {} names no deviation that costs 1; give one, such as {example}=VALUE",
            vehicle.name()
        )));
    }
    let mut named = labels.names.iter().zip(&costs);
    match named.find(|(_, deviation)| **deviation <= 0.0) {
        Some((name, value)) => Err(Failure::Request(format!(
            "{option}: {name} is {value}; a deviation that costs 1 is above 0"
        ))),
        None => Ok(costs),
    }
}

/// The gains at a trim for the customary deviations.
///
/// # Errors
///
/// [`Failure::Request`] for a model that names none, [`Failure::Numeric`] without a regulator.
#[cfg(feature = "generate")]
pub(crate) fn customary(
    vehicle: &Vehicle,
    flight: &SteadyState,
    trim: &Trim<Vec<f64>, Vec<f64>>,
) -> Result<Gains, Failure> {
    let states = costs("--state-deviation", &[], vehicle, vehicle.model.states())?;
    let inputs = costs("--input-deviation", &[], vehicle, vehicle.model.inputs())?;
    gains(vehicle, flight, trim, &states, &inputs)
}

/// The gains at a trim for deviations of states and inputs that cost 1.
fn gains(
    vehicle: &Vehicle,
    flight: &SteadyState,
    trim: &Trim<Vec<f64>, Vec<f64>>,
    costs: &[f64],
    inputs: &[f64],
) -> Result<Gains, Failure> {
    let moved = vehicle
        .inputs
        .names
        .iter()
        .copied()
        .zip(inputs.iter().copied());
    let (names, efforts): (Vec<_>, Vec<_>) = moved.filter(|it| it.1.is_finite()).unzip();
    let numeric = |error: String| Failure::Numeric(format!("{}: {error}", vehicle.name()));
    let text = |names: &[&str]| -> Vec<String> { names.iter().map(ToString::to_string).collect() };
    let point = (trim.state.as_slice(), trim.input.as_slice());
    let system = vehicle
        .model
        .linearize(&vehicle.parameters, point, &text(&names), &[]);
    let system = system.map_err(|error| numeric(error.to_string()))?;
    let (q, r) = (bryson(costs), bryson(&efforts));
    let regulator =
        Regulator::new(&system.a, &system.b, &q, &r).map_err(|error| numeric(error.to_string()))?;
    let weights = |names: &[&str], weight: &DMatrix<f64>| {
        Named::new(names.iter().zip(weight.diagonal().iter().copied()))
    };
    let drift = vehicle
        .model
        .drift(&vehicle.parameters, &trim.state, &trim.input);
    let drift = vehicle.states.pairs(drift).0;
    // Of all other states the trim leaves no more than rounding.
    let moves = |name| vehicle.model.trim_problem().moving.contains(&name);
    let rate = |(name, rate)| (name, if moves(name) { rate } else { 0.0 });
    let choices = vehicle.choices.iter();
    let values = vehicle.point(&trim.state, &trim.input);
    Ok(Gains {
        model: vehicle.name().to_owned(),
        table: vehicle.table.clone(),
        set: vehicle.set.to_string(),
        choices: Named::new(choices.map(|(name, chosen)| (name, chosen.map(str::to_owned)))),
        unit_system: vehicle.units.name().to_owned(),
        parameters_sha256: vehicle.fingerprint(),
        condition: Named::given(vehicle, flight),
        law: LAW.to_owned(),
        states: text(&system.states),
        inputs: text(&names),
        units: Named::new(
            vehicle
                .point_units()
                .0
                .into_iter()
                .map(|(name, unit)| (name, unit.to_owned())),
        ),
        state: Named::new(values.state.0),
        state_rate: Named::new(drift.into_iter().map(rate)),
        input: Named::new(values.input.0),
        outputs: Named::new(values.outputs.0),
        gain: regulator
            .gain
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect(),
        state_weight: weights(&system.states, &q),
        input_weight: weights(&names, &r),
        poles: regulator
            .poles
            .iter()
            .map(|pole| [pole.re, pole.im])
            .collect(),
        residual: regulator.residual,
    })
}

/// The gains for a person.
fn text(gains: &Gains, place: &str, trim: &str) -> String {
    let mut text = format!(
        "{}: regulator, {place}\n{trim}\ngain, in the units of the model, angles in rad:",
        gains.model
    );
    // Writing into a String cannot fail.
    for (input, row) in gains.inputs.iter().zip(&gains.gain) {
        let _ = write!(text, "\n  {input}");
        for (state, gain) in gains.states.iter().zip(row) {
            let _ = write!(text, "\n    {state:<12} {:.6e}", Shown(*gain));
        }
    }
    text.push_str("\npoles in 1/s:");
    for [real, imaginary] in &gains.poles {
        let _ = write!(text, "\n  {:.6} {:+.6}i", Shown(*real), Shown(*imaginary));
    }
    text
}
