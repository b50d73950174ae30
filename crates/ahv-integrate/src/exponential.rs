//! Exact propagation of linear flexible modes beside an explicit method for the rest.

use ahv_core::{Model, Real, Vector};

use crate::StepError;
use crate::error::{accept, step_size};

/// One flexible mode, η̈ + 2ζω η̇ + ω² η = N, and where its states stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexibleMode {
    position: usize,
    rate: usize,
    omega: f64,
    zeta: f64,
}

impl FlexibleMode {
    /// The mode whose coordinate and rate are the components `position` and `rate` of the state of `M`, with the
    /// frequency `omega` in rad/s and the damping ratio `zeta`.
    ///
    /// None if there are no such components, or if `omega` is not positive, `zeta` negative, or one not finite.
    pub fn new<M: Model>(position: &str, rate: &str, omega: f64, zeta: f64) -> Option<Self> {
        let index = <M::State as Vector<M::Scalar>>::index_of;
        let good = omega > 0.0 && omega.is_finite() && zeta >= 0.0 && zeta.is_finite();
        good.then_some(Self {
            position: index(position)?,
            rate: index(rate)?,
            omega,
            zeta,
        })
    }
}

/// A 2×2 matrix, by rows.
type Square = [[f64; 2]; 2];

/// e^A, φ₁, φ₂ and φ₃ of A = time · L for the state (η, η̇), where φ_{k+1}(A) = A⁻¹ (φ_k(A) − 1/k!).
fn phi_functions(mode: &FlexibleMode, time: f64) -> [Square; 4] {
    // For (η, η̇/ω) the entries of A are of one size.
    let turn = mode.omega * time;
    let a = [[0.0, turn], [-turn, -2.0 * mode.zeta * turn]];
    let inverse = [[-2.0 * mode.zeta / turn, -1.0 / turn], [1.0 / turn, 0.0]];
    let whole = transition(mode, time);
    let scaled = if turn * (1.0 + 2.0 * mode.zeta) < 1.0 {
        // Where the recursion would cancel, the series converges.
        [whole, series(&a, 1), series(&a, 2), series(&a, 3)]
    } else {
        let one = multiply(&inverse, &minus_identity(&whole, 1.0));
        let two = multiply(&inverse, &minus_identity(&one, 1.0));
        let three = multiply(&inverse, &minus_identity(&two, 0.5));
        [whole, one, two, three]
    };
    scaled.map(|[[a, b], [c, d]]| [[a, b / mode.omega], [c * mode.omega, d]])
}

/// e^{L time}, (14), for (η, η̇/ω), in its real form for ζ < 1, ζ = 1 and ζ > 1, and without a jump between them.
fn transition(mode: &FlexibleMode, time: f64) -> Square {
    let FlexibleMode { omega, zeta, .. } = *mode;
    let decay = zeta * omega;
    // (1 − ζ²) ω² t²: the square of the phase, negative for ζ > 1.
    let square = (1.0 - zeta) * (1.0 + zeta) * (omega * time) * (omega * time);
    // e^{−ζωt} times cos and ω sin / ω_d of the phase, or their hyperbolic counterparts.
    let (even, odd) = if square.abs() < 1e-3 {
        let envelope = Real::exp(-decay * time);
        let cos = 1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0));
        let sinc = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0));
        (envelope * cos, envelope * sinc * (omega * time))
    } else if square > 0.0 {
        let envelope = Real::exp(-decay * time);
        let phase = Real::sqrt(square);
        let (sin, cos) = Real::sin_cos(phase);
        (envelope * cos, envelope * sin * (omega * time / phase))
    } else {
        let gap = omega * Real::sqrt((zeta - 1.0) * (zeta + 1.0));
        let fast = Real::exp(-(decay + gap) * time);
        let slow = Real::exp(-(omega * omega / (decay + gap)) * time);
        (0.5 * (slow + fast), 0.5 * (slow - fast) * (omega / gap))
    };
    [[even + zeta * odd, odd], [-odd, even - zeta * odd]]
}

/// φ_order(A) = Σ Aʲ/(j + order)! for a small A.
fn series(a: &Square, order: u8) -> Square {
    let mut term = [[1.0, 0.0], [0.0, 1.0]];
    for factor in 1..=order {
        term = scale(&term, 1.0 / f64::from(factor));
    }
    let mut sum = term;
    for factor in 1..=20_u8 {
        let next = f64::from(factor) + f64::from(order);
        term = scale(&multiply(a, &term), 1.0 / next);
        sum = add(&sum, &term);
    }
    sum
}

fn multiply(left: &Square, right: &Square) -> Square {
    let [[a, b], [c, d]] = *left;
    let [[e, f], [g, h]] = *right;
    [
        [a * e + b * g, a * f + b * h],
        [c * e + d * g, c * f + d * h],
    ]
}

fn add(left: &Square, right: &Square) -> Square {
    let [[a, b], [c, d]] = *left;
    let [[e, f], [g, h]] = *right;
    [[a + e, b + f], [c + g, d + h]]
}

fn scale(matrix: &Square, factor: f64) -> Square {
    matrix.map(|row| row.map(|entry| factor * entry))
}

fn minus_identity(matrix: &Square, factor: f64) -> Square {
    add(matrix, &[[-factor, 0.0], [0.0, -factor]])
}

/// A function of time · L: a number on the rigid part, where L is 0, and a matrix on each mode.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Operator<const N: usize> {
    rigid: f64,
    modes: [Square; N],
}

impl<const N: usize> Operator<N> {
    fn apply<R: Real, X: Vector<R>>(&self, modes: &[FlexibleMode; N], x: &X) -> X {
        let rigid = R::from_f64(self.rigid);
        let mut y = x.map(|component| rigid * component);
        for (mode, [[a, b], [c, d]]) in modes.iter().zip(&self.modes) {
            let (Some(position), Some(rate)) = (x.get(mode.position), x.get(mode.rate)) else {
                continue;
            };
            let [a, b, c, d] = [a, b, c, d].map(|&entry| R::from_f64(entry));
            y.set(mode.position, a * position + b * rate);
            y.set(mode.rate, c * position + d * rate);
        }
        y
    }
}

/// ETDRK4 of Cox and Matthews (2002) with the flexible modes as the linear part: order 4, with a fixed step and a
/// held input.
///
/// The modes are propagated by the exact transition matrix (14), in the real form that their damping asks for, under
/// generalized forces that the stages of the classical Runge–Kutta method follow. A constant force is met exactly; a
/// step may be long against the period of a mode, but not against what the rigid body and the forces do. Without
/// modes it is the classical Runge–Kutta method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential<const N: usize> {
    dt: f64,
    modes: [FlexibleMode; N],
    half: Operator<N>,
    half_slope: Operator<N>,
    whole: Operator<N>,
    first: Operator<N>,
    middle: Operator<N>,
    last: Operator<N>,
}

impl<const N: usize> Exponential<N> {
    /// A stepper of step size `dt`, in s, for a model with these modes; [`step`](Self::step) refuses a step size that
    /// is not positive and finite.
    ///
    /// The modes are part of the model: frequencies and dampings that are not the model's own leave the order, but
    /// not the exactness.
    pub fn new(dt: f64, modes: [FlexibleMode; N]) -> Self {
        let halves = modes.map(|mode| phi_functions(&mode, 0.5 * dt));
        let wholes = modes.map(|mode| phi_functions(&mode, dt));
        let weights = |one: f64, two: f64, three: f64| Operator {
            rigid: dt * (one + two / 2.0 + three / 6.0),
            modes: wholes.map(|[_, phi_1, phi_2, phi_3]| {
                let sum = add(&scale(&phi_1, one), &scale(&phi_2, two));
                scale(&add(&sum, &scale(&phi_3, three)), dt)
            }),
        };
        Self {
            dt,
            modes,
            half: Operator {
                rigid: 1.0,
                modes: halves.map(|[exp, ..]| exp),
            },
            half_slope: Operator {
                rigid: 0.5 * dt,
                modes: halves.map(|[_, phi_1, ..]| scale(&phi_1, 0.5 * dt)),
            },
            whole: Operator {
                rigid: 1.0,
                modes: wholes.map(|[exp, ..]| exp),
            },
            first: weights(1.0, -3.0, 4.0),
            middle: weights(0.0, 2.0, -4.0),
            last: weights(0.0, -1.0, 4.0),
        }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline]
    pub fn step<M: Model>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
    ) -> Result<(), StepError<M::Scalar>> {
        let _: M::Scalar = step_size(self.dt)?;
        let modes = &self.modes;
        let sum = |a: M::State, b: M::State| a.zip_with(b, |a, b| a + b);
        let rest = |x: &M::State| self.rest(model, x, u);

        let from_start = self.half.apply(modes, x);
        let n1 = rest(x);
        let a = sum(from_start, self.half_slope.apply(modes, &n1));
        let n2 = rest(&a);
        let b = sum(from_start, self.half_slope.apply(modes, &n2));
        let n3 = rest(&b);
        let twice = n3.zip_with(n1, |n3, n1| n3 + n3 - n1);
        let c = sum(
            self.half.apply(modes, &a),
            self.half_slope.apply(modes, &twice),
        );
        let n4 = rest(&c);

        let ends = sum(self.first.apply(modes, &n1), self.last.apply(modes, &n4));
        let slopes = sum(ends, self.middle.apply(modes, &sum(n2, n3)));
        accept(x, sum(self.whole.apply(modes, x), slopes))
    }

    /// The drift without the linear part of the modes.
    #[inline]
    fn rest<M: Model>(&self, model: &M, x: &M::State, u: &M::Input) -> M::State {
        let mut rest = model.drift(x, u);
        for mode in &self.modes {
            let (Some(position), Some(rate)) = (x.get(mode.position), x.get(mode.rate)) else {
                continue;
            };
            let damping = M::Scalar::from_f64(2.0 * mode.zeta * mode.omega);
            let stiffness = M::Scalar::from_f64(mode.omega * mode.omega);
            if let Some(slope) = rest.get(mode.position) {
                rest.set(mode.position, slope - rate);
            }
            if let Some(slope) = rest.get(mode.rate) {
                rest.set(mode.rate, slope + damping * rate + stiffness * position);
            }
        }
        rest
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, Matrix2, Matrix4};

    use super::{FlexibleMode, phi_functions};

    /// By Taylor's series for a small part, and squaring.
    fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let part = matrix / 64.0;
        let one = DMatrix::identity(matrix.nrows(), matrix.ncols());
        let series = (1..24)
            .rev()
            .fold(one.clone(), |sum, k| &one + &part * sum / f64::from(k));
        (0..6).fold(series, |root, _| &root * &root)
    }

    /// The exponential of [A, 1, 0, 0; 0, 0, 1, 0; 0, 0, 0, 1; 0, 0, 0, 0] has e^A, φ₁, φ₂ and φ₃ in its first row of blocks.
    #[test]
    fn phi_functions_are_blocks_of_a_matrix_exponential() {
        let omega = 3.0;
        for zeta in [0.02, 0.7, 1.0, 1.8] {
            // From the series, over where it gives way to the recursion, to several periods.
            for turn in [1e-3, 0.1, 0.3, 0.5, 0.9, 1.1, 4.0, 12.0] {
                let time = turn / omega;
                let mode = FlexibleMode {
                    position: 0,
                    rate: 1,
                    omega,
                    zeta,
                };
                let rates = Matrix2::new(0.0, 1.0, -omega * omega, -2.0 * zeta * omega);
                let mut blocks = DMatrix::zeros(8, 8);
                blocks.view_mut((0, 0), (2, 2)).copy_from(&(rates * time));
                blocks
                    .view_mut((0, 2), (4, 4))
                    .copy_from(&Matrix4::identity());
                blocks
                    .view_mut((4, 6), (2, 2))
                    .copy_from(&Matrix2::identity());
                let exponential = exponential(&blocks);
                for (order, found) in phi_functions(&mode, time).into_iter().enumerate() {
                    for (row, entries) in found.into_iter().enumerate() {
                        for (column, entry) in entries.into_iter().enumerate() {
                            let exact: f64 = exponential[(row, 2 * order + column)];
                            // In units of η and η̇/ω.
                            let unit = [1.0, omega][row] / [1.0, omega][column];
                            let error = (entry - exact).abs() / unit;
                            assert!(
                                error < 1e-11,
                                "ζ {zeta}, ωt {turn}: φ{order}[{row}][{column}] is {entry}, not {exact}"
                            );
                        }
                    }
                }
            }
        }
    }
}
