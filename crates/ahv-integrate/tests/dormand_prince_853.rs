//! A step of the method of order 8 against SciPy's `DOP853`, and what its steps cost.
#![forbid(unsafe_code)]

mod common;

use std::cell::Cell;

use ahv_core::Model;
use ahv_integrate::{
    Adaptive, Constant, Dense, DormandPrince853, Method, Observer, Problem, Progress, Start,
};
use approx::assert_relative_eq;
use common::vector;

vector!(Pair, prey, hunter);
vector!(Nothing, none);

const HELD: Constant<Nothing<f64>> = Constant(Nothing { none: 0.0 });

/// Lotka and Volterra's equations, counting evaluations.
#[derive(Default)]
struct Hunt {
    drifts: Cell<u32>,
}

impl Model for Hunt {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        self.drifts.set(self.drifts.get() + 1);
        Pair {
            prey: x.prey * (1.0 - x.hunter),
            hunter: x.hunter * (x.prey - 1.0),
        }
    }
}

const START: Pair<f64> = Pair {
    prey: 2.0,
    hunter: 0.5,
};

fn assert_near(found: Pair<f64>, expected: [f64; 2]) {
    let [prey, hunter] = expected;
    assert_relative_eq!(found.prey, prey, max_relative = 1e-15);
    assert_relative_eq!(found.hunter, hunter, max_relative = 1e-15);
}

/// `scipy.integrate.DOP853` of SciPy 1.17.1 with `first_step=0.4` from (2, 0.5): state, `_estimate_error_norm` at rtol 1e-8 and
/// atol 1e-10, and `dense_output` at 0.3 and 0.8 of the step.
#[test]
fn a_step_is_that_of_scipy() {
    let model = Hunt::default();
    let start = Start {
        time: 0.0,
        state: START,
        slope: None,
    };
    let mut attempt = DormandPrince853.attempt(&model, &HELD, &start, 0.4);
    assert_near(attempt.next, [2.3174244227963947, 0.8004468863667764]);
    let next = attempt.next;
    let size = Method::<Hunt>::error_size(&DormandPrince853, &attempt, |error| {
        let part = |error: f64, a: f64, b: f64| error / (1e-10 + 1e-8 * a.max(b));
        let prey = part(error.prey, START.prey, next.prey);
        let hunter = part(error.hunter, START.hunter, next.hunter);
        prey.hypot(hunter) / 2.0_f64.sqrt()
    });
    assert_relative_eq!(size, 19.79197569906364, max_relative = 1e-6);
    let dense = DormandPrince853.dense(&model, &HELD, &mut attempt);
    assert_near(dense.at(0.12), [2.1153993193561393, 0.5677234846925014]);
    assert_near(dense.at(0.32), [2.2733741594433696, 0.7215828711865097]);
    assert_near(dense.at(0.4), [next.prey, next.hunter]);
    assert_eq!(attempt.last_slope, Some(model.drift(&next, &HELD.0)));
}

#[test]
fn a_state_at_rest_has_no_error() {
    let start = Start {
        time: 0.0,
        state: Pair {
            prey: 0.0,
            hunter: 0.0,
        },
        slope: None,
    };
    let attempt = DormandPrince853.attempt(&Hunt::default(), &HELD, &start, 0.4);
    let size = Method::<Hunt>::error_size(&DormandPrince853, &attempt, |_| 0.0);
    assert_eq!(size, 0.0);
}

/// Takes the dense output of every step.
struct Dull;

impl<X> Observer<X> for Dull {
    fn accepted(&mut self, _: &Dense<X>) {}
}

/// The accepted and refused steps of a run of three rounds, its drifts and its end.
fn hunt<O: Observer<Pair<f64>>>(tolerance: f64, observer: &mut O) -> ([u32; 3], Pair<f64>) {
    let model = Hunt::default();
    let mut progress = Progress::new(0.0, START);
    let absolute = Pair {
        prey: tolerance,
        hunter: tolerance,
    };
    Adaptive::new(DormandPrince853, tolerance, absolute)
        .run(&Problem::new(&model, &HELD), &mut progress, 20.0, observer)
        .expect("a bounded motion");
    let counts = [progress.accepted, progress.refused, model.drifts.get()];
    (counts, progress.state)
}

/// Two drifts find the first step; a step takes 12, of which the last step has one less; a refused one 11. Dense output takes
/// three more, and the slope at the end of the last step.
#[test]
fn a_run_costs_what_is_documented() {
    for tolerance in [1e-5, 1e-8, 1e-11] {
        let ([accepted, refused, drifts], end) = hunt(tolerance, &mut ());
        assert_eq!(drifts, 1 + 12 * accepted + 11 * refused);
        let (counts, same) = hunt(tolerance, &mut Dull);
        let more = 3 * accepted + 1;
        assert_eq!(counts, [accepted, refused, drifts + more]);
        assert_eq!(end, same, "an observer changes nothing");
    }
}

/// An error that falls with the eighth power of the step: a tolerance 10⁶ times as small takes 10^(6/8) = 5.6 times the steps.
#[test]
fn steps_follow_the_tolerance_with_the_eighth_root() {
    let steps = |tolerance| f64::from(hunt(tolerance, &mut ()).0[0]);
    let growth = steps(1e-12) / steps(1e-6);
    assert!((4.5..6.5).contains(&growth), "{growth}");
    // The motion is closed: ln prey − prey + ln hunter − hunter is constant.
    let constant = |x: Pair<f64>| x.prey.ln() - x.prey + x.hunter.ln() - x.hunter;
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let error = (constant(hunt(tolerance, &mut ()).1) - constant(START)).abs();
        assert!(error < 10.0 * tolerance, "{tolerance:e}: {error:e}");
    }
}
