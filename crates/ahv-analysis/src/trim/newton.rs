//! A damped Newton method without bounds.

use ahv_core::GeneratedModel;

use super::{Point, System};

/// Newton steps before the search gives up; from a cold start the models of this project need about six.
const MAX_ITERATIONS: usize = 50;

/// Halvings of a Newton step before the search gives up.
const MAX_HALVINGS: i32 = 30;

/// Largest admissible scaled residual.
const TOLERANCE: f64 = 1e-12;

/// Where Newton's method ended.
pub(super) struct Outcome<M: GeneratedModel> {
    pub(super) point: Point<M>,
    pub(super) converged: bool,
    pub(super) iterations: usize,
}

impl<M: GeneratedModel> System<'_, M> {
    /// Newton's method from `point`, each step halved until the residual shrinks.
    pub(super) fn solve(&self, mut point: Point<M>) -> Outcome<M> {
        let mut iterations = 0;
        let mut residual = self.residual(&point);
        loop {
            let converged = residual.as_ref().is_some_and(|it| it.amax() <= TOLERANCE);
            let next = (!converged && iterations < MAX_ITERATIONS)
                .then(|| self.newton_step(&point, residual.as_ref()?))
                .flatten();
            let Some(next) = next else {
                return Outcome {
                    point,
                    converged,
                    iterations,
                };
            };
            iterations += 1;
            point = next;
            residual = self.residual(&point);
        }
    }

    /// `None` where the equations are singular, or no part of the step makes the residual shrink.
    fn newton_step(&self, point: &Point<M>, residual: &nalgebra::DVector<f64>) -> Option<Point<M>> {
        let step = self.jacobian(point).lu().solve(residual)?;
        (0..=MAX_HALVINGS).find_map(|halvings| {
            let next = self.moved(point, &(&step * -libm::ldexp(1.0, -halvings)))?;
            let shrinks = self.residual(&next)?.norm() < residual.norm();
            shrinks.then_some(next)
        })
    }
}
