//! The figures for people, for programs, and for the documentation.

use std::fmt::Write as _;

use serde::Serialize;

use crate::agreement::Agreement;
use crate::bars::{self, Bar};
use crate::candidates::LANES;
use crate::compilation::{self, Compilation};
use crate::generation::Generation;
use crate::interval::Interval;
use crate::machine::Machine;
use crate::modes::Modes;
use crate::monte_carlo::MonteCarlo;
use crate::operations::Operations;
use crate::picture;
use crate::ports::Bound;
use crate::process::{self, Process};
use crate::rk4::Trajectories;
use crate::steppers::Steppers;
use crate::subject::SUBJECTS;
use crate::table::Table;
use crate::timing::{Spread, Timing};
use crate::weak::Weak;

/// Seconds that `generate` may take, and those of them that emission may.
const GENERATION_GOALS: (f64, f64) = (3.0, 0.05);

/// Everything that was found.
#[derive(Serialize)]
pub(crate) struct Report {
    pub(crate) machine: Machine,
    /// With peers alone.
    pub(crate) generation: Option<Generation>,
    /// With peers alone: without them what is there already is not compiled again.
    pub(crate) compilation: Option<Vec<Compilation>>,
    pub(crate) operations: Vec<Operations>,
    pub(crate) agreement: Vec<Agreement>,
    pub(crate) points: usize,
    pub(crate) rounds: u32,
    pub(crate) timings: Vec<Timing>,
    pub(crate) steppers: Steppers,
    pub(crate) trajectories: Trajectories,
    pub(crate) monte_carlo: MonteCarlo,
    /// With peers alone.
    pub(crate) processes: Option<Vec<Process>>,
    /// With peers alone.
    pub(crate) interval: Option<Interval>,
    pub(crate) modes: Modes,
    /// With peers alone: it takes minutes.
    pub(crate) weak: Option<Weak>,
    pub(crate) bound: Bound,
    /// Of all that is above.
    pub(crate) bars: Vec<Bar>,
}

impl Report {
    /// For programs.
    pub(crate) fn json(&self) -> Result<String, String> {
        let text = serde_json::to_string_pretty(self);
        text.map(|text| text + "\n")
            .map_err(|error| format!("error: {error}"))
    }

    /// For a terminal.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        for (name, value) in self.machine.lines() {
            let _ = writeln!(text, "{name:11}  {value}");
        }
        for table in self.tables() {
            let _ = writeln!(text, "\n== {}", table.title);
            text.push_str(&table.text());
        }
        let _ = writeln!(text, "\n{}", self.agreed());
        text
    }

    /// For the documentation: the same on every run but for the figures.
    pub(crate) fn markdown(&self) -> String {
        let mut text = String::from(
            "# Benchmarks\n\nWritten by `cargo xtask bench --peers`, which measures everything below again. \
             Do not edit.\n\nTimes and their ratios vary by machine, compilers and libc, and a little from \
             run to run; counts of operations do not.\n\n## Machine\n\n",
        );
        for (name, value) in self.machine.lines() {
            let _ = writeln!(text, "* {name}: {value}");
        }
        let _ = writeln!(text, "\n![{}]({})", picture::CAPTION, picture::LINK);
        for table in self.tables() {
            let _ = writeln!(text, "\n## {}\n", table.title);
            if !table.note.is_empty() {
                let _ = writeln!(text, "{}\n", table.note);
            }
            text.push_str(&table.markdown());
        }
        let _ = writeln!(text, "\n{}", self.agreed());
        text
    }

    fn tables(&self) -> Vec<Table> {
        let mut tables = vec![
            bars::table(&self.bars),
            self.times(),
            self.trajectories.table(),
        ];
        tables.extend(self.monte_carlo.tables());
        tables.extend(self.processes.as_deref().map(process::table));
        tables.extend(self.interval.as_ref().map(Interval::table));
        tables.push(self.modes.table());
        tables.extend(self.weak.iter().flat_map(|it| [it.errors(), it.times()]));
        let drift = self.lane_drift();
        tables.extend(drift.map(|it| self.bound.table([it.median, it.min])));
        tables.extend(self.steppers.tables());
        tables.extend(self.compilation.iter().map(|it| compilation::table(it)));
        tables.push(self.counts());
        tables.extend(self.generation.as_ref().map(generation));
        tables
    }

    /// Time of a member's drift in lanes.
    pub(crate) fn lane_drift(&self) -> Option<Spread> {
        let mut timings = self.timings.iter();
        let drift = |it: &&Timing| it.function == SUBJECTS[0].symbol && it.candidate == LANES;
        timings.find(drift).map(|it| it.nanoseconds)
    }

    fn agreed(&self) -> String {
        let worst = self.agreement.iter().map(|it| it.worst).fold(0.0, f64::max);
        format!(
            "All candidates agree at every point: the greatest difference is {worst:.1e} of the value or of its \
             component's root mean square."
        )
    }

    fn times(&self) -> Table {
        let mut rows = Vec::new();
        for subject in &SUBJECTS {
            for timing in self
                .timings
                .iter()
                .filter(|it| it.function == subject.symbol)
            {
                let Spread {
                    min,
                    lower_quartile,
                    median,
                    upper_quartile,
                } = timing.nanoseconds;
                rows.push(vec![
                    subject.title.to_owned(),
                    timing.candidate.to_owned(),
                    timing.built.clone(),
                    format!("{median:.1}"),
                    format!("{min:.1}"),
                    format!("{lower_quartile:.1}–{upper_quartile:.1}"),
                    format!("{:.2}", timing.ratio.median),
                    format!(
                        "{:.2}–{:.2}",
                        timing.ratio.lower_quartile, timing.ratio.upper_quartile
                    ),
                ]);
            }
        }
        Table {
            title: "Time of an evaluation".to_owned(),
            note: format!(
                "Scalar f64 at {} random points of the box of validity, one call a point; state and input are \
                 arguments of every call, coefficients are run-time parameters for everyone. `ahv` is the \
                 default mode: baseline target, no FMA, elementary functions of `ahv-core`; gcc contracts to FMA \
                 where the machine has it, and CasADi, wrenfold, SymForce and numba use the elementary functions of libc. \
                 CasADi, ahv, wrenfold and SymForce (its statements, without Eigen) lie in shared libraries behind \
                 CasADi's C interface; numba and JAX run in Python and loop over the points themselves, after a \
                 pass that does not count; JAX derives its Jacobians by `jacfwd`. {} rounds in which each has \
                 its turn, ratios to CasADi within each round. CasADi's C (SX, `cse`) stores the non-zeros of \
                 Jacobians; all others store dense ones.",
                self.points, self.rounds
            ),
            columns: vec![
                "call",
                "candidate",
                "built with",
                "ns",
                "min",
                "quartiles",
                "ratio",
                "quartiles",
            ],
            rows,
        }
    }

    fn counts(&self) -> Table {
        let row = |it: &Operations| {
            vec![
                format!("{}: {}", it.model, it.function),
                it.ahv.to_string(),
                it.ahv_divisions.to_string(),
                it.casadi.to_string(),
                it.casadi_counted_alike.to_string(),
                it.casadi_divisions.to_string(),
                it.wrenfold
                    .map_or_else(String::new, |count| count.to_string()),
            ]
        };
        Table {
            title: "Operations".to_owned(),
note: "As the headers of the generated functions say; CasADi's are the instructions of its SX function \
             with `cse`, without inputs, outputs and constants. Counted alike: a negation is free, and sine \
             and cosine of one angle are one. ahv does what depends on parameters alone once, in `prepare`."
                .to_owned(),
            columns: vec![
                "function",
                "ahv",
                "divisions",
                "CasADi",
                "counted alike",
                "divisions",
                "wrenfold",
            ],
            rows: self.operations.iter().map(row).collect(),
        }
    }
}

fn generation(found: &Generation) -> Table {
    let Generation {
        total,
        derive,
        emit,
        ..
    } = found;
    let row = |name: &str, spread: &Spread, goal: Option<f64>| {
        vec![
            name.to_owned(),
            format!("{:.3}", spread.median),
            format!("{:.3}", spread.min),
            format!("{:.3}–{:.3}", spread.lower_quartile, spread.upper_quartile),
            goal.map_or_else(String::new, |goal| against(spread.median, goal, " s")),
        ]
    };
    Table {
        title: "Generation".to_owned(),
        note: format!(
            "`ahv generate` (release) on all tables into an empty folder, after set-up; {} runs.",
            found.runs
        ),
        columns: vec!["part", "s", "min", "quartiles", "goal"],
        rows: vec![
            row("in all", total, Some(GENERATION_GOALS.0)),
            row("derive", derive, None),
            row("emit", emit, Some(GENERATION_GOALS.1)),
        ],
    }
}

fn against(value: f64, goal: f64, unit: &str) -> String {
    let verdict = if value <= goal { "met" } else { "MISSED" };
    format!("at most {goal}{unit}: {verdict}")
}
