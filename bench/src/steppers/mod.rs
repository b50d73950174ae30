//! What a step of every stepper costs, and what a flight of a given accuracy costs beside other solvers.

mod flights;
mod group;
mod library;
mod own;
mod precision;
mod service;
mod solver;
mod steps;
mod tables;

use std::process::Command;
use std::rc::Rc;

use serde::Serialize;

pub(crate) use flights::{END, Flight, Flights};
pub(crate) use group::distance;
pub(crate) use library::Steps;

use crate::commands;
use crate::service::Service;
use crate::setting::Setting;
use group::StepTime;
use precision::Work;
use solver::Solver;

/// What was measured.
#[derive(Serialize)]
pub(crate) struct Steppers {
    pub(crate) steps: Vec<StepTime>,
    /// Beside other solvers, where there are any.
    pub(crate) precision: Option<Precision>,
}

/// Flights to given errors.
#[derive(Serialize)]
pub(crate) struct Precision {
    pub(crate) work: Vec<Work>,
    /// Greatest difference of two references, ours and SciPy's, in units of the scales.
    pub(crate) references: f64,
    pub(crate) rounds: u32,
}

/// Times all steppers beside CasADi's C.
///
/// # Errors
/// A stepper that fails or disagrees.
pub(crate) fn steps(compiled: &Steps, rounds: u32) -> Result<Vec<StepTime>, String> {
    eprintln!("timing steps");
    steps::measure(compiled, rounds)
}

/// Builds the solvers, checks them against each other, and times them.
///
/// # Errors
/// A solver that cannot be built or that disagrees.
pub(crate) fn precision(
    setting: &Setting,
    compiled: &Steps,
    rounds: u32,
) -> Result<Precision, String> {
    eprintln!("building the solvers");
    let flights = Rc::new(Flights::new());
    let mut solvers = own::solvers(&flights);
    solvers.extend(compiled.solvers(&flights)?);
    let crates = Service::start(&mut Command::new(crates(setting)?), &flights.json())?;
    solvers.extend(service::crates(crates));
    let mut scripts = setting.script("solvers_peer");
    scripts
        .arg("--library")
        .arg(setting.out.join("casadi/libpeer.so"));
    let scripts = Service::start(scripts.args(setting.tables()?), &flights.json())?;
    solvers.extend(service::scripts(scripts));

    let references = precision::references(&mut solvers)?;
    let work = precision::measure(&mut solvers, &references.states, rounds)?;
    Ok(Precision {
        work,
        references: references.difference,
        rounds,
    })
}

/// Builds the program with the solvers of other crates.
fn crates(setting: &Setting) -> Result<std::path::PathBuf, String> {
    let folder = setting.peer_file("solver-crates");
    let target = setting.out.join("solver-crates");
    let mut cargo = setting.cargo("build", &folder, "", &target);
    commands::output(cargo.arg("--locked"))?;
    let name = format!("ahv-bench-solver-crates{}", std::env::consts::EXE_SUFFIX);
    Ok(target.join("release").join(name))
}

/// The solver of this name.
fn named<'s>(solvers: &'s mut [Solver], name: &str) -> Result<&'s mut Solver, String> {
    let found = solvers.iter_mut().find(|it| it.name == name);
    found.ok_or_else(|| format!("error: no solver {name}"))
}
