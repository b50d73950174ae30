//! Linearly implicit methods for stiff models.

use ahv_core::{DifferentiableModel, Real, Vector};

use crate::dense::{add_scaled, weighted};
use crate::linear::{Elimination, Factors};
use crate::{Attempt, Dense, InputSource, Method, Start};

/// Number of stages.
const STAGES: usize = 6;
/// Diagonal of the method.
const GAMMA: f64 = 0.25;
/// Times of the stages, in steps.
const C: [f64; STAGES] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
/// Weights of ∂f/∂t in the stages.
const D: [f64; STAGES] = [0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0];
/// Weights of the stages' solutions in the states of later stages.
const A: [[f64; STAGES]; STAGES] = [
    [0.0; STAGES],
    [1.544, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.9466785280815826, 0.2557011698983284, 0.0, 0.0, 0.0, 0.0],
    [
        3.314825187068521,
        2.896124015972201,
        0.9986419139977817,
        0.0,
        0.0,
        0.0,
    ],
    [
        1.221224509226641,
        6.019134481288629,
        12.53708332932087,
        -0.687886036105895,
        0.0,
        0.0,
    ],
    [
        1.221224509226641,
        6.019134481288629,
        12.53708332932087,
        -0.687886036105895,
        1.0,
        0.0,
    ],
];
/// Weights of the stages' solutions, over the step, on the right-hand sides of later stages.
const B: [[f64; STAGES]; STAGES] = [
    [0.0; STAGES],
    [-5.6688, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-2.430093356833875, -0.2063599157091915, 0.0, 0.0, 0.0, 0.0],
    [
        -0.1073529058151375,
        -9.594562251023355,
        -20.47028614809616,
        0.0,
        0.0,
        0.0,
    ],
    [
        7.496443313967647,
        -10.24680431464352,
        -33.99990352819905,
        11.7089089320616,
        0.0,
        0.0,
    ],
    [
        8.083246795921522,
        -7.981132988064893,
        -31.52159432874371,
        16.31930543123136,
        -6.058818238834054,
        0.0,
    ],
];
/// Weights of the stages' solutions in the two correction terms of the dense output.
const DENSE: [[f64; STAGES]; 2] = [
    [
        10.12623508344586,
        -7.487995877610167,
        -34.80091861555747,
        -7.992771707568823,
        1.025137723295662,
        0.0,
    ],
    [
        -0.6762803392801253,
        6.087714651680015,
        16.43084320892478,
        24.76722511418386,
        -6.594389125716872,
        0.0,
    ],
];

/// RODAS of Hairer and Wanner (1996): a Rosenbrock pair of orders 4 and 3, L-stable, stiffly accurate, with a dense
/// output of order 3.
///
/// It takes the exact Jacobian of the model (of 16 states at most, or it does not compile), factors one matrix a step,
/// and needs no iteration. Where the Jacobian is zero by its
/// [pattern](DifferentiableModel::STATE_JACOBIAN_PATTERN), nothing is computed: order of elimination and fill-in are
/// known at compile time. The pivots stay on the diagonal, where 1/(γh) is; a step in which one vanishes is not finite.
///
/// Within a step an input is a function of time alone: a [feedback](crate::Feedback) is called with the state at the start of the
/// step, as a sampled controller would be. For its order to hold under an input that moves within a step, the input
/// has to tell its [rate](InputSource::rate).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rodas4;

/// Coefficients of a Rosenbrock method of six stages, in the form that needs no product with the Jacobian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RosenbrockTableau {
    /// The diagonal, γ.
    pub gamma: f64,
    /// Times of the stages, in steps.
    pub c: [f64; STAGES],
    /// Weights of ∂f/∂t in the stages.
    pub d: [f64; STAGES],
    /// Weights of the stages' solutions in the states of later stages.
    pub a: [[f64; STAGES]; STAGES],
    /// Weights of the stages' solutions, over the step, on the right-hand sides of later stages.
    pub b: [[f64; STAGES]; STAGES],
}

impl Rodas4 {
    /// Its coefficients. The result is the last stage's state plus its solution, which is also the error estimate.
    pub const TABLEAU: RosenbrockTableau = RosenbrockTableau {
        gamma: GAMMA,
        c: C,
        d: D,
        a: A,
        b: B,
    };
}

impl<M: DifferentiableModel> Method<M> for Rodas4 {
    const ERROR_ORDER: u8 = 4;

    type Stages = [M::State; STAGES];

    #[inline]
    fn attempt<I: InputSource<M>>(
        &self,
        model: &M,
        input: &I,
        start: &Start<M::State>,
        step: f64,
    ) -> Attempt<M::State, Self::Stages> {
        let (x, since) = (start.state, start.time);
        let held = input.at(since, since, &x);
        let (first, by_state, by_input) = model.drift_and_jacobians(&x, &held);
        let diagonal = M::Scalar::from_f64(1.0 / (step * GAMMA));
        let factors = Factors::of_shifted(diagonal, &by_state, elimination::<M>());
        let by_time = input
            .rate(since, &x)
            .map(|rate| along::<M>(&by_input, &rate));
        let h_inverse = M::Scalar::from_f64(1.0 / step);

        let mut stages = [M::State::splat(M::Scalar::ZERO); STAGES];
        let mut next = x;
        let mut error = x;
        let coefficients = A.iter().zip(&B).zip(C.iter().zip(&D));
        for (stage, ((a, b), (&c, &d))) in coefficients.enumerate() {
            let state = add_scaled(x, M::Scalar::ONE, weighted(a, &stages));
            let slope = if stage == 0 {
                first
            } else {
                model.drift(&state, &input.at(since, since + c * step, &x))
            };
            let mut right = add_scaled(slope, h_inverse, weighted(b, &stages));
            if let Some(by_time) = by_time {
                right = add_scaled(right, M::Scalar::from_f64(d * step), by_time);
            }
            let solution = factors.solve(&right);
            if let Some(place) = stages.get_mut(stage) {
                *place = solution;
            }
            // Of the last stage: stiffly accurate, the last solution is the difference of the two orders.
            next = add_scaled(state, M::Scalar::ONE, solution);
            error = solution;
        }
        Attempt {
            time: since,
            step,
            state: x,
            first_slope: Some(first),
            next,
            last_slope: None,
            error,
            stages,
        }
    }

    #[inline]
    fn dense<I: InputSource<M>>(
        &self,
        _: &M,
        _: &I,
        attempt: &mut Attempt<M::State, Self::Stages>,
    ) -> Dense<M::State> {
        let [one, two] =
            DENSE.map(|weights| weighted::<M::Scalar, M::State>(&weights, &attempt.stages));
        let difference = attempt.next.zip_with(attempt.state, |b, a| b - a);
        Dense::new(
            attempt.time,
            attempt.step,
            [
                attempt.state,
                difference.zip_with(one, |d, k| d + k),
                two.zip_with(one, |l, k| l - k),
                two.map(|l| -l),
            ],
        )
    }
}

/// How the zeros of the model's Jacobian are made use of.
#[inline]
const fn elimination<M: DifferentiableModel>() -> &'static Elimination {
    const {
        let length = <M::State as Vector<M::Scalar>>::LEN;
        &Elimination::of(&M::STATE_JACOBIAN_PATTERN, length)
    }
}

/// The derivative of the drift along a direction of the input.
#[inline]
fn along<M: DifferentiableModel>(by_input: &M::InputJacobian, direction: &M::Input) -> M::State {
    let mut derivative = M::State::splat(M::Scalar::ZERO);
    let mut index = 0;
    by_input.map(|row| {
        let mut sum = M::Scalar::ZERO;
        row.zip_with(*direction, |a, b| {
            sum = sum + a * b;
            a
        });
        derivative.set(index, sum);
        index += 1;
        row
    });
    derivative
}
