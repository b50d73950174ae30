//! Fig. 5: the mode and its reduction (25) under the input (37), a sine with noise.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use ahv_analysis::statistics::{Estimate, mean_and_std};
use ahv_integrate::{LinearTransition, NormalStream};
use rayon::prelude::*;

use super::{METHODS, Size, Work, printed};
use crate::ensemble::Reading;
use crate::reduce::{Mode, ReduceError, ReducedMode, section_5_1};
use ahv_analysis::statistics::deviation_of;

/// η, η̇, χ by each method, and the sine and cosine that drive.
const STATES: usize = 7;
/// Channels of noise that a mode may use.
const CHANNELS: u64 = 8;

/// Fig. 5 by mode and reading of the noise.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Forced {
    /// Runs behind the estimates.
    pub runs: u64,
    /// Results: white noise first, then held; by mode.
    pub readings: [(Reading, Vec<ForcedMode>); 2],
}

/// A mode under its force; η and χ have the same noise.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ForcedMode {
    /// Root mean square of η over the last period of the sine, averaged over the runs.
    pub eta_rms: f64,
    /// The same of η̂ − η by method: over the runs with an interval of 95 %, and in closed form (white noise only).
    pub error_rms: [(Estimate, Option<f64>); 3],
    /// Part of it that the sine alone makes, for (25) follows it without lag: in closed form.
    pub error_rms_without_noise: f64,
    /// Times of the first run, in s.
    pub time: Vec<f64>,
    /// η of the first run.
    pub eta: Vec<f64>,
    /// η̂ of the first run, by method.
    pub eta_hat: [Vec<f64>; 3],
}

/// Runs both readings.
///
/// # Errors
///
/// [`ReduceError`] for a step size without sense.
pub(super) fn run(size: &Size, work: &mut Work<'_>) -> Result<Forced, ReduceError> {
    let mut run = |reading| {
        let modes = section_5_1().into_iter().zip(printed::INPUT_37).zip(0..);
        let modes = modes.map(|((mode, (amplitude, sigma)), index)| {
            let force = Force {
                mode: Mode { sigma, ..mode },
                amplitude,
                reading,
                channel: CHANNELS * index,
            };
            let result = force.run(size);
            work.done(size.forced_runs * size.steps);
            result
        });
        Ok::<_, ReduceError>((reading, modes.collect::<Result<_, _>>()?))
    };
    Ok(Forced {
        runs: size.forced_runs,
        readings: [run(Reading::White)?, run(Reading::Held)?],
    })
}

/// Steps of all runs.
pub(super) fn steps(size: &Size) -> u64 {
    2 * 3 * size.forced_runs * size.steps
}

/// A mode and what drives it.
struct Force {
    mode: Mode,
    amplitude: f64,
    reading: Reading,
    channel: u64,
}

/// η and η̂ by method, after a step.
type Row = [f64; 4];

impl Force {
    fn run(&self, size: &Size) -> Result<ForcedMode, ReduceError> {
        let [printed, variance, moment] = METHODS.map(|method| ReducedMode::new(self.mode, method));
        let reduced = [printed?, variance?, moment?];
        let (step, intensities) = self.transition(&reduced, size.dt)?;
        let period = ((TAU / size.dt).round() as usize).min(size.steps as usize);
        // Seeds of their own, as for the other figures.
        let seed = size.seed.wrapping_add(2);
        let squares: Vec<Row> = (0..size.forced_runs)
            .into_par_iter()
            .map(|member| {
                let rows = self.path(&step, &intensities, size.steps, seed, member);
                let last = rows.iter().rev().take(period);
                let mut sums = [0.0; 4];
                for &[eta, hats @ ..] in last {
                    let [p, v, m] = hats.map(|hat| (hat - eta) * (hat - eta));
                    for (sum, square) in sums.iter_mut().zip([eta * eta, p, v, m]) {
                        *sum += square / period as f64;
                    }
                }
                sums
            })
            .collect();
        let lag = self.rms_of_lag();
        let rms = |process: usize| {
            let sample: Vec<f64> = squares.iter().map(|row| row[process]).collect();
            let (mean, std) = mean_and_std(&sample);
            let squares = Estimate::of_mean(mean, std, sample.len() as f64);
            let root = deviation_of;
            Estimate {
                value: root(squares.value),
                low: root(squares.low),
                high: root(squares.high),
            }
        };
        let mut error_rms = [(rms(0), None); 3];
        for ((process, error), reduced) in (1..).zip(&mut error_rms).zip(&reduced) {
            let exact = match self.reading {
                Reading::White => Some((noise_error_variance(reduced)? + lag * lag).sqrt()),
                Reading::Held => None,
            };
            *error = (rms(process), exact);
        }
        let first = self.path(&step, &intensities, size.steps, seed, 0);
        let column = |process: usize| first.iter().map(|row| row[process]).collect::<Vec<f64>>();
        Ok(ForcedMode {
            eta_rms: rms(0).value,
            error_rms,
            error_rms_without_noise: lag,
            time: (1..=size.steps).map(|step| step as f64 * size.dt).collect(),
            eta: column(0),
            eta_hat: [column(1), column(2), column(3)],
        })
    }

    /// The transition over a step, and the intensities of the noise of each state.
    fn transition(
        &self,
        reduced: &[ReducedMode; 3],
        dt: f64,
    ) -> Result<(LinearTransition<f64, STATES>, [f64; STATES]), ReduceError> {
        let Mode { omega, zeta, sigma } = self.mode;
        let mut a = [[0.0; STATES]; STATES];
        a[0][1] = 1.0;
        a[1] = [
            -omega * omega,
            -2.0 * zeta * omega,
            0.0,
            0.0,
            0.0,
            self.amplitude,
            0.0,
        ];
        (a[5][6], a[6][5]) = (1.0, -1.0);
        let mut intensities = [0.0; STATES];
        intensities[1] = sigma;
        for (state, reduced) in (2..).zip(reduced) {
            a[state][state] = -reduced.decay();
            intensities[state] = reduced.intensity();
        }
        let noise = match self.reading {
            Reading::White => intensities.map(|row| intensities.map(|column| row * column)),
            Reading::Held => [[0.0; STATES]; STATES],
        };
        Ok((LinearTransition::new(a, noise, dt)?, intensities))
    }

    fn path(
        &self,
        transition: &LinearTransition<f64, STATES>,
        intensities: &[f64; STATES],
        steps: u64,
        seed: u64,
        member: u64,
    ) -> Vec<Row> {
        // Five states have noise.
        let mut streams: [NormalStream; 5] = std::array::from_fn(|channel| {
            NormalStream::new(seed, member, self.channel + channel as u64)
        });
        let mut x = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let stiffness = self.mode.omega * self.mode.omega;
        let rows = (0..steps).map(|step| {
            let (mut force, mut normals) = ([0.0; STATES], [0.0; STATES]);
            match self.reading {
                Reading::White => {
                    for (normal, stream) in normals.iter_mut().zip(&mut streams) {
                        *normal = stream.normal(step);
                    }
                }
                Reading::Held => {
                    let held = streams[0].normal(step);
                    force = intensities.map(|intensity| intensity * held);
                }
            }
            x = transition.step(&x, &force, &normals);
            let [eta, _, p, v, m, sine, _] = x;
            let slow = self.amplitude * sine / stiffness;
            [eta, slow + p, slow + v, slow + m]
        });
        rows.collect()
    }

    /// Root mean square of N/ω² − η for the sine alone, when the mode's own motion has died away.
    fn rms_of_lag(&self) -> f64 {
        let Mode { omega, zeta, .. } = self.mode;
        let stiffness = omega * omega;
        // η = A/(ω² − 1 + 2iζω) against A/ω² at 1 rad/s: the difference is A(−1 + 2iζω)/(ω²(ω² − 1 + 2iζω)).
        let over = 1.0_f64.hypot(2.0 * zeta * omega);
        let under = stiffness * (stiffness - 1.0).hypot(2.0 * zeta * omega);
        FRAC_1_SQRT_2 * self.amplitude * over / under
    }
}

/// Stationary variance of χ − η where both have the same white noise.
fn noise_error_variance(reduced: &ReducedMode) -> Result<f64, ReduceError> {
    let Mode { omega, zeta, sigma } = reduced.mode;
    let joint = LinearTransition::mode_and_coloured_noise(
        [omega, zeta, sigma],
        [reduced.decay(), reduced.intensity()],
        reduced.settling_time(),
    )?;
    let [[eta, _, both], _, [_, _, chi]] = *joint.covariance();
    Ok(eta + chi - 2.0 * both)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{Force, Reading, Size};
    use crate::reduce::Mode;

    /// A mode not far from the sine, with next to no noise: over its last period the first run shows the lag alone.
    #[test]
    fn without_noise_the_lag_is_left() {
        let (omega, zeta, sigma) = (2.0, 0.4, 1e-9);
        let force = Force {
            mode: Mode { omega, zeta, sigma },
            amplitude: 3.0,
            reading: Reading::White,
            channel: 0,
        };
        let size = Size {
            forced_runs: 1,
            steps: 5000,
            dt: TAU / 500.0,
            ..Size::PAPER
        };
        let flown = force.run(&size).expect("a mode");
        for (error, _) in flown.error_rms {
            let ratio = error.value / flown.error_rms_without_noise;
            assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
        }
    }
}
