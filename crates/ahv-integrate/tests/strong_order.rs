//! What the strong schemes do with what they are given; their orders are in the table of `orders`.
#![forbid(unsafe_code)]

mod common;
#[path = "common/normal.rs"]
mod normal;
#[allow(dead_code, reason = "another test measures the orders")]
#[path = "common/order.rs"]
mod order;
#[allow(dead_code, reason = "another test measures the orders")]
#[path = "common/strong.rs"]
mod strong;

use ahv_integrate::{ItoHeun, ItoMilstein, ItoSra1, StepError, StratonovichHeun};
use normal::{Normal, refined};
use strong::{Curved, NO_INPUT, START, Spiral, T_END, Two};

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
