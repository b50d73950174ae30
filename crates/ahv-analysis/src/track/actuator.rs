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

impl Actuator {
    /// The position after `dt` s of a held `command`, from `position`. Exact where no rate is limited.
    pub fn moved(&self, position: f64, command: f64, dt: f64) -> (f64, Limits) {
        let held = command.clamp(self.bounds.min, self.bounds.max);
        let wanted = (held - position) * -libm::expm1(-self.bandwidth * dt);
        let most = self.rate * dt;
        let limits = Limits {
            position: held != command,
            rate: wanted.abs() > most,
        };
        (position + wanted.clamp(-most, most), limits)
    }
}
