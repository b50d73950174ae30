//! How far the gain and the phase of each loop of a state feedback may be off before the closed loop is unstable.
//!
//! One loop is opened at an input at a time, the others stay closed: L(s) = kᵢ (sI − A + Σ bⱼ kⱼ)⁻¹ bᵢ, the sum over the other inputs.
//! The frequencies where L is real are zeros of L(s) − L(−s), those where |L| = 1 are eigenvalues of a Hamiltonian matrix (Boyd,
//! Balakrishnan and Kabamba 1989): no grid of frequencies is searched, and no narrow peak is passed over.
//!
//! ```
//! use ahv_analysis::margins::margins;
//! use nalgebra::DMatrix;
//!
//! // A double integrator with K = [1, √2]: as for every regulator the gain may grow without bound.
//! let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
//! let b = DMatrix::from_row_slice(2, 1, &[0.0, 1.0]);
//! let k = DMatrix::from_row_slice(1, 2, &[1.0, 2.0_f64.sqrt()]);
//! let found = margins(&a, &b, &k)?;
//! assert_eq!((found[0].least_gain, found[0].most_gain), (None, None));
//! assert!((found[0].phase.unwrap_or(0.0).to_degrees() - 65.53).abs() < 0.01);
//! # Ok::<(), ahv_analysis::margins::MarginError>(())
//! ```

use ahv_core::Shown;
use nalgebra::{Complex, DMatrix, DVector};

use crate::linearize::LinearSystem;
use crate::poles::{PolesError, eigen, zeros};

/// Relative error up to which L at a computed frequency is real, or of modulus 1.
const CROSSING: f64 = 1e-6;

/// Real part, over the norm of the closed loop, from which on a pole is unstable: a position that nothing feeds back is a pole at 0.
const UNSTABLE: f64 = 1e-10;

/// The margins of the loop that is opened at one input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// The factor of the gain below which the closed loop is unstable; none where it is stable down to 0.
    pub least_gain: Option<f64>,
    /// The factor of the gain above which it is unstable; none where it may grow without bound.
    pub most_gain: Option<f64>,
    /// The phase that makes it unstable, in rad; none where |L| is 1 nowhere.
    pub phase: Option<f64>,
}

/// Why there are no margins.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MarginError {
    /// Sizes that do not fit each other.
    #[error(
        "A must be square, B have its rows, and K a row for each column of B and a column for each of A"
    )]
    Size,
    /// A closed loop that is unstable has none.
    #[error("the closed loop is unstable: it has the pole {} {:+}i 1/s", Shown(*real), Shown(*imaginary))]
    Unstable {
        /// Real part, in 1/s.
        real: f64,
        /// Imaginary part, in 1/s.
        imaginary: f64,
    },
    /// Roots that were not found.
    #[error(transparent)]
    Roots(#[from] PolesError),
}

/// The margins at each input of dx/dt = A x + B u with u = −K x.
///
/// # Errors
///
/// [`MarginError`]
pub fn margins(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    gain: &DMatrix<f64>,
) -> Result<Vec<Margin>, MarginError> {
    let n = a.nrows();
    let fits = a.ncols() == n && b.nrows() == n && gain.shape() == (b.ncols(), n);
    if !fits {
        return Err(MarginError::Size);
    }
    let closed = a - b * gain;
    let poles = eigen::values(&closed).ok_or(PolesError::NoConvergence)?;
    let limit = UNSTABLE * closed.norm();
    if let Some(pole) = poles.iter().max_by(|a, b| a.re.total_cmp(&b.re))
        && pole.re > limit
    {
        return Err(MarginError::Unstable {
            real: pole.re,
            imaginary: pole.im,
        });
    }
    let loops = (0..b.ncols()).map(|input| {
        let (b, k) = (b.column(input).into_owned(), gain.row(input).transpose());
        Loop {
            a: &closed + &b * k.transpose(),
            b,
            k,
        }
        .margin()
    });
    loops.collect()
}

/// A loop that is opened at one input.
struct Loop {
    a: DMatrix<f64>,
    b: DVector<f64>,
    k: DVector<f64>,
}

impl Loop {
    fn margin(&self) -> Result<Margin, MarginError> {
        let real = self.real_at()?;
        let factors = real.iter().filter_map(|&omega| {
            let value = self.at(omega)?;
            (value.im.abs() <= CROSSING * modulus(value) && value.re < 0.0).then(|| -1.0 / value.re)
        });
        let factors: Vec<f64> = factors.filter(|it| it.is_finite()).collect();
        let of =
            |keep: &dyn Fn(f64) -> bool| factors.iter().copied().filter(|&it| keep(it)).collect();
        let [below, above]: [Vec<f64>; 2] = [of(&|it| it < 1.0), of(&|it| it > 1.0)];
        let phases = self.unit_at()?.into_iter().filter_map(|omega| {
            let value = self.at(omega)?;
            ((modulus(value) - 1.0).abs() <= CROSSING).then(|| (-value.im).atan2(-value.re).abs())
        });
        Ok(Margin {
            // What rounding leaves of a gain of 0 is none.
            least_gain: below
                .into_iter()
                .max_by(f64::total_cmp)
                .filter(|&gain| gain > CROSSING),
            most_gain: above.into_iter().min_by(f64::total_cmp),
            phase: phases.min_by(f64::total_cmp),
        })
    }

    /// L(jω); none at a pole.
    fn at(&self, omega: f64) -> Option<Complex<f64>> {
        let mut shifted = self.a.map(|it| Complex::from(-it));
        for i in 0..shifted.nrows() {
            shifted[(i, i)] += Complex::new(0.0, omega);
        }
        let x = shifted.lu().solve(&self.b.map(Complex::from))?;
        let value = x
            .iter()
            .zip(&self.k)
            .map(|(x, k)| x * *k)
            .sum::<Complex<f64>>();
        (value.re.is_finite() && value.im.is_finite()).then_some(value)
    }

    /// Frequencies where L may be real: zeros of L(s) − L(−s), in rad/s.
    fn real_at(&self) -> Result<Vec<f64>, MarginError> {
        let n = self.a.nrows();
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        a.view_mut((0, 0), (n, n)).copy_from(&self.a);
        a.view_mut((n, n), (n, n)).copy_from(&-&self.a);
        let twice = |it: &DVector<f64>| DMatrix::from_fn(2 * n, 1, |row, _| it[row % n]);
        let system = LinearSystem {
            states: vec![""; 2 * n],
            inputs: vec![""],
            outputs: vec![""],
            a,
            b: twice(&self.b),
            c: twice(&self.k).transpose(),
            d: DMatrix::zeros(1, 1),
        };
        let found = zeros(&system)?.finite;
        let up = found.iter().map(|it| it.value.im).filter(|it| *it >= 0.0);
        // L(0) is real, also where rounding moves that zero.
        Ok(up.chain([0.0]).collect())
    }

    /// Frequencies where |L| may be 1, in rad/s.
    fn unit_at(&self) -> Result<Vec<f64>, MarginError> {
        let n = self.a.nrows();
        let mut hamiltonian = DMatrix::zeros(2 * n, 2 * n);
        let mut put = |at, block: &DMatrix<f64>| hamiltonian.view_mut(at, (n, n)).copy_from(block);
        put((0, 0), &self.a);
        put((0, n), &(&self.b * self.b.transpose()));
        put((n, 0), &-(&self.k * self.k.transpose()));
        put((n, n), &-self.a.transpose());
        let values = eigen::values(&hamiltonian).ok_or(PolesError::NoConvergence)?;
        Ok(values
            .into_iter()
            .map(|it| it.im)
            .filter(|it| *it >= 0.0)
            .collect())
    }
}

fn modulus(value: Complex<f64>) -> f64 {
    value.re.hypot(value.im)
}
