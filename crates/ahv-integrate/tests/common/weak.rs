//! Weak orders without Monte Carlo: every outcome of the increments of few values is visited, or the moments of a linear
//! step are known.

use ahv_core::{
    AdditiveNoise, ColouredNoise, CommutativeNoise, DifferentiableNoise, ItoCorrected, Model,
    NoiseClass, StochasticModel, Vector,
};
use ahv_integrate::{StepError, WeakIncrements};

use super::common::vector;
use super::order::observed_order;

vector!(Pair, a, b);
vector!(Three, w_1, w_2, w_3);
vector!(One, w);
vector!(Two, coloured, white);
vector!(Nothing, held);

pub(crate) const NO_INPUT: Nothing<f64> = Nothing { held: 0.0 };
type Matrix = [[f64; 2]; 2];

/// Probability and increments of every outcome of a step.
pub(crate) fn outcomes<W: Vector<f64>>(dt: f64) -> Vec<(f64, WeakIncrements<W>)> {
    // A single channel uses no two-point number.
    let signs = if W::LEN == 1 { 0 } else { W::LEN };
    let mut all = Vec::new();
    for code in 0..3_usize.pow(W::LEN as u32) << signs {
        let digit = |channel: usize| (code >> signs) / 3_usize.pow(channel as u32) % 3;
        let three = |channel: usize| digit(channel) as f64 - 1.0;
        let two = |channel: usize| if code >> channel & 1 == 0 { -1.0 } else { 1.0 };
        let probability: f64 = (0..W::LEN)
            .map(|channel| {
                if digit(channel) == 1 {
                    2.0 / 3.0
                } else {
                    1.0 / 6.0
                }
            })
            .product();
        let increments = WeakIncrements::from_signs(dt, three, two);
        all.push((probability / (1_usize << signs) as f64, increments));
    }
    all
}

fn apply(m: &Matrix, x: &Pair<f64>) -> Pair<f64> {
    Pair {
        a: m[0][0] * x.a + m[0][1] * x.b,
        b: m[1][0] * x.a + m[1][1] * x.b,
    }
}

/// dx = A x dt + Σ Bₖ x dWₖ, no two of whose matrices commute.
#[derive(Clone, Copy)]
pub(crate) struct Linear {
    drift: Matrix,
    columns: [Matrix; 3],
}

pub(crate) const LINEAR: Linear = Linear {
    drift: [[-0.5, 0.8], [-0.3, 0.2]],
    columns: [
        [[0.3, 0.5], [0.0, -0.2]],
        [[0.1, 0.0], [0.6, 0.2]],
        [[0.0, -0.4], [0.3, 0.1]],
    ],
};

impl Model for Linear {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        apply(&self.drift, x)
    }
}

impl StochasticModel for Linear {
    type Noise = Three<f64>;

    fn noise_increment(&self, x: &Pair<f64>, _: &Nothing<f64>, dw: &Three<f64>) -> Pair<f64> {
        self.columns
            .iter()
            .zip(dw.to_array())
            .fold(Pair::splat(0.0), |sum, (m, dw)| {
                sum.zip_with(apply(m, x), |sum, g| sum + g * dw)
            })
    }
}

impl ItoCorrected for Linear {
    fn ito_correction(&self, x: &Pair<f64>, u: &Nothing<f64>) -> Pair<f64> {
        self.iterated_increment(x, u, |j, k| if j == k { 0.5 } else { 0.0 })
    }
}

impl DifferentiableNoise for Linear {
    /// L^j b^k = Bₖ Bⱼ x.
    fn iterated_increment(
        &self,
        x: &Pair<f64>,
        _: &Nothing<f64>,
        mut integral: impl FnMut(usize, usize) -> f64,
    ) -> Pair<f64> {
        let mut sum = Pair::splat(0.0);
        for (j, inner) in self.columns.iter().enumerate() {
            for (k, outer) in self.columns.iter().enumerate() {
                let part = apply(outer, &apply(inner, x));
                let weight = integral(j, k);
                sum = sum.zip_with(part, |sum, part| sum + weight * part);
            }
        }
        sum
    }
}

impl Linear {
    /// With the first column alone: it commutes with itself.
    pub(crate) const fn of_one_column(self) -> Self {
        let [first, ..] = self.columns;
        Self {
            columns: [first, [[0.0; 2]; 2], [[0.0; 2]; 2]],
            ..self
        }
    }

    /// The Itô equation whose solution is that of this one in the Stratonovich sense.
    pub(crate) fn in_the_stratonovich_sense(self) -> Self {
        let mut ito = self;
        for column in &self.columns {
            for i in 0..2 {
                for j in 0..2 {
                    let square: f64 = (0..2).map(|k| column[i][k] * column[k][j]).sum();
                    ito.drift[i][j] += 0.5 * square;
                }
            }
        }
        ito
    }
}

/// d/dt of E[x xᵀ] as the vector (E a², E ab, E b²).
fn second_moments_rate(model: &Linear, s: [f64; 3]) -> [f64; 3] {
    let p = [[s[0], s[1]], [s[1], s[2]]];
    let product = |m: &Matrix, n: &Matrix| -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..2).map(|k| m[i][k] * n[k][j]).sum()))
    };
    let transposed = |m: &Matrix| [[m[0][0], m[1][0]], [m[0][1], m[1][1]]];
    let left = product(&model.drift, &p);
    let mut rate = [2.0 * left[0][0], left[0][1] + left[1][0], 2.0 * left[1][1]];
    for column in &model.columns {
        let square = product(&product(column, &p), &transposed(column));
        rate[0] += square[0][0];
        rate[1] += square[0][1];
        rate[2] += square[1][1];
    }
    rate
}

fn exact_second_moments(model: &Linear, start: [f64; 3]) -> [f64; 3] {
    let steps = 2000;
    let h = 1.0 / f64::from(steps);
    let ahead = |s: [f64; 3], k: [f64; 3], h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
    let mut s = start;
    for _ in 0..steps {
        let k1 = second_moments_rate(model, s);
        let k2 = second_moments_rate(model, ahead(s, k1, 0.5 * h));
        let k3 = second_moments_rate(model, ahead(s, k2, 0.5 * h));
        let k4 = second_moments_rate(model, ahead(s, k3, h));
        s = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    s
}

pub(crate) type Step =
    fn(f64, &Linear, &mut Pair<f64>, &WeakIncrements<Three<f64>>) -> Result<(), StepError<f64>>;

/// E a², E ab, E b² after one time unit in `steps` steps. On a linear model a step is a random matrix, and the
/// moments take a step by the mean of its Kronecker square.
fn second_moments(step: Step, model: &Linear, start: [f64; 3], steps: u32) -> [f64; 3] {
    let dt = 1.0 / f64::from(steps);
    let mut map = [[0.0; 3]; 3];
    for (probability, increments) in outcomes(dt) {
        let column = |start: Pair<f64>| {
            let mut x = start;
            step(dt, model, &mut x, &increments).expect("a linear step is finite");
            x
        };
        let (p, q) = (
            column(Pair { a: 1.0, b: 0.0 }),
            column(Pair { a: 0.0, b: 1.0 }),
        );
        let kronecker = [
            [p.a * p.a, 2.0 * p.a * q.a, q.a * q.a],
            [p.a * p.b, p.a * q.b + q.a * p.b, q.a * q.b],
            [p.b * p.b, 2.0 * p.b * q.b, q.b * q.b],
        ];
        for (row, own) in map.iter_mut().zip(kronecker) {
            for (entry, own) in row.iter_mut().zip(own) {
                *entry += probability * own;
            }
        }
    }
    (0..steps).fold(start, |s, _| {
        map.map(|row| (0..3).map(|k| row[k] * s[k]).sum())
    })
}

pub(crate) fn weak_order(step: Step, model: &Linear, exact: &Linear) -> f64 {
    let start = [1.0, 0.5, 0.25];
    let truth = exact_second_moments(exact, start);
    let points = [8, 16, 32, 64, 128, 256].map(|steps| {
        let s = second_moments(step, model, start, steps);
        let error: f64 = (0..3).map(|i| (s[i] - truth[i]).powi(2)).sum();
        (1.0 / f64::from(steps), error.sqrt())
    });
    observed_order(&points)
}

/// da = (−a/2 + 4b/5) dt + (p + q a) dW₂, driven by the coloured noise db = −2b dt + dW₁. One of p and q is 0, so that
/// the second moments obey an equation of their own.
#[derive(Clone, Copy)]
pub(crate) struct Driven {
    additive: f64,
    multiplicative: f64,
}

/// The white noise is additive.
pub(crate) const ADDITIVE: Driven = Driven {
    additive: 0.9,
    multiplicative: 0.0,
};

/// The Itô correction of the white noise is not 0.
pub(crate) const MULTIPLICATIVE: Driven = Driven {
    additive: 0.0,
    multiplicative: 0.9,
};

const DRIVEN: Matrix = [[-0.5, 0.8], [0.0, -2.0]];

impl Model for Driven {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        apply(&DRIVEN, x)
    }
}

impl StochasticModel for Driven {
    type Noise = Two<f64>;

    fn noise_increment(&self, x: &Pair<f64>, _: &Nothing<f64>, dw: &Two<f64>) -> Pair<f64> {
        Pair {
            a: (self.additive + self.multiplicative * x.a) * dw.white,
            b: dw.coloured,
        }
    }

    fn noise_class(channel: usize) -> NoiseClass {
        match channel {
            0 => NoiseClass::Constant,
            _ => NoiseClass::Diagonal,
        }
    }
}

impl ItoCorrected for Driven {
    fn ito_correction(&self, x: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        let column = self.additive + self.multiplicative * x.a;
        Pair {
            a: 0.5 * self.multiplicative * column,
            b: 0.0,
        }
    }
}

impl ColouredNoise for Driven {
    fn decay(&self, state: usize) -> Option<f64> {
        (state == 1).then_some(2.0)
    }
}

/// A step of a [`Driven`] with the increments of its white noise and two standard normal numbers for the coloured one,
/// affine in the state, linear in the numbers.
pub(crate) type DrivenStep = fn(
    f64,
    &Driven,
    &mut Pair<f64>,
    &WeakIncrements<Two<f64>>,
    [f64; 2],
) -> Result<(), StepError<f64>>;

/// S M Sᵀ.
fn congruence(s: &Matrix, m: &Matrix) -> Matrix {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let parts = [(0, 0), (0, 1), (1, 0), (1, 1)];
            parts.map(|(k, l)| s[i][k] * m[k][l] * s[j][l]).iter().sum()
        })
    })
}

/// E[x xᵀ] after one time unit in `steps` steps: a step is S x + L z + c, of which S and c depend on the outcome of the
/// white noise, and takes M to the mean of S M Sᵀ + L Lᵀ + c cᵀ.
fn driven_moments(step: DrivenStep, model: &Driven, start: Matrix, steps: u32) -> Matrix {
    let dt = 1.0 / f64::from(steps);
    let parts: Vec<(f64, Matrix, Matrix)> = outcomes(dt)
        .iter()
        .map(|(probability, increments)| {
            let moved = |x: [f64; 2], z: [f64; 2]| {
                let mut x = Pair::from(x);
                step(dt, model, &mut x, increments, z).expect("a linear step is finite");
                x.to_array()
            };
            let free = moved([0.0; 2], [0.0; 2]);
            let matrix =
                |[p, q]: [[f64; 2]; 2]| std::array::from_fn(|i| [p[i] - free[i], q[i] - free[i]]);
            let unit = [[1.0, 0.0], [0.0, 1.0]];
            let s = matrix(unit.map(|x| moved(x, [0.0; 2])));
            let l = matrix(unit.map(|z| moved([0.0; 2], z)));
            let noise = congruence(&l, &unit);
            let noise =
                std::array::from_fn(|i| std::array::from_fn(|j| noise[i][j] + free[i] * free[j]));
            (*probability, s, noise)
        })
        .collect();
    (0..steps).fold(start, |m, _| {
        let mut mean = [[0.0; 2]; 2];
        for (probability, s, noise) in &parts {
            let carried = congruence(s, &m);
            for (i, row) in mean.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += probability * (carried[i][j] + noise[i][j]);
                }
            }
        }
        mean
    })
}

/// The observed order of the second moments of `model`; the truth is a fine solution of their equation.
pub(crate) fn driven_order(step: DrivenStep, model: &Driven) -> f64 {
    let start = [[1.0, 0.5], [0.5, 0.25]];
    let rate = |m: &Matrix| -> Matrix {
        let product = |i: usize, j: usize| DRIVEN[i][0] * m[0][j] + DRIVEN[i][1] * m[1][j];
        let white = [
            [
                model.additive.powi(2) + model.multiplicative.powi(2) * m[0][0],
                0.0,
            ],
            [0.0, 1.0],
        ];
        std::array::from_fn(|i| {
            std::array::from_fn(|j| product(i, j) + product(j, i) + white[i][j])
        })
    };
    let ahead = |m: &Matrix, k: &Matrix, h: f64| -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| m[i][j] + h * k[i][j]))
    };
    let (mut truth, h) = (start, 1e-3);
    for _ in 0..1000 {
        let k1 = rate(&truth);
        let k2 = rate(&ahead(&truth, &k1, 0.5 * h));
        let k3 = rate(&ahead(&truth, &k2, 0.5 * h));
        let k4 = rate(&ahead(&truth, &k3, h));
        for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            truth = ahead(&truth, &k, h * weight / 6.0);
        }
    }
    let points = [8, 16, 32, 64, 128, 256].map(|steps| {
        let m = driven_moments(step, model, start, steps);
        let error = |i: usize, j: usize| m[i][j] - truth[i][j];
        let size = error(0, 0).hypot(error(0, 1)).hypot(error(1, 1));
        (1.0 / f64::from(steps), size)
    });
    observed_order(&points)
}

/// dx = −x dt + dW, dy = (x² − y) dt + dW/2: a nonlinear drift with additive noise, whose moments obey linear equations.
pub(crate) struct Parabola;

impl Model for Parabola {
    type Scalar = f64;
    type State = Pair<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        Pair {
            a: -x.a,
            b: x.a * x.a - x.b,
        }
    }
}

impl StochasticModel for Parabola {
    type Noise = One<f64>;

    fn noise_increment(&self, _: &Pair<f64>, _: &Nothing<f64>, dw: &One<f64>) -> Pair<f64> {
        Pair {
            a: dw.w,
            b: 0.5 * dw.w,
        }
    }

    fn noise_class(_: usize) -> NoiseClass {
        NoiseClass::Constant
    }
}

impl ItoCorrected for Parabola {
    fn ito_correction(&self, _: &Pair<f64>, _: &Nothing<f64>) -> Pair<f64> {
        Pair::splat(0.0)
    }
}

impl DifferentiableNoise for Parabola {
    fn iterated_increment(
        &self,
        _: &Pair<f64>,
        _: &Nothing<f64>,
        _: impl FnMut(usize, usize) -> f64,
    ) -> Pair<f64> {
        Pair::splat(0.0)
    }
}

impl AdditiveNoise for Parabola {}
impl CommutativeNoise for Parabola {}

/// A step of [`Parabola`] with two standard normal numbers: ΔW = √h times the first.
pub(crate) type ParabolaStep = fn(f64, &mut Pair<f64>, [f64; 2]) -> Result<(), StepError<f64>>;

/// E x², E y and E y² of [`Parabola`] after `t` from `start`, by Taylor's series of the equation of its moments.
fn parabola_moments(start: Pair<f64>, t: f64) -> [f64; 3] {
    let Pair { a: x, b: y } = start;
    // 1, E x, E x², E x⁴, E y, E x² y, E y².
    let rate = |[one, x, x2, x4, y, x2y, y2]: [f64; 7]| {
        [
            0.0,
            -x,
            one - 2.0 * x2,
            6.0 * x2 - 4.0 * x4,
            x2 - y,
            x4 + x + y - 3.0 * x2y,
            0.25 * one + 2.0 * (x2y - y2),
        ]
    };
    let mut total = [1.0, x, x * x, x.powi(4), y, x * x * y, y * y];
    let mut term = total;
    for n in 1..30 {
        term = rate(term).map(|v| v * t / f64::from(n));
        total = std::array::from_fn(|i| total[i] + term[i]);
    }
    let [_, _, x2, _, y, _, y2] = total;
    [x2, y, y2]
}

/// The observed order of E x², E y and E y² of [`Parabola`]. Every outcome of numbers of few values is visited that have the moments of
/// the normal ones as far as weak order 2 asks for: three values of the first, two of the second.
pub(crate) fn parabola_order(step: ParabolaStep) -> f64 {
    fn means(step: ParabolaStep, dt: f64, x: Pair<f64>, steps: u32) -> [f64; 3] {
        if steps == 0 {
            return [x.a * x.a, x.b, x.b * x.b];
        }
        let (root, mut sum) = (3.0_f64.sqrt(), [0.0; 3]);
        for (z, probability) in [(-root, 1.0 / 6.0), (0.0, 2.0 / 3.0), (root, 1.0 / 6.0)] {
            for v in [-1.0, 1.0] {
                let mut next = x;
                step(dt, &mut next, [z, v]).expect("the state stays finite");
                let after = means(step, dt, next, steps - 1);
                for (sum, after) in sum.iter_mut().zip(after) {
                    *sum += 0.5 * probability * after;
                }
            }
        }
        sum
    }
    let (start, t) = (Pair { a: 1.0, b: 0.5 }, 0.125);
    let truth = parabola_moments(start, t);
    let points = [2, 3, 4, 5, 6].map(|steps| {
        let dt = t / f64::from(steps);
        let found = means(step, dt, start, steps);
        let error: f64 = (0..3).map(|i| (found[i] - truth[i]).powi(2)).sum();
        (dt, error.sqrt())
    });
    observed_order(&points)
}
