//! The controller against the closed forms of Hairer, Nørsett and Wanner (Solving Ordinary Differential Equations I, II.4).

extern crate std;

use std::vec::Vec;

use ahv_core::Model;

use super::{Controller, error_norm, farthest, first_step, power, units};
use crate::{Constant, Feedback, InputSource, Start};

#[path = "../../tests/common/mod.rs"]
mod common;

use common::vector;

vector!(Three, a, b, c);
vector!(One, x);

/// The standard library's power, to which `power` is an approximation.
fn exact_power(x: f64, exponent: f64) -> f64 {
    std::primitive::f64::powf(x, exponent)
}

#[track_caller]
fn assert_close(found: f64, expected: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < 1e-6, "{found} is not {expected}");
}

#[test]
fn powers_have_seven_digits() {
    for x in [1e-300, 1e-9, 0.3, 0.999, 1.0, 1.414, 2.0, 77.7, 1e9] {
        for exponent in [-0.25, -0.2, 0.04, 0.17] {
            let exact = exact_power(x, exponent);
            let error = (power(x, exponent) / exact - 1.0).abs();
            assert!(error < 1e-7, "{x}^{exponent}: {error:e}");
        }
    }
}

/// As in DOPRI5: the factor 0.9 · err^−(1/k − 0.75β) · err_before^β, β = 0.04, and at most 5.
#[test]
fn accepted_steps_follow_the_pi_controller() {
    for order in [4_u8, 5] {
        let mut controller = Controller::new(order);
        // DOPRI5 starts with this error before the first, and keeps no smaller one.
        let mut before = 1e-4;
        for norm in [0.5, 0.02, 1.0, 0.3, 1e-6, 0.7, 3e-4, 0.9, 1e-30, 0.0, 1.0] {
            let exponent = 0.75 * 0.04 - 1.0 / f64::from(order);
            let factor = 0.9 * exact_power(norm, exponent) * exact_power(before, 0.04);
            assert_close(controller.accept(norm), factor.min(5.0));
            before = norm.max(1e-4);
        }
    }
}

/// An error that falls with the k-th power of the step: where errors repeat, one 2^k times as large halves the step, but
/// for the weight β of the error before.
#[test]
fn errors_that_repeat_move_the_step_by_their_root() {
    let settled = |order: u8, norm: f64| {
        let mut controller = Controller::new(order);
        controller.accept(norm);
        controller.accept(norm)
    };
    for order in [4, 5] {
        let k = f64::from(order);
        let ratio = settled(order, 0.8) / settled(order, 0.8 / exact_power(2.0, k));
        assert_close(ratio, exact_power(2.0, k * 1.75 * 0.04) / 2.0);
    }
}

#[test]
fn a_step_does_not_grow_right_after_a_refusal() {
    let mut controller = Controller::new(5);
    assert_close(controller.refuse(32.0), 0.9 / 2.0);
    assert_eq!(controller.accept(1e-3), 1.0);
    // The refused error is no error before; the accepted one is.
    let factor = 0.9 * exact_power(0.1, 0.03 - 0.2) * exact_power(1e-3, 0.04);
    assert_close(controller.accept(0.1), factor);
    assert_eq!(controller.accept(1e-9), 5.0);
    controller.refuse(1.1);
    let factor = 0.9 * exact_power(1e-4, 0.04);
    assert_close(controller.accept(1.0), factor);
}

#[test]
fn a_refused_step_shrinks_with_the_root_of_its_error() {
    for order in [4, 5] {
        let refuse = |norm| Controller::new(order).refuse(norm);
        for factor in [1.01, 1.5, 2.0, 4.0] {
            assert_close(refuse(exact_power(factor, order.into())), 0.9 / factor);
        }
        assert_eq!(refuse(1e30), 0.2);
        for not_finite in [f64::INFINITY, f64::NAN] {
            assert_eq!(refuse(not_finite), 0.1);
        }
    }
}

#[test]
fn the_norm_counts_every_component_in_units_of_its_tolerance() {
    let (first, last) = (
        Three {
            a: -3.0,
            b: 1.0,
            c: 0.0,
        },
        Three {
            a: 2.0,
            b: -5.0,
            c: 0.0,
        },
    );
    let absolute = Three {
        a: 0.1,
        b: 0.5,
        c: 0.25,
    };
    // The units are 0.1 + 0.1·3, 0.5 + 0.1·5 and 0.25.
    let norm = |parts: [f64; 3]| {
        let error = Three {
            a: 0.4 * parts[0],
            b: parts[1],
            c: 0.25 * parts[2],
        };
        let units = units::<f64, _>([&first, &last], 0.1, &absolute);
        let size = error_norm::<f64, _>(&error, &units);
        (size, farthest::<f64, _>(&error, &units))
    };
    for (parts, worst) in [
        ([2.0, 1.0, -0.5], 0),
        ([0.1, -2.0, 1.0], 1),
        ([-0.1, 0.2, 0.3], 2),
        ([0.0, -0.3, 0.2], 1),
        ([-3.0, 1.0, 2.0], 0),
    ] {
        let (size, farthest) = norm(parts);
        let sum: f64 = parts.iter().map(|part| part * part).sum();
        assert_close(size, std::primitive::f64::sqrt(sum / 3.0));
        assert_eq!(farthest, Some(worst), "{parts:?}");
    }
    // Of equal ones the first, as of zeros.
    assert_eq!(norm([0.0; 3]), (0.0, Some(0)));
}

/// ẋ = f(x, u).
struct Law<F>(F);

impl<F: Fn(f64, f64) -> f64> Model for Law<F> {
    type Scalar = f64;
    type State = One<f64>;
    type Input = One<f64>;

    fn drift(&self, x: &One<f64>, u: &One<f64>) -> One<f64> {
        One {
            x: (self.0)(x.x, u.x),
        }
    }
}

fn first<F, I>(law: F, input: I, start: [f64; 2], tolerances: [f64; 2], order: u8) -> f64
where
    F: Fn(f64, f64) -> f64,
    I: InputSource<Law<F>>,
{
    let model = Law(law);
    let [time, x] = start;
    let state = One { x };
    let slope = model.drift(&state, &input.at(time, time, &state));
    let start = Start {
        time,
        state,
        slope: None,
    };
    let [relative, absolute] = tolerances;
    let absolute = One { x: absolute };
    first_step(&model, &input, &start, &slope, relative, &absolute, order)
}

const NONE: Constant<One<f64>> = Constant(One { x: 0.0 });

/// ẋ = λx: with r the tolerance relative to x, d₀ = 1/r, d₁ = |λ|/r, h₀ = 0.01/|λ|, d₂ = λ²/r.
#[test]
fn the_first_step_of_a_decay_is_that_of_the_book() {
    for (rate, relative) in [(-2.0, 1e-6), (-0.5, 1e-6), (-2.0, 1e-3), (3.0, 1e-9)] {
        for order in [4, 5] {
            let rate: f64 = rate;
            let steepest = rate.abs().max(rate * rate) / relative;
            let expected = exact_power(0.01 / steepest, 1.0 / f64::from(order));
            let step = first(|x, _| rate * x, NONE, [0.0, 7.0], [relative, 1e-30], order);
            assert_close(step, expected);
        }
    }
    // Never more than 100 h₀.
    let step = first(|x, _| -100.0 * x, NONE, [0.0, 7.0], [0.1, 1e-30], 5);
    assert_close(step, 0.01);
}

/// The Euler step looks at the input a guess later: a ramp that begins at the start bends, one that ends there does not.
#[test]
fn the_first_step_looks_ahead() {
    let ramp = |sign: f64| {
        Feedback(move |time: f64, _: &One<f64>| One {
            x: 1000.0 * (sign * (time - 3.0)).max(0.0),
        })
    };
    let step = |sign| first(|_, u| 1.0 + u, ramp(sign), [3.0, 1.0], [1e-6, 1e-30], 5);
    // d₁ = 1/r, d₂ = 1000/r.
    assert_close(step(1.0), exact_power(0.01e-6 / 1000.0, 0.2));
    assert_close(step(-1.0), exact_power(0.01e-6, 0.2));
    // And at the state ahead: a drift that bends above the start.
    let bends = |sign: f64| move |x: f64, _| 1.0 + 1000.0 * (sign * (x - 1.0)).max(0.0);
    let step = |sign| first(bends(sign), NONE, [3.0, 1.0], [1e-6, 1e-30], 5);
    assert_close(step(1.0), exact_power(0.01e-6 / 1000.0, 0.2));
    assert_close(step(-1.0), exact_power(0.01e-6, 0.2));
}

/// Where d₀ or d₁ is below 1e-5, h₀ is 1e-6; a first step is then at most 1e-4.
#[test]
fn a_state_or_a_slope_near_zero_says_nothing_about_the_scale() {
    let constant = |speed: f64, x: f64| first(move |_, _| speed, NONE, [0.0, x], [1e-30, 1.0], 5);
    let below = 1e-5_f64.next_down();
    // The state.
    assert_close(constant(1e-3, 0.0), 1e-4);
    assert_close(constant(1e-3, below), 1e-4);
    assert_close(constant(1e-3, 1e-5), 1e-2);
    // The slope: from 1e-5 on, h₁ = (0.01/d₁)^(1/5) counts alone.
    assert_close(constant(below, 1.0), 1e-4);
    assert_close(constant(1e-5, 1.0), exact_power(1e3, 0.2));
    // Nothing moves, up to 1e-15: h₀ itself.
    assert_eq!(constant(0.0, 1.0), 1e-6);
    assert_eq!(constant(1e-15, 1.0), 1e-6);
    assert_close(constant(1e-15_f64.next_up(), 1.0), 1e-4);
}

#[test]
fn a_first_step_is_positive_and_finite_whatever_overflows() {
    // Slope, state, and both, in units of the tolerances; a drift that ends at the start.
    type Drift = fn(f64, f64) -> f64;
    let wild: [(&str, Drift, f64); 5] = [
        ("slope", |_, _| 1e200, 1.0),
        ("state", |_, _| 1.0, 1e200),
        ("both", |x, _| x, 1e200),
        ("bend", |x, _| if x == 1.0 { 1.0 } else { 1e300 }, 1.0),
        ("hole", |x, _| if x == 1.0 { 1.0 } else { f64::NAN }, 1.0),
    ];
    let steps: Vec<f64> = wild
        .iter()
        .map(|&(name, law, x)| {
            let step = first(law, NONE, [0.0, x], [1e-200, 1e-6], 5);
            assert!(step > 0.0 && step.is_finite(), "{name}: {step}");
            step
        })
        .collect();
    // Where a norm overflows the guess stands; where the drift has a hole ahead, the slope alone counts.
    assert_eq!(steps[0], 1e-6);
    assert_close(steps[3], 0.01);
    assert_close(steps[4], exact_power(0.01e-6, 0.2));
}
