//! Events: where a function of time and state passes zero.

use ahv_core::{Model, Vector};

use crate::{Dense, Failure};

/// Which passage of zero counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// From below to above.
    Rising,
    /// From above to below.
    Falling,
    /// Either.
    Either,
    /// From above to below; a run that starts at 0 or below is refused. The function is what is left to a limit.
    Limit,
}

impl Crossing {
    fn passed(self, before: f64, after: f64) -> bool {
        let rising = before < 0.0 && after >= 0.0;
        let falling = before > 0.0 && after <= 0.0;
        match self {
            Self::Rising => rising,
            Self::Falling | Self::Limit => falling,
            Self::Either => rising || falling,
        }
    }
}

/// Something that happens where a function of time and state passes zero.
pub trait Event<M: Model> {
    /// Its name, for reports.
    fn name(&self) -> &'static str;

    /// The function; continuous over a step, in any unit.
    fn value(&self, time: f64, x: &M::State) -> f64;

    /// Which passage counts.
    fn crossing(&self) -> Crossing {
        Crossing::Limit
    }

    /// Whether the run ends there.
    fn ends_run(&self) -> bool {
        true
    }
}

/// An event of the user's own, from a function.
#[derive(Clone, Copy, Debug)]
pub struct When<F> {
    name: &'static str,
    value: F,
    crossing: Crossing,
    ends_run: bool,
}

impl<F> When<F> {
    /// Ends the run where `value(time, state)` passes zero as `crossing` says.
    pub const fn new(name: &'static str, crossing: Crossing, value: F) -> Self {
        Self {
            name,
            value,
            crossing,
            ends_run: true,
        }
    }

    /// Ends the run where `margin(time, state)`, what is left to a limit, is used up: for example the greatest
    /// dynamic pressure minus the present one.
    pub const fn limit(name: &'static str, margin: F) -> Self {
        Self::new(name, Crossing::Limit, margin)
    }

    /// Tells the observer, and lets the run go on.
    #[must_use]
    pub fn only_reported(mut self) -> Self {
        self.ends_run = false;
        self
    }
}

impl<M: Model, F: Fn(f64, &M::State) -> f64> Event<M> for When<F> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn value(&self, time: f64, x: &M::State) -> f64 {
        (self.value)(time, x)
    }

    fn crossing(&self) -> Crossing {
        self.crossing
    }

    fn ends_run(&self) -> bool {
        self.ends_run
    }
}

/// A limit on one component: an altitude floor, the greatest angle of attack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComponentLimit {
    name: &'static str,
    index: usize,
    limit: f64,
    sign: f64,
}

impl ComponentLimit {
    /// Ends the run where `component` of the state of `M` falls to `limit`, in its own unit; none if there is no such
    /// component.
    pub fn at_least<M: Model>(name: &'static str, component: &str, limit: f64) -> Option<Self> {
        Self::new::<M>(name, component, limit, 1.0)
    }

    /// Ends the run where `component` of the state of `M` rises to `limit`, in its own unit; none if there is no such
    /// component.
    pub fn at_most<M: Model>(name: &'static str, component: &str, limit: f64) -> Option<Self> {
        Self::new::<M>(name, component, limit, -1.0)
    }

    fn new<M: Model>(name: &'static str, component: &str, limit: f64, sign: f64) -> Option<Self> {
        let index = <M::State as Vector<M::Scalar>>::index_of(component)?;
        Some(Self {
            name,
            index,
            limit,
            sign,
        })
    }
}

impl<M: Model> Event<M> for ComponentLimit
where
    M::Scalar: Into<f64>,
{
    fn name(&self) -> &'static str {
        self.name
    }

    fn value(&self, _: f64, x: &M::State) -> f64 {
        x.get(self.index)
            .map_or(f64::NAN, |value| self.sign * (value.into() - self.limit))
    }
}

/// An event at its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located<X> {
    /// Place of the event among those of the problem.
    pub index: usize,
    /// Its name.
    pub name: &'static str,
    /// When it happened, in s.
    pub time: f64,
    /// The state then.
    pub state: X,
}

/// A step is searched in this many parts, so that two passages in one step are rarely missed.
const PARTS: u8 = 4;

/// Refuses a start at which an event cannot be told or a limit is passed.
pub(crate) fn check_start<M: Model>(
    events: &[&dyn Event<M>],
    time: f64,
    x: &M::State,
) -> Result<(), Failure> {
    for event in events {
        let value = finite_value(*event, time, x)?;
        if event.crossing() == Crossing::Limit && value <= 0.0 {
            return Err(not_bracketed(*event, time, value));
        }
    }
    Ok(())
}

/// Hands the events of a step that do not end the run to `report`, up to the first that does, which it returns.
///
/// The last part of the step ends at `next`, exactly.
pub(crate) fn search<M: Model>(
    events: &[&dyn Event<M>],
    dense: &Dense<M::State>,
    next: &M::State,
    mut report: impl FnMut(&Located<M::State>),
) -> Result<Option<Located<M::State>>, Failure> {
    let length = dense.end() - dense.start();
    let mut before = (dense.start(), dense.at::<M::Scalar>(dense.start()));
    for part in 1..=PARTS {
        let after = if part == PARTS {
            (dense.end(), *next)
        } else {
            let time = dense.start() + length * (f64::from(part) / f64::from(PARTS));
            (time, dense.at::<M::Scalar>(time))
        };
        let mut last: Option<Located<M::State>> = None;
        for (index, event) in events.iter().enumerate().filter(|(_, e)| e.ends_run()) {
            if let Some(located) = locate(index, *event, dense, &before, &after)?
                && last.is_none_or(|last| located.time < last.time)
            {
                last = Some(located);
            }
        }
        for (index, event) in events.iter().enumerate().filter(|(_, e)| !e.ends_run()) {
            if let Some(located) = locate(index, *event, dense, &before, &after)?
                && last.is_none_or(|last| located.time <= last.time)
            {
                report(&located);
            }
        }
        if last.is_some() {
            return Ok(last);
        }
        before = after;
    }
    Ok(None)
}

/// The event between two points of a step, if its function passes zero there.
///
/// Regula falsi with Illinois weights, and a bisection every third time, until neighbouring times are reached. The
/// later end of the bracket is the answer: a run that goes on from there does not meet the event again.
fn locate<M: Model>(
    index: usize,
    event: &dyn Event<M>,
    dense: &Dense<M::State>,
    before: &(f64, M::State),
    after: &(f64, M::State),
) -> Result<Option<Located<M::State>>, Failure> {
    let (mut early, mut late, mut state) = (before.0, after.0, after.1);
    let mut low = finite_value(event, early, &before.1)?;
    let mut high = finite_value(event, late, &state)?;
    if !event.crossing().passed(low, high) {
        return Ok(None);
    }
    let rises = low < 0.0;
    let length = late - early;
    let mut moved_late = None;
    for round in 0..240_u8 {
        let resolution = 2.0 * f64::EPSILON * (early.abs().max(late.abs()) + length);
        if late - early <= resolution || high == 0.0 {
            return Ok(Some(Located {
                index,
                name: event.name(),
                time: late,
                state,
            }));
        }
        let secant = early + (late - early) * (low / (low - high));
        let middle = early + 0.5 * (late - early);
        let guess = if round % 3 == 2 || !(secant > early && secant < late) {
            middle
        } else {
            secant
        };
        let guessed = dense.at::<M::Scalar>(guess);
        let value = finite_value(event, guess, &guessed)?;
        let passed = if rises { value >= 0.0 } else { value <= 0.0 };
        if passed {
            (late, high, state) = (guess, value, guessed);
        } else {
            (early, low) = (guess, value);
        }
        // The end that stays a second time loses weight.
        if moved_late == Some(passed) {
            if passed {
                low *= 0.5;
            } else {
                high *= 0.5;
            }
        }
        moved_late = Some(passed);
    }
    Err(not_bracketed(event, late, high))
}

fn finite_value<M: Model>(event: &dyn Event<M>, time: f64, x: &M::State) -> Result<f64, Failure> {
    let value = event.value(time, x);
    if value.is_finite() {
        Ok(value)
    } else {
        Err(not_bracketed(event, time, value))
    }
}

fn not_bracketed<M: Model>(event: &dyn Event<M>, time: f64, value: f64) -> Failure {
    Failure::EventNotBracketed {
        time,
        event: event.name(),
        value,
    }
}

#[cfg(test)]
mod tests {
    use super::Crossing::{Either, Falling, Limit, Rising};

    /// An event at the start of a step was found at the end of the step before.
    #[test]
    fn a_passage_begins_off_zero_and_may_end_at_it() {
        for (before, after, rises, falls) in [
            (-1.0, 1.0, true, false),
            (-1.0, 0.0, true, false),
            (1.0, -1.0, false, true),
            (1.0, 0.0, false, true),
            (0.0, 1.0, false, false),
            (0.0, -1.0, false, false),
            (0.0, 0.0, false, false),
            (1.0, 2.0, false, false),
            (-1.0, -2.0, false, false),
        ] {
            let passed = [Rising, Falling, Limit, Either].map(|way| way.passed(before, after));
            let expected = [rises, falls, falls, rises || falls];
            assert_eq!(passed, expected, "from {before} to {after}");
        }
    }
}
