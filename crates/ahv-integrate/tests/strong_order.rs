//! What methods with a fixed step do with what they are given; their orders are in the table of `orders`.
#![forbid(unsafe_code)]

mod common;
#[path = "common/normal.rs"]
mod normal;
#[path = "common/order.rs"]
mod order;
#[allow(dead_code, reason = "another test measures the orders")]
#[path = "common/strong.rs"]
mod strong;

use ahv_core::Vector;
use ahv_integrate::{
    Euler, Fixed, Heun, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, Rk4, StepError,
    StratonovichHeun, Tsit5, WeakIncrements, WienerIntegrals,
};
use normal::{Normal, refined};
use order::observed_order;
use strong::{Curved, NO_INPUT, Plane, START, Spiral, T_END, Two};

#[test]
fn equal_increments_give_equal_bits() {
    let path = refined::<Two<f64>>(&mut Normal(3), T_END, 6);
    let run = || {
        let mut x = START;
        for integrals in &path[6] {
            let dw = &integrals.dw;
            let steps = [
                ItoMilstein::new(0.01).step(&Spiral, &mut x, &NO_INPUT, dw),
                ItoHeun::new(0.01).step(&Spiral, &mut x, &NO_INPUT, dw),
                ItoSra1::new(0.01).step(&Curved, &mut x, &NO_INPUT, integrals),
            ];
            assert_eq!(steps, [Ok(()); 3]);
        }
        x.to_array().map(f64::to_bits)
    };
    assert_eq!(run(), run());
}

/// Every method with a fixed step; those that follow a Wiener path with these increments.
fn stepped(dt: f64, x: &mut Plane<f64>, dw: &Two<f64>) -> [Result<(), StepError<f64>>; 8] {
    let (spiral, u) = (&Spiral, &NO_INPUT);
    [
        Euler::new(dt).step(spiral, x, u),
        Heun::new(dt).step(spiral, x, u),
        Rk4::new(dt).step(spiral, x, u),
        Fixed::new(Tsit5, dt).step(spiral, x, u),
        ItoEulerMaruyama::new(dt).step(spiral, x, u, dw),
        ItoHeun::new(dt).step(spiral, x, u, dw),
        StratonovichHeun::new(dt).step(spiral, x, u, dw),
        ItoMilstein::new(dt).step(spiral, x, u, dw),
    ]
}

#[test]
fn bad_steps_are_errors_and_keep_the_state() {
    let dw = Two {
        w_1: 0.1,
        w_2: f64::NAN,
    };
    let mut x = START;
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for result in stepped(dt, &mut x, &dw) {
            let error = result.expect_err("no such step");
            assert!(matches!(error, StepError::StepSize { .. }), "{error}");
            assert!(error.to_string().contains("must be positive"), "{error}");
        }
    }
    assert_eq!(x, START);
    let non_finite = |result: &Result<(), StepError<f64>>| {
        let is = matches!(result, Err(StepError::NonFinite { name: "re", .. }));
        assert!(is, "{result:?}");
    };
    // Those that take noise.
    stepped(0.1, &mut x, &dw)[4..].iter().for_each(non_finite);
    let far = START.map(|value| 1e308 * value);
    let mut x = far;
    stepped(1e3, &mut x, &dw).iter().for_each(non_finite);
    assert_eq!(x, far);
}

/// A step of [`Curved`] without noise.
type Still = fn(f64, &mut Plane<f64>) -> Result<(), StepError<f64>>;

#[test]
fn without_noise_the_schemes_have_the_orders_of_their_documentation() {
    const ZERO: Two<f64> = Two { w_1: 0.0, w_2: 0.0 };
    let schemes: [(&str, f64, Still); 6] = [
        ("ItoEulerMaruyama", 1.0, |dt, x| {
            ItoEulerMaruyama::new(dt).step(&Curved, x, &NO_INPUT, &ZERO)
        }),
        ("ItoMilstein", 1.0, |dt, x| {
            ItoMilstein::new(dt).step(&Curved, x, &NO_INPUT, &ZERO)
        }),
        ("StratonovichHeun", 2.0, |dt, x| {
            StratonovichHeun::new(dt).step(&Curved, x, &NO_INPUT, &ZERO)
        }),
        ("ItoHeun", 2.0, |dt, x| {
            ItoHeun::new(dt).step(&Curved, x, &NO_INPUT, &ZERO)
        }),
        ("ItoSra1", 2.0, |dt, x| {
            let still = WienerIntegrals { dw: ZERO, dz: ZERO };
            ItoSra1::new(dt).step(&Curved, x, &NO_INPUT, &still)
        }),
        ("ItoDri1", 3.0, |dt, x| {
            let (three_point, two_point) = (ZERO, ZERO);
            let still = WeakIncrements {
                three_point,
                two_point,
            };
            ItoDri1::new(dt).step(&Curved, x, &NO_INPUT, &still)
        }),
    ];
    for (name, order, step) in schemes {
        let end = |steps: u32| {
            let mut x = START;
            for _ in 0..steps {
                step(T_END / f64::from(steps), &mut x).expect("the drift is bounded by the state");
            }
            x
        };
        let truth = end(1 << 14);
        let points = [16, 32, 64, 128].map(|steps| {
            let x = end(steps);
            let error = (x.re - truth.re).hypot(x.im - truth.im);
            (T_END / f64::from(steps), error)
        });
        let observed = observed_order(&points);
        assert!((observed - order).abs() < 0.15, "{name}: {observed}");
    }
}
