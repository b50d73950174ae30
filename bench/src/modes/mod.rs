//! The problem of the paper's section 5.1: ensembles of three modes and of the coloured noise that stands for each.

mod own;
pub(crate) mod problem;

pub(crate) use own::SIDE_BY_SIDE;

use ahv_core::{Model as _, StochasticModel as _, Vector as _};
use ahv_models::flexible_mode::{Input, Model, Noise, Parameters, SETS, State};
use serde::Serialize;
use serde_json::{Value, json};

use crate::arrays::Arrays;
use crate::ensembles::{Ensembles, GXX};
use crate::moments;
use crate::monte_carlo::problem::THREADS;
use crate::race::{Finish, NUMPY, Runner, race};
use crate::table::Table;
use problem::{DT, MODES, RUNS, Rates, STEPS, Sums};

/// Mode-steps of a turn.
const UNITS: f64 = (MODES * RUNS * STEPS) as f64;

/// The parameters of the three modes.
pub(crate) fn parameters() -> [Parameters<f64>; MODES] {
    SETS.map(|set| set.parameters)
}

/// What the equations of the peers hold, as the generated functions answer to units.
fn rates() -> [Rates; MODES] {
    let (rest, input) = (State::splat(0.0), Input::splat(0.0));
    parameters().map(|parameters| {
        let model = Model::new(&parameters);
        let drift = |x: State<f64>| model.drift(&x, &input);
        let noise = model.noise_increment(&rest, &input, &Noise { xi: 1.0 });
        [
            -drift(State { eta: 1.0, ..rest }).eta_dot,
            -drift(State {
                eta_dot: 1.0,
                ..rest
            })
            .eta_dot,
            noise.eta_dot,
            -drift(State { chi: 1.0, ..rest }).chi,
            noise.chi,
        ]
    })
}

/// Means and standard deviations of η and χ of each mode at the end.
fn ends(sums: &Vec<Sums>) -> Vec<f64> {
    let last = sums.iter().filter_map(|steps| steps.last());
    let pairs = last.flat_map(|&[eta, eta_2, chi, chi_2]| [[eta, eta_2], [chi, chi_2]]);
    moments::of_sums(&pairs.collect::<Vec<_>>(), RUNS as f64)
}

/// For the peers in Python.
pub(crate) fn problem() -> Value {
    json!({"rates": rates(), "dt": DT, "runs": RUNS, "steps": STEPS})
}

/// What was found.
#[derive(Serialize)]
pub(crate) struct Modes {
    pub(crate) finishes: Vec<Finish>,
    /// Greatest difference of a moment from the reference's, in standard errors.
    pub(crate) standard_errors: f64,
    pub(crate) rounds: u32,
}

/// Runs all ensembles, on one thread and on two.
///
/// # Errors
/// A runner that fails, or whose moments are not those of the reference.
pub(crate) fn measure(
    ensembles: Ensembles,
    arrays: Option<&Arrays>,
    rounds: u32,
) -> Result<Modes, String> {
    let mut found = Modes {
        finishes: Vec::new(),
        standard_errors: 0.0,
        rounds,
    };
    for (place, threads) in THREADS.into_iter().enumerate() {
        eprintln!("timing the three modes: {threads} threads");
        let rates = rates();
        let run = move |seed| Ok(ensembles.modes(&rates, threads, seed));
        let mut runners = vec![Runner::new("C++", GXX, UNITS, run, ends)];
        if let Some(arrays) = arrays {
            let numba = "`prange` over parts of the runs, NumPy's ziggurat on MT19937";
            let jax = "arrays of all runs and `scan`, f32 noise, f64 state";
            runners.push(Runner::service(
                "numba",
                numba,
                UNITS,
                &arrays.numba[place],
                "modes",
            ));
            runners.push(Runner::service(
                "JAX",
                jax,
                UNITS,
                &arrays.jax[place],
                "modes",
            ));
            if place == 0 {
                let numpy = "arrays of all runs, ziggurat on SFC64";
                runners.push(Runner::service(NUMPY, numpy, UNITS, &arrays.numpy, "modes"));
            }
        }
        runners.extend(own::runners(threads)?);
        let finishes = race(runners, threads, rounds)?;
        let errors = moments::check("the three modes", &finishes, RUNS as f64)?;
        found.standard_errors = found.standard_errors.max(errors);
        found.finishes.extend(finishes);
    }
    Ok(found)
}

impl Modes {
    /// For people.
    pub(crate) fn table(&self) -> Table {
        Table::of_rates(
            "Section 5.1, million mode-steps per second".to_owned(),
            format!(
                "Three modes and their coloured noises, {RUNS} runs of each at 1 ms by the Euler–Maruyama method, one normal number \
                 a mode-step in f64; a turn takes {STEPS} steps of the 10 000 and keeps mean and standard deviation of η and χ \
                 after each. {} rounds in which each has its turn; the last columns are times faster than C++ on as many \
                 threads, within each round. `ahv`: rustc -O, thin LTO, baseline target. Compilation is not part of the time. Moments at the end, over all turns, differ from \
                 the reference's by at most {:.1} standard errors.",
                self.rounds, self.standard_errors
            ),
            &self.finishes,
        )
    }
}
