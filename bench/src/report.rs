//! The figures for people, for programs, and for the documentation.

use std::fmt::Write as _;

use serde::Serialize;

use crate::bars::{self, Bar};
use crate::compilation;
use crate::found::Found;
use crate::generation::Generation;
use crate::interval::Interval;
use crate::operations::Operations;
use crate::picture;
use crate::process;
use crate::rounds::Spread;
use crate::subject::SUBJECTS;
use crate::table::Table;

/// Seconds that `generate` may take, and those of them that emission may.
const GENERATION_GOALS: (f64, f64) = (3.0, 0.05);

/// All figures, and the bars that they are compared with.
#[derive(Serialize)]
pub(crate) struct Report {
    #[serde(flatten)]
    pub(crate) found: Found,
    pub(crate) bars: Vec<Bar>,
}

impl Report {
    /// Of all that was measured.
    pub(crate) fn of(found: Found) -> Self {
        let bars = bars::all(&found);
        Self { found, bars }
    }

    /// For programs.
    pub(crate) fn json(&self) -> Result<String, String> {
        let text = serde_json::to_string_pretty(self);
        text.map(|text| text + "\n")
            .map_err(|error| format!("error: {error}"))
    }

    /// For a terminal.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        for (name, value) in self.found.machine.lines() {
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
        for (name, value) in self.found.machine.lines() {
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
            self.found.trajectories.table(),
        ];
        tables.extend(self.found.monte_carlo.tables());
        tables.extend(self.found.processes.as_deref().map(process::table));
        tables.extend(self.found.interval.as_ref().map(Interval::table));
        tables.push(self.found.modes.table());
        tables.extend(
            self.found
                .weak
                .iter()
                .flat_map(|it| [it.errors(), it.times()]),
        );
        let drift = self.found.lane_drift();
        tables.extend(drift.map(|it| self.found.bound.table([it.median, it.min])));
        tables.extend(self.found.steppers.tables());
        tables.extend(
            self.found
                .compilation
                .iter()
                .map(|it| compilation::table(it)),
        );
        tables.push(self.counts());
        tables.extend(self.found.generation.as_ref().map(generation));
        tables
    }

    fn agreed(&self) -> String {
        let worst = self
            .found
            .agreement
            .iter()
            .map(|it| it.worst)
            .fold(0.0, f64::max);
        format!(
            "All candidates agree at every point: the greatest difference is {worst:.1e} of the value or of its \
             component's root mean square."
        )
    }

    fn times(&self) -> Table {
        let mut rows = Vec::new();
        for subject in &SUBJECTS {
            for timing in self
                .found
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
                self.found.points, self.found.rounds
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
            rows: self.found.operations.iter().map(row).collect(),
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
