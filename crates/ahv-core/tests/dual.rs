//! Slopes of dual numbers beside the rules of calculus.

use ahv_core::{Dual, Lanes, Real};

/// Two functions of time at one time: values and rates of which none is 0 or 1.
const F: Dual = Dual {
    value: 0.7,
    slope: 3.0,
};
const G: Dual = Dual {
    value: -1.3,
    slope: 0.4,
};

fn near(found: Dual, value: f64, slope: f64) {
    let errors = [found.value - value, found.slope - slope];
    let small = errors.iter().all(|error| error.abs() < 1e-14);
    assert!(small, "{found:?}: {value}, {slope}");
}

/// The rules for sum, difference, product and quotient, written out in decimals.
#[test]
fn arithmetic_has_the_slopes_of_the_rules() {
    near(F + G, -0.6, 3.4);
    near(F - G, 2.0, 2.6);
    near(F * G, -0.91, -3.9 + 0.28);
    near(F / G, -7.0 / 13.0, (-3.9 - 0.28) / 1.69);
    near(-F, -0.7, -3.0);
    near(F.recip(), 10.0 / 7.0, -3.0 / 0.49);
}

/// The chain rule with the derivatives that every table has.
#[test]
fn functions_have_the_slopes_of_the_chain_rule() {
    let (sin, cos) = 0.7_f64.sin_cos();
    near(Real::sin(F), sin, 3.0 * cos);
    near(Real::cos(F), cos, -3.0 * sin);
    near(Real::exp(F), 0.7_f64.exp(), 3.0 * 0.7_f64.exp());
    near(Real::sqrt(F), 0.7_f64.sqrt(), 1.5 / 0.7_f64.sqrt());
    near(Real::abs(F), 0.7, 3.0);
    near(Real::abs(G), 1.3, -0.4);
    near(Real::tan(F), 0.7_f64.tan(), 3.0 / (cos * cos));
    near(Real::asin(F), 0.7_f64.asin(), 3.0 / 0.51_f64.sqrt());
    near(Real::atan(F), 0.7_f64.atan(), 3.0 / 1.49);
    near(
        Real::tanh(G),
        (-1.3_f64).tanh(),
        0.4 / 1.3_f64.cosh().powi(2),
    );
    near(Real::ln(F), 0.7_f64.ln(), 3.0 / 0.7);
    let of_angle = (-1.3 * 3.0 - 0.7 * 0.4) / (0.49 + 1.69);
    near(Real::atan2(F, G), 0.7_f64.atan2(-1.3), of_angle);
    let power = 0.7_f64.powf(-1.3);
    let of_power = power * (-1.3 / 0.7 * 3.0 + 0.7_f64.ln() * 0.4);
    near(Real::powr(F, G), power, of_power);
}

/// The slope of what is chosen; of a minimum and a maximum, that of the one that it is.
#[test]
fn choices_have_the_slope_of_what_they_choose() {
    assert_eq!(Real::select(G, F, F, G), F);
    assert_eq!(Real::select(F, G, F, G), G);
    assert_eq!((Real::min(F, G), Real::max(F, G)), (G, F));
    assert_eq!(
        Real::abs(Dual {
            slope: 3.0,
            ..Dual::ZERO
        })
        .slope,
        0.0
    );
}

/// Duals of duals carry the second derivative: d²/dx² tan x = 2 tan x (1 + tan² x).
#[test]
fn duals_of_duals_have_the_second_derivative() {
    let tan = Dual::variable(Dual::variable(0.4_f64)).tan();
    let t = 0.4_f64.tan();
    assert!((tan.value.slope - tan.slope.value).abs() < 1e-15);
    assert!((tan.slope.slope - 2.0 * t * (1.0 + t * t)).abs() < 1e-14);
}

/// In lanes each lane has the bits of its own number.
#[test]
fn lanes_have_the_slopes_of_their_numbers() {
    let x = [0.2, 0.7];
    let f = |x: Dual<Lanes<f64, 2>>| x.powr(Dual::constant(Lanes::splat(2.5))) * x.exp();
    let found = f(Dual::variable(Lanes(x)));
    for (lane, &x) in x.iter().enumerate() {
        let x = Dual::variable(x);
        let alone = x.powr(Dual::constant(2.5)) * x.exp();
        assert_eq!(found.slope.0[lane].to_bits(), alone.slope.to_bits());
    }
}
