//! A state feedback from a file of gains, as `ahv lqr --out` writes it.

use std::fs;
use std::path::{Path, PathBuf};

use ahv_analysis::monte_carlo::{Feedback, Flown};
use ahv_analysis::track::Actuator;
use ahv_core::Vector;
use clap::Args;
use serde_json::Value;

use super::Pair;
use crate::assignment::Assignments;
use crate::condition::Vehicle;
use crate::failure::Failure;
use crate::names;

/// Bandwidth of the actuators, in rad/s, unless another is given.
const BANDWIDTH: f64 = 20.0;
/// Rate of the actuators, in units of the input per second, unless another is given.
const RATE: f64 = 1.0;

/// State feedback.
#[derive(Args)]
pub(crate) struct FeedbackArguments {
    /// File of gains as `ahv lqr --out` writes it: inputs follow u = input - gain (x - state) through actuators
    #[arg(long, value_name = "FILE")]
    feedback: Option<PathBuf>,

    /// Bandwidth of the actuators in rad/s, a lag of first order
    #[arg(long, value_name = "RAD_S", default_value_t = BANDWIDTH, requires = "feedback", value_parser = crate::simulate::grid::positive, allow_negative_numbers = true)]
    actuator_bandwidth: f64,

    /// Largest rates of the inputs per second, e.g. phi=1,delta_e=60deg [default: 1 per s, 1 rad/s]
    #[arg(
        long,
        value_name = "NAME=VALUE",
        value_delimiter = ',',
        requires = "feedback"
    )]
    actuator_rate: Vec<String>,
}

impl FeedbackArguments {
    /// Whether there is a file of gains.
    pub(crate) const fn is_given(&self) -> bool {
        self.feedback.is_some()
    }

    /// The feedback, if there is one. Actuators move within the validity box of the inputs.
    pub(crate) fn read<M: Pair<F>, F: Flown>(
        &self,
        vehicle: &Vehicle<M>,
    ) -> Result<Option<Feedback<F>>, Failure> {
        let Some(path) = &self.feedback else {
            return Ok(None);
        };
        let fault = |what: &str| Failure::Request(format!("--feedback {}: {what}", path.display()));
        let gains = gains(path).map_err(|what| fault(&what))?;
        let system = gains["unit_system"].as_str().unwrap_or_default();
        if system != vehicle.units.name() {
            return Err(fault(&format!(
                "its gains are in {system}, the flights in {}; see --units",
                vehicle.units.name()
            )));
        }
        let [states, inputs] = ["states", "inputs"].map(|key| texts(&gains[key]));
        let columns = positions::<F::State<f64>>("state", &states).map_err(|what| fault(&what))?;
        let rows = positions::<F::Input<f64>>("input", &inputs).map_err(|what| fault(&what))?;
        let mut rates = F::Input::splat(RATE);
        Assignments::parse::<F::Input<f64>>("--actuator-rate", &self.actuator_rate, vehicle.units)?
            .apply(&mut rates, &[]);
        if let Some((name, _)) = rates.find(|rate| rate <= 0.0) {
            return Err(Failure::Request(format!(
                "--actuator-rate: the rate of {name} must be above 0"
            )));
        }
        let mut gain = F::Input::splat(F::State::splat(0.0));
        let mut actuators = F::Input::splat(None);
        for (index, &input) in rows.iter().enumerate() {
            let mut row = F::State::splat(0.0);
            for (column, &state) in columns.iter().enumerate() {
                let value = gains["gain"][index][column].as_f64();
                row.set(
                    state,
                    value.ok_or_else(|| fault("its gain lacks a number"))?,
                );
            }
            gain.set(input, row);
            let bounds = vehicle.input_bounds.get(input);
            actuators.set(
                input,
                bounds.map(|bounds| Actuator {
                    bandwidth: self.actuator_bandwidth,
                    rate: rates.get(input).unwrap_or(RATE),
                    bounds,
                }),
            );
        }
        Ok(Some(Feedback {
            state: named(&gains["state"]).map_err(|what| fault(&what))?,
            input: named(&gains["input"]).map_err(|what| fault(&what))?,
            gain,
            actuators,
        }))
    }
}

fn gains(path: &Path) -> Result<Value, String> {
    let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
    serde_json::from_str(&text).map_err(|error| format!("it is no JSON: {error}"))
}

fn texts(value: &Value) -> Vec<String> {
    let texts = value
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str);
    texts.map(str::to_owned).collect()
}

/// Indices of the components with these names.
fn positions<V: Vector<f64>>(kind: &str, names: &[String]) -> Result<Vec<usize>, String> {
    if names.is_empty() {
        return Err(format!(
            "it names no {kind}s; `ahv lqr --out` writes such a file"
        ));
    }
    let index =
        |name: &String| V::index_of(name).ok_or_else(|| names::unknown(kind, name, V::NAMES));
    names.iter().map(index).collect()
}

/// A vector from its components by name.
fn named<V: Vector<f64>>(value: &Value) -> Result<V, String> {
    let mut vector = V::splat(0.0);
    for (index, name) in V::NAMES.iter().enumerate() {
        let number = value[*name].as_f64();
        vector.set(
            index,
            number.ok_or_else(|| format!("it has no number for {name} of the trim"))?,
        );
    }
    Ok(vector)
}
