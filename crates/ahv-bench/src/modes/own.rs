//! The product's ways to do it. A row more is a [`Runner`] more in [`runners`].

use ahv_core::Vector as _;
use ahv_integrate::{ItoEulerMaruyama, WienerSource};
use ahv_models::flexible_mode::{Input, Model, State};
use rayon::ThreadPool;
use rayon::prelude::*;

use super::{DT, MODES, RUNS, STEPS, Sums, UNITS, added, ends, parameters};
use crate::race::Runner;
use crate::threads::pool;

/// Runs whose sums one task takes.
const CHUNK: usize = 50;

/// All of them on this number of threads.
///
/// # Errors
/// Threads that cannot be started.
pub(crate) fn runners(threads: usize) -> Result<Vec<Runner<'static>>, String> {
    let models = parameters().map(|it| Model::new(&it));
    let pool = pool(threads)?;
    Ok(vec![Runner::new(
        "ahv, `ItoEulerMaruyama`",
        "one run after the other, `WienerSource` keyed by run, f64",
        UNITS,
        move |seed| scalar(&models, seed, &pool),
        ends,
    )])
}

/// Each run with a stream of its own.
fn scalar(models: &[Model<f64>; MODES], seed: u64, pool: &ThreadPool) -> Result<Vec<Sums>, String> {
    let chunk = |first: usize| {
        let mut sums = vec![[[0.0; 4]; STEPS]; MODES];
        for run in first..(first + CHUNK).min(RUNS) {
            for (mode, (model, sums)) in models.iter().zip(&mut sums).enumerate() {
                let source = WienerSource::new(seed, (MODES * run + mode) as u64);
                summed(model, source, sums)?;
            }
        }
        Ok(sums)
    };
    let firsts = 0..RUNS.div_ceil(CHUNK);
    let parts = firsts.into_par_iter().map(|it| chunk(CHUNK * it));
    let parts: Vec<Vec<Sums>> = pool.install(|| parts.collect::<Result<_, String>>())?;
    Ok(added(&parts.concat()))
}

/// Adds a run.
fn summed(model: &Model<f64>, mut source: WienerSource<1>, sums: &mut Sums) -> Result<(), String> {
    let stepper = ItoEulerMaruyama::new(DT);
    let (mut x, input) = (State::splat(0.0), Input::splat(0.0));
    for (step, row) in sums.iter_mut().enumerate() {
        let dw = source.increments(step as u64, DT);
        stepper
            .step(model, &mut x, &input, &dw)
            .map_err(|it| format!("error: {it}"))?;
        for (sum, value) in row
            .iter_mut()
            .zip([x.eta, x.eta * x.eta, x.chi, x.chi * x.chi])
        {
            *sum += value;
        }
    }
    Ok(())
}
