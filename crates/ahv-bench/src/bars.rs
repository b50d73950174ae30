//! What the project asks of itself, beside what was measured.

use serde::Serialize;

use crate::candidates::{LANES, PRODUCT};
use crate::modes;
use crate::monte_carlo;
use crate::race::{Finish, NUMPY};
use crate::report::Report;
use crate::rk4;
use crate::table::Table;

/// A figure that is asked for.
#[derive(Serialize)]
pub(crate) struct Bar {
    pub(crate) what: &'static str,
    pub(crate) beside: &'static str,
    pub(crate) asked: f64,
    /// Whether more is better, not less.
    pub(crate) at_least: bool,
    /// None where the peer did not run.
    pub(crate) measured: Option<f64>,
    /// What stands in the way where it is missed.
    pub(crate) why: &'static str,
}

const CASADI: &str = "CasADi C";
const ENSEMBLE: &str = "CasADi C, C++ normals";
const THREADS: usize = 2;

const OF_KERNELS: &str = "nearly half of the instructions are loads, stores and comparisons";
const OF_NOISE: &str = "normal numbers, and the set-up of each eight members for a short flight";

/// All of them.
pub(crate) fn all(report: &Report) -> Vec<Bar> {
    let mut bars = kernels(report);
    bars.extend(trajectories(&report.trajectories.finishes));
    bars.extend(ensembles(&report.monte_carlo.finishes));
    bars.extend(sections(&report.modes.finishes));
    let weak = report.weak.iter().flat_map(|it| it.finishes.last());
    let weak = weak.map(|it| it.ratio.median).next();
    bars.push(most(
        "SDCOM, splitting at the weak error of Euler–Maruyama at 1 ms",
        "that",
        0.08,
        weak,
        "",
    ));
    let rate = |threads| {
        found(
            &report.monte_carlo.finishes,
            threads,
            monte_carlo::SIDE_BY_SIDE[0],
        )
    };
    let scaling = rate(1)
        .zip(rate(2))
        .map(|(one, two)| one.seconds.median / two.seconds.median);
    bars.push(Bar {
        at_least: true,
        ..most(
            "SDCOM in lanes, rate on two threads",
            "that on one",
            1.85,
            scaling,
            "",
        )
    });
    let bound = report
        .lane_drift()
        .map(|it| it.median / report.bound.nanoseconds);
    bars.push(most(
        "DCOM drift, in lanes",
        "bound of the execution ports",
        2.0,
        bound,
        OF_KERNELS,
    ));
    bars
}

fn most(
    what: &'static str,
    beside: &'static str,
    asked: f64,
    measured: Option<f64>,
    why: &'static str,
) -> Bar {
    Bar {
        what,
        beside,
        asked,
        at_least: false,
        measured,
        why,
    }
}

fn kernels(report: &Report) -> Vec<Bar> {
    let ratio = |function: &str, candidate: &str| {
        let timings = report.timings.iter();
        let found = timings.filter(|it| it.function == function && it.candidate == candidate);
        found.map(|it| it.ratio.median).next()
    };
    let bar = |what, asked, function, candidate| {
        most(what, CASADI, asked, ratio(function, candidate), OF_KERNELS)
    };
    let [drift, jacobians] = ["dcom_drift", "dcom_drift_jacobians"];
    vec![
        bar("DCOM drift", 0.60, drift, PRODUCT),
        bar("DCOM drift, in lanes", 0.14, drift, LANES),
        bar("DCOM drift + Jacobians", 0.65, jacobians, PRODUCT),
        bar("DCOM drift + Jacobians, in lanes", 0.20, jacobians, LANES),
    ]
}

/// The first of this name on this number of threads.
fn found<'f>(finishes: &'f [Finish], threads: usize, name: &str) -> Option<&'f Finish> {
    finishes
        .iter()
        .find(|it| it.threads == threads && it.candidate == name)
}

fn trajectories(finishes: &[Finish]) -> [Bar; 2] {
    let ratio = |name| found(finishes, 1, name).map(|it| it.ratio.median);
    [
        most("RK4 of DCOM", CASADI, 0.70, ratio(rk4::PRODUCT), ""),
        most("RK4 of DCOM, in lanes", CASADI, 0.18, ratio(LANES), ""),
    ]
}

fn ensembles(finishes: &[Finish]) -> Vec<Bar> {
    let [double, single, ..] = monte_carlo::SIDE_BY_SIDE;
    let ratio = |name| found(finishes, THREADS, name).map(|it| it.ratio.median);
    let beside = |peer| {
        let peer = found(finishes, THREADS, peer);
        let own = found(finishes, THREADS, double);
        own.zip(peer)
            .map(|(own, peer)| own.seconds.median / peer.seconds.median)
    };
    let [f64_noise, f32_noise] = [
        "SDCOM Euler–Maruyama, f64 noise",
        "SDCOM Euler–Maruyama, f32 noise",
    ];
    vec![
        most(f64_noise, ENSEMBLE, 0.16, ratio(double), OF_NOISE),
        most(f32_noise, ENSEMBLE, 0.10, ratio(single), OF_NOISE),
        most(f64_noise, "JAX", 0.04, beside("JAX"), OF_NOISE),
        most(f64_noise, "numba", 0.05, beside("numba"), OF_NOISE),
    ]
}

fn sections(finishes: &[Finish]) -> [Bar; 2] {
    let numpy = found(finishes, 1, NUMPY);
    let ratio = |name| {
        let own = found(finishes, THREADS, name);
        own.zip(numpy)
            .map(|(own, peer)| own.seconds.median / peer.seconds.median)
    };
    let [double, single] = modes::SIDE_BY_SIDE;
    [
        most(
            "Section 5.1, f64 noise",
            NUMPY,
            0.11,
            ratio(double),
            OF_NOISE,
        ),
        most(
            "Section 5.1, f32 noise",
            NUMPY,
            0.055,
            ratio(single),
            OF_NOISE,
        ),
    ]
}

impl Bar {
    fn verdict(&self) -> &'static str {
        match self.measured {
            None => "",
            Some(it) if self.at_least && it >= self.asked => "met",
            Some(it) if !self.at_least && it <= self.asked => "met",
            Some(_) => "MISSED",
        }
    }
}

/// For people.
pub(crate) fn table(bars: &[Bar]) -> Table {
    let row = |it: &Bar| {
        let sign = if it.at_least { "≥" } else { "≤" };
        let verdict = it.verdict();
        let why = if verdict == "MISSED" { it.why } else { "" };
        vec![
            it.what.to_owned(),
            it.beside.to_owned(),
            format!("{sign} {}", it.asked),
            it.measured
                .map_or_else(String::new, |it| format!("{it:.3}")),
            verdict.to_owned(),
            why.to_owned(),
        ]
    };
    Table {
        title: "Bars".to_owned(),
        note: format!(
            "What the project asks of itself: time over that of a peer in the same run, medians, in the default mode without FMA, with \
             inputs passed at every call; ensembles on {THREADS} threads, except NumPy, which has one. Of each peer the compiled \
             program is compared, without its compilation and its start."
        ),
        columns: vec![
            "what",
            "beside",
            "asked",
            "measured",
            "verdict",
            "what stands in the way",
        ],
        rows: bars.iter().map(row).collect(),
    }
}
