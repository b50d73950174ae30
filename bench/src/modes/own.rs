//! The product's ways to do it. A row more is a [`Runner`] more in [`runners`].

use std::marker::PhantomData;

use ahv_bench_kernels::lanes::{LANES, Packed, Scalar};
use ahv_core::{Real as _, Vector as _};
use ahv_integrate::{ItoEulerMaruyama, NormalLanes, Precision, WienerSource};
use ahv_models::flexible_mode::{Input, Model, Noise, State};
use rayon::ThreadPool;
use rayon::prelude::*;

use super::problem::{DT, MODES, RUNS, STEPS, Sums, added};
use super::{UNITS, ends, parameters};
use crate::lanes::Exact;
use crate::race::Runner;
use crate::threads::pool;

/// Runs whose sums one task takes.
const CHUNK: usize = 80;

/// One run after the other.
const PRODUCT: &str = "ahv, `ItoEulerMaruyama`";
/// Runs side by side.
pub(crate) const SIDE_BY_SIDE: [&str; 2] = ["ahv, 8 lanes", "ahv, 8 lanes, f32-noise"];

/// All of them on this number of threads.
///
/// # Errors
/// Threads that cannot be started.
pub(crate) fn runners(threads: usize) -> Result<Vec<Runner<'static>>, String> {
    let models = parameters().map(|it| Model::new(&it));
    let [alone, double, single] = [pool(threads)?, pool(threads)?, pool(threads)?];
    let scalar = move |seed| in_chunks(&alone, |first| chunk(&models, seed, first));
    let double = move |seed| in_chunks(&double, |first| lanes::<f64>(&models, seed, first));
    let single = move |seed| in_chunks(&single, |first| lanes::<f32>(&models, seed, first));
    let how = "one run after the other, `WienerSource` keyed by run, f64";
    let how_double = "8 runs side by side, `NormalLanes` keyed by run, f64";
    let how_single = "the same, normal numbers in f32";
    Ok(vec![
        Runner::new(PRODUCT, how, UNITS, scalar, ends),
        Runner::new(SIDE_BY_SIDE[0], how_double, UNITS, double, ends),
        Runner::new(SIDE_BY_SIDE[1], how_single, UNITS, single, ends),
    ])
}

/// Sums of all runs, of which `chunk` gives those of [`CHUNK`] from a first one on.
fn in_chunks(
    pool: &ThreadPool,
    chunk: impl Fn(usize) -> Result<Vec<Sums>, String> + Sync,
) -> Result<Vec<Sums>, String> {
    let firsts = 0..RUNS.div_ceil(CHUNK);
    let parts = firsts.into_par_iter().map(|it| chunk(CHUNK * it));
    let parts: Vec<Vec<Sums>> = pool.install(|| parts.collect::<Result<_, String>>())?;
    Ok(added(&parts.concat()))
}

/// The number of the stream of a run's mode.
fn stream(run: usize, mode: usize) -> u64 {
    (MODES * run + mode) as u64
}

/// Each run with a stream of its own.
fn chunk(models: &[Model<f64>; MODES], seed: u64, first: usize) -> Result<Vec<Sums>, String> {
    let mut sums = vec![[[0.0; 4]; STEPS]; MODES];
    for run in first..first + CHUNK {
        for (mode, (model, sums)) in models.iter().zip(&mut sums).enumerate() {
            summed(model, WienerSource::new(seed, stream(run, mode)), sums)?;
        }
    }
    Ok(sums)
}

/// The same with [`LANES`] runs side by side, with normal numbers in `T`.
fn lanes<T: Precision>(
    models: &[Model<f64>; MODES],
    seed: u64,
    first: usize,
) -> Result<Vec<Sums>, String>
where
    f64: From<T>,
{
    let mut sums = vec![[[0.0; 4]; STEPS]; MODES];
    for (mode, (model, sums)) in models.iter().zip(&mut sums).enumerate() {
        let members =
            |batch: usize| std::array::from_fn(|lane| stream(first + LANES * batch + lane, mode));
        let normals = std::array::from_fn(|batch| NormalLanes::new(seed, members(batch), 0));
        pulp::Arch::new().dispatch(SideBySide::<T, Exact> {
            model,
            normals,
            sums,
            scalar: PhantomData,
        });
    }
    Ok(sums)
}

/// Batches of a chunk.
const BATCHES: usize = CHUNK / LANES;

/// A chunk of runs of a mode, step by step.
struct SideBySide<'a, T, R> {
    model: &'a Model<f64>,
    normals: [NormalLanes<T, LANES>; BATCHES],
    sums: &'a mut Sums,
    scalar: PhantomData<R>,
}

impl<T: Precision, R: Scalar> pulp::WithSimd for SideBySide<'_, T, R>
where
    f64: From<T>,
{
    type Output = ();

    #[inline(always)]
    fn with_simd<V: pulp::Simd>(mut self, _: V) {
        let model = self.model.map_ref(|&value| R::from_f64(value));
        let (stepper, root) = (ItoEulerMaruyama::new(DT), DT.sqrt());
        let input = Input::splat(R::ZERO);
        let mut states = [State::splat(Packed::ZERO); BATCHES];
        for (step, row) in self.sums.iter_mut().enumerate() {
            let mut total = [Packed::ZERO; 4];
            for (x, normals) in states.iter_mut().zip(&mut self.normals) {
                let dw = normals.normal(step as u64).map(|it| root * f64::from(it));
                for turn in 0..R::TURNS {
                    let mut run = x.map_ref(|numbers| R::pick(numbers, turn));
                    let dw = Noise {
                        xi: R::pick(&dw, turn),
                    };
                    // A scalar without branches has no failure.
                    let _ = stepper.step(&model, &mut run, &input, &dw);
                    run.eta.put(&mut x.eta, turn);
                    run.eta_dot.put(&mut x.eta_dot, turn);
                    run.chi.put(&mut x.chi, turn);
                }
                let values = [x.eta, x.eta * x.eta, x.chi, x.chi * x.chi];
                for (total, value) in total.iter_mut().zip(values) {
                    *total = *total + value;
                }
            }
            for (sum, total) in row.iter_mut().zip(total) {
                *sum = total.0.iter().sum();
            }
        }
    }
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
