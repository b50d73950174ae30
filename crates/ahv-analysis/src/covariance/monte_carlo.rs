//! The same spread by flying many times.

use ahv_core::{ItoCorrected, Vector};
use ahv_integrate::{ItoHeun, WienerSource};
use rayon::prelude::*;

use super::{CovarianceError, Flight};
use crate::statistics::{Estimate, mean_and_std};

/// Fewest members that a standard deviation with an interval takes.
const FEWEST: usize = 2;

/// Many flights, each with noise of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ensemble {
    /// Number of flights.
    pub members: u64,
    /// Seed of the noise.
    pub seed: u64,
}

/// What an ensemble shows of the states at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// Time, in s.
    pub time: f64,
    /// Mean of each state with its interval of 95 %.
    pub mean: Vec<Estimate>,
    /// Standard deviation of each state with its interval of 95 % (of normal numbers).
    pub std: Vec<Estimate>,
    /// Members that had not broken down by then.
    pub members: u64,
}

impl<X: Vector<f64> + Send + Sync, U: Vector<f64> + Sync> Flight<X, U> {
    /// Means and standard deviations of the states at `times`, in s, over `ensemble`, by the Heun method in the Itô sense with
    /// noise of `N` channels.
    ///
    /// Increments are functions of (seed, member, channel, step), and sums run in the order of the members: the number of
    /// threads does not matter. A member whose state is no longer finite is left out from then on.
    ///
    /// # Errors
    ///
    /// [`CovarianceError::Times`], [`CovarianceError::BrokenDown`] when fewer than 2 members are left.
    pub fn monte_carlo<M, const N: usize>(
        &self,
        model: &M,
        times: &[f64],
        ensemble: Ensemble,
    ) -> Result<Vec<Sampled>, CovarianceError>
    where
        M: ItoCorrected<Scalar = f64, State = X, Input = U> + Sync,
    {
        let steps = self.steps(times)?;
        let fly = |member: u64| -> Vec<X> {
            let mut wiener = WienerSource::<N>::new(ensemble.seed, member);
            let (mut x, mut step) = (self.start, 0);
            let mut states = Vec::with_capacity(steps.len());
            for &(count, dt) in &steps {
                for _ in 0..count {
                    let dw = wiener.increments(step, dt);
                    if ItoHeun::new(dt)
                        .step(model, &mut x, &self.input, &dw)
                        .is_err()
                    {
                        return states;
                    }
                    step += 1;
                }
                states.push(x);
            }
            states
        };
        let flights: Vec<Vec<X>> = (0..ensemble.members).into_par_iter().map(fly).collect();
        let at = |(index, &time): (usize, &f64)| {
            let states: Vec<X> = flights
                .iter()
                .filter_map(|x| x.get(index).copied())
                .collect();
            if states.len() < FEWEST {
                return Err(CovarianceError::BrokenDown {
                    time,
                    left: states.len(),
                    members: ensemble.members,
                });
            }
            let count = states.len() as f64;
            let estimates = (0..X::LEN).map(|state| {
                let sample: Vec<f64> = states.iter().filter_map(|x| x.get(state)).collect();
                let (mean, std) = mean_and_std(&sample);
                (
                    Estimate::of_mean(mean, std, count),
                    Estimate::of_std(std, count),
                )
            });
            let (mean, std) = estimates.unzip();
            Ok(Sampled {
                time,
                mean,
                std,
                members: states.len() as u64,
            })
        };
        times.iter().enumerate().map(at).collect()
    }
}
