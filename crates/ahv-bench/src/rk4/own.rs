//! The product's ways to do it. A row more is a [`Runner`] more in [`runners`].

use std::hint::black_box;

use ahv_integrate::Rk4;
use ahv_models::dcom::{Model, State};

use super::{DT, REPEATS, STEPS, UNITS, flight};
use crate::race::Runner;

/// All of them.
pub(crate) fn runners() -> Vec<Runner<'static>> {
    let how = "rustc -O, thin LTO, baseline target; one flight after the other";
    let values = |x: &State<f64>| x.to_array().to_vec();
    vec![Runner::new("ahv, `Rk4`", how, UNITS[0], scalar, values)]
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
