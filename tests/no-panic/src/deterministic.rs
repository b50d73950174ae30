//! Every deterministic stepper, with every kind of input, event and policy, at values that the optimiser does not know.

use ahv_core::{Bounds, DifferentiableModel, Model, Real, Vector};
use ahv_integrate::{
    Adaptive, ComponentLimit, Constant, Crossing, Dense, DormandPrince54, Euler, Event,
    Exponential, Feedback, Fixed, FlexibleMode, Held, Heun, InputSource, Interpolated, Leaving,
    Located, Method, Observer, Problem, Progress, Rk4, Rodas4, Saturated, Tsit5, When, Within,
};
use ahv_models::{com, dcom};
use core::hint::black_box;

use crate::unknown;

/// Flies COM and DCOM with all of them.
pub(crate) fn all<R: Real + Into<f64>>() {
    let p = black_box(dcom::NOMINAL.map_into(R::from_f64));
    model(
        &dcom::Model::new(&p),
        dcom::STATE_BOUNDS,
        dcom::INPUT_BOUNDS,
    );
    let p = black_box(com::NOMINAL.map_into(R::from_f64));
    model(&com::Model::new(&p), com::STATE_BOUNDS, com::INPUT_BOUNDS);
}
struct Seen;
impl<X> Observer<X> for Seen {
    fn accepted(&mut self, step: &Dense<X>) {
        black_box(step.end());
    }
    fn event(&mut self, event: &Located<X>) {
        black_box(event.time);
    }
    fn outside(&mut self, time: f64, _: &ahv_core::Outside) {
        black_box(time);
    }
    fn saturated(&mut self, time: f64, _: &ahv_core::Outside) {
        black_box(time);
    }
}
fn model<M: DifferentiableModel, B: Vector<Bounds>, C: Vector<Bounds>>(m: &M, b: B, c: C)
where
    M::Scalar: Into<f64>,
{
    let (mut x, u): (M::State, M::Input) = (unknown(), unknown());
    let dt = black_box(0.01);
    black_box(Euler::new(dt).step(m, &mut x, &u).is_ok());
    black_box(Heun::new(dt).step(m, &mut x, &u).is_ok());
    black_box(Rk4::new(dt).step(m, &mut x, &u).is_ok());
    black_box(Fixed::new(Tsit5, dt).step(m, &mut x, &u).is_ok());
    black_box(Fixed::new(DormandPrince54, dt).step(m, &mut x, &u).is_ok());
    black_box(Fixed::new(Rodas4, dt).step(m, &mut x, &u).is_ok());
    if let Some(mode) = FlexibleMode::new::<M>(black_box("eta_1"), black_box("eta_dot_1"), dt, dt) {
        black_box(
            Exponential::new(dt, [mode, mode])
                .step(m, &mut x, &u)
                .is_ok(),
        );
    }
    let times = black_box([0.0, 1.0, 2.0]);
    let values: [M::Input; 3] = [unknown(), unknown(), unknown()];
    if let Some(held) = Held::new(black_box(&times[..]), black_box(&values[..])) {
        runs(m, &Saturated::new(held, c), b);
    }
    if let Some(lines) = Interpolated::new(black_box(&times[..]), black_box(&values[..])) {
        runs(m, &Saturated::new(lines, c), b);
    }
    runs(m, &Constant(u), b);
    let scale = black_box(M::Scalar::ONE);
    runs(
        m,
        &Feedback(move |_, x: &M::State| {
            let first = x.get(0).unwrap_or(scale);
            M::Input::splat(first)
        }),
        b,
    );
}
fn runs<M: DifferentiableModel, I: InputSource<M>, B: Vector<Bounds>>(m: &M, input: &I, b: B)
where
    M::Scalar: Into<f64>,
{
    run(m, input, b, Tsit5);
    run(m, input, b, DormandPrince54);
    run(m, input, b, Rodas4);
}
fn run<M: Model, I: InputSource<M>, B: Vector<Bounds>, S: Method<M>>(m: &M, input: &I, b: B, s: S)
where
    M::Scalar: Into<f64>,
{
    let floor = ComponentLimit::at_least::<M>("floor", black_box("altitude"), black_box(1.0));
    let Some(floor) = floor else { return };
    let own = When::new("own", Crossing::Either, |t: f64, _: &M::State| {
        t - black_box(0.5)
    })
    .only_reported();
    let events: [&dyn Event<M>; 2] = [&floor, &own];
    let leaving = if black_box(true) {
        Leaving::Stop
    } else {
        Leaving::Warn
    };
    let problem = Problem::new(m, input)
        .validity(Within::new(b, leaving))
        .events(black_box(&events[..]));
    let mut progress = Progress::new(black_box(0.0), unknown());
    let solver = Adaptive::new(s, black_box(1e-6), unknown())
        .most_steps(black_box(10))
        .longest_step(black_box(1.0));
    black_box(
        solver
            .run(&problem, &mut progress, black_box(1.0), &mut Seen)
            .is_ok(),
    );
    black_box(
        solver
            .run(&problem, &mut progress, black_box(1.0), &mut ())
            .is_ok(),
    );
}
