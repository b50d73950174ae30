//! Eigenvalues and eigenvectors of a real matrix, from its real Schur form.

use nalgebra::{Complex, DMatrix, Schur};

/// Steps of the QR iteration for each row, of which a handful suffices.
const STEPS: usize = 60;

/// A real matrix in coordinates in which it is triangular, but for blocks of two rows.
struct Form {
    /// The coordinates, orthonormal.
    basis: DMatrix<f64>,
    matrix: DMatrix<f64>,
    /// Its eigenvalues in the order of its diagonal.
    values: Vec<Complex<f64>>,
}

/// Eigenvalues as [`values`] gives them, and their eigenvectors.
pub(super) struct Eigen {
    pub(super) values: Vec<Complex<f64>>,
    /// Column by column.
    pub(super) vectors: DMatrix<Complex<f64>>,
}

/// Eigenvalues; the two of a pair are each other's conjugates to the bit, the upper one first. `None` if the iteration does
/// not converge, as with entries that are not finite.
pub(crate) fn values(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    form(matrix).map(|form| form.values)
}

/// Eigenvalues and eigenvectors; `None` as of [`values`].
pub(super) fn values_and_vectors(matrix: &DMatrix<f64>) -> Option<Eigen> {
    let form = form(matrix)?;
    let mut basis = form.basis.map(Complex::from);
    let mut triangle = form.matrix.map(Complex::from);
    for (row, upper) in form.values.iter().enumerate() {
        if upper.im > 0.0 {
            split(&mut basis, &mut triangle, row, *upper);
        }
    }
    Some(Eigen {
        vectors: basis * of_triangle(&triangle),
        values: form.values,
    })
}

/// The iteration stalls where a matrix is its own next iterate, as one that only permutes is. Mirrored, it is not.
fn form(matrix: &DMatrix<f64>) -> Option<Form> {
    let n = matrix.nrows();
    if n == 0 || matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let normal = DMatrix::from_fn(n, 1, |row, _| (row + 1) as f64).normalize();
    let mirror = DMatrix::identity(n, n) - 2.0 * &normal * normal.transpose();
    let in_basis = |basis: DMatrix<f64>| {
        let matrix = basis.tr_mul(matrix) * &basis;
        let schur = Schur::try_new(matrix, f64::EPSILON, STEPS * n)?;
        let values = schur.complex_eigenvalues().as_slice().to_vec();
        let (within, matrix) = schur.unpack();
        let basis = basis * within;
        let sound = values
            .iter()
            .all(|it| it.re.is_finite() && it.im.is_finite());
        sound.then_some(Form {
            basis,
            matrix,
            values,
        })
    };
    in_basis(DMatrix::identity(n, n)).or_else(|| in_basis(mirror))
}

/// Turns the block at `row`, whose eigenvalues are `upper` and its conjugate, into a triangular one.
fn split(
    basis: &mut DMatrix<Complex<f64>>,
    triangle: &mut DMatrix<Complex<f64>>,
    row: usize,
    upper: Complex<f64>,
) {
    let below = triangle[(row + 1, row)];
    let beside = upper - triangle[(row + 1, row + 1)];
    let norm = (below.norm_sqr() + beside.norm_sqr()).sqrt();
    let (x, y) = (beside / norm, below / norm);
    let turn = nalgebra::Matrix2::new(x, -y.conj(), y, x.conj());
    for matrix in [&mut *basis, &mut *triangle] {
        let turned = matrix.fixed_columns::<2>(row) * turn;
        matrix.fixed_columns_mut::<2>(row).copy_from(&turned);
    }
    let turned = turn.adjoint() * triangle.fixed_rows::<2>(row);
    triangle.fixed_rows_mut::<2>(row).copy_from(&turned);
    triangle[(row + 1, row)] = Complex::ZERO;
}

/// Eigenvectors of a triangular matrix, by substitution from below. Equal eigenvalues count as apart by a rounding.
fn of_triangle(triangle: &DMatrix<Complex<f64>>) -> DMatrix<Complex<f64>> {
    let n = triangle.nrows();
    let rounding = f64::EPSILON * triangle.norm().max(f64::MIN_POSITIVE);
    let mut vectors = DMatrix::identity(n, n);
    for column in 0..n {
        for row in (0..column).rev() {
            let known = row + 1..=column;
            let sum: Complex<f64> = known
                .map(|it| triangle[(row, it)] * vectors[(it, column)])
                .sum();
            let apart = triangle[(column, column)] - triangle[(row, row)];
            let apart = if apart.norm_sqr().sqrt() > rounding {
                apart
            } else {
                rounding.into()
            };
            vectors[(row, column)] = sum / apart;
        }
    }
    vectors
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A v = v λ, to `tolerance` of the largest entry.
    fn assert_solved(matrix: &DMatrix<f64>, tolerance: f64) {
        let Eigen { values, vectors } = values_and_vectors(matrix).expect("converges");
        let scaled = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(values));
        let rest = matrix.map(Complex::from) * &vectors - &vectors * scaled;
        for (of, rest) in vectors.column_iter().zip(rest.column_iter()) {
            assert!(
                rest.norm() <= tolerance * of.norm() * matrix.norm(),
                "{rest}"
            );
        }
    }

    #[test]
    fn vectors_are_solutions_also_of_what_permutes() {
        for n in 1..9 {
            // xⁿ = 1: each state is the next one's rate.
            let next = |row: usize, column| f64::from((row + 1) % n == column);
            assert_solved(&DMatrix::from_fn(n, n, next), 1e-14);
            let wild = |row: usize, column: usize| ((7 * row * row + 3 * column + 1) as f64).sin();
            assert_solved(&DMatrix::from_fn(n, n, wild), 1e-14);
        }
    }

    #[test]
    fn roots_of_one_are_found() {
        let n = 6;
        let next = DMatrix::from_fn(n, n, |row, column| f64::from((row + 1) % n == column));
        let values = values(&next).expect("converges");
        for k in 0..n {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
            let near = |it: &&Complex<f64>| (it.re - cos).hypot(it.im - sin) < 1e-14;
            assert_eq!(values.iter().filter(near).count(), 1, "{k}");
        }
    }

    #[test]
    fn what_is_not_finite_has_none() {
        let matrix = DMatrix::from_element(3, 3, f64::NAN);
        assert_eq!(values(&matrix), None);
    }
}
