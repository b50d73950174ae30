//! Which members are flown, and how.

use ahv_core::Bounds;
use ahv_integrate::NormalStream;

use super::Loss;
use super::arithmetic::Mode;
use super::feedback::Feedback;
use super::scheme::Scheme;
use crate::disperse::Draws;

/// Added to the seed of the noise, it is the seed of what members start from.
const START_SEED: u64 = 0x9E37_79B9_7F4A_7C15;

/// Members of a model, each with noise of its own. Vectors are in the order of the model's names.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Parameters.
    pub parameters: Vec<f64>,
    /// Parameters drawn for each member, in the place of those.
    pub dispersion: Option<Draws>,
    /// State at the start, and the standard deviation of a normal distribution about it.
    pub state: [Vec<f64>; 2],
    /// Input, and the standard deviation of a normal distribution about it: held, or where actuators start.
    pub input: [Vec<f64>; 2],
    /// What moves the inputs.
    pub feedback: Option<Feedback>,
    /// Intervals of the states that are watched: the box of validity, and limits of one's own.
    pub watched: Vec<Vec<Bounds>>,
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
    /// Whether a linear companion flies beside each member, and makes the intervals of means and standard deviations narrower.
    pub control_variate: bool,
}

/// A member on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct Particle {
    /// Number of the member whose noise it has from here on.
    pub member: u64,
    /// Number of the member whose parameters it has.
    pub origin: u64,
    /// Steps since the start.
    pub step: u64,
    /// State.
    pub x: Vec<f64>,
    /// Input.
    pub u: Vec<f64>,
}

/// What was seen of a member.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberRecord {
    /// States at the snapshots that it lived to see, one after the other.
    pub states: Vec<f64>,
    /// States of its linear companion at all snapshots, in the same way; empty without control variate.
    pub companion: Vec<f64>,
    /// Inputs at the same.
    pub inputs: Vec<f64>,
    /// Its last finite state.
    pub last: Vec<f64>,
    /// How it ended before its time.
    pub lost: Option<Loss>,
    /// Steps after which each state was first outside its interval, for each set of intervals.
    pub left: Vec<Vec<Option<u64>>>,
}

impl MemberRecord {
    /// State at a snapshot; `None` if it did not live to see it.
    pub fn state(&self, snapshot: usize) -> Option<&[f64]> {
        row(&self.states, self.last.len(), snapshot)
    }
}

/// Row number `index` of a matrix of so many columns.
pub(super) fn row(rows: &[f64], columns: usize, index: usize) -> Option<&[f64]> {
    rows.get(index * columns..(index + 1) * columns)
}

impl Experiment {
    /// Steps of a whole flight.
    pub fn steps(&self) -> u64 {
        self.snapshots.last().copied().unwrap_or(0)
    }

    /// A member at the start.
    pub(super) fn particle(&self, member: u64) -> Particle {
        let seed = self.seed.wrapping_add(START_SEED);
        let mut channels = 0..;
        let mut about = |(&mean, &std): (&f64, &f64)| {
            let channel = channels.next().unwrap_or(0);
            if std == 0.0 {
                return mean;
            }
            mean + std * NormalStream::new(seed, member, channel).normal(0)
        };
        let ([x, x_std], [u, u_std]) = (&self.state, &self.input);
        let x = x.iter().zip(x_std).map(&mut about).collect();
        let u = u.iter().zip(u_std).map(&mut about).collect();
        Particle {
            member,
            origin: member,
            step: 0,
            x,
            u,
        }
    }
}
