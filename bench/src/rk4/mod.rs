//! The classical Runge–Kutta method on DCOM: trajectories of 10 s at 1 ms.

mod own;

pub(crate) use own::PRODUCT;

use serde::Serialize;
use serde_json::{Value, json};

use crate::arrays::Arrays;
use crate::race::{Finish, Runner, race};
use crate::steppers::{Flight, Flights, Steps, distance};
use crate::table::Table;

/// Step size in s.
const DT: f64 = 1e-3;
/// Steps of a flight: after these the unstable airframe is still near the trim.
const STEPS: usize = 1000;
/// Flights that a trajectory takes.
const FLIGHTS: usize = 10;
/// Flights side by side where arrays are computed on.
const BATCH: usize = 1024;
/// Flights of a turn that go one after the other.
const REPEATS: usize = 20;
/// Share of a trajectory that a turn takes, one flight after the other and side by side.
const UNITS: [f64; 2] = [
    REPEATS as f64 / FLIGHTS as f64,
    BATCH as f64 / FLIGHTS as f64,
];
/// Greatest difference of two ends, relative to the component or to 1, if that is more.
const TOLERANCE: f64 = 1e-9;

fn flight() -> Flight {
    let [flight, _] = Flights::new().all;
    flight
}

/// For the peers in Python.
pub(crate) fn problem() -> Value {
    let flight = flight();
    json!({
        "start": flight.start.to_array(),
        "input": flight.input.to_array(),
        "parameters": flight.parameters.to_array().to_vec(),
        "dt": DT,
        "steps": STEPS,
        "repeats": REPEATS,
        "batch": BATCH,
    })
}

/// What was found.
#[derive(Serialize)]
pub(crate) struct Trajectories {
    pub(crate) finishes: Vec<Finish>,
    /// Greatest difference of an end from the reference's.
    pub(crate) difference: f64,
    pub(crate) rounds: u32,
}

/// Lets all fly.
///
/// # Errors
/// A runner that fails, or that ends elsewhere than the reference.
pub(crate) fn measure(
    compiled: &Steps,
    arrays: Option<&Arrays>,
    rounds: u32,
) -> Result<Trajectories, String> {
    eprintln!("timing trajectories");
    let mut runners = vec![casadi(compiled)?];
    if let Some(arrays) = arrays {
        let (numba, jax) = (&arrays.numba[0], &arrays.jax[0]);
        let njit = "`njit` of CasADi's step and the loop";
        runners.push(Runner::service("numba", njit, UNITS[0], numba, "rk4"));
        let vmap = "`vmap` over 1024 members, `fori_loop`";
        runners.push(Runner::service("JAX", vmap, UNITS[1], jax, "rk4"));
        let diffrax =
            "`diffeqsolve` with the tableau of the method, `StepTo`, `vmap` over 1024 members";
        runners.push(Runner::service(
            "diffrax",
            diffrax,
            UNITS[1],
            jax,
            "rk4_diffrax",
        ));
    }
    runners.extend(own::runners()?);
    let finishes = race(runners, 1, rounds)?;
    let difference = check(&finishes)?;
    Ok(Trajectories {
        finishes,
        difference,
        rounds,
    })
}

fn casadi(compiled: &Steps) -> Result<Runner<'static>, String> {
    let mut step = compiled.step("dcom_runge_kutta")?;
    let flight = flight();
    let (start, u, p) = (
        flight.start.to_array(),
        flight.input.to_array(),
        flight.parameters.to_array(),
    );
    let fly = move |_| {
        let mut x = start;
        for _ in 0..REPEATS {
            x = start;
            (0..STEPS).for_each(|_| x = step.call([&x, &u, &p, &[DT]]));
        }
        Ok(x)
    };
    let how = "gcc -O3 -march=native, a call a step";
    Ok(Runner::new("CasADi C", how, UNITS[0], fly, |x| x.to_vec()))
}

fn check(finishes: &[Finish]) -> Result<f64, String> {
    let ends = |it: &Finish| it.values.last().cloned().unwrap_or_default();
    let Some((reference, others)) = finishes.split_first() else {
        return Ok(0.0);
    };
    let mut greatest = 0.0_f64;
    for finish in others {
        let found = distance(&ends(finish), &ends(reference));
        // Written so that NaN fails.
        if !found.le(&TOLERANCE) {
            return Err(format!(
                "error: a flight by {} ends {found:.1e} from the reference's end",
                finish.candidate
            ));
        }
        greatest = greatest.max(found);
    }
    Ok(greatest)
}

impl Trajectories {
    /// For people.
    pub(crate) fn table(&self) -> Table {
        let row = |it: &Finish| {
            let micro = |seconds: f64| format!("{:.0}", seconds * 1e6);
            let seconds = it.seconds;
            vec![
                it.candidate.to_owned(),
                it.how.to_owned(),
                micro(seconds.median),
                micro(seconds.min),
                format!(
                    "{}–{}",
                    micro(seconds.lower_quartile),
                    micro(seconds.upper_quartile)
                ),
                format!("{:.2}", it.ratio.median),
                format!(
                    "{:.2}–{:.2}",
                    it.ratio.lower_quartile, it.ratio.upper_quartile
                ),
            ]
        };
        Table {
            title: "RK4 of DCOM, 1 ms, 10 s".to_owned(),
            note: format!(
                "Time of a trajectory of 10 000 steps on one thread, set 5.1: {FLIGHTS} flights of 1 s at held inputs from the same \
                 start, because the open-loop airframe runs away in 10 s. A turn takes {REPEATS} flights one after the other, \
                 or of members side by side (JAX and diffrax {BATCH}, ahv 8 at a time), of which the time a member is given. {} rounds in \
                 which each has its turn, ratios to CasADi's C within each. Compilation is not part of the time. All ends agree \
                 to {:.0e}, relative to the component or to 1, if that is more.",
                self.rounds, self.difference
            ),
            columns: vec![
                "candidate",
                "how",
                "µs",
                "min",
                "quartiles",
                "ratio",
                "quartiles",
            ],
            rows: self.finishes.iter().map(row).collect(),
        }
    }
}
