//! What looks at the members of a batch while they fly.

use ahv_core::{Bounds, GeneratedModel, Vector};

use super::lanes::{LANES, Packed};
use crate::values::values;

/// A number of steps that none has reached.
pub(super) const NEVER: u64 = u64::MAX;

/// Who looks at the members of a batch after each step.
pub(super) struct Observers<'o, F: GeneratedModel> {
    /// The box of validity, and the limits if there are any: they are looked at within the loop over steps.
    pub(super) watches: &'o mut [BoundsMonitor<F>],
    /// Whatever else.
    pub(super) other: Option<&'o mut dyn Observer<F>>,
}

impl<F: GeneratedModel> Observers<'_, F> {
    /// As [`Observer::after_step`].
    #[inline(always)]
    pub(super) fn after_step(&mut self, x: &F::StateOf<Packed>, u: &F::InputOf<Packed>, step: u64) {
        for watch in &mut *self.watches {
            watch.look(x, step);
        }
        if let Some(other) = &mut self.other {
            other.after_step(x, u, step);
        }
    }

    /// As [`Observer::close`].
    pub(super) fn close(&mut self, lane: usize) {
        self.watches.iter_mut().for_each(|watch| watch.close(lane));
        if let Some(other) = &mut self.other {
            other.close(lane);
        }
    }
}

/// Looks at the members of a batch.
pub(super) trait Observer<F: GeneratedModel> {
    /// Looks at states and inputs after `step` steps.
    fn after_step(&mut self, x: &F::StateOf<Packed>, u: &F::InputOf<Packed>, step: u64);

    /// Looks at this lane no more: its member is lost.
    fn close(&mut self, lane: usize);
}

/// Intervals of the states, and when each was left first.
pub(super) struct BoundsMonitor<F: GeneratedModel> {
    intervals: F::StateOf<Interval>,
}

/// An interval of one state.
#[derive(Clone, Copy)]
struct Interval {
    /// Ends; for a member that has left it, infinite.
    min: Packed,
    max: Packed,
    /// Steps after which the state first was outside.
    left: [u64; LANES],
}

impl Interval {
    /// Looks at this lane no more.
    fn close(&mut self, lane: usize) {
        self.min.0[lane] = f64::NEG_INFINITY;
        self.max.0[lane] = f64::INFINITY;
    }
}

impl<F: GeneratedModel> BoundsMonitor<F> {
    /// States without bounds are not watched.
    #[inline(never)]
    pub(super) fn new(bounds: &[Bounds]) -> Self {
        let open = Bounds::new(f64::NEG_INFINITY, f64::INFINITY);
        let intervals = F::StateOf::from_fn(|index| {
            let bounds = bounds.get(index).unwrap_or(&open);
            Interval {
                min: Packed::splat(bounds.min),
                max: Packed::splat(bounds.max),
                left: [NEVER; LANES],
            }
        });
        Self { intervals }
    }

    /// Steps after which a member first was outside, state by state.
    #[inline(never)]
    pub(super) fn left(&self, lane: usize) -> Vec<Option<u64>> {
        let intervals = values(&self.intervals).into_iter();
        let steps = intervals.map(|interval: Interval| interval.left[lane]);
        steps
            .map(|step| Some(step).filter(|&step| step != NEVER))
            .collect()
    }

    /// Looks at the states after `step` steps.
    #[inline(always)]
    fn look(&mut self, x: &F::StateOf<Packed>, step: u64) {
        let mut any = false;
        for lane in 0..LANES {
            let mut outside = false;
            F::zip_state(x, &self.intervals, |x, interval| {
                outside |= x.0[lane] < interval.min.0[lane];
                outside |= x.0[lane] > interval.max.0[lane];
            });
            any |= outside;
        }
        if any {
            self.note(x, step);
        }
    }

    #[cold]
    #[inline(never)]
    fn note(&mut self, x: &F::StateOf<Packed>, step: u64) {
        F::update_state(&mut self.intervals, *x, |interval, x| {
            for (lane, value) in x.0.into_iter().enumerate() {
                if value < interval.min.0[lane] || value > interval.max.0[lane] {
                    interval.left[lane] = step;
                    interval.close(lane);
                }
            }
        });
    }

    fn close(&mut self, lane: usize) {
        let all = F::StateOf::splat(lane);
        F::update_state(&mut self.intervals, all, Interval::close);
    }
}
