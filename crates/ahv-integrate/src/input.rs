//! What drives a model: constants, samples, feedback, and limits on all of them.

use ahv_core::{Bounds, Model, Outside, Real, Vector};

/// An input as a function of time and state.
///
/// It may jump or kink at [breaks](Self::next_break). No step goes across one, so that a method keeps its order;
/// `since`, the start of the step, says which piece is meant where two meet.
pub trait InputSource<M: Model> {
    /// The input at `time`, in s, of the piece that `since` begins or lies in.
    fn at(&self, since: f64, time: f64, x: &M::State) -> M::Input;

    /// The first time after `time`, in s, at which the input may jump or kink; infinity where there is none.
    #[inline]
    fn next_break(&self, _time: f64) -> f64 {
        f64::INFINITY
    }

    /// Partial derivative by time of the piece at `since`, per s; none stands for 0.
    #[inline]
    fn rate(&self, _since: f64, _x: &M::State) -> Option<M::Input> {
        None
    }

    /// Hands each component that a limit holds back at `time` to `report`, with the value that was commanded.
    #[inline]
    fn saturations(&self, _time: f64, _x: &M::State, _report: &mut dyn FnMut(Outside)) {}
}

/// The same input at all times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant<U>(pub U);

impl<M: Model> InputSource<M> for Constant<M::Input> {
    #[inline]
    fn at(&self, _: f64, _: f64, _: &M::State) -> M::Input {
        self.0
    }
}

/// A callback: the input that `F(time, state)` commands, for example a feedback controller.
///
/// The explicit methods call it at every stage, and keep their order if it is smooth.
#[derive(Clone, Copy, Debug)]
pub struct Feedback<F>(pub F);

impl<M: Model, F: Fn(f64, &M::State) -> M::Input> InputSource<M> for Feedback<F> {
    #[inline]
    fn at(&self, _: f64, time: f64, x: &M::State) -> M::Input {
        (self.0)(time, x)
    }
}

/// Samples of an input at rising times.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Samples<'a, U> {
    times: &'a [f64],
    values: &'a [U],
    first: U,
}

impl<'a, U: Copy> Samples<'a, U> {
    fn new(times: &'a [f64], values: &'a [U]) -> Option<Self> {
        let rising = times
            .iter()
            .zip(times.iter().skip(1))
            .all(|(earlier, later)| earlier < later);
        let finite = times.iter().all(|time| time.is_finite());
        let first = *values.first()?;
        (times.len() == values.len() && rising && finite).then_some(Self {
            times,
            values,
            first,
        })
    }

    /// Index of the first sample after `time`.
    #[inline]
    fn after(&self, time: f64) -> usize {
        self.times.partition_point(|&sample| sample <= time)
    }

    /// The sample that holds at `time`; the first holds before its own time too.
    #[inline]
    fn held(&self, time: f64) -> U {
        let index = self.after(time).saturating_sub(1);
        self.values.get(index).copied().unwrap_or(self.first)
    }

    #[inline]
    fn point(&self, index: usize) -> Option<(f64, U)> {
        Some((*self.times.get(index)?, *self.values.get(index)?))
    }

    #[inline]
    fn next_break(&self, time: f64) -> f64 {
        self.times
            .get(self.after(time))
            .copied()
            .unwrap_or(f64::INFINITY)
    }
}

/// Samples that hold until the next one; the first and the last hold without end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held<'a, U> {
    samples: Samples<'a, U>,
}

impl<'a, U: Copy> Held<'a, U> {
    /// `values[i]` from `times[i]`, in s, on; none unless there are as many values as times, at least one, and the
    /// times rise.
    pub fn new(times: &'a [f64], values: &'a [U]) -> Option<Self> {
        let samples = Samples::new(times, values)?;
        Some(Self { samples })
    }
}

impl<M: Model> InputSource<M> for Held<'_, M::Input> {
    #[inline]
    fn at(&self, since: f64, _: f64, _: &M::State) -> M::Input {
        self.samples.held(since)
    }

    #[inline]
    fn next_break(&self, time: f64) -> f64 {
        self.samples.next_break(time)
    }
}

/// Samples with straight lines between them; the first and the last hold without end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interpolated<'a, U> {
    samples: Samples<'a, U>,
}

impl<'a, U: Copy> Interpolated<'a, U> {
    /// `values[i]` at `times[i]`, in s; none unless there are as many values as times, at least one, and the times
    /// rise.
    pub fn new(times: &'a [f64], values: &'a [U]) -> Option<Self> {
        let samples = Samples::new(times, values)?;
        Some(Self { samples })
    }

    /// The ends of the line that holds at `since`; none where a sample holds.
    #[inline]
    fn line(&self, since: f64) -> Option<[(f64, U); 2]> {
        let after = self.samples.after(since);
        let before = self.samples.point(after.checked_sub(1)?)?;
        Some([before, self.samples.point(after)?])
    }
}

impl<M: Model> InputSource<M> for Interpolated<'_, M::Input> {
    #[inline]
    fn at(&self, since: f64, time: f64, _: &M::State) -> M::Input {
        match self.line(since) {
            Some([(t0, u0), (t1, u1)]) => {
                let part = M::Scalar::from_f64((time - t0) / (t1 - t0));
                u0.zip_with(u1, |a, b| a + part * (b - a))
            }
            None => self.samples.held(since),
        }
    }

    #[inline]
    fn next_break(&self, time: f64) -> f64 {
        self.samples.next_break(time)
    }

    #[inline]
    fn rate(&self, since: f64, _: &M::State) -> Option<M::Input> {
        let [(t0, u0), (t1, u1)] = self.line(since)?;
        let per_second = M::Scalar::from_f64(1.0 / (t1 - t0));
        Some(u0.zip_with(u1, |a, b| (b - a) * per_second))
    }
}

/// An input behind limits, such as those of actuators and throttle.
///
/// A command beyond a limit becomes the limit, and is reported by
/// [`saturations`](InputSource::saturations). NaN passes, so that it is found as a failure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saturated<S, B> {
    source: S,
    limits: B,
}

impl<S, B> Saturated<S, B> {
    /// `source` within `limits`, for example the `INPUT_BOUNDS` of a model.
    pub const fn new(source: S, limits: B) -> Self {
        Self { source, limits }
    }
}

/// `u` within `limits`, component by component; each that lies outside is handed to `report` with its value.
#[inline]
pub fn saturate<R, U, B>(u: &U, limits: &B, mut report: impl FnMut(Outside)) -> U
where
    R: Real + Into<f64>,
    U: Vector<R>,
    B: Vector<Bounds>,
{
    let mut held = *u;
    for (index, &name) in U::NAMES.iter().enumerate() {
        let (Some(component), Some(bounds)) = (u.get(index), limits.get(index)) else {
            continue;
        };
        let value: f64 = component.into();
        if bounds.contains(value) {
            continue;
        }
        if value < bounds.min {
            held.set(index, R::from_f64(bounds.min));
        } else if value > bounds.max {
            held.set(index, R::from_f64(bounds.max));
        }
        report(Outside {
            name,
            value,
            bounds,
        });
    }
    held
}

impl<M, S, B> InputSource<M> for Saturated<S, B>
where
    M: Model,
    M::Scalar: Into<f64>,
    S: InputSource<M>,
    B: Vector<Bounds>,
{
    #[inline]
    fn at(&self, since: f64, time: f64, x: &M::State) -> M::Input {
        saturate(&self.source.at(since, time, x), &self.limits, |_| ())
    }

    #[inline]
    fn next_break(&self, time: f64) -> f64 {
        self.source.next_break(time)
    }

    #[inline]
    fn rate(&self, since: f64, x: &M::State) -> Option<M::Input> {
        let mut rate = self.source.rate(since, x)?;
        let command = self.source.at(since, since, x);
        saturate(&command, &self.limits, |outside| {
            let index = <M::Input as Vector<M::Scalar>>::index_of(outside.name);
            index.and_then(|index| rate.set(index, M::Scalar::ZERO));
        });
        Some(rate)
    }

    #[inline]
    fn saturations(&self, time: f64, x: &M::State, report: &mut dyn FnMut(Outside)) {
        saturate(&self.source.at(time, time, x), &self.limits, &mut *report);
        self.source.saturations(time, x, report);
    }
}
