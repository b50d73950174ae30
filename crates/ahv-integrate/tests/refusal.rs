//! Schemes refuse models whose noise they do not admit, and say why.
#![forbid(unsafe_code)]

mod common;

use ahv_core::{DifferentiableNoise, ItoCorrected, Model, NoiseClass, StochasticModel};
use ahv_integrate::{
    AdditiveChannels, CommutativeChannels, ItoMilstein, ItoSra1, NoiseError, WienerIntegrals,
};
use ahv_models::sdcom;
use common::vector;

vector!(State, a, b);
vector!(Noise, w_general, w_diagonal, w_constant);

/// G = [b, a, 0; 0, 0, 2]: the first column commutes with no other, the others do.
struct Mixed;

impl Model for Mixed {
    type Scalar = f64;
    type State = State<f64>;
    type Input = State<f64>;

    fn drift(&self, _: &State<f64>, _: &State<f64>) -> State<f64> {
        State { a: 0.0, b: 0.0 }
    }
}

impl StochasticModel for Mixed {
    type Noise = Noise<f64>;

    fn noise_increment(&self, x: &State<f64>, _: &State<f64>, dw: &Noise<f64>) -> State<f64> {
        State {
            a: x.b * dw.w_general + x.a * dw.w_diagonal,
            b: 2.0 * dw.w_constant,
        }
    }

    fn noise_class(channel: usize) -> NoiseClass {
        match channel {
            0 => NoiseClass::General,
            1 => NoiseClass::Diagonal,
            _ => NoiseClass::Constant,
        }
    }

    fn noise_commutes(first: usize, second: usize) -> bool {
        first == second || (first != 0 && second != 0)
    }
}

impl ItoCorrected for Mixed {
    fn ito_correction(&self, x: &State<f64>, u: &State<f64>) -> State<f64> {
        self.iterated_increment(x, u, |j, k| if j == k { 0.5 } else { 0.0 })
    }
}

impl DifferentiableNoise for Mixed {
    fn iterated_increment(
        &self,
        x: &State<f64>,
        _: &State<f64>,
        mut integral: impl FnMut(usize, usize) -> f64,
    ) -> State<f64> {
        // L^j b^k in the row of a: from b^general = (b, 0) along w_constant, from b^diagonal = (a, 0) along the others.
        let a = 2.0 * integral(2, 0) + x.b * integral(0, 1) + x.a * integral(1, 1);
        State { a, b: 0.0 }
    }
}

const START: State<f64> = State { a: 1.0, b: 2.0 };

#[test]
fn additive_schemes_name_the_channel_that_is_not() {
    let refused = |active: fn(&str) -> bool| AdditiveChannels::new(&Mixed, active).err();
    let error = refused(|_| true).expect("the first channel is general");
    assert_eq!(
        error,
        NoiseError::NotAdditive {
            channel: "w_general",
            class: NoiseClass::General
        }
    );
    assert_eq!(
        error.to_string(),
        "the scheme needs additive noise, but what w_general does may depend on any state"
    );
    let error = refused(|name| name != "w_general").expect("the second channel is diagonal");
    assert!(
        error
            .to_string()
            .contains("w_diagonal does depends on the states"),
        "{error}"
    );
    assert_eq!(refused(|name| name == "w_constant"), None);
}

#[test]
fn commutative_schemes_name_the_channels_that_do_not() {
    let error = CommutativeChannels::new(&Mixed, |_| true).err();
    let expected = NoiseError::NotCommuting {
        first: "w_general",
        second: "w_diagonal",
    };
    assert_eq!(error, Some(expected));
    assert_eq!(
        expected.to_string(),
        "the scheme needs commutative noise, but w_general and w_diagonal do not commute"
    );
}

#[test]
fn channels_that_are_off_do_nothing() {
    let dw = Noise {
        w_general: 0.3,
        w_diagonal: 0.2,
        w_constant: 0.1,
    };
    let mut x = START;
    let model = CommutativeChannels::new(&Mixed, |name| name == "w_diagonal")
        .expect("a single channel commutes");
    assert_eq!(
        ItoMilstein::new(0.01).step(&model, &mut x, &START, &dw),
        Ok(())
    );
    // The Milstein step of dX = X dW.
    let expected = 1.0 + 0.2 + 0.5 * (0.04 - 0.01);
    assert!((x.a - expected).abs() < 1e-15 && x.b == START.b, "{x:?}");
    assert_eq!(
        model.ito_correction(&START, &START),
        State { a: 0.5, b: 0.0 }
    );

    let mut x = START;
    let model = AdditiveChannels::new(&Mixed, |name| name == "w_constant")
        .expect("the third channel is additive");
    let integrals = WienerIntegrals { dw, dz: dw };
    assert_eq!(
        ItoSra1::new(0.01).step(&model, &mut x, &START, &integrals),
        Ok(())
    );
    assert_eq!(x, State { a: 1.0, b: 2.2 });
}

/// SDCOM's angles disturb it by columns that depend on the state.
#[test]
fn sdcom_with_all_its_noise_is_refused() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let error = AdditiveChannels::new(&model, |_| true).err();
    assert_eq!(
        error,
        Some(NoiseError::NotAdditive {
            channel: "w_gamma",
            class: NoiseClass::General
        })
    );
}
