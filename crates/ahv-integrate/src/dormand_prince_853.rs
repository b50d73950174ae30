//! An explicit method of order 8.

mod coefficients;

use ahv_core::{Model, Real, Vector};

use crate::dense::add_scaled;
use crate::{Attempt, Dense, InputSource, Method, Start};
use coefficients::{A, C, DENSE, ERROR_3, ERROR_5};

/// Number of stages of a step.
const STAGES: usize = 12;
/// The same with the slope at the end and the three further stages of the dense output.
const ALL_STAGES: usize = 16;

/// The method of order 8 by Dormand and Prince with the error estimates of orders 5 and 3 and the dense output of order 7
/// by Hairer, Nørsett and Wanner (DOP853; *Solving Ordinary Differential Equations I*, 1993).
///
/// A step costs 12 drifts, and 11 where the drift at its start is known. Dense output costs four more, of which the next step uses
/// one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DormandPrince853;

impl DormandPrince853 {
    /// Times of the stages, in steps.
    pub const C: [f64; ALL_STAGES] = C;
    /// Weights of the slopes in each stage. Row 12 is that of the result, of order 8; rows 13 to 15 are those of the stages
    /// of the dense output.
    pub const A: [[f64; ALL_STAGES]; ALL_STAGES] = A;
    /// Weights of the result, minus those of the results of orders 5 and 3; of order 5 up to a factor.
    pub const ERRORS: [[f64; STAGES]; 2] = [ERROR_5, ERROR_3];
    /// Weights of the slopes in the terms θ²(1−θ)², θ³(1−θ)², θ³(1−θ)³ and θ⁴(1−θ)³ of the dense output, which are added
    /// to the cubic polynomial that has the states and slopes of both ends.
    pub const DENSE: [[f64; ALL_STAGES]; 4] = DENSE;
}

/// Σ `row[i]` `slopes[i]` over the places that are named, which are those of weights that are not 0. Not a loop: with a
/// weight known at each place a sum takes a third of the instructions.
macro_rules! sum {
    ($row:expr, $slopes:ident: $first:literal $($other:literal)*) => {{
        let row = const { &$row };
        let sum = $slopes[$first].map(|slope| M::Scalar::from_f64(row[$first]) * slope);
        $(let sum = add_scaled(sum, M::Scalar::from_f64(row[$other]), $slopes[$other]);)*
        sum
    }};
}

/// Fills in the slope of each stage from those that its row of `A` names.
macro_rules! stages {
    (($x:ident, $h:ident, $slope:ident) $slopes:ident; $($stage:literal: $($earlier:literal)+;)+) => {$(
        let state = add_scaled($x, $h, sum!(A[$stage], $slopes: $($earlier)+));
        $slopes[$stage] = $slope(C[$stage], &state);
    )+};
}

impl<M: Model> Method<M> for DormandPrince853 {
    /// Of the combined estimate; its two parts fall with the powers 6 and 4.
    const ERROR_ORDER: u8 = 8;

    type Stages = [M::State; STAGES];

    #[inline]
    fn attempt<I: InputSource<M>>(
        &self,
        model: &M,
        input: &I,
        start: &Start<M::State>,
        step: f64,
    ) -> Attempt<M::State, Self::Stages> {
        let h = M::Scalar::from_f64(step);
        let (since, x) = (start.time, start.state);
        let slope = |c: f64, x: &M::State| model.drift(x, &input.at(since, since + c * step, x));
        let first = start.slope.unwrap_or_else(|| slope(0.0, &x));
        let mut k = [first; STAGES];
        stages! {
            (x, h, slope) k;
            1: 0;
            2: 0 1;
            3: 0 2;
            4: 0 2 3;
            5: 0 3 4;
            6: 0 3 4 5;
            7: 0 3 4 5 6;
            8: 0 3 4 5 6 7;
            9: 0 3 4 5 6 7 8;
            10: 0 3 4 5 6 7 8 9;
            11: 0 3 4 5 6 7 8 9 10;
        }
        let error: M::State = sum!(ERROR_5, k: 0 5 6 7 8 9 10 11);
        Attempt {
            time: since,
            step,
            state: x,
            first_slope: Some(first),
            next: add_scaled(x, h, sum!(A[STAGES], k: 0 5 6 7 8 9 10 11)),
            // A step that is refused does not need it.
            last_slope: None,
            error: error.map(|e| h * e),
            stages: k,
        }
    }

    /// e₅²/√(e₅² + 0.01 e₃²) for the sizes e₅ and e₃ of the two estimates.
    #[inline]
    fn error_size(
        &self,
        attempt: &Attempt<M::State, Self::Stages>,
        norm: impl Fn(&M::State) -> f64,
    ) -> f64 {
        let fifth = norm(&attempt.error);
        if fifth == 0.0 {
            return 0.0;
        }
        let (h, k) = (M::Scalar::from_f64(attempt.step), &attempt.stages);
        let third: M::State = sum!(ERROR_3, k: 0 5 6 7 8 9 10 11);
        let ratio = norm(&third.map(|e| h * e)) / fifth;
        fifth / Real::sqrt(1.0 + 0.01 * ratio * ratio)
    }

    #[inline]
    fn dense<I: InputSource<M>>(
        &self,
        model: &M,
        input: &I,
        attempt: &mut Attempt<M::State, Self::Stages>,
    ) -> Dense<M::State> {
        let (since, step, x) = (attempt.time, attempt.step, attempt.state);
        let h = M::Scalar::from_f64(step);
        let slope = |c: f64, x: &M::State| model.drift(x, &input.at(since, since + c * step, x));
        let next = attempt.next;
        let last = *attempt.last_slope.get_or_insert_with(|| slope(1.0, &next));
        let mut k = [last; ALL_STAGES];
        for (place, &slope) in k.iter_mut().zip(&attempt.stages) {
            *place = slope;
        }
        stages! {
            (x, h, slope) k;
            13: 0 6 7 8 9 10 11 12;
            14: 0 5 6 7 10 11 12 13;
            15: 0 5 6 7 8 12 13 14;
        }
        let difference = next.zip_with(x, |b, a| b - a);
        let ahead = k[0].zip_with(difference, |k, d| h * k - d);
        let behind = difference.zip_with(last, |d, k| d - h * k);
        let bend = behind.zip_with(ahead, |b, a| b - a);
        let terms = [
            sum!(DENSE[0], k: 0 5 6 7 8 9 10 11 12 13 14 15),
            sum!(DENSE[1], k: 0 5 6 7 8 9 10 11 12 13 14 15),
            sum!(DENSE[2], k: 0 5 6 7 8 9 10 11 12 13 14 15),
            sum!(DENSE[3], k: 0 5 6 7 8 9 10 11 12 13 14 15),
        ];
        let terms = terms.map(|term: M::State| term.map(|t| h * t));
        Dense::new(since, step, powers(x, difference, ahead, bend, terms))
    }
}

/// The coefficients of x + dθ + aθ(1−θ) + bθ²(1−θ) + t₁θ²(1−θ)² + t₂θ³(1−θ)² + t₃θ³(1−θ)³ + t₄θ⁴(1−θ)³ in powers of θ.
#[inline]
fn powers<R: Real, X: Vector<R>>(x: X, d: X, a: X, b: X, [t1, t2, t3, t4]: [X; 4]) -> [X; 8] {
    let sum = |parts: &[(f64, X)]| {
        parts
            .iter()
            .fold(X::splat(R::ZERO), |sum, &(weight, part)| {
                add_scaled(sum, R::from_f64(weight), part)
            })
    };
    [
        x,
        sum(&[(1.0, d), (1.0, a)]),
        sum(&[(-1.0, a), (1.0, b), (1.0, t1)]),
        sum(&[(-1.0, b), (-2.0, t1), (1.0, t2), (1.0, t3)]),
        sum(&[(1.0, t1), (-2.0, t2), (-3.0, t3), (1.0, t4)]),
        sum(&[(1.0, t2), (3.0, t3), (-3.0, t4)]),
        sum(&[(-1.0, t3), (3.0, t4)]),
        t4.map(|t| -t),
    ]
}
