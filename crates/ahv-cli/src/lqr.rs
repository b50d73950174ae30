//! `ahv lqr`: a linear-quadratic regulator at a trim, as a file of gains.

use std::fmt::Write;
use std::path::PathBuf;

use ahv_analysis::linearize::linearize;
use ahv_analysis::lqr::{Regulator, bryson, deviations};
use ahv_analysis::trim::{SteadyState, Trim};
use ahv_core::{GeneratedModel, Vector};
use clap::Args;
use nalgebra::DMatrix;

use crate::assignment::Assignments;
use crate::failure::{Failure, print};
use crate::flight_condition::FlightCondition;
use crate::gains::{Gains, GainsFile, LAW};
use crate::named::Named;
use crate::number::Shown;
use crate::output::{self, Pairs, describe};
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
pub(crate) fn run<M: GeneratedModel>(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle: Vehicle<M> = arguments.vehicle.vehicle()?;
    let flight = arguments.condition.flight(&vehicle)?;
    let trim = vehicle.trim(&flight)?;
    let states: M::State = costs("--state-deviation", &arguments.state_deviation, &vehicle)?;
    let inputs: M::Input = costs("--input-deviation", &arguments.input_deviation, &vehicle)?;
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
            describe(&trim.state, vehicle.units),
            describe(&trim.input, vehicle.units)
        );
        print(&text(&gains, &place, &trim))
    }
}

/// The deviations that cost 1: the customary ones, with those of `texts` in their place.
fn costs<M: GeneratedModel, V: Vector<f64>>(
    option: &str,
    texts: &[String],
    vehicle: &Vehicle<M>,
) -> Result<V, Failure> {
    let given = Assignments::parse::<V>(option, texts, vehicle.units)?;
    if V::NAMES == M::Input::NAMES {
        vehicle.check_effect(option, &given)?;
    }
    let mut costs: V = vehicle.units.convert(deviations(M::DEVIATIONS));
    given.apply(&mut costs, &[]);
    match costs.find(|deviation| deviation <= 0.0) {
        Some((name, value)) => Err(Failure::Request(format!(
            "{option}: {name} is {value}; a deviation that costs 1 is above 0"
        ))),
        None => Ok(costs),
    }
}

/// The gains at a trim for deviations of states and inputs that cost 1.
fn gains<M: GeneratedModel>(
    vehicle: &Vehicle<M>,
    flight: &SteadyState<M::Input>,
    trim: &Trim<M::State, M::Input>,
    states: &M::State,
    inputs: &M::Input,
) -> Result<Gains, Failure> {
    let moved: Vec<_> = Pairs::of(inputs)
        .0
        .into_iter()
        .filter(|it| it.1.is_finite())
        .collect();
    let (names, efforts): (Vec<_>, Vec<_>) = moved.into_iter().unzip();
    let costs: Vec<f64> = Pairs::of(states).0.into_iter().map(|it| it.1).collect();
    let numeric = |error: String| Failure::Numeric(format!("{}: {error}", M::NAME));
    let system = linearize(&vehicle.model, &trim.state, &trim.input, &names, &[])
        .map_err(|error| numeric(error.to_string()))?;
    let (q, r) = (bryson(&costs), bryson(&efforts));
    let regulator =
        Regulator::new(&system.a, &system.b, &q, &r).map_err(|error| numeric(error.to_string()))?;
    let weights = |names: &[&str], weight: &DMatrix<f64>| {
        Named::new(names.iter().zip(weight.diagonal().iter().copied()))
    };
    let drift = Pairs::of(&vehicle.model.drift(&trim.state, &trim.input)).0;
    // Of all other states the trim leaves no more than rounding.
    let moves = |name| M::TRIM.moving.contains(&name);
    let rate = |(name, rate)| (name, if moves(name) { rate } else { 0.0 });
    let choices = vehicle.choices.iter();
    let text = |names: &[&str]| names.iter().map(ToString::to_string).collect();
    Ok(Gains {
        model: M::NAME.to_owned(),
        table: vehicle.table.clone(),
        set: vehicle.set.to_string(),
        choices: Named::new(choices.map(|(name, chosen)| (name, chosen.map(str::to_owned)))),
        unit_system: vehicle.units.name().to_owned(),
        parameters_sha256: vehicle.fingerprint(),
        condition: Named::given::<M>(flight),
        law: LAW.to_owned(),
        states: text(&system.states),
        inputs: text(&names),
        units: Named::new(
            Pairs::units_of_both::<M::State, M::Input>(vehicle.units)
                .0
                .into_iter()
                .map(|(name, unit)| (name, unit.to_owned())),
        ),
        state: Named::of(&trim.state),
        state_rate: Named::new(drift.into_iter().map(rate)),
        input: Named::of(&trim.input),
        outputs: Named::of(&vehicle.outputs(&trim.state, &trim.input)),
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
