//! Solvers in programs of their own.

use std::cell::RefCell;
use std::rc::Rc;

use serde_json::json;

use super::solver::{Solver, steps, tolerances};
use crate::service::Service;

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
            solve: Box::new(move |request| {
                service.borrow_mut().ask(&json!({
                    "solver": method,
                    "flight": request.flight,
                    "setting": request.setting,
                    "repeats": request.repeats,
                }))
            }),
        }
    };
    names.into_iter().map(solver).collect()
}
