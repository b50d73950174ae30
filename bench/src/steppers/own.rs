//! The product's steppers.

use std::cell::Cell;
use std::hint::black_box;
use std::rc::Rc;
use std::time::Instant;

use ahv_core::{DifferentiableModel, Model, Pattern, Vector as _};
use ahv_integrate::{
    Adaptive, Constant, DormandPrince54, DormandPrince853, Euler, Exponential, Fixed, FlexibleMode,
    Heun, Problem, Progress, Rk4, Rodas4, Tsit5,
};
use ahv_models::dcom::{self, Input, InputJacobian, Parameters, State, StateJacobian};

use super::flights::{END, Flight, Flights};
use super::solver::{Request, Solution, Solver, steps, tolerances};

/// DCOM, counting its evaluations.
struct Counted<'m> {
    model: &'m dcom::Model<f64>,
    drifts: Cell<u64>,
    jacobians: Cell<u64>,
}

impl Model for Counted<'_> {
    type Scalar = f64;
    type State = State<f64>;
    type Input = Input<f64>;

    fn drift(&self, x: &State<f64>, u: &Input<f64>) -> State<f64> {
        self.drifts.set(self.drifts.get() + 1);
        self.model.drift(x, u)
    }
}

impl DifferentiableModel for Counted<'_> {
    type StateJacobian = StateJacobian<f64>;
    type InputJacobian = InputJacobian<f64>;

    const STATE_JACOBIAN_PATTERN: Pattern<2> = dcom::Model::<f64>::STATE_JACOBIAN_PATTERN;

    fn jacobians(
        &self,
        x: &State<f64>,
        u: &Input<f64>,
    ) -> (StateJacobian<f64>, InputJacobian<f64>) {
        self.jacobians.set(self.jacobians.get() + 1);
        self.model.jacobians(x, u)
    }

    fn drift_and_jacobians(
        &self,
        x: &State<f64>,
        u: &Input<f64>,
    ) -> (State<f64>, StateJacobian<f64>, InputJacobian<f64>) {
        self.drifts.set(self.drifts.get() + 1);
        self.jacobians.set(self.jacobians.get() + 1);
        self.model.drift_and_jacobians(x, u)
    }
}

/// A stepper for any model with the vectors of DCOM.
trait Stepper: 'static {
    /// The end of the flight and the number of steps, at this setting.
    fn fly<M>(&self, model: &M, flight: &Flight, setting: f64) -> Result<(State<f64>, u64), String>
    where
        M: DifferentiableModel<Scalar = f64, State = State<f64>, Input = Input<f64>>;
}

/// Steppers with a fixed step.
macro_rules! fixed {
    ($($name:ident($dt:ident, $flight:ident): $stepper:expr;)+) => {$(
        struct $name;

        impl Stepper for $name {
            fn fly<M>(&self, model: &M, $flight: &Flight, steps: f64) -> Result<(State<f64>, u64), String>
            where
                M: DifferentiableModel<Scalar = f64, State = State<f64>, Input = Input<f64>>,
            {
                let ($dt, steps) = (END / steps, steps as u64);
                let stepper = $stepper;
                let mut x = $flight.start;
                for _ in 0..steps {
                    let stepped = stepper.step(model, &mut x, &$flight.input);
                    stepped.map_err(|it| it.to_string())?;
                }
                Ok((x, steps))
            }
        }
    )+};
}

fixed! {
    FixedEuler(dt, flight): Euler::new(dt);
    FixedHeun(dt, flight): Heun::new(dt);
    FixedRk4(dt, flight): Rk4::new(dt);
    FixedTsit5(dt, flight): Fixed::new(Tsit5, dt);
    FixedDormandPrince54(dt, flight): Fixed::new(DormandPrince54, dt);
    FixedDormandPrince853(dt, flight): Fixed::new(DormandPrince853, dt);
    FixedRodas4(dt, flight): Fixed::new(Rodas4, dt);
    FixedExponential(dt, flight): Exponential::new(dt, modes(&flight.parameters)?);
}

/// Steppers with control of the step.
macro_rules! adaptive {
    ($($name:ident: $method:ident;)+) => {$(
        struct $name {
            scales: State<f64>,
        }

        impl Stepper for $name {
            fn fly<M>(&self, model: &M, flight: &Flight, tolerance: f64) -> Result<(State<f64>, u64), String>
            where
                M: DifferentiableModel<Scalar = f64, State = State<f64>, Input = Input<f64>>,
            {
                let absolute = self.scales.map(|scale| tolerance * scale);
                let input = Constant(flight.input);
                let mut progress = Progress::new(0.0, flight.start);
                let run = Adaptive::new($method, tolerance, absolute);
                let ending = run.run(&Problem::new(model, &input), &mut progress, END, &mut ());
                ending.map_err(|it| it.to_string())?;
                Ok((progress.state, progress.accepted.into()))
            }
        }
    )+};
}

adaptive! {
    AdaptiveTsit5: Tsit5;
    AdaptiveDormandPrince54: DormandPrince54;
    AdaptiveDormandPrince853: DormandPrince853;
    AdaptiveRodas4: Rodas4;
}

/// The flexible modes of these parameters.
pub(crate) fn modes(p: &Parameters<f64>) -> Result<[FlexibleMode; 3], String> {
    let mode = |position, rate, omega, zeta| {
        let mode = FlexibleMode::new::<dcom::Model<f64>>(position, rate, omega, zeta);
        mode.ok_or_else(|| format!("error: {position} is no mode"))
    };
    Ok([
        mode("eta_1", "eta_dot_1", p.omega_1, p.zeta_1)?,
        mode("eta_2", "eta_dot_2", p.omega_2, p.zeta_2)?,
        mode("eta_3", "eta_dot_3", p.omega_3, p.zeta_3)?,
    ])
}

/// All of them.
pub(crate) fn solvers(flights: &Rc<Flights>) -> Vec<Solver> {
    let scales = flights.scales;
    vec![
        solver("ahv `Euler`", steps(9, 22), FixedEuler, flights),
        solver("ahv `Heun`", steps(6, 20), FixedHeun, flights),
        solver("ahv `Rk4`", steps(3, 16), FixedRk4, flights),
        solver("ahv `Fixed<Tsit5>`", steps(3, 14), FixedTsit5, flights),
        solver(
            "ahv `Fixed<DormandPrince54>`",
            steps(3, 14),
            FixedDormandPrince54,
            flights,
        ),
        solver(
            "ahv `Fixed<DormandPrince853>`",
            steps(3, 14),
            FixedDormandPrince853,
            flights,
        ),
        solver("ahv `Fixed<Rodas4>`", steps(3, 14), FixedRodas4, flights),
        solver("ahv `Exponential`", steps(3, 14), FixedExponential, flights),
        solver(REFERENCE, tolerances(), AdaptiveTsit5 { scales }, flights),
        solver(
            "ahv `Adaptive<DormandPrince54>`",
            tolerances(),
            AdaptiveDormandPrince54 { scales },
            flights,
        ),
        solver(
            "ahv `Adaptive<DormandPrince853>`",
            tolerances(),
            AdaptiveDormandPrince853 { scales },
            flights,
        ),
        solver(
            "ahv `Adaptive<Rodas4>`",
            tolerances(),
            AdaptiveRodas4 { scales },
            flights,
        ),
    ]
}

/// The one whose tightest solution is the reference for errors.
pub(crate) const REFERENCE: &str = "ahv `Adaptive<Tsit5>`";

fn solver(name: &str, settings: Vec<f64>, stepper: impl Stepper, flights: &Rc<Flights>) -> Solver {
    let flights = Rc::clone(flights);
    let models = flights
        .all
        .each_ref()
        .map(|it| dcom::Model::new(&it.parameters));
    let solve = move |request: &Request| {
        let pair = models
            .get(request.flight)
            .zip(flights.all.get(request.flight));
        let (model, flight) = pair.ok_or("error: no such flight")?;
        let counted = Counted {
            model,
            drifts: Cell::new(0),
            jacobians: Cell::new(0),
        };
        let (state, steps) = stepper.fly(&counted, flight, request.setting)?;
        let begin = Instant::now();
        for _ in 0..request.repeats {
            let setting = black_box(request.setting);
            let _ = black_box(stepper.fly(model, flight, setting)?);
        }
        Ok(Solution {
            seconds: begin.elapsed().as_secs_f64() / f64::from(request.repeats.max(1)),
            state: state.to_array(),
            steps,
            drifts: counted.drifts.get(),
            jacobians: counted.jacobians.get(),
        })
    };
    Solver {
        name: name.to_owned(),
        settings,
        solve: Box::new(solve),
    }
}
