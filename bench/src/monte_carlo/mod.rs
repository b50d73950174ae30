//! Monte Carlo of SDCOM: many short flights from the trim, by the Euler–Maruyama method.

mod own;
pub(crate) mod problem;
mod shares;

pub(crate) use own::{SIDE_BY_SIDE, experiment, fly};

use ahv_models::sdcom::Noise;
use serde::Serialize;
use serde_json::{Value, json};

use crate::arrays::Arrays;
use crate::ensembles::{Ensembles, GXX};
use crate::moments;
use crate::race::{Finish, NUMPY, Runner, race};
use crate::table::Table;
use problem::{DT, Flight, MEMBERS, STATES, STEPS, THREADS};

/// Member-steps of a turn.
const UNITS: f64 = (STEPS * MEMBERS) as f64;

/// For the peers in Python.
pub(crate) fn problem() -> Value {
    let flight = Flight::new();
    json!({
        "start": flight.start.to_array(),
        "input": flight.input.to_array(),
        "parameters": flight.parameters.to_array().to_vec(),
        "dt": DT,
        "steps": STEPS,
        "members": MEMBERS,
        "channels": Noise::<f64>::LEN,
    })
}

/// What was found.
#[derive(Serialize)]
pub(crate) struct MonteCarlo {
    pub(crate) finishes: Vec<Finish>,
    /// Steps in lanes and their normal numbers.
    pub(crate) shares: Vec<Finish>,
    /// Greatest difference of a moment from the reference's, in standard errors.
    pub(crate) standard_errors: f64,
    pub(crate) rounds: u32,
}

/// Lets all fly, on one thread and on two.
///
/// # Errors
/// A runner that fails, or whose moments are not those of the reference.
pub(crate) fn measure(
    ensembles: Ensembles,
    arrays: Option<&Arrays>,
    rounds: u32,
) -> Result<MonteCarlo, String> {
    let mut found = MonteCarlo {
        finishes: Vec::new(),
        shares: shares::measure(rounds)?,
        standard_errors: 0.0,
        rounds,
    };
    for (place, threads) in THREADS.into_iter().enumerate() {
        eprintln!("timing the Monte Carlo: {threads} threads");
        let flight = Flight::new();
        let fly = move |seed| Ok(ensembles.monte_carlo(&flight, threads, seed));
        let ends = |ends: &Vec<_>| moments::of_members::<STATES>(ends);
        let mut runners = vec![Runner::new("CasADi's step in C++", GXX, UNITS, fly, ends)];
        if let Some(arrays) = arrays {
            runners.extend(peers(arrays, place));
        }
        runners.extend(own::runners(flight, threads)?);
        let finishes = race(runners, threads, rounds)?;
        let errors = moments::check("the Monte Carlo", &finishes, MEMBERS as f64)?;
        found.standard_errors = found.standard_errors.max(errors);
        found.finishes.extend(finishes);
    }
    Ok(found)
}

fn peers(arrays: &Arrays, place: usize) -> Vec<Runner<'static>> {
    let (numba, jax) = (&arrays.numba[place], &arrays.jax[place]);
    let mut peers = vec![
        Runner::service(
            "numba",
            "`prange` over members, NumPy's ziggurat on MT19937",
            UNITS,
            numba,
            "monte_carlo",
        ),
        Runner::service(
            "JAX",
            "`vmap` over blocks of 1024 members and `scan`, f32 noise, f64 state",
            UNITS,
            jax,
            "monte_carlo",
        ),
        Runner::service(
            "diffrax",
            "`Euler`, `UnsafeBrownianPath`, `vmap` over members",
            UNITS,
            jax,
            "monte_carlo_diffrax",
        ),
    ];
    if place == 0 {
        peers.push(Runner::service(
            NUMPY,
            "arrays of 1024 members, ziggurat on SFC64",
            UNITS,
            &arrays.numpy,
            "monte_carlo",
        ));
    }
    peers
}

impl MonteCarlo {
    /// For people.
    pub(crate) fn tables(&self) -> [Table; 2] {
        let rates = Table::of_rates(
            "Monte Carlo of SDCOM, million member-steps per second".to_owned(),
            format!(
                "Euler–Maruyama at 1 ms with six Wiener channels in f64: drift, noise and normal numbers of a step, {MEMBERS} \
                 flights of {} s a turn from the trim of `ahv trim --model sdcom` at its inputs, set 5.1. {} rounds in which each \
                 has its turn; the last columns are times faster than CasADi's step on as many threads, within each round. \
                 `ahv`: rustc -O, thin LTO, baseline target. Compilation is not part of the time. Means and standard deviations of all states at the end, over all turns, \
                 differ from the reference's by at most {:.1} standard errors.",
                STEPS as f64 * DT,
                self.rounds,
                self.standard_errors
            ),
            &self.finishes,
        );
        [rates, shares::table(&self.shares)]
    }
}
