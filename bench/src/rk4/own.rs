//! The product's ways to do it. A row more is a [`Runner`] more in [`runners`].

use std::hint::black_box;
use std::marker::PhantomData;

use ahv_bench_kernels::lanes::{DcomRk4, LANES, Packed, Scalar};
use ahv_integrate::Rk4;
use ahv_models::dcom::{Model, State};

use super::{DT, FLIGHTS, REPEATS, STEPS, UNITS, flight};
use crate::candidates;
use crate::lanes::Exact;
use crate::race::Runner;

/// Times that [`LANES`] members fly in a turn.
const LANE_REPEATS: usize = 8;
/// Trajectories of that.
const LANE_UNITS: f64 = (LANE_REPEATS * LANES) as f64 / FLIGHTS as f64;

/// All of them.
///
/// # Errors
/// Members side by side that do not end where one ends alone.
pub(crate) fn runners() -> Result<Vec<Runner<'static>>, String> {
    if side_by_side::<Exact>(0)? != scalar(0)? {
        return Err("error: members side by side end elsewhere than alone".to_owned());
    }
    let alone = "rustc -O, thin LTO, baseline target; one flight after the other";
    let lanes = "the same, 8 flights side by side, AVX2 or AVX-512 chosen at run time";
    let values = |x: &State<f64>| x.to_array().to_vec();
    Ok(vec![
        Runner::new(PRODUCT, alone, UNITS[0], scalar, values),
        Runner::new(
            candidates::LANES,
            lanes,
            LANE_UNITS,
            side_by_side::<Exact>,
            values,
        ),
    ])
}

/// One flight after the other.
pub(crate) const PRODUCT: &str = "ahv, `Rk4`";

fn side_by_side<R: Scalar>(_: u64) -> Result<State<f64>, String> {
    let flight = flight();
    let model = Model::new(&flight.parameters).map_ref(|&it| Packed::splat(it));
    let mut state = flight.start.map_into(Packed::splat);
    let machine = pulp::Arch::new();
    for _ in 0..LANE_REPEATS {
        state = black_box(flight.start).map_into(Packed::splat);
        machine.dispatch(DcomRk4::<R> {
            model: &model,
            state: &mut state,
            input: &flight.input.map_into(Packed::splat),
            dt: DT,
            steps: STEPS,
            scalar: PhantomData,
        });
        black_box(&mut state);
    }
    Ok(state.map_ref(|numbers| numbers.0[LANES - 1]))
}

fn scalar(_: u64) -> Result<State<f64>, String> {
    let flight = flight();
    let model = Model::new(&flight.parameters);
    let stepper = Rk4::new(DT);
    let mut x = flight.start;
    for _ in 0..REPEATS {
        x = black_box(flight.start);
        for _ in 0..STEPS {
            let stepped = stepper.step(&model, &mut x, &flight.input);
            stepped.map_err(|it| format!("error: {it}"))?;
        }
        black_box(x);
    }
    Ok(x)
}
