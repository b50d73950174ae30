//! Explicit Runge–Kutta pairs of orders 5 and 4.

use ahv_core::{Model, Real, Vector};

use crate::dense::{add_scaled, weighted};
use crate::{Attempt, Dense, InputSource, Method, Start};

/// Number of stages.
const STAGES: usize = 7;

/// Coefficients of an explicit pair of seven stages whose last stage is the first of the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau {
    /// Times of the stages, in steps.
    pub c: [f64; STAGES],
    /// Weights of the slopes in each stage; the last row is also that of the result, of order 5.
    pub a: [[f64; STAGES]; STAGES],
    /// Weights of the result of order 5, minus those of the result of order 4.
    pub error: [f64; STAGES],
    /// Weight of each slope in the dense output of order 4, as a polynomial: coefficients of θ, θ², θ³, θ⁴.
    pub dense: [[f64; 4]; STAGES],
}

/// A pair that [`Tableau`] describes.
pub trait EmbeddedPair {
    /// Its coefficients.
    const TABLEAU: Tableau;
}

/// The pair 5(4) of Dormand and Prince (1980), with the dense output of order 4 by Shampine (1986).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DormandPrince54;

impl EmbeddedPair for DormandPrince54 {
    const TABLEAU: Tableau = Tableau {
        c: [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0],
        a: [
            [0.0; STAGES],
            [0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0, 0.0],
            [
                19372.0 / 6561.0,
                -25360.0 / 2187.0,
                64448.0 / 6561.0,
                -212.0 / 729.0,
                0.0,
                0.0,
                0.0,
            ],
            [
                9017.0 / 3168.0,
                -355.0 / 33.0,
                46732.0 / 5247.0,
                49.0 / 176.0,
                -5103.0 / 18656.0,
                0.0,
                0.0,
            ],
            DORMAND_PRINCE_B,
        ],
        error: [
            71.0 / 57600.0,
            0.0,
            -71.0 / 16695.0,
            71.0 / 1920.0,
            -17253.0 / 339200.0,
            22.0 / 525.0,
            -1.0 / 40.0,
        ],
        dense: dormand_prince_dense(),
    };
}

const DORMAND_PRINCE_B: [f64; STAGES] = [
    35.0 / 384.0,
    0.0,
    500.0 / 1113.0,
    125.0 / 192.0,
    -2187.0 / 6784.0,
    11.0 / 84.0,
    0.0,
];

/// Hairer, Nørsett and Wanner's form of the dense output,
/// θ b + θ(1−θ)(δ₁ − b) + θ²(1−θ)(2b − δ₁ − δ₇) + θ²(1−θ)² d, sorted by powers of θ.
const fn dormand_prince_dense() -> [[f64; 4]; STAGES] {
    const fn weight(b: f64, first: f64, last: f64, d: f64) -> [f64; 4] {
        [
            first,
            3.0 * b - 2.0 * first - last + d,
            first + last - 2.0 * b - 2.0 * d,
            d,
        ]
    }
    let [b1, b2, b3, b4, b5, b6, b7] = DORMAND_PRINCE_B;
    [
        weight(b1, 1.0, 0.0, -12715105075.0 / 11282082432.0),
        weight(b2, 0.0, 0.0, 0.0),
        weight(b3, 0.0, 0.0, 87487479700.0 / 32700410799.0),
        weight(b4, 0.0, 0.0, -10690763975.0 / 1880347072.0),
        weight(b5, 0.0, 0.0, 701980252875.0 / 199316789632.0),
        weight(b6, 0.0, 0.0, -1453857185.0 / 822651844.0),
        weight(b7, 0.0, 1.0, 69997945.0 / 29380423.0),
    ]
}

/// The pair 5(4) of Tsitouras (2011), with its dense output of order 4.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tsit5;

impl EmbeddedPair for Tsit5 {
    const TABLEAU: Tableau = Tableau {
        c: [0.0, 0.161, 0.327, 0.9, 0.9800255409045097, 1.0, 1.0],
        a: [
            [0.0; STAGES],
            [0.161, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [
                -0.008480655492356989,
                0.335480655492357,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
            [
                2.8971530571054935,
                -6.359448489975075,
                4.3622954328695815,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
            [
                5.325864828439257,
                -11.748883564062828,
                7.4955393428898365,
                -0.09249506636175525,
                0.0,
                0.0,
                0.0,
            ],
            [
                5.86145544294642,
                -12.92096931784711,
                8.159367898576159,
                -0.071584973281401,
                -0.028269050394068383,
                0.0,
                0.0,
            ],
            [
                0.09646076681806523,
                0.01,
                0.4798896504144996,
                1.379008574103742,
                -3.290069515436081,
                2.324710524099774,
                0.0,
            ],
        ],
        error: [
            -0.001780011052225777,
            -0.0008164344596567469,
            0.007880878010261995,
            -0.1447110071732629,
            0.5823571654525552,
            -0.45808210592918697,
            1.0 / 66.0,
        ],
        dense: [
            [
                1.0,
                -2.763706197274826,
                2.9132554618219126,
                -1.0530884977290216,
            ],
            [0.0, 0.1317, -0.2234, 0.1017],
            [
                0.0,
                3.9302962368947516,
                -5.941033872131505,
                2.490627285651253,
            ],
            [
                0.0,
                -12.411077166933676,
                30.33818863028232,
                -16.548102889244902,
            ],
            [0.0, 37.50931341651104, -88.1789048947664, 47.37952196281928],
            [
                0.0,
                -27.896526289197286,
                65.09189467479366,
                -34.87065786149661,
            ],
            [0.0, 1.5, -4.0, 2.5],
        ],
    };
}

impl<P: EmbeddedPair, M: Model> Method<M> for P {
    const ERROR_ORDER: u8 = 5;

    type Stages = [M::State; STAGES];

    #[inline]
    fn attempt<I: InputSource<M>>(
        &self,
        model: &M,
        input: &I,
        start: &Start<M::State>,
        step: f64,
    ) -> Attempt<M::State, Self::Stages> {
        let tableau = const { &P::TABLEAU };
        let h = M::Scalar::from_f64(step);
        let x = start.state;
        let drift = |time: f64, x: &M::State| model.drift(x, &input.at(start.time, time, x));
        let first = start.slope.unwrap_or_else(|| drift(start.time, &x));
        let mut stages = [first; STAGES];
        let mut next = x;
        for (stage, (row, &c)) in tableau.a.iter().zip(&tableau.c).enumerate().skip(1) {
            next = add_scaled(x, h, weighted(row, &stages));
            let slope = drift(start.time + c * step, &next);
            if let Some(place) = stages.get_mut(stage) {
                *place = slope;
            }
        }
        let error: M::State = weighted(&tableau.error, &stages);
        Attempt {
            time: start.time,
            step,
            state: x,
            first_slope: Some(first),
            next,
            last_slope: stages.last().copied(),
            error: error.map(|e| h * e),
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
        let tableau = const { &P::TABLEAU };
        let h = M::Scalar::from_f64(attempt.step);
        let mut coefficients = [M::State::splat(M::Scalar::ZERO); 5];
        for (weights, &slope) in tableau.dense.iter().zip(&attempt.stages) {
            for (coefficient, &weight) in coefficients.iter_mut().skip(1).zip(weights) {
                *coefficient = add_scaled(*coefficient, h * M::Scalar::from_f64(weight), slope);
            }
        }
        if let Some(constant) = coefficients.first_mut() {
            *constant = attempt.state;
        }
        Dense::new(attempt.time, attempt.step, coefficients)
    }
}
