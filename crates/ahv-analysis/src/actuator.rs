//! Lags and limits between a command and what moves.

use ahv_core::Bounds;

/// An actuator: a lag of first order with limits of position and rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    /// Of the lag, in rad/s.
    pub bandwidth: f64,
    /// Largest speed, in the unit of the input per second.
    pub rate: f64,
    /// Limits of position, in the unit of the input.
    pub bounds: Bounds,
}

/// Which limits an actuator met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// The command lay outside the limits of position.
    pub position: bool,
    /// The lag asked for more than the largest speed.
    pub rate: bool,
}

/// An actuator over a step of fixed length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorStep {
    /// Of the distance to the command, what the lag makes good.
    share: f64,
    /// Largest move, in the unit of the input.
    most: f64,
    bounds: Bounds,
}

impl Actuator {
    /// The actuator over steps of `dt`, in s.
    pub fn over(&self, dt: f64) -> ActuatorStep {
        ActuatorStep {
            share: -libm::expm1(-self.bandwidth * dt),
            most: self.rate * dt,
            bounds: self.bounds,
        }
    }

    /// The position after `dt` s of a held `command`, from `position`. Exact where no rate is limited.
    pub fn moved(&self, position: f64, command: f64, dt: f64) -> (f64, Limits) {
        let step = self.over(dt);
        let limits = Limits {
            position: step.held(command) != command,
            rate: step.wanted(position, command).abs() > step.most,
        };
        (step.moved(position, command), limits)
    }
}

impl ActuatorStep {
    /// The position after the step, from `position`. Without branches.
    #[inline(always)]
    pub fn moved(&self, position: f64, command: f64) -> f64 {
        position + between(self.wanted(position, command), -self.most, self.most)
    }

    #[inline(always)]
    fn held(&self, command: f64) -> f64 {
        between(command, self.bounds.min, self.bounds.max)
    }

    #[inline(always)]
    fn wanted(&self, position: f64, command: f64) -> f64 {
        (self.held(command) - position) * self.share
    }
}

/// As `f64::clamp`, without its check of the ends.
#[inline(always)]
fn between(value: f64, min: f64, max: f64) -> f64 {
    let value = if value < min { min } else { value };
    if value > max { max } else { value }
}
