//! The product's ways to do it. A row more is a [`Runner`] more in [`runners`].

use ahv_analysis::erased::values;
use ahv_analysis::monte_carlo::{Experiment, LANES, Mode, Scheme};
use ahv_analysis::ordered::Control;
use ahv_core::Vector as _;
use ahv_integrate::{ItoEulerMaruyama, WienerSource};
use ahv_models::sdcom::{Input, Model, Noise, State};
use rayon::ThreadPool;
use rayon::prelude::*;

use super::UNITS;
use super::problem::{DT, Flight, MEMBERS, STATES, STEPS};
use crate::moments;
use crate::race::Runner;
use crate::threads::pool;

/// One member after the other.
const PRODUCT: &str = "ahv, `ItoEulerMaruyama`";
/// Members side by side, in each mode.
pub(crate) const SIDE_BY_SIDE: [&str; 2] = ["ahv, 8 lanes", "ahv, 8 lanes, f32-noise"];
const MODES: [(Mode, &str); 2] = [
    (Mode::Exact, "8 members side by side, f64"),
    (Mode::F32Noise, "the same, normal numbers in f32"),
];

/// All of them on this number of threads.
///
/// # Errors
/// Threads that cannot be started, and members side by side that do not end where one ends alone.
pub(crate) fn runners(flight: Flight, threads: usize) -> Result<Vec<Runner<'static>>, String> {
    let model = Model::new(&flight.parameters);
    let scalar = move |seed, pool: &ThreadPool| scalar(&model, &flight, seed, pool);
    let exact = experiment(&flight, Mode::Exact);
    let pool_of = || pool(threads);
    let checked = pool_of()?;
    if side_by_side(&exact, 0, &checked)? != scalar(0, &checked)? {
        return Err("error: members side by side end elsewhere than alone".to_owned());
    }
    let values = |ends: &Vec<_>| moments::of_members::<STATES>(ends);
    let how = "one member after the other, `WienerSource` keyed by member, f64";
    let run = move |seed| scalar(seed, &checked);
    let mut runners = vec![Runner::new(PRODUCT, how, UNITS, run, values)];
    for (name, (mode, how)) in SIDE_BY_SIDE.into_iter().zip(MODES) {
        let (experiment, pool) = (experiment(&flight, mode), pool_of()?);
        let run = move |seed| side_by_side(&experiment, seed, &pool);
        runners.push(Runner::new(name, how, UNITS, run, values));
    }
    Ok(runners)
}

/// What members fly from a start at held inputs, by the method of the peers, with nothing watched.
pub(crate) fn experiment(flight: &Flight, mode: Mode) -> Experiment {
    Experiment {
        parameters: values(&flight.parameters),
        dispersion: None,
        state: [values(&flight.start), values(&State::splat(0.0))],
        input: [values(&flight.input), values(&Input::splat(0.0))],
        feedback: None,
        watched: Vec::new(),
        scheme: Scheme::EulerMaruyama,
        mode,
        dt: DT,
        snapshots: vec![STEPS as u64],
        seed: 0,
        control_variate: false,
    }
}

/// The ends of members, [`LANES`] at a time.
pub(crate) fn fly(
    experiment: &Experiment,
    members: u64,
    pool: &ThreadPool,
) -> Result<Vec<[f64; STATES]>, String> {
    let control = Control::default();
    let engine = experiment.engine::<Model<f64>>();
    let engine = engine.map_err(|it| format!("error: {it}"))?;
    let batch = |first: u64| {
        let first = first * LANES as u64;
        let numbers: Vec<u64> = (first..members.min(first + LANES as u64)).collect();
        let seen = engine.fly(&numbers, &control);
        let seen = seen.map_err(|it| format!("error: {it}"))?;
        let ends = seen.into_iter().flatten().map(|it| match it.lost {
            None => Ok(std::array::from_fn(|state| it.last[state])),
            Some(_) => Err("error: a member is lost".to_owned()),
        });
        ends.collect::<Result<Vec<_>, String>>()
    };
    let batches = (0..members.div_ceil(LANES as u64))
        .into_par_iter()
        .map(batch);
    let ends: Vec<_> = pool.install(|| batches.collect::<Result<_, String>>())?;
    Ok(ends.concat())
}

fn side_by_side(
    experiment: &Experiment,
    seed: u64,
    pool: &ThreadPool,
) -> Result<Vec<[f64; STATES]>, String> {
    let experiment = Experiment {
        seed,
        ..experiment.clone()
    };
    fly(&experiment, MEMBERS as u64, pool)
}

/// Each member with a stream of its own.
fn scalar(
    model: &Model<f64>,
    flight: &Flight,
    seed: u64,
    pool: &ThreadPool,
) -> Result<Vec<[f64; STATES]>, String> {
    let stepper = ItoEulerMaruyama::new(DT);
    let fly = |member: usize| {
        let mut source = WienerSource::<{ Noise::<f64>::LEN }>::new(seed, member as u64);
        let mut x = flight.start;
        for step in 0..STEPS as u64 {
            let dw: Noise<f64> = source.increments(step, DT);
            stepper
                .step(model, &mut x, &flight.input, &dw)
                .map_err(|it| format!("error: {it}"))?;
        }
        Ok(x.to_array())
    };
    pool.install(|| (0..MEMBERS).into_par_iter().map(fly).collect())
}
