//! An expectation by DRI1, of weak order 2, beside Euler and Maruyama's scheme, of weak order 1, at the same long step.
//!
//! `cargo run --release -p ahv-integrate --example dri1`

use ahv_integrate::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
struct State<T> {
    x: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Noise<T> {
    w_1: T,
    w_2: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Nothing<T> {
    none: T,
}

impl_vector!(State { x: ["1", "1", 1.0] });
impl_vector!(Noise {
    w_1: ["1", "1", 1.0],
    w_2: ["1", "1", 1.0]
});
impl_vector!(Nothing {
    none: ["1", "1", 1.0]
});

/// dx = −x dt + 0.5 x dW₁ + 0.3 dW₂: with m = E x², ṁ = (−2 + 0.25) m + 0.09.
struct Linear;

impl Model for Linear {
    type Scalar = f64;
    type State = State<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &State<f64>, _: &Nothing<f64>) -> State<f64> {
        x.map(|x| -x)
    }
}

impl StochasticModel for Linear {
    type Noise = Noise<f64>;

    fn noise_increment(&self, x: &State<f64>, _: &Nothing<f64>, dw: &Noise<f64>) -> State<f64> {
        x.map(|x| 0.5 * x * dw.w_1 + 0.3 * dw.w_2)
    }

    /// DRI1 leaves out the stages of a column that is constant.
    fn noise_class(channel: usize) -> NoiseClass {
        match channel {
            1 => NoiseClass::Constant,
            _ => NoiseClass::General,
        }
    }
}

const MEMBERS: u64 = 200_000;
const STEPS: u64 = 4;
const DT: f64 = 0.25;

/// The mean of x² at 1 s, and its standard error.
fn second_moment(
    mut step: impl FnMut(&mut State<f64>, u64, u64) -> Result<(), StepError<f64>>,
) -> Result<(f64, f64), StepError<f64>> {
    let (mut sum, mut squares) = (0.0, 0.0);
    for member in 0..MEMBERS {
        let mut state = State { x: 1.0 };
        for number in 0..STEPS {
            step(&mut state, member, number)?;
        }
        let square = state.x * state.x;
        sum += square;
        squares += square * square;
    }
    let count = MEMBERS as f64;
    let mean = sum / count;
    Ok((mean, ((squares / count - mean * mean) / count).sqrt()))
}

fn main() -> Result<(), StepError<f64>> {
    let none = Nothing { none: 0.0 };
    let (euler, euler_error) = second_moment(|x, member, number| {
        let dw = WienerSource::<2>::new(1, member).increments(number, DT);
        ItoEulerMaruyama::new(DT).step(&Linear, x, &none, &dw)
    })?;
    let (dri1, dri1_error) = second_moment(|x, member, number| {
        // Two normal numbers a channel become numbers of few values.
        let mut normals = KeyedNormals { seed: 1, member };
        let increments =
            WeakIncrements::from_normals(DT, |channel| normals.normal(number, channel));
        ItoDri1::new(DT).step(&Linear, x, &none, &increments)
    })?;
    let still = 0.09 / 1.75;
    let exact = still + (1.0 - still) * (-1.75_f64).exp();
    println!("exact           {exact:.4}");
    println!("Euler-Maruyama  {euler:.4} ± {euler_error:.4}");
    println!("DRI1            {dri1:.4} ± {dri1_error:.4}");
    assert!((dri1 - exact).abs() < 0.4 * (euler - exact).abs());
    Ok(())
}
