//! Poles, their modes, and zeros of linear systems.

mod balance;
mod blocks;
pub(crate) mod eigen;
mod modes;
mod staircase;
mod zeros;

use ahv_core::ModeOfMotion;
use nalgebra::{Complex, DMatrix, DVector};

use crate::linearize::LinearSystem;
pub(crate) use balance::{balance, similar};
use blocks::blocks;
use eigen::Eigen;
pub use zeros::{Decoupling, Zero, Zeros, zeros};

/// A pole with the mode that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// The eigenvalue of A, 1/s.
    pub value: Complex<f64>,
    /// Name of the mode; `None` where no mode has such states.
    pub mode: Option<&'static str>,
    /// Share of the mode's states in the participation factors of this pole, from 0 to 1.
    pub participation: f64,
}

/// Why there are no poles or zeros.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PolesError {
    /// The QR iteration did not converge, as with entries that are not finite.
    #[error("the eigenvalues did not converge")]
    NoConvergence,
    /// The rank of the transfer matrix cannot be told from rounding.
    #[error("the rank of the transfer matrix cannot be told from rounding")]
    AmbiguousRank,
}

/// Damping ratio −Re λ/|λ| of a pole or zero λ: 1 for a real stable one; 0 for λ = 0.
pub fn damping(root: Complex<f64>) -> f64 {
    let frequency = frequency(root);
    if frequency > 0.0 {
        // A root on the imaginary axis has no sign.
        -root.re / frequency + 0.0
    } else {
        0.0
    }
}

/// Natural frequency |λ| of a pole or zero λ, rad/s.
pub fn frequency(root: Complex<f64>) -> f64 {
    root.re.hypot(root.im)
}

/// Poles of `system` by rising frequency, each with its mode among `modes`. A pole that rounding cannot tell from 0 is 0.
///
/// Modes are told by participation factors |uᵢ vᵢ| with right and left eigenvectors u, v (Perez-Arriaga, Verghese and
/// Schweppe 1982), which do not depend on units.
///
/// Poles are found block by block of states that act on each other. A state on which nothing depends, such as a position, has
/// a pole of its own: together with the states that drive it, the pole 0 would be multiple and its eigenvectors one.
///
/// # Errors
///
/// [`PolesError::NoConvergence`]
pub fn poles(system: &LinearSystem, modes: &[ModeOfMotion]) -> Result<Vec<Pole>, PolesError> {
    let balanced = similar(&system.a, &balance(&system.a));
    let mut found = Vec::with_capacity(balanced.nrows());
    for block in blocks(&balanced) {
        found.extend(of_block(&balanced, &block)?);
    }
    // The roots of a pair are equally large to the bit, the upper one stands first.
    found.sort_by(|(a, _), (b, _)| {
        let frequencies = frequency(*a).total_cmp(&frequency(*b));
        frequencies.then(b.im.total_cmp(&a.im))
    });
    Ok(modes::named(modes, &system.states, &found))
}

/// A pole with the participation of each state.
type Found = (Complex<f64>, DVector<f64>);

/// The poles of some states.
fn of_block(balanced: &DMatrix<f64>, block: &[usize]) -> Result<Vec<Found>, PolesError> {
    let n = block.len();
    let matrix = DMatrix::from_fn(n, n, |row, column| balanced[(block[row], block[column])]);
    let Eigen { values, vectors } =
        eigen::values_and_vectors(&matrix).ok_or(PolesError::NoConvergence)?;
    let participation = participation(&vectors);
    let pole = |index: usize| {
        let mut of_all = DVector::zeros(balanced.nrows());
        for (row, &state) in block.iter().enumerate() {
            of_all[state] = participation[(row, index)];
        }
        (told_from_zero(values[index], balanced), of_all)
    };
    Ok((0..n).map(pole).collect())
}

/// `root` of a balanced matrix or pencil; 0 where rounding cannot tell it from 0.
fn told_from_zero(root: Complex<f64>, balanced: &DMatrix<f64>) -> Complex<f64> {
    let rounding = f64::EPSILON * balanced.norm() * balanced.nrows() as f64;
    if frequency(root) > rounding {
        root
    } else {
        Complex::new(0.0, 0.0)
    }
}

/// Participation of states (rows) in poles (columns); columns sum to 1. All 0 without a full set of eigenvectors.
fn participation(right: &DMatrix<Complex<f64>>) -> DMatrix<f64> {
    let none = right.map(|_| 0.0);
    let Some(left) = right.clone().try_inverse() else {
        return none;
    };
    let mut factors = right.zip_map(&left.transpose(), |u, v| frequency(u * v));
    for mut column in factors.column_iter_mut() {
        let sum = column.sum();
        column /= sum;
    }
    match factors.iter().all(|it| it.is_finite()) {
        true => factors,
        false => none,
    }
}
