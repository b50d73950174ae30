//! Exact transitions of linear equations with additive noise.

use core::array::from_fn;

use ahv_core::Real;

use crate::StepError;
use crate::error::step_size;

type Matrix<R, const N: usize> = [[R; N]; N];

/// The transition is found for dt/2²⁰ by series and doubled this often, or more often where A is larger.
const DOUBLINGS: usize = 20;
/// Most doublings: after as many, no step is left of any dt.
const MOST_DOUBLINGS: usize = 2200;
/// Sum of |A| times the small step, at most: the series then has no error but that of rounding.
const SMALL: f64 = 1.0 / 32.0;
/// Terms of those series.
const TERMS: usize = 8;

/// The exact transition of dx = (A x + c) dt + B dW over a step, with constant A and B and a held c.
///
/// x(t + dt) = Φ x(t) + Ψ c + L z with Φ = exp(A dt), Ψ = ∫ exp(A s) ds, z standard normal, and L Lᵀ the exact covariance
/// ∫ exp(A s) BBᵀ exp(Aᵀ s) ds. The law has no error at any dt but that of rounding. The noise is additive: Itô and Stratonovich agree.
///
/// Computed by a series for a small part of the step and by doubling, as often as ‖A‖ dt asks for; no case of damping is
/// special. With a scalar of several lanes a direction that has no variance in one lane is left out of L in all.
///
/// What shares its noise with other states goes into one transition: with A = [0, 0; 0, −a] and
/// BBᵀ = [1, b; b, b²] it is the joint law of the Wiener increment, from 0, and of the coloured noise that it drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearTransition<R, const N: usize> {
    transition: Matrix<R, N>,
    forced: Matrix<R, N>,
    covariance: Matrix<R, N>,
    root: Matrix<R, N>,
}

impl<R: Real> LinearTransition<R, 1> {
    /// The Ornstein–Uhlenbeck process dχ = −a χ dt + b dW over a step of `dt`, in s, with the rate a = `decay`, in 1/s,
    /// and b = `diffusion`, in the unit of χ per s^½.
    ///
    /// # Errors
    ///
    /// [`StepError::StepSize`] unless `dt` is positive and finite.
    pub fn ornstein_uhlenbeck(decay: R, diffusion: R, dt: f64) -> Result<Self, StepError<R>> {
        Self::new([[-decay]], [[diffusion * diffusion]], dt)
    }
}

impl<R: Real> LinearTransition<R, 2> {
    /// The pair (η, η̇) of the mode η̈ + 2ζω η̇ + ω² η = F + σ ξ with white noise ξ over a step of `dt`, in s.
    ///
    /// `omega` in rad/s, `zeta` a number, `sigma` in the unit of η per s^³⁄²; F, held, is the second component of the
    /// force. Any damping.
    ///
    /// # Errors
    ///
    /// [`StepError::StepSize`] unless `dt` is positive and finite.
    pub fn mode(omega: R, zeta: R, sigma: R, dt: f64) -> Result<Self, StepError<R>> {
        let o = R::ZERO;
        let a = [[o, R::ONE], [-(omega * omega), -(R::TWO * zeta * omega)]];
        Self::new(a, [[o, o], [o, sigma * sigma]], dt)
    }
}

impl<R: Real> LinearTransition<R, 3> {
    /// (η, η̇, χ): the mode η̈ + 2ζω η̇ + ω² η = F + σ ξ and the coloured noise dχ = −a χ dt + b dW of one and the same
    /// white noise ξ over a step of `dt`, in s. Units as for the two by themselves; a = `decay`, b = `diffusion`.
    ///
    /// # Errors
    ///
    /// [`StepError::StepSize`] unless `dt` is positive and finite.
    pub fn mode_and_coloured_noise(
        [omega, zeta, sigma]: [R; 3],
        [decay, diffusion]: [R; 2],
        dt: f64,
    ) -> Result<Self, StepError<R>> {
        let o = R::ZERO;
        let a = [
            [o, R::ONE, o],
            [-(omega * omega), -(R::TWO * zeta * omega), o],
            [o, o, -decay],
        ];
        let b = [o, sigma, diffusion];
        Self::new(a, b.map(|row| b.map(|column| row * column)), dt)
    }
}

impl<R: Real, const N: usize> LinearTransition<R, N> {
    /// The transition over a step of `dt`, in s, of A = `a`, in 1/s, and BBᵀ = `intensity`, per s.
    ///
    /// # Errors
    ///
    /// [`StepError::StepSize`] unless `dt` is positive and finite.
    pub fn new(a: [[R; N]; N], intensity: [[R; N]; N], dt: f64) -> Result<Self, StepError<R>> {
        let mut small = step_size::<R>(dt)? * R::from_f64(1.0 / (1_u64 << DOUBLINGS) as f64);
        let norm = a
            .iter()
            .flatten()
            .fold(R::ZERO, |sum, &entry| sum + entry.abs());
        // In every lane: a root is finite from 0 on.
        let is_small = |small: R| (R::from_f64(SMALL) - norm * small).sqrt().is_finite();
        let mut doublings = DOUBLINGS;
        while !is_small(small) && doublings < MOST_DOUBLINGS {
            (small, doublings) = (small * R::HALF, doublings + 1);
        }
        // What Φ has over 1 is kept: the 1 would hide it.
        let (mut excess, mut forced, mut covariance) = series(&a, &intensity, small);
        for _ in 0..doublings {
            covariance = sum(&covariance, &carried(&excess, &covariance));
            forced = sum(&sum(&forced, &forced), &product(&excess, &forced));
            excess = sum(&sum(&excess, &excess), &product(&excess, &excess));
        }
        Ok(Self {
            transition: sum(&excess, &diagonal(R::ONE)),
            forced,
            covariance,
            root: cholesky(&covariance),
        })
    }

    /// The transition with another scalar: `f` applied to every entry.
    #[inline(always)]
    pub fn map_ref<U: Real>(&self, f: impl Fn(&R) -> U + Copy) -> LinearTransition<U, N> {
        LinearTransition {
            transition: mapped(&self.transition, f),
            forced: mapped(&self.forced, f),
            covariance: mapped(&self.covariance, f),
            root: mapped(&self.root, f),
        }
    }

    /// Φ.
    pub const fn transition(&self) -> &[[R; N]; N] {
        &self.transition
    }

    /// Ψ, in s.
    pub const fn forced(&self) -> &[[R; N]; N] {
        &self.forced
    }

    /// The covariance of what the noise adds over a step.
    pub const fn covariance(&self) -> &[[R; N]; N] {
        &self.covariance
    }

    /// L, lower triangular; a direction without variance has a column of zeros.
    pub const fn root(&self) -> &[[R; N]; N] {
        &self.root
    }

    /// The state after the step without force: `normals` are independent standard normal numbers.
    #[inline(always)]
    pub fn free_step(&self, x: &[R; N], normals: &[R; N]) -> [R; N] {
        let (moved, noise) = (applied(&self.transition, x), applied(&self.root, normals));
        zip(&moved, &noise, |a, b| a + b)
    }

    /// The state after the step: `force` is c, held, in the units of the state per second, and `normals` are independent
    /// standard normal numbers.
    #[inline(always)]
    pub fn step(&self, x: &[R; N], force: &[R; N], normals: &[R; N]) -> [R; N] {
        let parts = [
            applied(&self.transition, x),
            applied(&self.forced, force),
            applied(&self.root, normals),
        ];
        parts
            .iter()
            .fold([R::ZERO; N], |total, part| zip(&total, part, |a, b| a + b))
    }
}

/// exp(A h) − 1, ∫ exp(A s) ds and ∫ exp(A s) Q exp(Aᵀ s) ds over h, by their series.
fn series<R: Real, const N: usize>(
    a: &Matrix<R, N>,
    q: &Matrix<R, N>,
    h: R,
) -> (Matrix<R, N>, Matrix<R, N>, Matrix<R, N>) {
    // Terms (A h)^n/n!, A^(n−1) hⁿ/n! and (A· + ·Aᵀ)^(n−1) Q hⁿ/n!.
    let mut forced_term = diagonal(h);
    let mut covariance_term = scaled(q, h);
    let mut excess = product(a, &forced_term);
    let (mut forced, mut covariance) = (forced_term, covariance_term);
    for n in 2..=TERMS {
        let factor = h / R::from_f64(n as f64);
        forced_term = scaled(&product(a, &forced_term), factor);
        let left = product(a, &covariance_term);
        covariance_term = scaled(&sum(&left, &transposed(&left)), factor);
        excess = sum(&excess, &product(a, &forced_term));
        forced = sum(&forced, &forced_term);
        covariance = sum(&covariance, &covariance_term);
    }
    (excess, forced, covariance)
}

/// Φ Σ Φᵀ with Φ = 1 + `excess`.
fn carried<R: Real, const N: usize>(excess: &Matrix<R, N>, sigma: &Matrix<R, N>) -> Matrix<R, N> {
    let left = sum(sigma, &product(excess, sigma));
    sum(&left, &product(&left, &transposed(excess)))
}

/// L with L Lᵀ = `c`, lower triangular. A direction without variance gets a column of zeros.
fn cholesky<R: Real, const N: usize>(c: &Matrix<R, N>) -> Matrix<R, N> {
    let mut rows = [[R::ZERO; N]; N];
    for i in 0..N {
        let mut row = [R::ZERO; N];
        for j in 0..=i {
            // Row i is not yet in place; its columns before j are.
            let other = if j == i { row } else { line(&rows, j) };
            let known = row
                .iter()
                .zip(&other)
                .take(j)
                .fold(R::ZERO, |total, (&a, &b)| total + a * b);
            let rest = entry(c, i, j) - known;
            let value = if j == i {
                finite(rest.sqrt())
            } else {
                finite(rest / entry(&rows, j, j))
            };
            if let Some(place) = row.get_mut(j) {
                *place = value;
            }
        }
        if let Some(place) = rows.get_mut(i) {
            *place = row;
        }
    }
    rows
}

/// `value`, or 0 where it is infinite or NaN: the pivot was 0, or below by rounding.
fn finite<R: Real>(value: R) -> R {
    if value.is_finite() { value } else { R::ZERO }
}

fn line<R: Real, const N: usize>(m: &Matrix<R, N>, i: usize) -> [R; N] {
    m.get(i).copied().unwrap_or([R::ZERO; N])
}

fn entry<R: Real, const N: usize>(m: &Matrix<R, N>, i: usize, j: usize) -> R {
    line(m, i).get(j).copied().unwrap_or(R::ZERO)
}

#[inline(always)]
fn zip<T: Copy, const N: usize>(a: &[T; N], b: &[T; N], f: impl Fn(T, T) -> T) -> [T; N] {
    let mut result = *a;
    for (a, &b) in result.iter_mut().zip(b) {
        *a = f(*a, b);
    }
    result
}

fn diagonal<R: Real, const N: usize>(value: R) -> Matrix<R, N> {
    from_fn(|i| from_fn(|j| if i == j { value } else { R::ZERO }))
}

fn scaled<R: Real, const N: usize>(m: &Matrix<R, N>, factor: R) -> Matrix<R, N> {
    m.map(|row| row.map(|entry| entry * factor))
}

fn sum<R: Real, const N: usize>(a: &Matrix<R, N>, b: &Matrix<R, N>) -> Matrix<R, N> {
    zip(a, b, |a, b| zip(&a, &b, |a, b| a + b))
}

fn transposed<R: Real, const N: usize>(m: &Matrix<R, N>) -> Matrix<R, N> {
    from_fn(|i| from_fn(|j| entry(m, j, i)))
}

fn product<R: Real, const N: usize>(a: &Matrix<R, N>, b: &Matrix<R, N>) -> Matrix<R, N> {
    let columns = transposed(b);
    a.map(|row| applied(&columns, &row))
}

#[inline(always)]
fn applied<R: Real, const N: usize>(m: &Matrix<R, N>, x: &[R; N]) -> [R; N] {
    let mut result = [R::ZERO; N];
    for (place, row) in result.iter_mut().zip(m) {
        for (&a, &b) in row.iter().zip(x) {
            *place = *place + a * b;
        }
    }
    result
}

#[inline(always)]
fn mapped<R: Real, U: Real, const N: usize>(m: &Matrix<R, N>, f: impl Fn(&R) -> U) -> Matrix<U, N> {
    let mut result = [[U::ZERO; N]; N];
    for (places, row) in result.iter_mut().zip(m) {
        for (place, entry) in places.iter_mut().zip(row) {
            *place = f(entry);
        }
    }
    result
}
