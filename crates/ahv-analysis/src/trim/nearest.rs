//! A Levenberg-Marquardt method inside the bounds: Moré 1978, with the step projected onto the box.

use ahv_core::GeneratedModel;
use nalgebra::{DMatrix, DVector};

use super::{Blocking, Point, System};

/// Steps before the search gives up.
const MAX_ITERATIONS: usize = 500;

/// Cosine between residual and a column of the Jacobian below which the unknown no longer helps.
const STATIONARY: f64 = 1e-6;

/// Scaled residual at which there is nothing left to reduce.
const SOLVED: f64 = 1e-12;

/// Damping at the start, its factor after a step that fails, and the damping that ends the search.
const DAMPING: (f64, f64, f64) = (1e-3, 10.0, 1e12);

impl<M: GeneratedModel> System<'_, M> {
    /// The point inside the bounds with a minimum of the sum of squares, from `start`, and the steps taken.
    pub(super) fn nearest(&self, start: Point<M>) -> (Point<M>, usize) {
        let mut point = self.clamped(&start);
        let (mut damping, factor, hopeless) = DAMPING;
        for iteration in 0..MAX_ITERATIONS {
            let Some((jacobian, residual)) = self.descent(&point) else {
                return (point, iteration);
            };
            let step = damped_step(&jacobian, &residual, damping);
            let next = step.and_then(|step| Some(self.clamped(&self.moved(&point, &step)?)));
            let better = next.filter(|next| {
                let reduced = self.residual(next);
                reduced.is_some_and(|reduced| reduced.norm() < residual.norm())
            });
            match better {
                Some(next) => (point, damping) = (next, damping / factor),
                None if damping > hopeless => return (point, iteration),
                None => damping *= factor,
            }
        }
        (point, MAX_ITERATIONS)
    }

    /// The bounds that stop a descent at `point`.
    pub(super) fn blocking(&self, point: &Point<M>) -> Vec<Blocking> {
        let Some(residual) = self.residual(point) else {
            return Vec::new();
        };
        let gradient = self.jacobian(point).tr_mul(&residual);
        self.stops(point, &gradient).into_iter().flatten().collect()
    }

    /// Jacobian, without the columns that a bound stops, and residual; `None` where nothing can be reduced.
    fn descent(&self, point: &Point<M>) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let residual = self.residual(point)?;
        let mut jacobian = self.jacobian(point);
        let gradient = jacobian.tr_mul(&residual);
        let stops = self.stops(point, &gradient);
        for (mut column, stop) in jacobian.column_iter_mut().zip(&stops) {
            if stop.is_some() {
                column.fill(0.0);
            }
        }
        let norm = residual.norm();
        let helps = jacobian
            .column_iter()
            .any(|column| column.dot(&residual).abs() > STATIONARY * column.norm() * norm);
        (helps && norm > SOLVED).then_some((jacobian, residual))
    }
}

/// Minimises |J s + r|² + damping·|D s|², D the norms of the columns; 0 along columns of zeros.
fn damped_step(
    jacobian: &DMatrix<f64>,
    residual: &DVector<f64>,
    damping: f64,
) -> Option<DVector<f64>> {
    let mut normal = jacobian.tr_mul(jacobian);
    for i in 0..normal.nrows() {
        let square = normal[(i, i)];
        normal[(i, i)] = if square > 0.0 {
            square * (1.0 + damping)
        } else {
            1.0
        };
    }
    let gradient = jacobian.tr_mul(residual);
    normal.cholesky().map(|it| it.solve(&-gradient))
}
