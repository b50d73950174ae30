//! The points in time of a simulation.

use crate::failure::Failure;

/// Steps beyond which a request is taken for a slip.
const MAX_STEPS: f64 = 1e8;

/// Reads a positive, finite number.
///
/// # Errors
///
/// What is wrong, for clap to print.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        Ok(_) => Err("must be positive and finite".to_owned()),
        Err(_) => Err("is not a number of seconds".to_owned()),
    }
}

/// Equal steps, the last one shortened to end where it should.
pub(super) struct Grid {
    pub(super) steps: u64,
    pub(super) t_end: f64,
    pub(super) dt: f64,
    last: f64,
    /// Steps in a second, if that is a whole number.
    rate: Option<f64>,
}

impl Grid {
    /// A grid up to `t_end` with steps `dt`, both in s, positive and finite.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if there would be more than 1e8 steps.
    pub(super) fn new(t_end: f64, dt: f64) -> Result<Self, Failure> {
        let ratio = t_end / dt;
        // 3 s / 0.01 s must be 300 steps though the quotient of the two doubles may miss 300 by rounding.
        let divides = (ratio - ratio.round()).abs() <= 4.0 * f64::EPSILON * ratio;
        let steps = if divides { ratio.round() } else { ratio.ceil() }.max(1.0);
        if steps > MAX_STEPS {
            return Err(Failure::Request(format!(
                "--t-end {t_end} with --dt {dt} makes {steps:.3e} steps; at most {MAX_STEPS:.0e} are allowed, so take a larger --dt"
            )));
        }
        let last = if divides {
            dt
        } else {
            t_end - (steps - 1.0) * dt
        };
        let rate = Some((1.0 / dt).round()).filter(|&rate| 1.0 / rate == dt);
        Ok(Self {
            steps: steps as u64,
            t_end,
            dt,
            last,
            rate,
        })
    }

    /// Time in s after `steps` steps.
    pub(super) fn time(&self, steps: u64) -> f64 {
        match self.rate {
            _ if steps == self.steps => self.t_end,
            // 35 / 100 is 0.35, while 35 × 0.01 is 0.35000000000000003.
            Some(rate) => steps as f64 / rate,
            None => steps as f64 * self.dt,
        }
    }

    /// Length in s of step `step`, counted from 0.
    pub(super) fn step_length(&self, step: u64) -> f64 {
        if step + 1 == self.steps {
            self.last
        } else {
            self.dt
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Grid;

    fn grid(t_end: f64, dt: f64) -> Grid {
        Grid::new(t_end, dt).expect("few steps")
    }

    #[test]
    fn a_multiple_of_the_step_has_equal_steps() {
        for (t_end, dt, steps) in [
            (3.0, 0.01, 300),
            (0.3, 0.1, 3),
            (0.7, 0.001, 700),
            (1.0, 1.0, 1),
        ] {
            let grid = grid(t_end, dt);
            assert_eq!(grid.steps, steps);
            assert_eq!(grid.step_length(steps - 1), dt);
            assert_eq!(grid.time(steps), t_end);
        }
    }

    #[test]
    fn times_are_free_of_rounding_where_they_can_be() {
        let grid = grid(1.0, 0.01);
        assert_eq!(
            (grid.time(35), grid.time(57), grid.time(70)),
            (0.35, 0.57, 0.7)
        );
    }

    #[test]
    fn the_last_step_is_shortened() {
        let uneven = grid(1.0, 0.3);
        assert_eq!(
            (uneven.steps, uneven.step_length(2), uneven.time(4)),
            (4, 0.3, 1.0)
        );
        assert!((uneven.step_length(3) - 0.1).abs() < 1e-15);
        let short = grid(0.1, 5.0);
        assert_eq!((short.steps, short.step_length(0)), (1, 0.1));
    }

    #[test]
    fn absurd_counts_are_refused() {
        assert!(Grid::new(1e9, 1.0).is_err());
        assert!(Grid::new(f64::MAX, f64::MIN_POSITIVE).is_err());
        assert!(Grid::new(1e8, 1.0).is_ok());
    }
}
