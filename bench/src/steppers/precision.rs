//! Work and precision: what a solution costs whose measured error is a given one.

use serde::Serialize;

use super::flights::{Flights, STATES};
use super::named;
use super::own::REFERENCE;
use super::service::{CVODES, SCIPY};
use super::solver::{Request, Solution, Solver};
use crate::rounds::Spread;

/// The errors at which solvers are compared, in units of the scales.
pub(crate) const TARGETS: [f64; 2] = [1e-6, 1e-9];
/// The references may differ by a hundredth of the smallest of them.
const REFERENCE_TOLERANCE: f64 = 1e-11;
/// Tolerance of the references.
const TIGHTEST: f64 = 1e-13;
/// Runs with a greater error do not count: most are unstable.
const UNSTABLE: f64 = 1e-2;
/// Below this error nothing more is needed.
const SETTLED: f64 = 0.03 * TARGETS[1];
/// A solution that takes longer, in s, is not refined further.
const FEASIBLE: f64 = 2.0;
/// Solutions are repeated until a turn takes this long, in s.
const TURN: f64 = 2e-3;

/// What a solver takes for a flight at an error.
#[derive(Serialize)]
pub(crate) struct Work {
    pub(crate) set: &'static str,
    pub(crate) solver: String,
    pub(crate) target: f64,
    /// None where no setting came down to the error.
    pub(crate) effort: Option<Effort>,
    /// Smallest error that was measured.
    pub(crate) least_error: f64,
}

/// Interpolated between the two settings on either side of the error, or that of the coarsest setting.
#[derive(Serialize)]
pub(crate) struct Effort {
    /// The target, or the error of the coarsest setting where that is smaller.
    pub(crate) error: f64,
    /// Seconds a flight.
    pub(crate) seconds: Spread,
    /// Over the time of CVODES at the same error in the same round.
    pub(crate) ratio: Spread,
    /// Nanoseconds an accepted step.
    pub(crate) nanoseconds_a_step: f64,
    pub(crate) steps: f64,
    pub(crate) drifts: f64,
    pub(crate) jacobians: f64,
}

/// The ends of the flights.
pub(crate) struct References {
    pub(crate) states: Vec<[f64; STATES]>,
    /// Greatest difference between ours and SciPy's.
    pub(crate) difference: f64,
}

/// The ends of the flights at the tightest tolerance, by two implementations of two methods.
///
/// # Errors
/// They differ.
pub(crate) fn references(solvers: &mut [Solver]) -> Result<References, String> {
    let flights = Flights::new();
    let mut found = References {
        states: Vec::new(),
        difference: 0.0,
    };
    for flight in 0..flights.all.len() {
        let request = Request {
            flight,
            setting: TIGHTEST,
            repeats: 0,
        };
        let [own, other] = [REFERENCE, SCIPY].map(|name| {
            let solved = (named(solvers, name)?.solve)(&request)?;
            Ok::<_, String>(solved.state)
        });
        let (own, other) = (own?, other?);
        let difference = flights.distance(&own, &other);
        // Written so that NaN fails.
        if !difference.le(&REFERENCE_TOLERANCE) {
            return Err(format!("error: the references differ by {difference:.1e}"));
        }
        found.difference = found.difference.max(difference);
        found.states.push(own);
    }
    Ok(found)
}

/// A setting on one side of a target.
#[derive(Clone)]
struct Rung {
    setting: f64,
    error: f64,
    solution: Solution,
    /// Seconds a solution, one a round.
    times: Vec<f64>,
}

/// The settings of a solver on either side of each target, coarse and fine; twice the coarsest one, where that is already
/// finer than the target.
struct Ladder {
    flight: usize,
    around: [Option<[Rung; 2]>; TARGETS.len()],
    least_error: f64,
}

/// Work of every solver on every flight at every target.
pub(crate) fn measure(
    solvers: &mut [Solver],
    references: &[[f64; STATES]],
    rounds: u32,
) -> Result<Vec<Work>, String> {
    let flights = Flights::new();
    let mut ladders = Vec::new();
    for (flight, reference) in references.iter().enumerate() {
        for solver in solvers.iter_mut() {
            eprintln!("solving {} with {}", flights.all[flight].set, solver.name);
            let error = |state: &[f64; STATES]| flights.distance(state, reference);
            ladders.push(Ladder::of(solver, flight, error));
        }
    }
    let count = solvers.len();
    for round in 0..rounds as usize {
        eprintln!("timing the solvers: round {} of {rounds}", round + 1);
        for turn in 0..ladders.len() {
            // Another one begins each round, so that none always follows the same one.
            let index = (turn + round) % ladders.len();
            ladders[index].time(&mut solvers[index % count])?;
        }
    }
    let base = solvers.iter().position(|it| it.name == CVODES);
    let base = base.ok_or("error: no CVODES")?;
    let mut work = Vec::new();
    for (index, ladder) in ladders.iter().enumerate() {
        let cvodes = &ladders[index / count * count + base];
        for (which, &target) in TARGETS.iter().enumerate() {
            work.push(Work {
                set: flights.all[ladder.flight].set,
                solver: solvers[index % count].name.clone(),
                target,
                effort: ladder.effort(which, cvodes),
                least_error: ladder.least_error,
            });
        }
    }
    Ok(work)
}

impl Ladder {
    /// Solves at finer and finer settings, and keeps those around the targets.
    fn of(solver: &mut Solver, flight: usize, error: impl Fn(&[f64; STATES]) -> f64) -> Self {
        let mut rungs = Vec::new();
        for setting in solver.settings.clone() {
            let request = Request {
                flight,
                setting,
                repeats: 1,
            };
            // At coarse settings a flight may diverge, and at fine ones a solver may refuse.
            let Ok(solution) = (solver.solve)(&request) else {
                continue;
            };
            let error = error(&solution.state);
            // Written so that NaN is left out.
            if !error.le(&UNSTABLE) {
                continue;
            }
            rungs.push(Rung {
                setting,
                error,
                solution,
                times: Vec::new(),
            });
            if solution.seconds > FEASIBLE || error < SETTLED {
                break;
            }
        }
        let around = TARGETS.map(|target| {
            // The last crossing: an error that is small by chance is passed over.
            let above = rungs.iter().rposition(|it| it.error > target);
            let [coarse, fine] = above.map_or([0, 0], |above| [above, above + 1]);
            Some([rungs.get(coarse)?.clone(), rungs.get(fine)?.clone()])
        });
        Self {
            flight,
            around,
            least_error: rungs
                .iter()
                .map(|it| it.error)
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// One round of all settings.
    fn time(&mut self, solver: &mut Solver) -> Result<(), String> {
        for rung in self.around.iter_mut().flatten().flatten() {
            let repeats = (TURN / rung.solution.seconds).ceil().clamp(1.0, 1000.0);
            let request = Request {
                flight: self.flight,
                setting: rung.setting,
                repeats: repeats as u32,
            };
            rung.times.push((solver.solve)(&request)?.seconds);
        }
        Ok(())
    }

    /// Seconds at the target in each round.
    fn seconds(&self, which: usize) -> Option<Vec<f64>> {
        let [coarse, fine] = self.around[which].as_ref()?;
        let times = coarse.times.iter().zip(&fine.times);
        let at = |(&a, &b)| interpolated(TARGETS[which], [coarse.error, fine.error], [a, b]);
        Some(times.map(at).collect())
    }

    fn effort(&self, which: usize, base: &Self) -> Option<Effort> {
        let rungs @ [coarse, fine] = self.around[which].as_ref()?;
        let seconds = self.seconds(which)?;
        let base = base.seconds(which)?;
        let ratios = seconds.iter().zip(&base).map(|(own, base)| own / base);
        let errors = [coarse.error, fine.error];
        let count = |of: fn(&Solution) -> u64| {
            let counts = rungs.each_ref().map(|it| of(&it.solution) as f64);
            interpolated(TARGETS[which], errors, counts)
        };
        let steps = count(|it| it.steps);
        let ratio = Spread::of(ratios.collect());
        let seconds = Spread::of(seconds);
        Some(Effort {
            error: coarse.error.min(TARGETS[which]),
            ratio,
            nanoseconds_a_step: seconds.median * 1e9 / steps,
            seconds,
            steps,
            drifts: count(|it| it.drifts),
            jacobians: count(|it| it.jacobians),
        })
    }
}

/// What belongs to an error of `target` on the straight line of logarithms through two points; on the straight line of
/// the values themselves where one is 0. The first value, if its error is not above the target.
fn interpolated(target: f64, errors: [f64; 2], [a, b]: [f64; 2]) -> f64 {
    if errors[0] <= target {
        return a;
    }
    let [coarse, fine] = errors.map(f64::ln);
    // An error of 0 counts as the smallest number.
    let part = (target.ln() - coarse) / (fine.max(f64::MIN_POSITIVE.ln()) - coarse);
    if a > 0.0 && b > 0.0 {
        (a.ln() + part * (b.ln() - a.ln())).exp()
    } else {
        a + part * (b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::interpolated;

    #[test]
    fn a_power_law_is_interpolated_exactly() {
        // Work 3 e^(−1/4).
        let work = |error: f64| 3.0 * error.powf(-0.25);
        let found = interpolated(1e-6, [1e-5, 2e-7], [work(1e-5), work(2e-7)]);
        assert!((found / work(1e-6) - 1.0).abs() < 1e-12, "{found}");
    }

    #[test]
    fn nothing_coarser_is_made_up() {
        assert_eq!(interpolated(1e-6, [1e-8, 1e-8], [2.0, 2.0]), 2.0);
    }

    #[test]
    fn nothing_stays_nothing() {
        assert_eq!(interpolated(1e-6, [1e-5, 1e-7], [0.0, 0.0]), 0.0);
    }
}
