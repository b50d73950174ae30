//! Solvers of other Rust crates on the generated right-hand side of DCOM: a line of JSON in, a line of JSON out.
//!
//! The first line in is the [`Problem`], every other a [`Request`]; each is answered by an [`Answer`].
#![forbid(unsafe_code)]

mod diffsol_peer;
mod ode_solvers_peer;

use std::hint::black_box;
use std::io::{self, BufRead as _, Write as _};
use std::time::Instant;

use ahv_models::dcom::{Input, Model, Parameters, State};
use serde::{Deserialize, Serialize};

/// Number of states.
const N: usize = 11;

/// What is solved.
#[derive(Deserialize)]
struct Problem {
    /// Seconds of flight.
    end: f64,
    /// What an error is measured in, and an absolute tolerance.
    scales: [f64; N],
    flights: Vec<Start>,
}

/// A set of parameters and where the flight with it starts.
#[derive(Deserialize)]
struct Start {
    parameters: Vec<f64>,
    state: [f64; N],
    input: [f64; 3],
}

/// A solver, its setting, and how often it shall solve.
#[derive(Deserialize)]
struct Request {
    flight: usize,
    solver: String,
    /// A tolerance, relative and in units of the scales; or a number of steps.
    setting: f64,
    repeats: u32,
}

/// What came out.
#[derive(Serialize)]
#[serde(untagged)]
enum Answer {
    Solved {
        /// Mean time of a solution in s.
        seconds: f64,
        #[serde(flatten)]
        solution: Solution,
    },
    Failed {
        failure: String,
    },
}

/// The end of a flight, and what it took.
#[derive(Serialize)]
struct Solution {
    state: [f64; N],
    steps: u64,
    drifts: u64,
    jacobians: u64,
}

/// A flight that is ready to be solved.
struct Flight {
    model: Model<f64>,
    state: [f64; N],
    input: Input<f64>,
    scales: [f64; N],
    end: f64,
}

fn main() -> io::Result<()> {
    let mut lines = io::stdin().lock().lines();
    let first = lines.next().transpose()?.unwrap_or_default();
    let problem: Problem = serde_json::from_str(&first)?;
    let flights: Vec<Flight> = problem
        .flights
        .iter()
        .map(|it| flight(&problem, it))
        .collect();
    for line in lines {
        let request: Request = serde_json::from_str(&line?)?;
        let answer = match flights.get(request.flight) {
            Some(flight) => answer(flight, &request),
            None => Err(format!("no flight {}", request.flight)),
        };
        let answer = answer.unwrap_or_else(|failure| Answer::Failed { failure });
        let mut out = io::stdout().lock();
        serde_json::to_writer(&mut out, &answer)?;
        writeln!(out)?;
        out.flush()?;
    }
    Ok(())
}

fn flight(problem: &Problem, start: &Start) -> Flight {
    let mut values = start.parameters.iter().copied();
    let parameters = ahv_core::Vector::from_fn(|_| values.next().unwrap_or(f64::NAN));
    let parameters: Parameters<f64> = parameters;
    let [phi, delta_e, delta_c] = start.input;
    Flight {
        model: Model::new(&parameters),
        state: start.state,
        input: Input {
            phi,
            delta_e,
            delta_c,
        },
        scales: problem.scales,
        end: problem.end,
    }
}

/// Solves once to warm up, and then as often as is asked for.
fn answer(flight: &Flight, request: &Request) -> Result<Answer, String> {
    let mut solve: Box<dyn FnMut() -> Result<Solution, String> + '_> = match request
        .solver
        .split_once(' ')
    {
        Some(("ode_solvers", method)) => ode_solvers_peer::solver(flight, method, request.setting)?,
        Some(("diffsol", method)) => diffsol_peer::solver(flight, method, request.setting)?,
        _ => return Err(format!("no solver {}", request.solver)),
    };
    let mut solution = solve()?;
    let start = Instant::now();
    for _ in 0..request.repeats {
        solution = black_box(solve()?);
    }
    let seconds = start.elapsed().as_secs_f64() / f64::from(request.repeats.max(1));
    Ok(Answer::Solved { seconds, solution })
}

/// The drift at `state`.
fn drift(flight: &Flight, state: [f64; N]) -> [f64; N] {
    ahv_core::Model::drift(&flight.model, &State::from(state), &flight.input).into()
}
