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
    /// Of the distance to the command, what the lag makes good in the step.
    pub(crate) const fn share(&self) -> f64 {
        self.share
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    const ELEVATOR: Actuator = Actuator {
        bandwidth: 20.0,
        rate: 0.5,
        bounds: Bounds {
            min: -0.2,
            max: 0.3,
        },
    };
    const FREE: Actuator = Actuator {
        rate: f64::INFINITY,
        ..ELEVATOR
    };

    fn near(found: (f64, Limits), position: f64, limits: Limits) {
        assert!((found.0 - position).abs() < 1e-15, "{found:?}, {position}");
        assert_eq!(found.1, limits);
    }

    /// Up and down, the distance to the command decays as exp(−ωt).
    #[test]
    fn without_limits_it_is_a_lag() {
        let left = (-20.0_f64 * 0.03).exp();
        for (from, to) in [(0.1, 0.25), (0.25, 0.1), (-0.1, 0.2), (0.2, -0.1)] {
            let found = FREE.moved(from, to, 0.03);
            near(found, to + (from - to) * left, Limits::default());
        }
    }

    /// A command beyond an end is one to the end, and is told; one to the end itself is met.
    #[test]
    fn the_position_keeps_its_bounds() {
        for (command, end, position) in [
            (1.0, 0.3, true),
            (0.3, 0.3, false),
            (-1.0, -0.2, true),
            (-0.2, -0.2, false),
        ] {
            let limits = Limits {
                position,
                rate: false,
            };
            near(FREE.moved(0.1, command, 10.0), end, limits);
        }
    }

    /// At 0.5 rad/s it moves 0.005 rad in 10 ms, if the lag asks for as much.
    #[test]
    fn it_moves_no_faster_than_its_rate() {
        let limits = Limits {
            position: false,
            rate: true,
        };
        near(ELEVATOR.moved(0.1, 0.25, 0.01), 0.105, limits);
        near(ELEVATOR.moved(0.1, -0.15, 0.01), 0.095, limits);
        let slow = 0.1 + 0.02 * -libm::expm1(-0.2);
        near(ELEVATOR.moved(0.1, 0.12, 0.01), slow, Limits::default());
    }
}
