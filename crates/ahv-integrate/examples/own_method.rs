//! A method of your own with control of the step size and dense output: Bogacki and Shampine's pair of orders 3 and 2 (1989).
//!
//! `cargo run -p ahv-integrate --example own_method`

use ahv_integrate::prelude::*;
use ahv_models::flexible_mode;

struct BogackiShampine32;

/// x + h Σ weights slopes.
fn ahead<R: Real, X: Vector<R>>(x: X, h: f64, weights: &[f64], slopes: &[X]) -> X {
    let terms = weights.iter().zip(slopes);
    terms.fold(x, |sum, (&weight, &slope)| {
        sum.zip_with(slope, |s, k| s + R::from_f64(h * weight) * k)
    })
}

impl<M: Model> Method<M> for BogackiShampine32 {
    /// The estimate is the difference from a result of order 2, whose error in a step is of order 3.
    const ERROR_ORDER: u8 = 3;

    /// The dense output takes the slopes at both ends.
    type Stages = [M::State; 2];

    fn attempt<I: InputSource<M>>(
        &self,
        model: &M,
        input: &I,
        start: &Start<M::State>,
        step: f64,
    ) -> Attempt<M::State, Self::Stages> {
        let (time, x) = (start.time, start.state);
        let slope = |c: f64, x: &M::State| model.drift(x, &input.at(time, time + c * step, x));
        let k1 = start.slope.unwrap_or_else(|| slope(0.0, &x));
        let k2 = slope(0.5, &ahead(x, step, &[0.5], &[k1]));
        let k3 = slope(0.75, &ahead(x, step, &[0.75], &[k2]));
        let next = ahead(x, step, &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0], &[k1, k2, k3]);
        let k4 = slope(1.0, &next);
        let difference = [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0];
        let zero = M::State::splat(M::Scalar::ZERO);
        Attempt {
            time,
            step,
            state: x,
            first_slope: Some(k1),
            next,
            last_slope: Some(k4),
            error: ahead(zero, step, &difference, &[k1, k2, k3, k4]),
            stages: [k1, k4],
        }
    }

    /// The cubic polynomial with the states and slopes of both ends.
    fn dense<I: InputSource<M>>(
        &self,
        _: &M,
        _: &I,
        attempt: &mut Attempt<M::State, Self::Stages>,
    ) -> Dense<M::State> {
        let [first, last] = attempt.stages.map(|slope| {
            let h = M::Scalar::from_f64(attempt.step);
            slope.map(|k| h * k)
        });
        let difference = attempt.next.zip_with(attempt.state, |b, a| b - a);
        let three = M::Scalar::from_f64(3.0);
        let square = difference
            .zip_with(first, |d, k| three * d - (k + k))
            .zip_with(last, |sum, k| sum - k);
        let cube = first
            .zip_with(last, |a, b| a + b)
            .zip_with(difference, |sum, d| sum - (d + d));
        let coefficients = [attempt.state, first, square, cube];
        Dense::new(attempt.time, attempt.step, coefficients)
    }
}

fn main() -> Result<(), Failure> {
    let model = flexible_mode::Model::new(&flexible_mode::NOMINAL);
    let force = flexible_mode::Input { force: 0.0 };
    let plucked = flexible_mode::State {
        eta: 1.0,
        ..flexible_mode::State::splat(0.0)
    };
    let zero = When::new(
        "zero",
        Crossing::Falling,
        |_, x: &flexible_mode::State<f64>| x.eta,
    );
    let events: [&dyn Event<_>; 1] = [&zero];
    let input = Constant(force);
    let problem = Problem::new(&model, &input).events(&events);

    println!("tolerance   steps   first zero in s     error");
    let p = flexible_mode::NOMINAL;
    let exact = (std::f64::consts::PI - p.zeta.acos()) / (p.omega * (1.0 - p.zeta * p.zeta).sqrt());
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let mut progress = Progress::new(0.0, plucked);
        Adaptive::new(
            BogackiShampine32,
            tolerance,
            flexible_mode::State::splat(tolerance),
        )
        .run(&problem, &mut progress, 1.0, &mut ())?;
        let error = (progress.time - exact).abs();
        println!(
            "{tolerance:9.0e} {:7} {:17.9} {error:9.1e}",
            progress.accepted, progress.time
        );
        assert!(error < tolerance);
    }
    Ok(())
}
