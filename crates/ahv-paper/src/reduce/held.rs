//! The errors of a reduction where the noise is a number that is drawn every so often and held.

use ahv_integrate::{LinearTransition, StepError};

use super::{Mode, ReduceError, ReducedMode};

/// Parts of a sampling period that are looked at between samples.
const BETWEEN: u32 = 16;
/// Samples after which held noise is no longer followed.
const MOST_SAMPLES: f64 = 1e5;

/// The same where white noise is sampled and held, as computers often have it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct HeldPeak {
    /// Over the times of the samples, in the unit of η.
    pub at_samples: f64,
    /// Over all times.
    pub between_samples: f64,
}

impl ReducedMode {
    /// max |D_η(t) − D_χ(t)| where a number of N(0, σ²) is drawn every `period`, in s, and held.
    ///
    /// The variances follow exactly from the transition matrices; χ is driven by such numbers too, times b/σ.
    ///
    /// # Errors
    ///
    /// [`ReduceError::Step`] unless `period` is positive and finite.
    pub fn largest_std_error_held(&self, period: f64) -> Result<HeldPeak, ReduceError> {
        let samples = (self.settling_time() / period).ceil().min(MOST_SAMPLES) as u64;
        let mut peak = HeldPeak {
            at_samples: 0.0,
            between_samples: 0.0,
        };
        self.held(period, samples, BETWEEN, |part, error| {
            peak.between_samples = peak.between_samples.max(error.abs());
            if part == BETWEEN {
                peak.at_samples = peak.at_samples.max(error.abs());
            }
        })?;
        Ok(peak)
    }

    /// D_η − D_χ under such noise: at 0 and after each of `parts` parts of each of `samples` periods.
    ///
    /// # Errors
    ///
    /// As [`Self::largest_std_error_held`].
    pub fn std_errors_held(
        &self,
        period: f64,
        samples: u64,
        parts: u32,
    ) -> Result<Vec<f64>, ReduceError> {
        let mut errors = vec![0.0];
        self.held(period, samples, parts, |_, error| errors.push(error))?;
        Ok(errors)
    }

    /// Reports the error at each of `parts` parts of each period, counted from 1.
    fn held(
        &self,
        period: f64,
        samples: u64,
        parts: u32,
        mut report: impl FnMut(u32, f64),
    ) -> Result<(), ReduceError> {
        let Mode { omega, zeta, sigma } = self.mode;
        let steps = (1..=parts).map(|part| {
            let time = period * f64::from(part) / f64::from(parts);
            let mode = LinearTransition::mode(omega, zeta, 0.0, time)?;
            let noise = LinearTransition::ornstein_uhlenbeck(self.decay(), 0.0, time)?;
            Ok((mode, noise))
        });
        let steps: Vec<_> = steps.collect::<Result<_, StepError<f64>>>()?;
        let (mut eta, mut chi) = ([[0.0; 2]; 2], [[0.0]]);
        for _ in 0..samples {
            let mut next = (eta, chi);
            for (part, (mode, noise)) in (1..).zip(&steps) {
                next = (
                    carried(mode, &eta, &[0.0, sigma]),
                    carried(noise, &chi, &[self.intensity()]),
                );
                report(part, next.0[0][0].sqrt() - next.1[0][0].sqrt());
            }
            (eta, chi) = next;
        }
        Ok(())
    }
}

/// Φ Σ Φᵀ + (Ψ c)(Ψ c)ᵀ: the covariance after a step with a held random force along `force`.
fn carried<const N: usize>(
    step: &LinearTransition<f64, N>,
    covariance: &[[f64; N]; N],
    force: &[f64; N],
) -> [[f64; N]; N] {
    let along = |row: &[f64; N], vector: &[f64; N]| -> f64 {
        row.iter().zip(vector).map(|(a, b)| a * b).sum()
    };
    let gain = step.forced().map(|row| along(&row, force));
    let transition = step.transition();
    // Σ is symmetric: its rows are its columns.
    let half = transition.map(|row| covariance.map(|column| along(&row, &column)));
    let mut next = [[0.0; N]; N];
    for ((next, half), a) in next.iter_mut().zip(&half).zip(&gain) {
        for ((next, row), b) in next.iter_mut().zip(transition).zip(&gain) {
            *next = along(row, half) + a * b;
        }
    }
    next
}
