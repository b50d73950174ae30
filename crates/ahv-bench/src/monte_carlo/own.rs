//! The product's ways to do it. A row more is a [`Runner`] more in [`runners`].

use ahv_integrate::{ItoEulerMaruyama, WienerSource};
use ahv_models::sdcom::{Model, Noise};
use rayon::ThreadPool;
use rayon::prelude::*;

use super::{DT, Flight, MEMBERS, STATES, STEPS, UNITS};
use crate::moments;
use crate::race::Runner;
use crate::threads::pool;

/// All of them on this number of threads.
///
/// # Errors
/// Threads that cannot be started.
pub(crate) fn runners(flight: Flight, threads: usize) -> Result<Vec<Runner<'static>>, String> {
    let model = Model::new(&flight.parameters);
    let pool = pool(threads)?;
    let scalar = move |seed| scalar(&model, &flight, seed, &pool);
    Ok(vec![Runner::new(
        "ahv, `ItoEulerMaruyama`",
        "one member after the other, `WienerSource` keyed by member, f64",
        UNITS,
        scalar,
        |ends| moments::of_members::<STATES>(ends),
    )])
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
