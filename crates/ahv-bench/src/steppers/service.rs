//! Solvers in programs of their own: a line of JSON in, a line of JSON out.

use std::cell::RefCell;
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::rc::Rc;

use serde_json::{Value, json};

use super::flights::Flights;
use super::solver::{Request, Solution, Solver, steps, tolerances};

/// A running program.
pub(crate) struct Service {
    child: Child,
    answers: BufReader<ChildStdout>,
}

impl Service {
    /// Starts a program and tells it the flights.
    pub(crate) fn start(command: &mut Command, flights: &Flights) -> Result<Self, String> {
        let command = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command
            .spawn()
            .map_err(|error| format!("error: cannot run a peer: {error}"))?;
        let answers = child.stdout.take().ok_or("error: a peer has no output")?;
        let mut service = Self {
            child,
            answers: BufReader::new(answers),
        };
        service.write(&flights.json())?;
        Ok(service)
    }

    fn write(&mut self, line: &Value) -> Result<(), String> {
        let problem = |error| format!("error: a peer does not listen: {error}");
        let input = self
            .child
            .stdin
            .as_mut()
            .ok_or("error: a peer has no input")?;
        writeln!(input, "{line}").map_err(problem)
    }

    fn ask(&mut self, solver: &str, request: &Request) -> Result<Solution, String> {
        self.write(&json!({
            "solver": solver,
            "flight": request.flight,
            "setting": request.setting,
            "repeats": request.repeats,
        }))?;
        let mut line = String::new();
        let read = self.answers.read_line(&mut line);
        read.map_err(|error| format!("error: a peer does not answer: {error}"))?;
        let answer: Value = serde_json::from_str(&line)
            .map_err(|error| format!("error: a peer's answer to {solver}: {error}"))?;
        match answer["failure"].as_str() {
            Some(failure) => Err(failure.to_owned()),
            None => serde_json::from_value(answer).map_err(|error| format!("error: {error}")),
        }
    }
}

impl Drop for Service {
    /// The program ends with its input.
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}

/// Those of peers/solver-crates.
pub(crate) fn crates(service: Service) -> Vec<Solver> {
    solvers(
        service,
        vec![
            ("ode_solvers `Rk4`", "ode_solvers Rk4", steps(3, 16)),
            ("ode_solvers `Dopri5`", "ode_solvers Dopri5", tolerances()),
            ("ode_solvers `Dop853`", "ode_solvers Dop853", tolerances()),
            ("diffsol `tsit45`", "diffsol Tsit45", tolerances()),
            ("diffsol `bdf`", "diffsol BDF", tolerances()),
            ("diffsol `esdirk34`", "diffsol ESDIRK34", tolerances()),
            ("diffsol `tr_bdf2`", "diffsol TR-BDF2", tolerances()),
        ],
    )
}

/// CasADi's integrator with its default method, to which all are compared.
pub(crate) const CVODES: &str = "CasADi `cvodes`, BDF";
/// The one that the reference for errors is compared with.
pub(crate) const SCIPY: &str = "SciPy `DOP853`";

/// Those of peers/solvers_peer.py.
pub(crate) fn scripts(service: Service) -> Vec<Solver> {
    solvers(
        service,
        vec![
            (CVODES, "cvodes bdf", tolerances()),
            ("CasADi `cvodes`, Adams", "cvodes adams", tolerances()),
            (SCIPY, "scipy DOP853", tolerances()),
            ("SciPy `LSODA`", "scipy LSODA", tolerances()),
            ("SciPy `Radau`", "scipy Radau", tolerances()),
        ],
    )
}

fn solvers(service: Service, names: Vec<(&str, &'static str, Vec<f64>)>) -> Vec<Solver> {
    let service = Rc::new(RefCell::new(service));
    let solver = |(name, method, settings): (&str, &'static str, Vec<f64>)| {
        let service = Rc::clone(&service);
        Solver {
            name: name.to_owned(),
            settings,
            solve: Box::new(move |request| service.borrow_mut().ask(method, request)),
        }
    };
    names.into_iter().map(solver).collect()
}
