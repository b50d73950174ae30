//! A stochastic scheme of your own, run by the same code as the library's: the tamed Euler scheme of Hutzenthaler, Jentzen
//! and Kloeden (2012), for drifts that grow faster than the state.
//!
//! `cargo run -p ahv-integrate --example own_scheme`

use ahv_integrate::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
struct State<T> {
    x: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Noise<T> {
    w: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Nothing<T> {
    none: T,
}

impl_vector!(State { x: ["1", "1", 1.0] });
impl_vector!(Noise { w: ["1", "1", 1.0] });
impl_vector!(Nothing {
    none: ["1", "1", 1.0]
});

/// dx = −x³ dt + dW
struct Cubic;

impl Model for Cubic {
    type Scalar = f64;
    type State = State<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &State<f64>, _: &Nothing<f64>) -> State<f64> {
        x.map(|x| -x * x * x)
    }
}

impl StochasticModel for Cubic {
    type Noise = Noise<f64>;

    fn noise_increment(&self, _: &State<f64>, _: &Nothing<f64>, dw: &Noise<f64>) -> State<f64> {
        State { x: dw.w }
    }
}

/// x ← x + f h/(1 + h |f|) + G ΔW
struct TamedEuler {
    dt: f64,
}

impl<M: StochasticModel> SdeScheme<M> for TamedEuler {
    const SENSE: Sense = Sense::Ito;
    const ADMITS: Admits = Admits::Any;

    fn set_up(_: &M, _: &M::State, _: &M::Input, dt: f64) -> Result<Self, NoiseError> {
        Ok(Self { dt })
    }

    fn step_from_normals(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        normal: impl Fn(usize) -> f64,
    ) -> Result<(), StepError<M::Scalar>> {
        let root = self.dt.sqrt();
        let dw = M::Noise::from_fn(|channel| M::Scalar::from_f64(root * normal(channel)));
        let (drift, noise) = model.drift_and_noise_increment(x, u, &dw);
        let mut square = M::Scalar::ZERO;
        drift.map(|f| {
            square = square + f * f;
            f
        });
        let dt = M::Scalar::from_f64(self.dt);
        let tamed = dt / (M::Scalar::ONE + dt * square.sqrt());
        let next = x
            .zip_with(drift, |x, f| x + tamed * f)
            .zip_with(noise, |x, g| x + g);
        if let Some((name, value)) = next.find(|component| !component.is_finite()) {
            return Err(StepError::NonFinite { name, value });
        }
        *x = next;
        Ok(())
    }
}

/// Runs any scheme for 5 s.
fn fly<S: SdeScheme<Cubic>>(start: f64, dt: f64) -> Result<f64, Box<dyn std::error::Error>> {
    let (mut x, none) = (State { x: start }, Nothing { none: 0.0 });
    let scheme = S::set_up(&Cubic, &x, &none, dt)?;
    for step in 0..(5.0 / dt) as u64 {
        let normal = |index: usize| NormalStream::new(3, 0, index as u64).normal(step);
        scheme.step_from_normals(&Cubic, &mut x, &none, normal)?;
    }
    Ok(x.x)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for start in [1.0, 20.0] {
        println!("from {start}:");
        println!("  TamedEuler        {:?}", fly::<TamedEuler>(start, 0.01)?);
        match fly::<ItoEulerMaruyama>(start, 0.01) {
            Ok(end) => println!("  ItoEulerMaruyama  {end:?}"),
            Err(why) => println!("  ItoEulerMaruyama  {why}"),
        }
    }
    // From 20 the steps of Euler and Maruyama's scheme overshoot further and further.
    assert!(fly::<TamedEuler>(20.0, 0.01)?.abs() < 5.0);
    assert!(fly::<ItoEulerMaruyama>(20.0, 0.01).is_err());
    Ok(())
}
