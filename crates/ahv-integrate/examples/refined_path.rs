//! One Brownian path at finer and finer steps: the strong order of a scheme, seen on a single path.
//!
//! `cargo run -p ahv-integrate --example refined_path`

use ahv_integrate::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Price<T> {
    price: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Wiener<T> {
    w: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Nothing<T> {
    none: T,
}

impl_vector!(Price {
    price: ["1", "1", 1.0]
});
impl_vector!(Wiener { w: ["1", "1", 1.0] });
impl_vector!(Nothing {
    none: ["1", "1", 1.0]
});

/// dx = μ x dt + σ x dW: x(t) = x(0) exp((μ − σ²/2) t + σ W(t)).
struct Geometric;

const MU: f64 = 0.1;
const SIGMA: f64 = 0.5;

impl Model for Geometric {
    type Scalar = f64;
    type State = Price<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Price<f64>, _: &Nothing<f64>) -> Price<f64> {
        x.map(|x| MU * x)
    }
}

impl StochasticModel for Geometric {
    type Noise = Wiener<f64>;

    fn noise_increment(&self, x: &Price<f64>, _: &Nothing<f64>, dw: &Wiener<f64>) -> Price<f64> {
        x.map(|x| SIGMA * x * dw.w)
    }
}

/// ½ Σ L^k b^k, which Milstein's and Heun's schemes ask for.
impl ItoCorrected for Geometric {
    fn ito_correction(&self, x: &Price<f64>, _: &Nothing<f64>) -> Price<f64> {
        x.map(|x| 0.5 * SIGMA * SIGMA * x)
    }
}

impl DifferentiableNoise for Geometric {
    fn iterated_increment(
        &self,
        x: &Price<f64>,
        _: &Nothing<f64>,
        mut integral: impl FnMut(usize, usize) -> f64,
    ) -> Price<f64> {
        x.map(|x| SIGMA * SIGMA * x * integral(0, 0))
    }
}

/// A single column commutes with itself.
impl CommutativeNoise for Geometric {}

fn main() -> Result<(), StepError<f64>> {
    let (none, start) = (Nothing { none: 0.0 }, Price { price: 1.0 });
    // Normal numbers as functions of seed and member: the same path, whatever the level.
    let source = KeyedNormals { seed: 7, member: 0 };
    let mut path = BrownianPath::new(source, 1.0);
    let whole: WienerIntegrals<Wiener<f64>> = path.integrals(0, 0).expect("level 0 has one step");
    let exact = ((MU - 0.5 * SIGMA * SIGMA) + SIGMA * whole.dw.w).exp();

    println!("steps   Euler-Maruyama   Milstein");
    let mut errors = [0.0; 2];
    for level in [4, 7, 10, 13] {
        let dt = path.dt(level);
        let (mut euler, mut milstein) = (start, start);
        for step in 0..1 << level {
            let integrals = path.integrals(level, step).expect("a step of this level");
            ItoEulerMaruyama::new(dt).step(&Geometric, &mut euler, &none, &integrals.dw)?;
            ItoMilstein::new(dt).step(&Geometric, &mut milstein, &none, &integrals.dw)?;
        }
        errors = [euler, milstein].map(|x| (x.price - exact).abs());
        println!("{:5} {:16.1e} {:10.1e}", 1 << level, errors[0], errors[1]);
    }
    assert!(errors[0] < 1e-2 && errors[1] < 1e-4);
    Ok(())
}
