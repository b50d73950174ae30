//! What is to be flown.

/// A step of velocity and altitude, each through a command filter of third order with one triple pole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manoeuvre {
    /// When the steps come, in s.
    pub start: f64,
    /// Velocity, in ft/s.
    pub velocity: Step,
    /// Altitude, in ft.
    pub altitude: Step,
}

/// A step of one quantity with its command filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Value before the step.
    pub from: f64,
    /// What the step adds.
    pub change: f64,
    /// The filter's triple pole is −bandwidth, in rad/s.
    pub bandwidth: f64,
}

/// The commands at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// V_c, in ft/s.
    pub velocity: f64,
    /// Its rate, in ft/s².
    pub acceleration: f64,
    /// h_c, in ft.
    pub altitude: f64,
    /// Its rate, in ft/s.
    pub climb_rate: f64,
    /// Its second derivative, in ft/s².
    pub climb_acceleration: f64,
}

impl Reference {
    /// The flight path that climbs as commanded, in rad: arcsin(ḣ_c/V_c).
    pub fn gamma(&self) -> f64 {
        (self.climb_rate / self.velocity).asin()
    }
}

impl Manoeuvre {
    /// What `ahv track` flies from level flight at `velocity` (ft/s) and `altitude` (ft): 300 ft/s and 1500 ft more.
    pub const fn standard(velocity: f64, altitude: f64) -> Self {
        Self {
            start: 2.0,
            velocity: Step {
                from: velocity,
                change: 300.0,
                bandwidth: 0.12,
            },
            altitude: Step {
                from: altitude,
                change: 1500.0,
                bandwidth: 0.15,
            },
        }
    }

    /// The commands at `time`, in s.
    pub fn at(&self, time: f64) -> Reference {
        let since = (time - self.start).max(0.0);
        let [velocity, acceleration, _] = self.velocity.response(since);
        let [altitude, climb_rate, climb_acceleration] = self.altitude.response(since);
        Reference {
            velocity,
            acceleration,
            altitude,
            climb_rate,
            climb_acceleration,
        }
    }
}

impl Step {
    /// Output of the filter and its first two derivatives, `since` s after the step: from (1 + s/ω)⁻³ in closed form.
    fn response(&self, since: f64) -> [f64; 3] {
        let w = self.bandwidth;
        let t = w * since;
        let left = self.change * libm::exp(-t);
        [
            self.from + self.change - left * (1.0 + t + 0.5 * t * t),
            left * w * 0.5 * t * t,
            left * w * w * (t - 0.5 * t * t),
        ]
    }
}
