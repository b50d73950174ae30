//! Covariances against closed forms, SciPy, quadrature and flights.

use std::marker::PhantomData;

use super::small::{Driven, Eighteen, Fifteen, One, Pair, Square, Two};
use crate::common::level;
use ahv_analysis::covariance::{CovarianceError, Flight, Regulation, lyapunov, noise_intensity};
use ahv_analysis::erased::{values, vector};
use ahv_analysis::linearize::linearize;
use ahv_analysis::lqr::{Regulator, bryson, deviations};
use ahv_analysis::trim::trim;
use ahv_core::{DifferentiableModel, GeneratedModel, Vector};
use ahv_models::sdcom;
use approx::assert_relative_eq;
use nalgebra::DMatrix;

fn matrix(rows: &[&[f64]]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows[0].len(), |row, column| rows[row][column])
}

/// η̈ + 2ζω η̇ + ω² η = σ ξ: Var η = σ²/(4ζω³), Var η̇ = σ²/(4ζω), no correlation.
#[test]
fn a_mode_has_its_stationary_variance() {
    for (omega, zeta, sigma) in [(19.7437, 0.7, 17.0), (105.0, 0.02, 10.0), (2.0, 3.0, 1.0)] {
        let a = matrix(&[&[0.0, 1.0], &[-omega * omega, -2.0 * zeta * omega]]);
        let p = lyapunov(&a, &matrix(&[&[0.0, 0.0], &[0.0, sigma * sigma]])).expect("stable");
        let rate = sigma * sigma / (4.0 * zeta * omega);
        assert_relative_eq!(p[(0, 0)], rate / (omega * omega), max_relative = 1e-10);
        assert_relative_eq!(p[(1, 1)], rate, max_relative = 1e-10);
        assert!(p[(0, 1)].abs() < 1e-10 * rate);
    }
}

/// The numbers are those of `scipy.linalg.solve_continuous_lyapunov(a, -g @ g.T)`, SciPy 1.17.1.
#[test]
fn a_system_has_the_covariance_that_scipy_finds() {
    let a = matrix(&[
        &[-1.0, 2.0, 0.5, 0.0],
        &[0.0, -3.0, 1.0, 4.0],
        &[0.25, 0.0, -2.0, -5.0],
        &[0.0, -1.0, 5.0, -0.5],
    ]);
    let g = matrix(&[&[1.0, 0.0], &[0.5, 2.0], &[0.0, -1.0], &[3.0, 0.25]]);
    let expected = matrix(&[
        &[
            1.299891261237743,
            0.566106313878214,
            -0.664642733037366,
            0.141666111495582,
        ],
        &[
            0.566106313878214,
            1.230883021053873,
            -1.198724999079699,
            0.691593515560329,
        ],
        &[
            -0.664642733037366,
            -1.198_724_999_079_7,
            1.573759082431542,
            -0.562735769624485,
        ],
        &[
            0.141666111495582,
            0.691593515560328,
            -0.562735769624485,
            2.051955272634499,
        ],
    ]);
    let p = lyapunov(&a, &(&g * g.transpose())).expect("stable");
    assert_relative_eq!(p, expected, max_relative = 1e-12);
}

#[test]
fn what_has_no_stationary_covariance_is_refused() {
    let q = DMatrix::identity(2, 2);
    let unstable = lyapunov(&matrix(&[&[0.5, 0.0], &[0.0, -1.0]]), &q);
    assert!(matches!(unstable, Err(CovarianceError::Unstable { real, .. }) if real == 0.5));
    let integrator = lyapunov(&matrix(&[&[0.0, 1.0], &[0.0, -1.0]]), &q);
    assert!(matches!(integrator, Err(CovarianceError::Unstable { .. })));
    let shape = lyapunov(&matrix(&[&[-1.0]]), &q);
    assert!(matches!(
        shape,
        Err(CovarianceError::Shape { name: "Q", .. })
    ));
    let nan = lyapunov(&matrix(&[&[-1.0, f64::NAN], &[0.0, -1.0]]), &q);
    assert!(matches!(nan, Err(CovarianceError::NonFinite { name: "A" })));
}

/// x = 1/(1 + t), so that Ṗ = −4 P/(1 + t) + σ² and P = σ² ((1 + t)⁵ − 1)/(5 (1 + t)⁴).
#[test]
fn the_covariance_follows_a_curved_flight_with_order_2() {
    let model = Square(0.3);
    let times = [0.0, 0.5, 0.505, 3.0];
    let errors = [2e-2, 1e-2].map(|dt| {
        let spread = Flight::new(vec![1.0], vec![1.0], dt).covariance(&model, &times);
        let errors = spread
            .expect("a flight")
            .into_iter()
            .zip(times)
            .map(|(it, time)| {
                let r = 1.0 + time;
                let expected = 0.09 * (r.powi(5) - 1.0) / (5.0 * r.powi(4));
                [it.state[0] - 1.0 / r, it.covariance[(0, 0)] - expected]
            });
        errors.collect::<Vec<_>>()
    });
    assert_eq!(errors[0][0], [0.0, 0.0]);
    for (coarse, fine) in errors[0].iter().zip(&errors[1]).skip(1) {
        for (coarse, fine) in coarse.iter().zip(fine) {
            assert!(coarse.abs() < 4e-5, "{errors:?}");
            let ratio = coarse / fine;
            assert!((3.5..4.5).contains(&ratio), "{ratio} of {errors:?}");
        }
    }
}

#[test]
fn times_and_steps_without_sense_are_refused() {
    let model = Square(0.3);
    let flight = |dt| Flight::new(vec![1.0], vec![1.0], dt);
    for (dt, times) in [
        (0.0, vec![1.0]),
        (f64::NAN, vec![1.0]),
        (0.1, vec![1.0, 0.5]),
        (0.1, vec![-1.0]),
        (0.1, vec![f64::INFINITY]),
    ] {
        let refused = flight(dt).covariance(&model, &times);
        assert_eq!(refused, Err(CovarianceError::Times), "{dt} {times:?}");
    }
    let diverged = Flight {
        start: vec![-1.0],
        ..flight(0.01)
    };
    let failure = diverged.covariance(&model, &[3.0]);
    assert_eq!(
        failure,
        Err(CovarianceError::StepTooLong {
            time: 3.0,
            dt: 0.01
        })
    );
    let indefinite = Flight {
        initial: matrix(&[&[1.0, 2.0], &[2.0, 1.0]]),
        ..flight(0.01)
    };
    let failure = indefinite.covariance(&model, &[1.0]);
    assert!(
        matches!(failure, Err(CovarianceError::Indefinite { least }) if (least + 1.0).abs() < 1e-12),
        "{failure:?}"
    );
}

/// Var x = g²(1 − e^(−2at))/(2a) and Var y = g²/a² (t − 2(1 − e^(−at))/a + (1 − e^(−2at))/(2a)): a step as long as one likes.
#[test]
fn coloured_noise_and_its_integral_have_their_closed_form_however_stiff() {
    for a in [0.5, 40.0, 2625.0, 1e5] {
        let model = Pair { a, c: 0.0, g: 3.0 };
        for dt in [0.01, 0.05, 1.0] {
            let spread = Flight::new(vec![0.0; 2], vec![0.0], dt).covariance(&model, &[0.05, 1.0]);
            for it in spread.expect("a flight") {
                let t = it.time;
                let [once, twice] = [1.0, 2.0].map(|k| -f64::exp_m1(-k * a * t) / (k * a));
                let x = 9.0 * twice;
                let y = 9.0 / (a * a) * (t - 2.0 * once + twice);
                assert_relative_eq!(it.covariance[(0, 0)], x, max_relative = 1e-9);
                assert_relative_eq!(it.covariance[(1, 1)], y, max_relative = 1e-9);
                assert_relative_eq!(
                    it.covariance[(0, 1)],
                    4.5 * once * once,
                    max_relative = 1e-9
                );
            }
        }
    }
}

/// Held inputs and states that are not known exactly: x = x₀ e^(−at) + c u (1 − e^(−at))/a.
#[test]
fn an_initial_covariance_moves_with_the_flight() {
    let (a, c, t) = (0.8, 2.0, 0.7);
    let model = Pair { a, c, g: 0.0 };
    let flight = Flight {
        initial: matrix(&[&[0.04, 0.0, 0.01], &[0.0, 0.0, 0.0], &[0.01, 0.0, 0.09]]),
        ..Flight::new(vec![0.0; 2], vec![0.0], 0.1)
    };
    let spread = flight.covariance(&model, &[t]).expect("a flight");
    let (e, r) = ((-a * t).exp(), -f64::exp_m1(-a * t) * c / a);
    let expected = 0.04 * e * e + 0.02 * e * r + 0.09 * r * r;
    assert_relative_eq!(spread[0].covariance[(0, 0)], expected, max_relative = 1e-12);
}

/// However long the longest step may be, there is one: at a trim without error.
#[test]
fn a_step_longer_than_the_flight_is_the_flight() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let [short, long] = [0.05, 1e12].map(|dt| {
        let spread = held(&model, dt).covariance(&model, &[0.05]);
        spread.expect("a flight")[0].std()
    });
    assert!(long[0] > 0.0);
    for (short, long) in short.into_iter().zip(long) {
        assert_relative_eq!(short, long, max_relative = 1e-9);
    }
}

/// What is known for sure, what is known to 1e-9 and what is known to 1e6 stand beside each other in an initial covariance.
/// Correlations are what they are, however small the variances.
#[test]
fn units_of_an_initial_covariance_do_not_matter() {
    let model = Pair {
        a: 0.0,
        c: 0.0,
        g: 0.0,
    };
    let of = |initial| Flight {
        initial,
        ..Flight::new(vec![0.0; 2], vec![0.0], 0.1)
    };
    let (small, large, share) = (1e-9, 1e6, 0.9);
    let both = share * small * large;
    let at_once = of(matrix(&[
        &[small * small, both, 0.0],
        &[both, large * large, 0.0],
        &[0.0, 0.0, 0.0],
    ]));
    let spread = at_once.covariance(&model, &[0.0]).expect("a flight");
    let found = &spread[0].covariance;
    assert_relative_eq!(found[(0, 0)], small * small, max_relative = 1e-12);
    assert_relative_eq!(found[(0, 1)], both, max_relative = 1e-12);
    assert_relative_eq!(found[(1, 1)], large * large, max_relative = 1e-12);
    for size in [small, 1.0, large] {
        let beyond = of(matrix(&[
            &[size * size, 1.5 * size * size, 0.0],
            &[1.5 * size * size, size * size, 0.0],
            &[0.0, 0.0, 0.0],
        ]));
        let failure = beyond.covariance(&model, &[0.0]);
        assert!(
            matches!(failure, Err(CovarianceError::Indefinite { least }) if (least + 0.5).abs() < 1e-12),
            "{size}: {failure:?}"
        );
    }
}

/// An input known to σ moves each state by σ t: sixteen, seventeen and thirty states and inputs have it, and 33 are refused.
#[test]
fn as_many_states_and_inputs_as_transitions_are_made_for() {
    fn moves<U: Vector<f64>>() -> Result<(), CovarianceError> {
        let mut flight = Flight::new(vec![0.0; 15], vec![0.0; U::LEN], 0.1);
        flight.initial[(15, 15)] = 0.04;
        let spread = flight.covariance(&Driven::<U>(PhantomData), &[3.0])?;
        for std in spread[0].std() {
            assert_relative_eq!(std, 0.6, max_relative = 1e-12);
        }
        Ok(())
    }

    assert_eq!(moves::<One<f64>>(), Ok(()));
    assert_eq!(moves::<Two<f64>>(), Ok(()));
    assert_eq!(moves::<Fifteen<f64>>(), Ok(()));
    let expected = CovarianceError::TooLarge {
        found: 33,
        most: 32,
    };
    assert_eq!(moves::<Eighteen<f64>>(), Err(expected));
}

/// u̇ = b (−k₁ x − k₂ y − u): the loop comes to rest, and what rests is what a long flight comes to.
#[test]
fn a_closed_loop_comes_to_rest_where_lyapunov_says() {
    let model = Pair {
        a: -0.5,
        c: 1.0,
        g: 0.3,
    };
    let open = Flight::new(vec![0.0; 2], vec![0.0], 0.05);
    let failure = open.stationary_among(&model, &[]);
    assert!(
        matches!(
            failure,
            Err(CovarianceError::UndampedMode { real: 0.5, .. })
        ),
        "{failure:?}"
    );
    let closed = Flight {
        feedback: Some(Regulation {
            state: vec![0.0; 2],
            rate: vec![0.0; 2],
            input: vec![0.0],
            gain: matrix(&[&[3.0, 2.0]]),
            bandwidth: vec![20.0],
        }),
        ..open.clone()
    };
    let rest = closed.stationary_among(&model, &[]).expect("it is stable");
    let late = closed.covariance(&model, &[30.0]).expect("a flight");
    assert_relative_eq!(
        late[0].covariance,
        rest,
        max_relative = 1e-9,
        epsilon = 1e-12
    );
    let moving = Flight {
        start: vec![0.1, 0.0],
        ..closed
    };
    assert!(matches!(
        moving.stationary_among(&model, &[]),
        Err(CovarianceError::NotAtRest { name: "x", .. })
    ));
}

/// A flight of a model at its trim, with held inputs.
pub(super) fn held<M: GeneratedModel>(model: &M, dt: f64) -> Flight {
    let trim = trim(model, &level::<M>()).expect("it trims");
    Flight::new(values(&trim.state), values(&trim.input), dt)
}

/// exp(M), by its series for M/2⁸ and squaring.
fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let small = matrix / 256.0;
    let mut term = DMatrix::identity(matrix.nrows(), matrix.ncols());
    let mut sum = term.clone();
    for order in 1..=20 {
        term = &term * &small / f64::from(order);
        sum += &term;
    }
    for _ in 0..8 {
        sum = &sum * &sum;
    }
    sum
}

/// A trim stays, so that the covariance is that of a constant linear system: exp([−A, Q; 0, Aᵀ] t) has it (Van Loan 1978).
#[test]
fn the_covariance_at_a_trim_is_that_of_one_matrix_exponential() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let flight = held(&model, 0.1);
    let spread = flight.covariance(&model, &[0.5]).expect("a flight");
    let (x, u) = (vector(&flight.start), vector(&flight.input));
    let (a, _) = model.jacobians(&x, &u);
    let a: [[f64; 8]; 8] = a.to_matrix();
    let noise = noise_intensity(&model, &x, &u);
    let t = 0.05;
    let mut block = DMatrix::zeros(16, 16);
    for row in 0..8 {
        for column in 0..8 {
            block[(row, column)] = -a[row][column] * t;
            block[(8 + row, 8 + column)] = a[column][row] * t;
            block[(row, 8 + column)] = noise[(row, column)] * t;
        }
    }
    let exponential = exponential(&block);
    let transition = exponential.view((8, 8), (8, 8)).transpose();
    let added = &transition * exponential.view((0, 8), (8, 8));
    let mut expected = DMatrix::zeros(8, 8);
    for _ in 0..10 {
        expected = &transition * expected * transition.transpose() + &added;
    }
    for (index, std) in spread[0].std().into_iter().enumerate() {
        assert_relative_eq!(std, expected[(index, index)].sqrt(), max_relative = 1e-7);
    }
}

/// A linear-quadratic regulator on SDCOM: its stationary covariance is a fixed point of the exact transition.
#[test]
fn a_regulated_flight_has_a_stationary_covariance() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let open = held(&model, 0.05);
    assert!(matches!(
        open.stationary(&model),
        Err(CovarianceError::UndampedMode {
            mode: "short period",
            ..
        })
    ));
    let inputs = ["phi", "delta_e"];
    let system = linearize(
        &model,
        &vector(&open.start),
        &vector(&open.input),
        &inputs,
        &[],
    )
    .expect("linear");
    let x_std: sdcom::State<f64> = deviations(<sdcom::Model<f64>>::DEVIATIONS);
    let u_std: sdcom::Input<f64> = deviations(<sdcom::Model<f64>>::DEVIATIONS);
    let regulator = Regulator::new(
        &system.a,
        &system.b,
        &bryson(&x_std.to_array()),
        &bryson(&[u_std.phi, u_std.delta_e]),
    );
    let gain = regulator.expect("a regulator").gain.insert_row(2, 0.0);
    let closed = Flight {
        feedback: Some(Regulation {
            state: open.start.clone(),
            rate: vec![0.0; 8],
            input: open.input.clone(),
            gain,
            bandwidth: vec![20.0, 20.0, 0.0],
        }),
        ..open
    };
    let rest = closed.stationary(&model).expect("it is stable");
    // Slow modes take their time to get there.
    let late = closed.covariance(&model, &[20.0]).expect("a flight");
    for index in 0..8 {
        let (rest, late) = (rest[(index, index)].sqrt(), late[0].std()[index]);
        assert!(late <= rest * (1.0 + 1e-9), "{index}: {late} {rest}");
    }
    let fast = late[0].std()[3] / rest[(3, 3)].sqrt();
    assert!((0.9..=1.0 + 1e-9).contains(&fast), "{fast}");
}
