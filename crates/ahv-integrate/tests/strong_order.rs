//! What the strong schemes do with what they are given; their orders are in the table of `orders`.
#![forbid(unsafe_code)]

mod common;
#[path = "common/normal.rs"]
mod normal;
#[path = "common/order.rs"]
mod order;
#[allow(dead_code, reason = "another test measures the orders")]
#[path = "common/strong.rs"]
mod strong;

use ahv_integrate::{
    ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, StepError, StratonovichHeun,
    WeakIncrements, WienerIntegrals,
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

#[test]
fn bad_steps_are_errors_and_keep_the_state() {
    let dw = Two {
        w_1: 0.1,
        w_2: f64::NAN,
    };
    let mut x = START;
    for dt in [0.0, -1.0, f64::INFINITY] {
        let expected = Err(StepError::StepSize { dt });
        assert_eq!(
            ItoHeun::new(dt).step(&Spiral, &mut x, &NO_INPUT, &dw),
            expected
        );
        assert_eq!(
            ItoMilstein::new(dt).step(&Spiral, &mut x, &NO_INPUT, &dw),
            expected
        );
    }
    for result in [
        ItoHeun::new(0.1).step(&Spiral, &mut x, &NO_INPUT, &dw),
        StratonovichHeun::new(0.1).step(&Spiral, &mut x, &NO_INPUT, &dw),
        ItoMilstein::new(0.1).step(&Spiral, &mut x, &NO_INPUT, &dw),
    ] {
        assert!(
            matches!(result, Err(StepError::NonFinite { name: "re", .. })),
            "{result:?}"
        );
    }
    assert_eq!(x, START);
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
