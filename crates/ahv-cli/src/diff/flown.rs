//! How often flights leave the validity box, before and after.

use ahv_analysis::disperse::{Distribution, Draws};
use ahv_analysis::monte_carlo::{Experiment, Feedback, Mode};
use ahv_analysis::statistics::Estimate;
use nalgebra::DMatrix;
use serde::Serialize;

use super::effect::Steady;
use crate::failure::Failure;
use crate::flights::watched;
use crate::gains::Gains;
use crate::progress::{Progress, Work};
use crate::vehicle::Vehicle;

/// Length of a flight, in s.
const DURATION_S: f64 = 3.0;

/// Steps of a flight.
const STEPS: u32 = 3000;

/// The seed of noise and dispersion.
const SEED: u64 = 0;

/// Flights of both vehicles from their trims, with noise and with parameters drawn uniformly within their uncertainty.
#[derive(Serialize)]
pub(super) struct Flown {
    pub(super) members: u64,
    pub(super) seconds: f64,
    seed: u64,
    /// Whether the gains of the old table act; else the inputs are held.
    pub(super) feedback: bool,
    /// Probability to leave the validity box of its table, with its interval of 95 %.
    pub(super) old: Estimate,
    pub(super) new: Estimate,
}

/// Flies both.
///
/// # Errors
///
/// [`Failure`] of flights that cannot start, or were interrupted.
pub(super) fn compare(
    vehicles: &[Vehicle; 2],
    steady: &[Steady; 2],
    gains: Option<&Gains>,
    members: u64,
) -> Result<Flown, Failure> {
    let [old, new] = [0, 1].map(|side| left(&vehicles[side], &steady[side], gains, members));
    Ok(Flown {
        members,
        seconds: DURATION_S,
        seed: SEED,
        feedback: gains.is_some(),
        old: old?,
        new: new?,
    })
}

fn left(
    vehicle: &Vehicle,
    steady: &Steady,
    gains: Option<&Gains>,
    members: u64,
) -> Result<Estimate, Failure> {
    let trim = &steady.trim;
    let draws = Draws::of_values(
        vehicle.model.parameters().names,
        vehicle.parameters.clone(),
        vehicle.uncertainty.clone(),
        Distribution::Uniform,
        Vec::new(),
        SEED,
    );
    let still = |values: &[f64]| [values.to_vec(), vec![0.0; values.len()]];
    let experiment = Experiment {
        parameters: vehicle.parameters.clone(),
        dispersion: Some(draws.map_err(|error| Failure::Request(error.to_string()))?),
        state: still(&trim.state),
        input: still(&trim.input),
        feedback: gains.map(|gains| law(vehicle, steady, gains)),
        watched: vec![vehicle.state_bounds.clone()],
        scheme: vehicle.model.default_scheme(&vehicle.parameters),
        mode: Mode::Exact,
        dt: DURATION_S / f64::from(STEPS),
        snapshots: vec![u64::from(STEPS)],
        seed: SEED,
        control_variate: false,
    };
    let progress = Progress::start(Work {
        command: "diff",
        unit: "member-steps",
        total: Some(members.saturating_mul(u64::from(STEPS))),
    });
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let outcome = watched(progress, |control| {
        let engine = vehicle.model.engine(&experiment)?;
        engine.run(members, threads, control)
    })?;
    if outcome.members < outcome.asked {
        let message = format!(
            "interrupted: {} of {} flights were flown",
            outcome.members, outcome.asked
        );
        return Err(Failure::Interrupted(message));
    }
    let last = outcome.snapshots.last();
    let count = last.and_then(|it| it.left_any.first().copied());
    Ok(Estimate::of_share(count.unwrap_or(0), outcome.flown()))
}

/// The gains about the trim of this vehicle: what a pilot would fly with gains that were not designed again.
fn law(vehicle: &Vehicle, steady: &Steady, gains: &Gains) -> Feedback {
    let (states, inputs, trim) = (vehicle.states, vehicle.inputs, &steady.trim);
    let drift = vehicle
        .model
        .drift(&vehicle.parameters, &trim.state, &trim.input);
    let moving = vehicle.model.trim_problem().moving;
    let rates = states.names.iter().zip(drift);
    let rates = rates.map(|(name, rate)| if moving.contains(name) { rate } else { 0.0 });
    let entry = |row: usize, column: usize| {
        let name = inputs.names.get(row).copied().unwrap_or_default();
        let own = gains.inputs.iter().position(|it| it == name);
        let row = own.and_then(|own| gains.gain.get(own));
        row.and_then(|row| row.get(column)).copied().unwrap_or(0.0)
    };
    Feedback {
        state: trim.state.clone(),
        rate: rates.collect(),
        input: trim.input.clone(),
        gain: DMatrix::from_fn(inputs.len(), states.len(), entry),
        actuators: vec![None; inputs.len()],
    }
}
