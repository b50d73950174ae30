//! Peers that compute on arrays of points, members and runs, in Python.

use std::cell::RefCell;
use std::rc::Rc;

use serde::Deserialize;
use serde_json::{Value, json};

use crate::service::Service;
use crate::setting::Setting;

/// The packages, each on one thread and on two.
pub(crate) struct Arrays {
    pub(crate) numba: [Rc<RefCell<Service>>; 2],
    pub(crate) jax: [Rc<RefCell<Service>>; 2],
    /// It has one thread.
    pub(crate) numpy: Rc<RefCell<Service>>,
}

/// How a job is done.
pub(crate) struct Turn {
    pub(crate) seed: u64,
    /// Times that do not count.
    pub(crate) warm_up: u32,
    /// Times that do.
    pub(crate) repeats: u32,
    /// Whether the outcome is told.
    pub(crate) values: bool,
}

/// What came of it.
#[derive(Deserialize)]
pub(crate) struct Answer {
    /// Mean of the times that count.
    pub(crate) seconds: f64,
    /// Until it had run for the first time, less the time of a run.
    pub(crate) first: f64,
    pub(crate) values: Vec<f64>,
}

impl Turn {
    /// Once, without an answer.
    pub(crate) fn of(seed: u64) -> Self {
        Self {
            seed,
            warm_up: 0,
            repeats: 1,
            values: false,
        }
    }
}

impl Arrays {
    /// Starts all of them.
    pub(crate) fn start(setting: &Setting, problem: &Value) -> Result<Self, String> {
        let start = |package, threads| {
            let service = start(setting, package, threads, problem)?;
            Ok::<_, String>(Rc::new(RefCell::new(service)))
        };
        Ok(Self {
            numba: [start("numba", 1)?, start("numba", 2)?],
            jax: [start("jax", 1)?, start("jax", 2)?],
            numpy: start("numpy", 1)?,
        })
    }
}

fn start(
    setting: &Setting,
    package: &str,
    threads: usize,
    problem: &Value,
) -> Result<Service, String> {
    let mut script = setting.script(&format!("{package}_peer"));
    script.arg("--functions").arg(setting.out.join("casadi"));
    script.args(["--threads", &threads.to_string()]);
    Service::start(&mut script, problem)
}

/// A turn of a service that is started for it.
pub(crate) fn ask_once(
    setting: &Setting,
    package: &str,
    threads: usize,
    problem: &Value,
    job: &str,
    turn: Turn,
) -> Result<Answer, String> {
    ask(
        &RefCell::new(start(setting, package, threads, problem)?),
        job,
        turn,
    )
}

/// A turn of a service at a job.
pub(crate) fn ask(service: &RefCell<Service>, job: &str, turn: Turn) -> Result<Answer, String> {
    service.borrow_mut().ask(&json!({
        "job": job,
        "seed": turn.seed,
        "warm_up": turn.warm_up,
        "repeats": turn.repeats,
        "values": turn.values,
    }))
}
