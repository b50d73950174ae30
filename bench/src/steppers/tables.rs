//! The figures of the steppers as tables.

use super::group::{COUNT, DT};
use super::precision::{Effort, TARGETS, Work};
use super::service::CVODES;
use super::{Precision, Steppers};
use crate::table::Table;

impl Steppers {
    /// Time of a step, and work and precision of each flight.
    pub(crate) fn tables(&self) -> Vec<Table> {
        let mut tables = vec![self.step_times()];
        tables.extend(self.precision.iter().flat_map(Precision::tables));
        tables
    }

    fn step_times(&self) -> Table {
        let row = |it: &super::group::StepTime| {
            vec![
                it.model.to_owned(),
                it.stepper.to_owned(),
                it.part.to_owned(),
                format!("{:.0}", it.nanoseconds.median),
                format!("{:.0}", it.nanoseconds.min),
                format!(
                    "{:.0}–{:.0}",
                    it.nanoseconds.lower_quartile, it.nanoseconds.upper_quartile
                ),
                format!("{:.2}", it.ratio.median),
                format!(
                    "{:.2}–{:.2}",
                    it.ratio.lower_quartile, it.ratio.upper_quartile
                ),
            ]
        };
        Table {
            title: "Time of a step".to_owned(),
            note: format!(
                "Steppers with a fixed step of {DT} s, {COUNT} steps a turn, of the set 5.1; ratios to CasADi's C of \
                 the same model within each turn. `ahv`: rustc -O, thin LTO, baseline target; CasADi's C of one step: \
                 gcc -O3 -march=native, a call a step. Noise is drawn before and not part of the time; all schemes get \
                 the same numbers. `Rk4` and `ItoEulerMaruyama` end where CasADi's steps end."
            ),
            columns: vec![
                "model",
                "stepper",
                "part",
                "ns",
                "min",
                "quartiles",
                "ratio",
                "quartiles",
            ],
            rows: self.steps.iter().map(row).collect(),
        }
    }
}

impl Precision {
    fn tables(&self) -> Vec<Table> {
        let mut tables = Vec::new();
        let mut sets: Vec<&str> = self.work.iter().map(|it| it.set).collect();
        sets.dedup();
        for set in sets {
            for target in TARGETS {
                let note = if tables.is_empty() {
                    self.note()
                } else {
                    String::new()
                };
                tables.push(Table {
                    title: format!("A flight to an error of {target:.0e}, {set}"),
                    note,
                    columns: vec![
                        "solver",
                        "error",
                        "µs",
                        "quartiles",
                        "ratio",
                        "quartiles",
                        "ns a step",
                        "steps",
                        "right-hand sides",
                        "Jacobians",
                    ],
                    rows: self.rows(set, target),
                });
            }
        }
        tables
    }

    fn note(&self) -> String {
        format!(
            "One second of DCOM, open loop at held inputs, from near the level trim with ringing modes. The error is the \
             greatest of the states' at the end, in half widths of the box of validity, against the reference: \
             `Adaptive<Tsit5>` at 1e-13, from which SciPy's `DOP853` at 1e-13 differs by at most {:.0e}. Each solver \
             was run at numbers of steps that grow by thirds and halves (CasADi's loops: that double), or at tolerances √10 \
             apart (relative, and absolute in half widths), runs with errors over 1e-2 left out; time and counts are \
             interpolated, as straight lines of logarithms, between the two runs whose measured errors lie around the \
             given one. Where the coarsest run that counts is better already, it stands as it is with its error; \
             where no run is good enough (none is refined that takes 2 s), the smallest error stands alone. {} rounds in \
             which each has its turn, ratios to {CVODES} within each round. Refused steps count in the right-hand sides and the time, not in the steps. `ahv`, \
             `ode_solvers` and `diffsol` (dense nalgebra matrices) run on the generated right-hand side and Jacobian, \
             built by rustc -O, thin LTO, baseline target; CasADi's methods on its own, compiled by gcc -O3 \
             -march=native (`cvodes`: JIT, timed from Python around the integrator's call); SciPy's on CasADi's C through \
             ctypes. `cvodes` and `ode_solvers` take one absolute tolerance and solve for states in units of half \
             widths.",
            self.references, self.rounds
        )
    }

    fn rows(&self, set: &str, target: f64) -> Vec<Vec<String>> {
        let wanted = |it: &&Work| it.set == set && it.target == target;
        self.work.iter().filter(wanted).map(row).collect()
    }
}

fn row(work: &Work) -> Vec<String> {
    let mut cells = vec![work.solver.clone()];
    match &work.effort {
        Some(effort) => cells.extend(figures(effort)),
        None => {
            cells.push(format!("{:.0e} at best", work.least_error));
            cells.resize(10, String::new());
        }
    }
    cells
}

fn figures(effort: &Effort) -> [String; 9] {
    let Effort { seconds, ratio, .. } = effort;
    let micro = |seconds: f64| format!("{:.1}", seconds * 1e6);
    [
        format!("{:.0e}", effort.error),
        micro(seconds.median),
        format!(
            "{}–{}",
            micro(seconds.lower_quartile),
            micro(seconds.upper_quartile)
        ),
        format!("{:.3}", ratio.median),
        format!("{:.3}–{:.3}", ratio.lower_quartile, ratio.upper_quartile),
        format!("{:.0}", effort.nanoseconds_a_step),
        format!("{:.0}", effort.steps),
        format!("{:.0}", effort.drifts),
        format!("{:.0}", effort.jacobians),
    ]
}
