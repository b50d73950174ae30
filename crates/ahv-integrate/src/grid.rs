//! Runs with steps of a given length.

use ahv_core::Real;

use crate::{Failure, Progress, StepError};

/// Steps beyond which a grid is taken for a slip.
const MOST_STEPS: f64 = 1e8;

/// Equal steps, the last one shortened to end where it should.
///
/// ```
/// # use ahv_integrate::{Failure, Progress, Rk4, TimeGrid};
/// # use ahv_models::dcom;
/// # let (model, u) = (dcom::Model::new(&dcom::NOMINAL), dcom::Input::from([0.0; 3]));
/// # let x = dcom::State { velocity: 7702.0, altitude: 85e3, ..dcom::State::from([0.0; 11]) };
/// let grid = TimeGrid::new(0.0, 0.1, 0.001)?;
/// let mut progress = Progress::new(0.0, x);
/// while grid.step(&mut progress, |x, _, dt| Rk4::new(dt).step(&model, x, &u))? {}
/// assert_eq!(progress.time, 0.1);
/// # Ok::<(), Failure>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeGrid {
    begin: f64,
    end: f64,
    dt: f64,
    steps: u32,
    last: f64,
    /// Steps in a second, if that is a whole number.
    rate: Option<f64>,
}

impl TimeGrid {
    /// From `begin` to `end` with steps `dt`, in s.
    ///
    /// # Errors
    ///
    /// [`Failure::Setting`] if `dt` is not positive and finite, `begin` not finite, `end` not finite and greater, or if
    /// there would be more than 1e8 steps.
    pub fn new(begin: f64, end: f64, dt: f64) -> Result<Self, Failure> {
        let setting = |name, value, good| match good {
            true => Ok(()),
            false => Err(Failure::Setting { name, value }),
        };
        setting("step", dt, dt > 0.0 && dt.is_finite())?;
        setting("begin", begin, begin.is_finite())?;
        let duration = end - begin;
        setting("end", end, duration > 0.0 && duration.is_finite())?;
        let ratio = duration / dt;
        // 3 s / 0.01 s must be 300 steps though the quotient of the two doubles may miss 300 by rounding.
        let divides = (ratio - nearest(ratio)).abs() <= 4.0 * f64::EPSILON * ratio;
        let whole = nearest(if divides { ratio } else { ratio + 0.5 }).max(1.0);
        setting("number of steps", whole, whole <= MOST_STEPS)?;
        let last = if divides {
            dt
        } else {
            duration - (whole - 1.0) * dt
        };
        Ok(Self {
            begin,
            end,
            dt,
            steps: whole as u32,
            last,
            rate: Some(nearest(dt.recip())).filter(|&rate| rate.recip() == dt),
        })
    }

    /// Number of steps.
    pub const fn steps(&self) -> u32 {
        self.steps
    }

    /// Length of a step but the last, in s.
    pub const fn dt(&self) -> f64 {
        self.dt
    }

    /// The end, in s.
    pub const fn end(&self) -> f64 {
        self.end
    }

    /// Time in s after `steps` steps.
    pub fn time(&self, steps: u32) -> f64 {
        let count = f64::from(steps);
        match self.rate {
            _ if steps == self.steps => self.end,
            // 35 / 100 is 0.35, while 35 × 0.01 is 0.35000000000000003.
            Some(rate) => self.begin + count / rate,
            None => self.begin + count * self.dt,
        }
    }

    /// Length in s of step number `step`, counted from 0.
    pub const fn length(&self, step: u32) -> f64 {
        if step.saturating_add(1) == self.steps {
            self.last
        } else {
            self.dt
        }
    }

    /// Takes the step that is due after [`progress.accepted`](Progress::accepted) steps: `advance` takes the state over
    /// step number so-and-so of so many seconds. Returns whether there was one.
    ///
    /// # Errors
    ///
    /// [`Failure`] with the time at the start of the step; `progress` is then the last good one if `advance` leaves the
    /// state as it was, as all steppers do.
    #[inline]
    pub fn step<X, R: Real>(
        &self,
        progress: &mut Progress<X>,
        advance: impl FnOnce(&mut X, u32, f64) -> Result<(), StepError<R>>,
    ) -> Result<bool, Failure> {
        let step = progress.accepted;
        if step >= self.steps {
            return Ok(false);
        }
        advance(&mut progress.state, step, self.length(step))
            .map_err(|error| error.at(progress.time))?;
        progress.accepted = step + 1;
        progress.time = self.time(progress.accepted);
        Ok(true)
    }
}

/// The whole number nearest to `value` ≥ 0; the greatest 64-bit one beyond. `f64::round` is not in `core`.
const fn nearest(value: f64) -> f64 {
    (value + 0.5) as u64 as f64
}
