//! Linear systems: zeros, and the regulator.

use ahv_analysis::linearize::LinearSystem;
use ahv_analysis::lqr::Regulator;
use ahv_analysis::poles::{self, Decoupling};
use nalgebra::{Complex, DMatrix};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::failure::numeric;

/// A matrix of rows.
pub(crate) type Nested = Vec<Vec<f64>>;
/// Real and imaginary part.
pub(crate) type Pair = (f64, f64);

pub(crate) fn matrix(array: &PyReadonlyArray2<'_, f64>) -> DMatrix<f64> {
    let array = array.as_array();
    DMatrix::from_fn(array.nrows(), array.ncols(), |row, column| {
        array[(row, column)]
    })
}

pub(crate) fn nested(matrix: &DMatrix<f64>) -> Nested {
    let rows = matrix.row_iter();
    rows.map(|row| row.iter().copied().collect()).collect()
}

pub(crate) fn pair(root: &Complex<f64>) -> Pair {
    (root.re, root.im)
}

/// Finite zeros, each with what misses it, the normal rank, and the orders of the infinite zeros.
type Zeros = (Vec<(Pair, Option<&'static str>)>, usize, Vec<usize>);

/// Invariant zeros of a linear system.
#[pyfunction]
pub(crate) fn zeros(
    py: Python<'_>,
    a: PyReadonlyArray2<'_, f64>,
    b: PyReadonlyArray2<'_, f64>,
    c: PyReadonlyArray2<'_, f64>,
    d: PyReadonlyArray2<'_, f64>,
) -> PyResult<Zeros> {
    let system = LinearSystem {
        states: Vec::new(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        a: matrix(&a),
        b: matrix(&b),
        c: matrix(&c),
        d: matrix(&d),
    };
    let zeros = py.detach(|| poles::zeros(&system));
    let zeros = zeros.map_err(|error| numeric(py, error))?;
    let finite = zeros.finite.iter().map(|zero| {
        let misses = zero.decoupling.map(|it| match it {
            Decoupling::Input => "input",
            Decoupling::Output => "output",
        });
        (pair(&zero.value), misses)
    });
    Ok((finite.collect(), zeros.normal_rank, zeros.infinite_orders))
}

/// The gain K, the cost X, the poles of A − B K, and the residual of the Riccati equation.
#[pyfunction]
pub(crate) fn regulator(
    py: Python<'_>,
    a: PyReadonlyArray2<'_, f64>,
    b: PyReadonlyArray2<'_, f64>,
    q: PyReadonlyArray2<'_, f64>,
    r: PyReadonlyArray2<'_, f64>,
) -> PyResult<(Nested, Nested, Vec<Pair>, f64)> {
    let [a, b, q, r] = [a, b, q, r].map(|array| matrix(&array));
    let found = py.detach(|| Regulator::new(&a, &b, &q, &r));
    let found = found.map_err(|error| numeric(py, error))?;
    let poles = found.poles.iter().map(pair).collect();
    Ok((
        nested(&found.gain),
        nested(&found.cost),
        poles,
        found.residual,
    ))
}
