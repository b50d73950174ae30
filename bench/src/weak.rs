//! Weak error against time: the step of the splitting that is as accurate as Euler–Maruyama at 1 ms.

use ahv_analysis::monte_carlo::{Experiment, Mode, Scheme};
use rayon::ThreadPool;
use serde::Serialize;

use crate::moments;
use crate::monte_carlo::problem::{DT, Flight, STATES};
use crate::monte_carlo::{experiment, fly};
use crate::race::{Finish, Runner, race};
use crate::table::Table;
use crate::threads::pool;

/// Length of a flight, in s: after it the coloured noise is near its stationary law, and the unstable airframe near the trim.
const END: f64 = 1.0;
/// Steps of the splitting, in s, ascending.
const SPLITTING: [f64; 6] = [0.005, 0.01, 0.02, 0.04, 0.05, 0.1];
/// Seed of the reference; the others have seeds of their own.
const SEED: u64 = 1000;
/// Flights of each method for its error.
const FLIGHTS: u64 = 1 << 19;
/// Flights of a turn.
const MEMBERS: u64 = 2048;
/// Number of threads for errors; times are of one thread.
const THREADS: usize = 2;

/// A method with a step, and how far its moments are from the reference's.
#[derive(Serialize)]
pub(crate) struct Error {
    pub(crate) scheme: &'static str,
    /// Step size in s.
    pub(crate) dt: f64,
    /// Greatest difference of a state's mean, in standard deviations of the state.
    pub(crate) mean: f64,
    /// Greatest relative difference of a standard deviation.
    pub(crate) deviation: f64,
}

impl Error {
    fn greatest(&self) -> f64 {
        self.mean.max(self.deviation)
    }
}

/// What was found.
#[derive(Serialize)]
pub(crate) struct Weak {
    /// Euler–Maruyama, then the splitting at each step.
    pub(crate) errors: Vec<Error>,
    /// Euler–Maruyama, then the splitting at the greatest step at which its error is not greater.
    pub(crate) finishes: Vec<Finish>,
    pub(crate) rounds: u32,
    /// That step, in s.
    pub(crate) chosen: f64,
}

/// Finds the errors, and the time of both.
///
/// # Errors
/// A member that is lost, or a splitting that is nowhere as accurate.
pub(crate) fn measure(rounds: u32) -> Result<Weak, String> {
    eprintln!("finding weak errors");
    let threads = pool(THREADS)?;
    let found = |scheme, dt, seed| moments_of(&experiment_of(scheme, dt, seed), &threads);
    let reference = found(Scheme::Splitting, DT, SEED)?;
    let mut errors = Vec::new();
    let all = SPLITTING.map(|dt| (Scheme::Splitting, dt));
    for (seed, (scheme, dt)) in [(Scheme::EulerMaruyama, DT)]
        .into_iter()
        .chain(all)
        .enumerate()
    {
        errors.push(error(
            scheme,
            dt,
            &found(scheme, dt, seed as u64)?,
            &reference,
        ));
    }
    let Some((first, others)) = errors.split_first() else {
        return Err("error: no errors".to_owned());
    };
    let as_good = others
        .iter()
        .take_while(|it| it.greatest() <= first.greatest());
    let chosen = as_good.last().map(|it| it.dt);
    let chosen = chosen.ok_or("error: the splitting is nowhere as accurate as Euler–Maruyama")?;
    let one = pool(1)?;
    let runner = |name, how, scheme, dt| {
        let (experiment, one) = (experiment_of(scheme, dt, 0), &one);
        let run = move |seed| {
            let experiment = Experiment {
                seed,
                ..experiment.clone()
            };
            fly(&experiment, MEMBERS, one)
        };
        Runner::new(name, how, MEMBERS as f64, run, |_| Vec::new())
    };
    let runners = vec![
        runner("ahv, 8 lanes", "euler-maruyama", Scheme::EulerMaruyama, DT),
        runner("ahv, 8 lanes", "splitting", Scheme::Splitting, chosen),
    ];
    let finishes = race(runners, 1, rounds)?;
    Ok(Weak {
        errors,
        finishes,
        rounds,
        chosen,
    })
}

fn experiment_of(scheme: Scheme, dt: f64, seed: u64) -> Experiment {
    Experiment {
        scheme,
        dt,
        seed,
        snapshots: vec![(END / dt).round() as u64],
        ..experiment(&Flight::new(), Mode::Exact)
    }
}

fn moments_of(experiment: &Experiment, threads: &ThreadPool) -> Result<Vec<f64>, String> {
    let ends = fly(experiment, FLIGHTS, threads)?;
    Ok(moments::of_members::<STATES>(&ends))
}

fn error(scheme: Scheme, dt: f64, found: &[f64], reference: &[f64]) -> Error {
    let (means, deviations) = found.split_at(STATES);
    let (true_means, true_deviations) = reference.split_at(STATES);
    // Written so that NaN stays.
    let greatest = |worst: f64, it: f64| if it <= worst { worst } else { it };
    let of_means = means.iter().zip(true_means).zip(true_deviations);
    let of_means = of_means.map(|((mean, other), deviation)| (mean - other).abs() / deviation);
    let of_deviations = deviations.iter().zip(true_deviations);
    let of_deviations = of_deviations.map(|(it, other)| (it / other - 1.0).abs());
    Error {
        scheme: scheme.name(),
        dt,
        mean: of_means.fold(0.0, greatest),
        deviation: of_deviations.fold(0.0, greatest),
    }
}

impl Weak {
    /// Errors, for people.
    pub(crate) fn errors(&self) -> Table {
        let row = |it: &Error| {
            vec![
                it.scheme.to_owned(),
                format!("{:.0}", it.dt * 1e3),
                format!("{:.2} %", 100.0 * it.mean),
                format!("{:.2} %", 100.0 * it.deviation),
            ]
        };
        let [mean, deviation] = [2.0, 1.0].map(|it: f64| 100.0 * (it / FLIGHTS as f64).sqrt());
        Table {
            title: "Weak error of SDCOM".to_owned(),
            note: format!(
                "Flights of {END} s from the trim at its inputs, in lanes, f64. Greatest differences of the states' means, in standard \
                 deviations, and of the standard deviations, relative, from those of the splitting at 1 ms; {} flights of each with \
                 seeds of their own, so that chance alone, of one state, gives {mean:.2} % and {deviation:.2} %.",
                FLIGHTS
            ),
            columns: vec!["scheme", "step, ms", "mean", "standard deviation"],
            rows: self.errors.iter().map(row).collect(),
        }
    }

    /// Times, for people.
    pub(crate) fn times(&self) -> Table {
        let row = |it: &Finish| {
            let spread = it.seconds;
            let micro = |seconds: f64| format!("{:.2}", seconds * 1e6);
            vec![
                it.how.to_owned(),
                micro(spread.median),
                format!(
                    "{}–{}",
                    micro(spread.lower_quartile),
                    micro(spread.upper_quartile)
                ),
                format!("{:.3}", it.ratio.median),
                format!(
                    "{:.3}–{:.3}",
                    it.ratio.lower_quartile, it.ratio.upper_quartile
                ),
            ]
        };
        Table {
            title: "A flight of SDCOM at equal weak error".to_owned(),
            note: format!(
                "A flight of {END} s of a member in lanes, f64, on one thread: Euler–Maruyama at 1 ms, and the splitting at {:.0} ms, the \
                 greatest step of the table above at which its error is not greater. {} rounds in which each has its turn.",
                self.chosen * 1e3,
                self.rounds
            ),
            columns: vec!["scheme", "µs", "quartiles", "ratio", "quartiles"],
            rows: self.finishes.iter().map(row).collect(),
        }
    }
}
