//! The methods of `diffsol`, with nalgebra's dense matrices.

use std::cell::Cell;

use ahv_core::DifferentiableModel as _;
use ahv_models::dcom::State;
use diffsol::{
    ConstantOp, DenseMatrix as _, NalgebraContext, NalgebraLU, NalgebraMat, NalgebraVec,
    NonLinearOp, NonLinearOpJacobian, OdeBuilder, OdeEquations, OdeEquationsRef, OdeSolverMethod,
    OdeSolverProblem, OdeSolverStopReason, Op, UnitCallable,
};

use crate::{Flight, N, Solution, drift};

type Matrix = NalgebraMat<f64>;
type Lu = NalgebraLU<f64>;

/// The flight as `diffsol` wants its equations: right-hand side, Jacobian and start.
struct Equations<'f> {
    flight: &'f Flight,
    drifts: Cell<u64>,
    jacobians: Cell<u64>,
    context: NalgebraContext,
}

impl Op for Equations<'_> {
    type T = f64;
    type V = NalgebraVec<f64>;
    type M = Matrix;
    type C = NalgebraContext;

    fn context(&self) -> &NalgebraContext {
        &self.context
    }

    fn nstates(&self) -> usize {
        N
    }

    fn nout(&self) -> usize {
        N
    }

    fn nparams(&self) -> usize {
        0
    }
}

impl Equations<'_> {
    fn jacobian_of(&self, x: &[f64]) -> [[f64; N]; N] {
        self.jacobians.set(self.jacobians.get() + 1);
        let (by_state, _) = self
            .flight
            .model
            .jacobians(&State::from(array(x)), &self.flight.input);
        by_state.to_array().map(|row| row.to_array())
    }
}

impl NonLinearOp for Equations<'_> {
    fn call_inplace(&self, x: &Self::V, _: f64, rate: &mut Self::V) {
        self.drifts.set(self.drifts.get() + 1);
        rate.batch_as_mut_slice(0)
            .copy_from_slice(&drift(self.flight, array(x.batch_as_slice(0))));
    }
}

impl NonLinearOpJacobian for Equations<'_> {
    fn jac_mul_inplace(&self, x: &Self::V, _: f64, v: &Self::V, y: &mut Self::V) {
        let rows = self.jacobian_of(x.batch_as_slice(0));
        for (y, row) in y.batch_as_mut_slice(0).iter_mut().zip(rows) {
            *y = row
                .iter()
                .zip(v.batch_as_slice(0))
                .map(|(a, v)| a * v)
                .sum();
        }
    }

    fn jacobian_inplace(&self, x: &Self::V, _: f64, matrix: &mut Matrix) {
        for (i, row) in self
            .jacobian_of(x.batch_as_slice(0))
            .into_iter()
            .enumerate()
        {
            for (j, entry) in row.into_iter().enumerate() {
                matrix.set_index(i, j, entry);
            }
        }
    }
}

impl ConstantOp for Equations<'_> {
    fn call_inplace(&self, _: f64, x: &mut Self::V) {
        x.batch_as_mut_slice(0).copy_from_slice(&self.flight.state);
    }
}

impl<'a> OdeEquationsRef<'a> for Equations<'_> {
    type Mass = UnitCallable<Matrix>;
    type Rhs = &'a Self;
    type Root = UnitCallable<Matrix>;
    type Init = &'a Self;
    type Out = UnitCallable<Matrix>;
    type Reset = UnitCallable<Matrix>;
}

impl OdeEquations for Equations<'_> {
    fn rhs(&self) -> &Self {
        self
    }

    fn mass(&self) -> Option<UnitCallable<Matrix>> {
        None
    }

    fn init(&self) -> &Self {
        self
    }

    fn set_params(&mut self, _: &Self::V) {}

    fn get_params(&self, _: &mut Self::V) {}
}

/// `method` with this tolerance.
pub(crate) fn solver<'f>(
    flight: &'f Flight,
    method: &str,
    tolerance: f64,
) -> Result<Box<dyn FnMut() -> Result<Solution, String> + 'f>, String> {
    let equations = Equations {
        flight,
        drifts: Cell::new(0),
        jacobians: Cell::new(0),
        context: NalgebraContext::default(),
    };
    let problem = OdeBuilder::<Matrix>::new()
        .rtol(tolerance)
        .atol(flight.scales.map(|scale| tolerance * scale))
        .build_from_eqn(equations)
        .map_err(|it| it.to_string())?;
    macro_rules! solving {
        ($($new:tt)+) => {
            Box::new(move || run(&problem, problem.$($new)+().map_err(|it| it.to_string())?))
        };
    }
    Ok(match method {
        "BDF" => solving!(bdf::<Lu>),
        "TR-BDF2" => solving!(tr_bdf2::<Lu>),
        "ESDIRK34" => solving!(esdirk34::<Lu>),
        "Tsit45" => solving!(tsit45),
        _ => return Err(format!("no method {method}")),
    })
}

fn run<'p, 'f: 'p>(
    problem: &'p OdeSolverProblem<Equations<'f>>,
    mut solver: impl OdeSolverMethod<'p, Equations<'f>>,
) -> Result<Solution, String> {
    problem.eqn.drifts.set(0);
    problem.eqn.jacobians.set(0);
    solver
        .set_stop_time(problem.eqn.flight.end)
        .map_err(|it| it.to_string())?;
    let (mut steps, mut stopped) = (0, false);
    while !stopped {
        let reason = solver.step().map_err(|it| it.to_string())?;
        stopped = matches!(reason, OdeSolverStopReason::TstopReached);
        steps += 1;
    }
    Ok(Solution {
        state: array(solver.state().y.batch_as_slice(0)),
        steps,
        drifts: problem.eqn.drifts.get(),
        jacobians: problem.eqn.jacobians.get(),
    })
}

/// The state from `diffsol`'s vector.
fn array(x: &[f64]) -> [f64; N] {
    std::array::from_fn(|i| x.get(i).copied().unwrap_or(f64::NAN))
}
