//! Flights of a model that is not named: what is flown, and what is seen of it.

use ahv_core::{Bounds, GeneratedModel, Vector};
use nalgebra::DMatrix;

use super::{values, vector};
use crate::actuator::Actuator;
use crate::covariance::Regulation;
use crate::disperse::Draws;
use crate::monte_carlo::{self, Loss, Mode, Scheme};

/// As [`monte_carlo::Experiment`].
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Parameters.
    pub parameters: Vec<f64>,
    /// Parameters drawn for each member, in the place of those.
    pub dispersion: Option<Draws>,
    /// State at the start, and the standard deviation of a normal distribution about it.
    pub state: [Vec<f64>; 2],
    /// Input, and the standard deviation of a normal distribution about it.
    pub input: [Vec<f64>; 2],
    /// What moves the inputs.
    pub feedback: Option<Feedback>,
    /// Intervals of the states that are watched.
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
}

impl Experiment {
    /// Steps of a whole flight.
    pub fn steps(&self) -> u64 {
        self.snapshots.last().copied().unwrap_or(0)
    }

    pub(super) fn typed<M: GeneratedModel>(&self) -> monte_carlo::Experiment<M> {
        let open = Bounds::new(f64::NEG_INFINITY, f64::INFINITY);
        let intervals = |bounds: &Vec<Bounds>| {
            M::StateOf::from_fn(|index| bounds.get(index).copied().unwrap_or(open))
        };
        monte_carlo::Experiment {
            parameters: vector(&self.parameters),
            dispersion: self.dispersion.clone(),
            state: [vector(&self.state[0]), vector(&self.state[1])],
            input: [vector(&self.input[0]), vector(&self.input[1])],
            feedback: self.feedback.as_ref().map(Feedback::typed),
            watched: self.watched.iter().map(intervals).collect(),
            scheme: self.scheme,
            mode: self.mode,
            dt: self.dt,
            snapshots: self.snapshots.clone(),
            seed: self.seed,
        }
    }
}

/// As [`monte_carlo::Feedback`].
#[derive(Clone, Debug)]
pub struct Feedback {
    /// State of the trim at the start.
    pub state: Vec<f64>,
    /// Rate of the trim, per second.
    pub rate: Vec<f64>,
    /// Input of the trim.
    pub input: Vec<f64>,
    /// Gain, inputs by states.
    pub gain: DMatrix<f64>,
    /// What moves each input; one without is held.
    pub actuators: Vec<Option<Actuator>>,
}

impl Feedback {
    pub(super) fn typed<M: GeneratedModel>(&self) -> monte_carlo::Feedback<M> {
        let gain = |input, state| {
            self.gain
                .get((input, state))
                .map_or(0.0, |gain: &f64| *gain)
        };
        monte_carlo::Feedback {
            state: vector(&self.state),
            rate: vector(&self.rate),
            input: vector(&self.input),
            gain: M::InputOf::from_fn(|input| M::StateOf::from_fn(|state| gain(input, state))),
            actuators: M::InputOf::from_fn(|input| self.actuators.get(input).copied().flatten()),
        }
    }

    /// As [`monte_carlo::Feedback::regulation`].
    pub fn regulation(&self) -> Regulation<Vec<f64>, Vec<f64>> {
        let bandwidth = |actuator: &Option<Actuator>| actuator.map_or(0.0, |it| it.bandwidth);
        Regulation {
            state: self.state.clone(),
            rate: self.rate.clone(),
            input: self.input.clone(),
            gain: self.gain.clone(),
            bandwidth: self.actuators.iter().map(bandwidth).collect(),
        }
    }
}

/// As [`monte_carlo::Seen`], without what it saw on the way.
#[derive(Clone, Debug)]
pub struct Seen {
    /// Its last finite state.
    pub last: Vec<f64>,
    /// How it ended before its time.
    pub lost: Option<Loss>,
    /// Steps after which each state was first outside its interval, for each set of intervals.
    pub left: Vec<Vec<Option<u64>>>,
}

impl Seen {
    pub(super) fn of<M: GeneratedModel>(seen: &monte_carlo::Seen<M>) -> Self {
        Self {
            last: values(&seen.last),
            lost: seen.lost,
            left: seen.left.iter().map(values).collect(),
        }
    }
}

/// As [`monte_carlo::Point`].
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Time, in s.
    pub time: f64,
    /// State.
    pub state: Vec<f64>,
    /// Input.
    pub input: Vec<f64>,
}
