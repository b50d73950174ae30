//! Figs. 3 and 4: the distributions of η and χ at a fixed time.

use ahv_analysis::statistics::{Estimate, kolmogorov_smirnov, kurtosis, mean_and_std};

use super::{METHODS, Size, Work, printed};
use crate::ensemble::{Drive, Experiment, Reading};
use crate::reduce::{ReduceError, ReducedMode, section_5_1};

/// The distributions at the time of Figs. 3 and 4.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Snapshot {
    /// Runs.
    pub runs: u64,
    /// Time, in s.
    pub time: f64,
    /// Results by mode.
    pub modes: Vec<ModeSnapshot>,
}

/// The distributions of a mode under white noise; η and χ have noises of their own.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ModeSnapshot {
    /// Standard deviation of η with its interval of 95 %, and in closed form.
    pub eta_std: (Estimate, f64),
    /// Excess kurtosis of η: 0 for a normal distribution, standard error √(24/n).
    pub eta_kurtosis: f64,
    /// What is known of χ, by method.
    pub methods: [MethodSnapshot; 3],
    /// η, run by run.
    #[serde(skip)]
    pub eta: Vec<f64>,
}

/// The distribution of χ by one method.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct MethodSnapshot {
    /// Standard deviation with its interval of 95 %, and in closed form.
    pub chi_std: (Estimate, f64),
    /// Greatest distance of the distribution functions of η and χ.
    pub distance: f64,
    /// Distance that two samples of one distribution stay below with probability 95 %.
    pub critical: f64,
    /// χ, run by run.
    #[serde(skip)]
    pub chi: Vec<f64>,
}

/// Runs the ensembles.
///
/// # Errors
///
/// [`ReduceError`] for a step size without sense.
pub(super) fn run(size: &Size, work: &mut Work<'_>) -> Result<Snapshot, ReduceError> {
    let steps = (printed::SNAPSHOT_TIME / size.dt).round() as u64;
    let experiment = Experiment {
        reading: Reading::White,
        drive: Drive::Independent,
        runs: size.snapshot_runs,
        steps,
        dt: size.dt,
        // Other numbers than those of Table 1.
        seed: size.seed.wrapping_add(1),
    };
    let count = experiment.runs as f64;
    let time = steps as f64 * size.dt;
    let mut modes = Vec::new();
    for (index, mode) in (0..).zip(section_5_1()) {
        let [eta, chi @ ..] = experiment.ends(&mode, index)?;
        // Exact transitions of linear equations: the numbers are normal.
        let estimate = |sample: &[f64]| Estimate::of_normal_std(mean_and_std(sample).1, count);
        let [printed, variance, moment] = METHODS.map(|method| ReducedMode::new(mode, method));
        let reduced = [printed?, variance?, moment?];
        let exact = reduced[0].eta_variance_at(time).sqrt();
        let mut reduced = reduced.iter();
        let methods = chi.map(|chi| {
            let (distance, critical) = kolmogorov_smirnov(&eta, &chi);
            let exact = reduced
                .next()
                .map_or(0.0, |reduced| reduced.chi_variance_at(time).sqrt());
            MethodSnapshot {
                chi_std: (estimate(&chi), exact),
                distance,
                critical,
                chi,
            }
        });
        modes.push(ModeSnapshot {
            eta_std: (estimate(&eta), exact),
            eta_kurtosis: kurtosis(&eta) - 3.0,
            methods,
            eta,
        });
        work.done(experiment.runs * steps);
    }
    Ok(Snapshot {
        runs: size.snapshot_runs,
        time,
        modes,
    })
}

/// Steps of all ensembles.
pub(super) fn steps(size: &Size) -> u64 {
    3 * size.snapshot_runs * (printed::SNAPSHOT_TIME / size.dt).round() as u64
}
