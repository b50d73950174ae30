//! Steppers that control their step, with events, dense output, validity box and saturation.

use ahv_core::{Bounds, DifferentiableModel, Outside, Real, Vector};
use ahv_integrate::{
    Adaptive, ComponentLimit, Constant, Crossing, Dense, DormandPrince54, DormandPrince853, Event,
    Feedback, Held, InputSource, Interpolated, Leaving, Located, Method, Observer, Problem,
    Progress, Rodas4, Saturated, Tsit5, When, Within,
};
use core::hint::black_box;

use crate::{Place, Visitor};

/// Length of a run in s.
const LENGTH: f64 = 1.0 / 64.0;

/// Every method with a held input.
pub(crate) fn held<M, B, C>(
    at: &Place<M>,
    states: B,
    inputs: C,
    visitor: &mut dyn Visitor<M::Scalar>,
) where
    M: DifferentiableModel,
    M::Scalar: Into<f64>,
    B: Vector<Bounds>,
    C: Vector<Bounds>,
{
    let input = Saturated::new(Constant(at.u), inputs);
    methods(at, &input, "Constant", states, visitor);
}

/// Every method with inputs that move: samples, lines, feedback; and beyond their limits.
pub(crate) fn moving<M, B, C>(
    at: &Place<M>,
    states: B,
    inputs: C,
    visitor: &mut dyn Visitor<M::Scalar>,
) where
    M: DifferentiableModel,
    M::Scalar: Into<f64>,
    B: Vector<Bounds>,
    C: Vector<Bounds>,
{
    let two = M::Scalar::TWO;
    let times = black_box([0.0, 0.4 * LENGTH, 0.7 * LENGTH]);
    let values = black_box([at.u, at.u.map(|u| two * u), at.u]);
    let (times, values) = (black_box(&times[..]), black_box(&values[..]));
    if let Some(samples) = Held::new(times, values) {
        let input = Saturated::new(samples, inputs);
        methods(at, &input, "Held", states, visitor);
    }
    if let Some(lines) = Interpolated::new(times, values) {
        let input = Saturated::new(lines, inputs);
        methods(at, &input, "Interpolated", states, visitor);
    }
    let feedback = |time: f64, x: &M::State| {
        let gain = M::Scalar::from_f64(time) + x.get(black_box(3)).unwrap_or(two);
        at.u.map(|u| u * (M::Scalar::ONE + gain))
    };
    let input = Saturated::new(Feedback(feedback), inputs);
    methods(at, &input, "Feedback", states, visitor);
}

fn methods<M, I, B>(
    at: &Place<M>,
    input: &I,
    source: &'static str,
    states: B,
    visitor: &mut dyn Visitor<M::Scalar>,
) where
    M: DifferentiableModel,
    M::Scalar: Into<f64>,
    I: InputSource<M>,
    B: Vector<Bounds>,
{
    at.visit(visitor, "Adaptive<DormandPrince54>", source, |x, step| {
        run(at, input, states, DormandPrince54, x, step)
    });
    at.visit(visitor, "Adaptive<Tsit5>", source, |x, step| {
        run(at, input, states, Tsit5, x, step)
    });
    at.visit(visitor, "Adaptive<DormandPrince853>", source, |x, step| {
        run(at, input, states, DormandPrince853, x, step)
    });
    at.visit(visitor, "Adaptive<Rodas4>", source, |x, step| {
        run(at, input, states, Rodas4, x, step)
    });
}

/// Counts what it is told.
#[derive(Default)]
struct Seen(u32);

impl<X> Observer<X> for Seen {
    fn accepted(&mut self, step: &Dense<X>) {
        self.0 = self.0.wrapping_add(u32::from(step.end() > step.start()));
    }

    fn event(&mut self, event: &Located<X>) {
        self.0 = self.0.wrapping_add(u32::from(event.time.is_finite()));
    }

    fn outside(&mut self, _: f64, _: &Outside) {
        self.0 = self.0.wrapping_add(1);
    }

    fn saturated(&mut self, _: f64, _: &Outside) {
        self.0 = self.0.wrapping_add(1);
    }
}

/// A run of an observer's and one of nobody's from where it ended. Even steps warn outside the box, odd ones stop.
fn run<M, I, B, S>(
    at: &Place<M>,
    input: &I,
    states: B,
    method: S,
    x: &mut M::State,
    step: u64,
) -> bool
where
    M: DifferentiableModel,
    M::Scalar: Into<f64>,
    I: InputSource<M>,
    B: Vector<Bounds>,
    S: Method<M>,
{
    let first = <M::State as Vector<M::Scalar>>::NAMES
        .first()
        .copied()
        .unwrap_or("");
    let limits = (
        ComponentLimit::at_least::<M>("floor", black_box(first), black_box(-1e9)),
        ComponentLimit::at_most::<M>("ceiling", black_box(first), black_box(1e9)),
    );
    let (Some(floor), Some(ceiling)) = limits else {
        return false;
    };
    let end = black_box(LENGTH);
    let own = When::new("half", Crossing::Either, |t: f64, _: &M::State| {
        t - 0.5 * end
    })
    .only_reported();
    let last = When::limit("last", |t: f64, _: &M::State| 0.9 * end - t);
    let events: [&dyn Event<M>; 4] = [&floor, &ceiling, &own, &last];
    let leaving = if step.is_multiple_of(2) {
        Leaving::Warn
    } else {
        Leaving::Stop
    };
    let whole = Problem::new(&at.model, input)
        .validity(Within::new(states, leaving))
        .events(black_box(&events[..]));
    let rest = Problem::new(&at.model, input);

    let absolute = x.map(|x| M::Scalar::from_f64(black_box(1e-6)) * (M::Scalar::ONE + x.abs()));
    let solver = Adaptive::new(method, black_box(1e-6), absolute)
        .most_steps(black_box(1000))
        .longest_step(black_box(0.5 * LENGTH));
    let mut progress = Progress::new(0.0, *x);
    let mut seen = Seen::default();
    let ended = solver.run(&whole, &mut progress, end, &mut seen);
    let went_on = solver.run(&rest, &mut progress, end, &mut ());
    *x = progress.state;
    black_box(seen.0) > 0 && ended.is_ok() && went_on.is_ok()
}
