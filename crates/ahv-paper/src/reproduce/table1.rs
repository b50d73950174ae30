//! Table 1 and Fig. 2: errors of mean and standard deviation over time.

use std::ops::Range;

use ahv_analysis::statistics::Estimate;
use rayon::prelude::*;

use super::p_value::{PValue, Verdict};
use super::printed::TABLE_1;
use super::sample_moments::SampleMoments;
use super::{METHODS, Size, Work};
use crate::ensemble::{Drive, Experiment, Moments, PROCESSES, Reading};
use crate::reduce::{Mode, ReduceError, ReducedMode, section_5_1};

/// Periods of held noise of which Fig. 2 shows what lies between the samples.
pub const FINE_PERIODS: u64 = 40;
/// Parts of such a period.
const FINE_PARTS: u32 = 16;
/// Samples between two points of Fig. 2 after them.
const COARSE: usize = 10;
/// Points of Fig. 2 over time for white noise, and the first, in s.
const POINTS: (u32, f64) = (400, 1e-3);

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
    /// The number that Table 1 prints for the mean, in the distribution of the first method's maxima.
    pub mean_p: PValue,
    /// The same for the standard deviation.
    pub std_p: PValue,
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
    /// Times, in s, that show the first hundredths of a second too.
    pub fine_time: Vec<f64>,
    /// e^D at these times for infinitely many runs, by method.
    pub fine_exact_std: [Vec<f64>; 3],
}

/// Runs every case.
///
/// # Errors
///
/// [`ReduceError`] for a step size without sense, or too few runs.
pub(super) fn run(size: &Size, work: &mut Work<'_>) -> Result<Table1, ReduceError> {
    let mut table = Table1 {
        cases: Vec::new(),
        curves: Vec::new(),
    };
    for (number, case) in (0..).zip(cases(size)) {
        let experiment = Experiment {
            reading: case.reading,
            drive: case.drive,
            runs: case.runs,
            steps: size.steps,
            dt: size.dt,
            seed: size.seed,
        };
        let mut curves = Vec::new();
        let mut results = Vec::new();
        for ((index, mode), printed) in (0..).zip(section_5_1()).zip(TABLE_1) {
            let exact = exact_errors(&mode, &experiment)?;
            let maxima = Maxima::new(&experiment, &mode, 3 * number + index)?;
            results.push(maxima.result(size, printed, &exact, work));
            if shown(&case, size) {
                curves.push(error_curves(&experiment, &mode, index, exact)?);
                work.done(case.runs * size.steps);
            }
        }
        if let Ok(curves) = curves.try_into() {
            table.curves.push(curves);
        }
        if let Ok(modes) = results.try_into() {
            table.cases.push(CaseResult { case, modes });
        }
    }
    Ok(table)
}

/// Whether Fig. 2 shows an experiment of the case.
fn shown(case: &Case, size: &Size) -> bool {
    case.drive == Drive::Independent && case.runs == size.runs
}

/// Steps of all experiments.
pub(super) fn steps(size: &Size) -> u64 {
    let drawn = 2 * size.repeats + size.most_repeats.max(size.repeats);
    let flown = |case: &Case| {
        if shown(case, size) { case.runs } else { 0 }
    };
    let cases = cases(size);
    let steps = cases
        .iter()
        .map(|case| 3 * size.steps * (drawn + flown(case)));
    steps.sum()
}

/// Draws of the greatest errors of a mode in a case.
struct Maxima {
    laws: [SampleMoments; 3],
    seed: u64,
    channel: u64,
}

impl Maxima {
    fn new(experiment: &Experiment, mode: &Mode, number: u64) -> Result<Self, ReduceError> {
        let [printed, variance, moment] =
            METHODS.map(|method| SampleMoments::new(experiment, &ReducedMode::new(*mode, method)?));
        Ok(Self {
            laws: [printed?, variance?, moment?],
            // Other numbers than those of the other figures.
            seed: experiment.seed.wrapping_add(3),
            channel: 3 * number,
        })
    }

    fn draw(&self, method: usize, repeats: Range<u64>) -> Vec<[f64; 2]> {
        let channel = self.channel + method as u64;
        let draws = repeats.into_par_iter();
        draws
            .map(|repeat| self.laws[method].maxima(self.seed, repeat, channel))
            .collect()
    }

    /// The result for a mode: of the method that Table 1 is about, as many draws as its verdicts need.
    fn result(
        &self,
        size: &Size,
        printed: (f64, f64),
        exact: &[Vec<f64>; 3],
        work: &mut Work<'_>,
    ) -> ModeResult {
        let mut maxima = [0, 1, 2].map(|method| self.draw(method, 0..size.repeats));
        work.done(3 * size.repeats * size.steps);
        let kind = |sample: &[[f64; 2]], kind: usize| -> Vec<f64> {
            sample.iter().map(|maxima| maxima[kind]).collect()
        };
        let mut drawn = size.repeats;
        let [mean_p, std_p] = loop {
            let values = [(0, printed.0), (1, printed.1)]
                .map(|(place, number)| PValue::new(&kind(&maxima[0], place), number));
            let decided = values.iter().all(|it| it.verdict != Verdict::Undecided);
            if decided || drawn >= size.most_repeats {
                break values;
            }
            let next = (2 * drawn).min(size.most_repeats);
            maxima[0].extend(self.draw(0, drawn..next));
            work.done((next - drawn) * size.steps);
            drawn = next;
        };
        // What was not needed is done too.
        work.done(size.most_repeats.saturating_sub(drawn) * size.steps);
        let spread = |method: usize, place: usize| {
            Estimate::of_distribution(&kind(&maxima[method], place)).unwrap_or(Estimate {
                value: 0.0,
                low: 0.0,
                high: 0.0,
            })
        };
        ModeResult {
            mean: std::array::from_fn(|method| spread(method, 0)),
            std: std::array::from_fn(|method| spread(method, 1)),
            exact_std: exact.each_ref().map(|errors| largest(errors)),
            mean_p,
            std_p,
        }
    }
}

/// One experiment whose runs are flown.
fn error_curves(
    experiment: &Experiment,
    mode: &Mode,
    index: u64,
    exact_std: [Vec<f64>; 3],
) -> Result<ErrorCurves, ReduceError> {
    let errors = errors(&experiment.moments(mode, index, 0)?);
    let [mean, std] = [0, 1].map(|kind| errors.each_ref().map(|error| error[kind].clone()));
    let (fine_time, fine_exact_std) = fine_errors(mode, experiment, &exact_std)?;
    Ok(ErrorCurves {
        time: experiment.times(),
        mean,
        std,
        exact_std,
        fine_time,
        fine_exact_std,
    })
}

/// Times that show the first hundredths of a second too, and e^D for infinitely many runs there.
fn fine_errors(
    mode: &Mode,
    experiment: &Experiment,
    at_samples: &[Vec<f64>; 3],
) -> Result<(Vec<f64>, [Vec<f64>; 3]), ReduceError> {
    let [printed, variance, moment] = METHODS.map(|method| ReducedMode::new(*mode, method));
    let reduced = [printed?, variance?, moment?];
    if experiment.reading == Reading::White {
        let (points, first) = POINTS;
        let end = experiment.steps as f64 * experiment.dt;
        let place = |index: u32| (end / first).powf(f64::from(index) / f64::from(points));
        let times: Vec<f64> = (0..=points).map(|index| first * place(index)).collect();
        let errors = reduced.map(|reduced| {
            let errors = times.iter().map(|&time| reduced.std_error_at(time));
            errors.collect()
        });
        return Ok((times, errors));
    }
    let (periods, parts) = (FINE_PERIODS.min(experiment.steps), FINE_PARTS);
    let late = || (periods as usize + 1..=experiment.steps as usize).step_by(COARSE);
    let part = experiment.dt / f64::from(parts);
    let mut times: Vec<f64> = (1..=periods * u64::from(parts))
        .map(|index| index as f64 * part)
        .collect();
    times.extend(late().map(|sample| sample as f64 * experiment.dt));
    let mut errors = [Vec::new(), Vec::new(), Vec::new()];
    for ((errors, reduced), samples) in errors.iter_mut().zip(&reduced).zip(at_samples) {
        let early = reduced.std_errors_held(experiment.dt, periods, parts)?;
        errors.extend(early.into_iter().skip(1));
        errors.extend(late().filter_map(|sample| samples.get(sample).copied()));
    }
    Ok((times, errors))
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

#[cfg(test)]
mod tests {
    use super::{Maxima, PValue, TABLE_1, Verdict};
    use crate::ensemble::{Drive, Experiment, Reading};
    use crate::reduce::section_5_1;

    /// One noise for η and χ, e^D of mode 1: 60 experiments put the printed 0.03 outside, by chance; 6000 have the 5 % and 95 %
    /// points 0.0298 and 0.0323 (`science.md`, section 3).
    #[test]
    fn a_verdict_is_not_a_chance_of_few_experiments() {
        let experiment = Experiment {
            reading: Reading::Held,
            drive: Drive::Common,
            runs: 1000,
            steps: 1000,
            dt: 0.01,
            seed: 1,
        };
        let [mode, ..] = section_5_1();
        let maxima = Maxima::new(&experiment, &mode, 0).expect("laws");
        let draws = maxima.draw(0, 0..6000);
        let sample: Vec<f64> = draws.iter().map(|&[_, std]| std).collect();
        let p = |count: usize| PValue::new(&sample[..count], TABLE_1[0].1);
        assert_eq!(p(60).verdict, Verdict::Undecided);
        assert_eq!(p(6000).verdict, Verdict::Inside, "{:?}", p(6000));
        let spread = ahv_analysis::statistics::Estimate::of_distribution(&sample).expect("draws");
        for (found, checked) in [(spread.low, 0.0298), (spread.high, 0.0323)] {
            assert!((found - checked).abs() < 1.5e-4, "{spread:?}");
        }
    }
}
