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

use std::path::Path;
use std::process::Command;
use std::rc::Rc;

use serde::Serialize;

pub(crate) use flights::END;

use crate::candidates::{self, Peers};
use crate::commands;
use flights::Flights;
use group::StepTime;
use library::Steps;
use precision::Work;
use service::Service;
use solver::Solver;

/// What was measured.
#[derive(Serialize)]
pub(crate) struct Steppers {
    pub(crate) steps: Vec<StepTime>,
    pub(crate) work: Vec<Work>,
    /// Greatest difference of two references, ours and SciPy's, in units of the scales.
    pub(crate) references: f64,
    pub(crate) rounds: u32,
}

/// Builds the solvers, checks them against each other, and times them.
///
/// # Errors
/// A solver that cannot be built or that disagrees.
pub(crate) fn measure(
    root: &Path,
    python: &Path,
    out: &Path,
    peers: &Peers,
    rounds: u32,
) -> Result<Steppers, String> {
    eprintln!("building the solvers");
    let folder = out.join("casadi");
    let compiled = Steps::new(&candidates::compiled(&folder, "steps")?, &peers.casadi)?;
    let flights = Rc::new(Flights::new());
    let mut solvers = own::solvers(&flights);
    solvers.extend(compiled.solvers(&flights)?);
    let crates = Service::start(&mut Command::new(crates(root, out)?), &flights)?;
    solvers.extend(service::crates(crates));
    let mut scripts = candidates::peer(root, python, "solvers_peer");
    scripts.arg("--library").arg(folder.join("libpeer.so"));
    let scripts = Service::start(scripts.args(commands::tables(root)?), &flights)?;
    solvers.extend(service::scripts(scripts));

    eprintln!("timing steps");
    let steps = steps::measure(&compiled, rounds)?;
    let references = precision::references(&mut solvers)?;
    let work = precision::measure(&mut solvers, &references.states, rounds)?;
    Ok(Steppers {
        steps,
        work,
        references: references.difference,
        rounds,
    })
}

/// Builds the program with the solvers of other crates.
fn crates(root: &Path, out: &Path) -> Result<std::path::PathBuf, String> {
    let folder = root.join("crates/ahv-bench/peers/solver-crates");
    let target = out.join("solver-crates");
    let mut cargo = candidates::cargo(&folder, "", &target);
    commands::output(cargo.arg("--locked"))?;
    let name = format!("ahv-bench-solver-crates{}", std::env::consts::EXE_SUFFIX);
    Ok(target.join("release").join(name))
}

/// The solver of this name.
fn named<'s>(solvers: &'s mut [Solver], name: &str) -> Result<&'s mut Solver, String> {
    let found = solvers.iter_mut().find(|it| it.name == name);
    found.ok_or_else(|| format!("error: no solver {name}"))
}
