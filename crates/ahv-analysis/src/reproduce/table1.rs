//! Table 1 and Fig. 2: errors of mean and standard deviation over time.

use super::{METHODS, Size, Work};
use crate::ensemble::{Drive, Experiment, Moments, PROCESSES, Reading};
use crate::reduce::{Mode, ReduceError, ReducedMode, section_5_1};
use crate::statistics::Estimate;

/// A way to read section 5.1.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Case {
    /// Reading of the noise.
    pub reading: Reading,
    /// Noise of χ.
    pub drive: Drive,
    /// Runs of an experiment.
    pub runs: u64,
}

/// What is tried: both readings, both drives, and the number of runs that fits Table 1 best.
fn cases(size: &Size) -> [Case; 5] {
    use {Drive::*, Reading::*};
    let case = |reading, drive, runs| Case {
        reading,
        drive,
        runs,
    };
    [
        case(Held, Independent, size.runs),
        case(Held, Common, size.runs),
        case(White, Independent, size.runs),
        case(White, Common, size.runs),
        case(Held, Independent, size.runs * 2 / 5),
    ]
}

/// Table 1 by every case.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Table1 {
    /// Cases in the order in which the page shows them.
    pub cases: Vec<CaseResult>,
    /// Errors over time of the first experiment of the first and third case, by mode: Fig. 2.
    pub curves: Vec<[ErrorCurves; 3]>,
}

/// The modes in one case.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CaseResult {
    /// The case.
    pub case: Case,
    /// Results by mode.
    pub modes: [ModeResult; 3],
}

/// Errors of a mode, by method, in the order of [`METHODS`].
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ModeResult {
    /// max |e^m(t)| over repeated experiments: median with 5 % and 95 % points.
    pub mean: [Estimate; 3],
    /// max |e^D(t)| over repeated experiments: median with 5 % and 95 % points.
    pub std: [Estimate; 3],
    /// max |e^D(t)| for infinitely many runs, at the times of the samples.
    pub exact_std: [f64; 3],
}

/// Errors over time of one experiment.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ErrorCurves {
    /// Times, in s.
    pub time: Vec<f64>,
    /// e^m(t) by method.
    pub mean: [Vec<f64>; 3],
    /// e^D(t) by method.
    pub std: [Vec<f64>; 3],
    /// e^D(t) for infinitely many runs, by method.
    pub exact_std: [Vec<f64>; 3],
}

/// Runs every case.
///
/// # Errors
///
/// [`ReduceError`] for a step size without sense.
pub(super) fn run(size: &Size, work: &mut Work<'_>) -> Result<Table1, ReduceError> {
    let mut table = Table1 {
        cases: Vec::new(),
        curves: Vec::new(),
    };
    for case in cases(size) {
        let experiment = Experiment {
            reading: case.reading,
            drive: case.drive,
            runs: case.runs,
            steps: size.steps,
            dt: size.dt,
            seed: size.seed,
        };
        let modes = section_5_1();
        let exact = modes.map(|mode| exact_errors(&mode, &experiment));
        let mut curves = Vec::new();
        let mut results = Vec::new();
        for ((index, mode), exact) in (0..).zip(&modes).zip(exact) {
            let exact = exact?;
            let mut maxima = vec![[[0.0; 2]; 3]; 0];
            for repeat in 0..size.repeats {
                let moments = experiment.moments(mode, index, repeat * case.runs)?;
                let errors = errors(&moments);
                maxima.push(
                    errors
                        .each_ref()
                        .map(|error| error.each_ref().map(|e| largest(e))),
                );
                if repeat == 0 {
                    let [mean, std] =
                        [0, 1].map(|kind| errors.each_ref().map(|error| error[kind].clone()));
                    curves.push(ErrorCurves {
                        time: experiment.times(),
                        mean,
                        std,
                        exact_std: exact.clone(),
                    });
                }
                work.done(case.runs * size.steps);
            }
            results.push(summary(&maxima, &exact));
        }
        if let (true, Ok(curves)) = (
            case.drive == Drive::Independent && case.runs == size.runs,
            curves.try_into(),
        ) {
            table.curves.push(curves);
        }
        if let Ok(modes) = results.try_into() {
            table.cases.push(CaseResult { case, modes });
        }
    }
    Ok(table)
}

/// Steps of all experiments.
pub(super) fn steps(size: &Size) -> u64 {
    cases(size)
        .map(|case| 3 * case.runs * size.steps * size.repeats)
        .iter()
        .sum()
}

/// Errors of mean and of standard deviation over time, by method.
fn errors([eta, chi @ ..]: &[Moments; PROCESSES]) -> [[Vec<f64>; 2]; 3] {
    let difference = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
    chi.each_ref().map(|chi| {
        [
            difference(&eta.mean, &chi.mean),
            difference(&eta.std, &chi.std),
        ]
    })
}

fn largest(errors: &[f64]) -> f64 {
    errors
        .iter()
        .fold(0.0, |largest: f64, error| largest.max(error.abs()))
}

/// e^D(t) for infinitely many runs.
fn exact_errors(mode: &Mode, experiment: &Experiment) -> Result<[Vec<f64>; 3], ReduceError> {
    let mut errors = [Vec::new(), Vec::new(), Vec::new()];
    for (errors, method) in errors.iter_mut().zip(METHODS) {
        let reduced = ReducedMode::new(*mode, method)?;
        *errors = match experiment.reading {
            Reading::White => {
                let times = experiment.times().into_iter();
                times.map(|time| reduced.std_error_at(time)).collect()
            }
            Reading::Held => reduced.std_errors_held(experiment.dt, experiment.steps, 1)?,
        };
    }
    Ok(errors)
}

fn summary(maxima: &[[[f64; 2]; 3]], exact: &[Vec<f64>; 3]) -> ModeResult {
    let spread = |method: usize, kind: usize| {
        let sample: Vec<f64> = maxima.iter().map(|maxima| maxima[method][kind]).collect();
        Estimate::of_distribution(&sample).unwrap_or(Estimate {
            value: 0.0,
            low: 0.0,
            high: 0.0,
        })
    };
    ModeResult {
        mean: std::array::from_fn(|method| spread(method, 0)),
        std: std::array::from_fn(|method| spread(method, 1)),
        exact_std: exact.each_ref().map(|errors| largest(errors)),
    }
}
