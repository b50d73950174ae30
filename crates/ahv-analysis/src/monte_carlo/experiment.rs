//! Which members are flown, and how.

use std::sync::atomic::{AtomicBool, AtomicU64};

use ahv_core::{Bounds, GeneratedModel};
use ahv_integrate::NormalStream;

use super::Loss;
use super::arithmetic::Mode;
use super::feedback::Feedback;
use super::rare::Particle;
use super::scheme::Scheme;
use crate::disperse::Draws;

/// Added to the seed of the noise, it is the seed of what members start from.
const START_SEED: u64 = 0x9E37_79B9_7F4A_7C15;

/// Members of a model, each with noise of its own.
#[derive(Clone)]
pub struct Experiment<F: GeneratedModel> {
    /// Parameters.
    pub parameters: F::ParametersOf<f64>,
    /// Parameters drawn for each member, in the place of those.
    pub dispersion: Option<Draws>,
    /// State at the start, and the standard deviation of a normal distribution about it.
    pub state: [F::StateOf<f64>; 2],
    /// Input, and the standard deviation of a normal distribution about it: held, or where actuators start.
    pub input: [F::InputOf<f64>; 2],
    /// What moves the inputs.
    pub feedback: Option<Feedback<F>>,
    /// Intervals of the states that are watched: the box of validity, and limits of one's own.
    pub watched: Vec<F::StateOf<Bounds>>,
    /// Stepper.
    pub scheme: Scheme,
    /// Arithmetic.
    pub mode: Mode,
    /// Step, in s.
    pub dt: f64,
    /// Numbers of steps after which the states are told, ascending; the flight ends with the last.
    pub snapshots: Vec<u64>,
    /// Seed of noise and dispersion.
    pub seed: u64,
}

/// What was seen of a member.
#[derive(Clone)]
pub struct Seen<F: GeneratedModel> {
    /// State and input at each snapshot that it lived to see.
    pub at: Vec<(F::StateOf<f64>, F::InputOf<f64>)>,
    /// Its last finite state.
    pub last: F::StateOf<f64>,
    /// How it ended before its time.
    pub lost: Option<Loss>,
    /// Steps after which each state was first outside its interval, for each set of intervals.
    pub left: Vec<F::StateOf<Option<u64>>>,
}

/// Counts steps, and stops the work when asked to.
#[derive(Debug, Default)]
pub struct Control {
    /// Steps of members that are done.
    pub done: AtomicU64,
    /// Whether to stop.
    pub stop: AtomicBool,
}

impl<F: GeneratedModel> Experiment<F> {
    /// Steps of a whole flight.
    pub fn steps(&self) -> u64 {
        self.snapshots.last().copied().unwrap_or(0)
    }

    /// A member at the start.
    pub(super) fn particle(&self, member: u64) -> Particle<F> {
        let seed = self.seed.wrapping_add(START_SEED);
        let normal = |channel: usize| NormalStream::new(seed, member, channel as u64).normal(0);
        let ([mut x, x_std], [mut u, u_std]) = (self.state, self.input);
        let mut channel = 0;
        let mut about = |value: &mut f64, std: f64| {
            if std != 0.0 {
                *value += std * normal(channel);
            }
            channel += 1;
        };
        F::update_state(&mut x, x_std, &mut about);
        F::update_input(&mut u, u_std, &mut about);
        Particle {
            member,
            origin: member,
            step: 0,
            x,
            u,
        }
    }
}
