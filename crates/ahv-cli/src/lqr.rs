//! `ahv lqr`: a linear-quadratic regulator at a trim, as a file of gains.

use std::fmt::Write;
use std::path::PathBuf;

use ahv_analysis::linearize::linearize;
use ahv_analysis::lqr::{Regulator, bryson, deviations};
use ahv_analysis::trim::Trim;
use ahv_core::Vector;
use clap::Args;
use serde::Serialize;

use crate::assignment::Assignments;
use crate::condition::{Condition, Heading, Vehicle};
use crate::failure::{Failure, print};
use crate::number::Shown;
use crate::output::{self, Pairs, describe};
use crate::place::Place;
use crate::vehicle::{FlightModel, for_model};

/// Designs a linear-quadratic regulator at a trim.
///
/// The law is u = input - gain (x - state). It minimises the integral of the squares of the deviations of states and
/// inputs, each over the deviation that costs 1. Customary are velocity=10ft/s, altitude=100ft, gamma=0.01rad,
/// alpha=0.02rad, pitch_rate=0.05rad/s, phi=0.2 and delta_e=0.05rad; other states cost nothing, other inputs are held.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    condition: Condition,

    #[command(flatten)]
    place: Place,

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

/// A file of gains.
#[derive(Serialize)]
struct Gains<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    law: &'static str,
    /// Columns of the gain.
    states: Vec<&'static str>,
    /// Rows of the gain.
    inputs: Vec<&'static str>,
    units: Pairs<&'static str>,
    /// State of the trim.
    state: Pairs<f64>,
    /// Input of the trim.
    input: Pairs<f64>,
    /// By rows.
    gain: Vec<Vec<f64>>,
    /// Diagonals of Q and R.
    state_weight: Pairs<f64>,
    input_weight: Pairs<f64>,
    /// Of the closed loop, in 1/s.
    poles: Vec<[f64; 2]>,
    residual: f64,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] without trim or regulator.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    for_model!(arguments.condition.model, M => design::<M>(arguments))
}

fn design<M: FlightModel>(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle: Vehicle<M> = arguments.condition.vehicle()?;
    let flight = arguments.place.flight(&vehicle)?;
    let trim = vehicle.trim(&flight)?;
    let states: M::State = costs("--state-deviation", &arguments.state_deviation, &vehicle)?;
    let inputs: M::Input = costs("--input-deviation", &arguments.input_deviation, &vehicle)?;
    let gains = Gains::new(&vehicle, &trim, &states, &inputs)?;
    if let Some(path) = &arguments.out {
        output::write(path, output::json(&gains)? + "\n")?;
    }
    if arguments.json {
        output::print_json(&gains)
    } else {
        let place = vehicle.at(&flight);
        let trim = format!(
            "{}\n{}",
            describe(&trim.state, vehicle.units),
            describe(&trim.input, vehicle.units)
        );
        print(&gains.text(&place, &trim))
    }
}

/// The deviations that cost 1: the customary ones, with those of `texts` in their place.
fn costs<M: FlightModel, V: Vector<f64>>(
    option: &str,
    texts: &[String],
    vehicle: &Vehicle<M>,
) -> Result<V, Failure> {
    let given = Assignments::parse::<V>(option, texts, vehicle.units)?;
    let mut costs: V = vehicle.units.convert(deviations());
    given.apply(&mut costs, &[]);
    match costs.find(|deviation| deviation <= 0.0) {
        Some((name, value)) => Err(Failure::Request(format!(
            "{option}: {name} is {value}; a deviation that costs 1 is above 0"
        ))),
        None => Ok(costs),
    }
}

impl<'a> Gains<'a> {
    fn new<M: FlightModel>(
        vehicle: &'a Vehicle<M>,
        trim: &Trim<M::State, M::Input>,
        states: &M::State,
        inputs: &M::Input,
    ) -> Result<Self, Failure> {
        let cost = |inputs: &M::Input, index| inputs.get(index).unwrap_or(f64::INFINITY);
        let moved = (0..M::Input::LEN).filter(|&index| cost(inputs, index).is_finite());
        let efforts: Vec<f64> = moved.clone().map(|index| cost(inputs, index)).collect();
        let names = moved.filter_map(|index| M::Input::NAMES.get(index).copied());
        let names: Vec<&'static str> = names.collect();
        let numeric = |error: String| Failure::Numeric(format!("{}: {error}", M::NAME));
        let system = linearize(&vehicle.model, &trim.state, &trim.input, &names, &[])
            .map_err(|error| numeric(error.to_string()))?;
        let costs: Vec<f64> = Pairs::of(states)
            .0
            .into_iter()
            .map(|(_, cost)| cost)
            .collect();
        let (q, r) = (bryson(&costs), bryson(&efforts));
        let regulator = Regulator::new(&system.a, &system.b, &q, &r)
            .map_err(|error| numeric(error.to_string()))?;
        let weights = |names: &[&'static str], diagonal: &[f64]| {
            Pairs(
                names
                    .iter()
                    .copied()
                    .zip(diagonal.iter().copied())
                    .collect(),
            )
        };
        let rows = regulator.gain.row_iter();
        Ok(Self {
            heading: vehicle.heading(),
            law: "u = input - gain (x - state)",
            units: Pairs::units_of_both::<M::State, M::Input>(vehicle.units),
            state: Pairs::of(&trim.state),
            input: Pairs::of(&trim.input),
            gain: rows.map(|row| row.iter().copied().collect()).collect(),
            state_weight: weights(&system.states, q.diagonal().as_slice()),
            input_weight: weights(&names, r.diagonal().as_slice()),
            poles: regulator
                .poles
                .iter()
                .map(|pole| [pole.re, pole.im])
                .collect(),
            residual: regulator.residual,
            states: system.states,
            inputs: names,
        })
    }

    fn text(&self, place: &str, trim: &str) -> String {
        let mut text = format!(
            "{}: regulator at {place}\n{trim}\ngain:",
            self.heading.model
        );
        // Writing into a String cannot fail.
        for (input, row) in self.inputs.iter().zip(&self.gain) {
            let _ = write!(text, "\n  {input}");
            for (state, gain) in self.states.iter().zip(row) {
                let _ = write!(text, "\n    {state:<12} {:.6e}", Shown(*gain));
            }
        }
        text.push_str("\npoles in 1/s:");
        for [real, imaginary] in &self.poles {
            let _ = write!(text, "\n  {:.6} {:+.6}i", Shown(*real), Shown(*imaginary));
        }
        text
    }
}
