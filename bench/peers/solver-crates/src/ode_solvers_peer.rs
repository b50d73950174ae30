//! The methods of `ode_solvers`.

use std::hint::black_box;

use ode_solvers::dop_shared::{IntegrationError, Stats};
use ode_solvers::{Dop853, Dopri5, OutputType, Rk4, SVector, System};

use crate::{Flight, N, Solution, drift};

type Scaled = SVector<f64, N>;

/// The flight in units of the scales: the crate takes one absolute tolerance for all states.
struct Rates<'f>(&'f Flight);

impl System<f64, Scaled> for Rates<'_> {
    fn system(&self, _: f64, y: &Scaled, rate: &mut Scaled) {
        let scales = Scaled::from(self.0.scales);
        let slope = Scaled::from(drift(self.0, y.component_mul(&scales).into()));
        *rate = slope.component_div(&scales);
    }
}

/// The flight as it is.
struct Plain<'f>(&'f Flight);

impl System<f64, Scaled> for Plain<'_> {
    fn system(&self, _: f64, x: &Scaled, rate: &mut Scaled) {
        *rate = Scaled::from(drift(self.0, (*x).into()));
    }
}

/// `method` with this tolerance or number of steps.
pub(crate) fn solver<'f>(
    flight: &'f Flight,
    method: &str,
    setting: f64,
) -> Result<Box<dyn FnMut() -> Result<Solution, String> + 'f>, String> {
    let scales = Scaled::from(flight.scales);
    let start = Scaled::from(flight.state);
    let scaled = start.component_div(&scales);
    let end = flight.end;
    Ok(match method {
        "Rk4" => Box::new(move || {
            let start = black_box(start);
            let mut solver = Rk4::new(Plain(flight), 0.0, start, end, end / setting);
            let stats = solver.integrate().map_err(|it| it.to_string())?;
            Ok(solution(stats, solver.y_out().last(), &Scaled::repeat(1.0)))
        }),
        "Dopri5" => Box::new(move || {
            let start = black_box(scaled);
            let mut solver = Dopri5::new(Rates(flight), 0.0, end, end, start, setting, setting);
            solver.set_output(OutputType::Sparse);
            let stats = solver
                .integrate()
                .map_err(|it: IntegrationError| it.to_string())?;
            Ok(solution(stats, solver.y_out().last(), &scales))
        }),
        "Dop853" => Box::new(move || {
            let start = black_box(scaled);
            let mut solver = Dop853::new(Rates(flight), 0.0, end, end, start, setting, setting);
            solver.set_output(OutputType::Sparse);
            let stats = solver.integrate().map_err(|it| it.to_string())?;
            Ok(solution(stats, solver.y_out().last(), &scales))
        }),
        _ => return Err(format!("no method {method}")),
    })
}

fn solution(stats: Stats, last: Option<&Scaled>, scales: &Scaled) -> Solution {
    let last = last.copied().unwrap_or_else(|| Scaled::repeat(f64::NAN));
    Solution {
        state: last.component_mul(scales).into(),
        steps: stats.accepted_steps.into(),
        drifts: stats.num_eval.into(),
        jacobians: 0,
    }
}
