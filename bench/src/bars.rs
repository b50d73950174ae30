//! What the project asks of itself, beside what was measured.

use serde::Serialize;

use crate::candidates::{LANES, PRODUCT, REFERENCE};
use crate::found::Found;
use crate::modes;
use crate::monte_carlo;
use crate::process::{self, Process};
use crate::race::{Finish, NUMPY};
use crate::rk4;
use crate::rounds::Spread;
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
    pub(crate) measured: Option<Measured>,
    /// What stands in the way where it is missed.
    pub(crate) why: &'static str,
}

/// A ratio, measured on a machine that others disturb.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct Measured {
    /// Of the medians, or the median of those within the rounds.
    pub(crate) median: f64,
    /// Of the least times: the machine at its best for both.
    pub(crate) least: f64,
}

impl Measured {
    fn of(own: Spread, peer: Spread) -> Self {
        Self {
            median: own.median / peer.median,
            least: own.min / peer.min,
        }
    }

    /// With the median of the ratios within the rounds.
    fn in_rounds(own: &Finish, peer: &Finish) -> Self {
        Self {
            median: own.ratio.median,
            ..Self::of(own.seconds, peer.seconds)
        }
    }
}

const ENSEMBLE: &str = "CasADi C, C++ normals";
const THREADS: usize = 2;

const OF_LANES: &str = "what else runs on the core: a loop in lanes keeps its ports busy";
const OF_RK4: &str = "one member in a turn: of the loop with two the compiler makes no faster code";
const OF_NOISE: &str = "drift and noise increment; what normal numbers take stands below";
const OF_MODES: &str =
    "normal numbers, and the sums over runs; NumPy's numbers are by SFC64, its fastest generator";

/// All of them.
pub(crate) fn all(of: &Found) -> Vec<Bar> {
    let mut bars = kernels(of);
    bars.extend(trajectories(&of.trajectories.finishes));
    bars.extend(ensembles(&of.monte_carlo.finishes));
    bars.extend(processes(of.processes.as_deref().unwrap_or_default()));
    let interval = of.interval.as_ref().and_then(|it| {
        let [peer, _, own] = &it.finishes[..] else {
            return None;
        };
        Some(Measured::in_rounds(own, peer))
    });
    bars.push(most(
        "Interval of σ_α, 1 % wide, in closed loop, as a process",
        ENSEMBLE,
        0.05,
        interval,
        "",
    ));
    bars.extend(sections(&of.modes.finishes));
    let weak = of.weak.as_ref().and_then(|it| {
        let (peer, own) = (it.finishes.first()?, it.finishes.last()?);
        Some(Measured::in_rounds(own, peer))
    });
    bars.push(most(
        "SDCOM, splitting at the weak error of Euler–Maruyama at 1 ms",
        "that",
        0.08,
        weak,
        "",
    ));
    let rate = |threads| {
        found(
            &of.monte_carlo.finishes,
            threads,
            monte_carlo::SIDE_BY_SIDE[0],
        )
    };
    let scaling = rate(1)
        .zip(rate(2))
        .map(|(one, two)| Measured::of(one.seconds, two.seconds));
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
    let bound = of.lane_drift().map(|it| Measured {
        median: it.median / of.bound.nanoseconds,
        least: it.min / of.bound.nanoseconds,
    });
    bars.push(most(
        "DCOM drift, in lanes",
        "bound of the execution ports",
        2.0,
        bound,
        OF_LANES,
    ));
    bars
}

fn most(
    what: &'static str,
    beside: &'static str,
    asked: f64,
    measured: Option<Measured>,
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

fn kernels(of: &Found) -> Vec<Bar> {
    let ratio = |function: &str, candidate: &str| {
        let timing = |candidate| {
            let mut timings = of.timings.iter();
            timings.find(|it| it.function == function && it.candidate == candidate)
        };
        let (own, peer) = (timing(candidate)?, timing(REFERENCE)?);
        Some(Measured {
            median: own.ratio.median,
            ..Measured::of(own.nanoseconds, peer.nanoseconds)
        })
    };
    let bar = |what, asked, function, candidate| {
        most(what, REFERENCE, asked, ratio(function, candidate), OF_LANES)
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
    let ratio = |name| {
        let (own, peer) = (found(finishes, 1, name)?, found(finishes, 1, REFERENCE)?);
        Some(Measured::in_rounds(own, peer))
    };
    [
        most("RK4 of DCOM", REFERENCE, 0.70, ratio(rk4::PRODUCT), ""),
        most(
            "RK4 of DCOM, in lanes",
            REFERENCE,
            0.18,
            ratio(LANES),
            OF_RK4,
        ),
    ]
}

fn ensembles(finishes: &[Finish]) -> Vec<Bar> {
    let [double, single] = monte_carlo::SIDE_BY_SIDE;
    let ratio = |name| {
        let own = found(finishes, THREADS, name)?;
        // The first of all is what ratios are to.
        let peer = finishes.iter().find(|it| it.threads == THREADS)?;
        Some(Measured::in_rounds(own, peer))
    };
    let [f64_noise, f32_noise] = [
        "SDCOM Euler–Maruyama, f64 noise",
        "SDCOM Euler–Maruyama, f32 noise",
    ];
    vec![
        most(f64_noise, ENSEMBLE, 0.16, ratio(double), OF_NOISE),
        most(f32_noise, ENSEMBLE, 0.10, ratio(single), OF_NOISE),
    ]
}

/// The same as a process: without a start, caching what is compiled would mean nothing.
fn processes(processes: &[Process]) -> Vec<Bar> {
    let seconds = |name| {
        let found = processes.iter().find(|it| it.name == name);
        found.map(|it| it.seconds)
    };
    let [own, jax, _, numba] = process::NAMES;
    let bar = |peer, asked| {
        let ratio = seconds(own).zip(seconds(peer));
        let ratio = ratio.map(|(own, peer)| Measured::of(own, peer));
        most(
            "SDCOM Euler–Maruyama, f64 noise, as a process",
            peer,
            asked,
            ratio,
            "",
        )
    };
    vec![bar(jax, 0.04), bar(numba, 0.05)]
}

fn sections(finishes: &[Finish]) -> [Bar; 2] {
    let numpy = found(finishes, 1, NUMPY);
    let ratio = |name| {
        let own = found(finishes, THREADS, name);
        own.zip(numpy)
            .map(|(own, peer)| Measured::of(own.seconds, peer.seconds))
    };
    let [double, single] = modes::SIDE_BY_SIDE;
    [
        most(
            "Section 5.1, f64 noise",
            NUMPY,
            0.11,
            ratio(double),
            OF_MODES,
        ),
        most(
            "Section 5.1, f32 noise",
            NUMPY,
            0.055,
            ratio(single),
            OF_MODES,
        ),
    ]
}

impl Bar {
    fn verdict(&self) -> &'static str {
        let meets = |it: f64| {
            if self.at_least {
                it >= self.asked
            } else {
                it <= self.asked
            }
        };
        match self.measured {
            None => "",
            Some(it) if meets(it.median) => "met",
            Some(it) if meets(it.least) => "met at its best",
            Some(_) => "MISSED",
        }
    }
}

/// For people.
pub(crate) fn table(bars: &[Bar]) -> Table {
    let row = |it: &Bar| {
        let sign = if it.at_least { "≥" } else { "≤" };
        let verdict = it.verdict();
        let why = if verdict == "met" { "" } else { it.why };
        let shown = |of: fn(Measured) -> f64| {
            let measured = it.measured.map(of);
            measured.map_or_else(String::new, |it| format!("{it:.3}"))
        };
        vec![
            it.what.to_owned(),
            it.beside.to_owned(),
            format!("{sign} {}", it.asked),
            shown(|it| it.median),
            shown(|it| it.least),
            verdict.to_owned(),
            why.to_owned(),
        ]
    };
    Table {
        title: "Bars".to_owned(),
        note: format!(
            "What the project asks of itself: time over that of a peer in the same run, in the default mode without FMA, with inputs passed \
             at every call; ensembles on {THREADS} threads, except NumPy, which has one. Of each peer the compiled program is \
             compared, without its compilation and its start, except where a process is. Medians are of times on a machine that \
             others use too; where they share a core, what keeps it busiest suffers most. The least times are those of the machine \
             at its best, for both: a bar that they alone meet is met at its best."
        ),
        columns: vec![
            "what",
            "beside",
            "asked",
            "medians",
            "least times",
            "verdict",
            "what stands in the way",
        ],
        rows: bars.iter().map(row).collect(),
    }
}
