//! Covariances against closed forms, SciPy, exact transitions and flights.
#![forbid(unsafe_code)]

use ahv_analysis::covariance::{
    CovarianceError, Ensemble, Flight, Spreading, lyapunov, noise_intensity,
};
use ahv_analysis::trim::{SteadyFlight, trim};
use ahv_core::{DifferentiableModel, Model, Pattern, StochasticModel, Vector};
use ahv_integrate::LinearTransition;
use ahv_models::{dcom, sdcom};
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

#[derive(Clone, Copy, Debug, PartialEq)]
struct One<T> {
    x: T,
}

ahv_core::impl_vector! { One { x: ["1", "1", 1.0] } }

/// dx = −x² dt + σ dW.
struct Square(f64);

impl Model for Square {
    type Scalar = f64;
    type State = One<f64>;
    type Input = One<f64>;

    fn drift(&self, x: &One<f64>, _: &One<f64>) -> One<f64> {
        One { x: -x.x * x.x }
    }
}

impl DifferentiableModel for Square {
    type StateJacobian = One<One<f64>>;
    type InputJacobian = One<One<f64>>;
    const STATE_JACOBIAN_PATTERN: Pattern<2> = Pattern::new([1, 1], &[[0, 0]]);

    fn jacobians(&self, x: &One<f64>, _: &One<f64>) -> (One<One<f64>>, One<One<f64>>) {
        let by_state = One {
            x: One { x: -2.0 * x.x },
        };
        (by_state, One { x: One { x: 0.0 } })
    }

    fn drift_and_jacobians(
        &self,
        x: &One<f64>,
        u: &One<f64>,
    ) -> (One<f64>, One<One<f64>>, One<One<f64>>) {
        let (by_state, by_input) = self.jacobians(x, u);
        (self.drift(x, u), by_state, by_input)
    }
}

impl StochasticModel for Square {
    type Noise = One<f64>;

    fn noise_increment(&self, _: &One<f64>, _: &One<f64>, dw: &One<f64>) -> One<f64> {
        One { x: self.0 * dw.x }
    }
}

/// x = 1/(1 + t), so that Ṗ = −4 P/(1 + t) + σ² and P = σ² ((1 + t)⁵ − 1)/(5 (1 + t)⁴).
#[test]
fn the_covariance_follows_a_curved_trajectory() {
    let (model, one) = (Square(0.3), One { x: 1.0 });
    let flight = Flight {
        start: one,
        input: one,
        dt: 0.01,
    };
    let times = [0.0, 0.5, 0.505, 3.0];
    let spread = flight.covariance(&model, &times).expect("a flight");
    for (spread, time) in spread.iter().zip(times) {
        let r = 1.0 + time;
        assert_relative_eq!(spread.state.x, 1.0 / r, max_relative = 1e-9);
        let expected = 0.09 * (r.powi(5) - 1.0) / (5.0 * r.powi(4));
        assert_relative_eq!(spread.covariance[(0, 0)], expected, max_relative = 1e-8);
    }
}

#[test]
fn times_and_steps_without_sense_are_refused() {
    let (model, one) = (Square(0.3), One { x: 1.0 });
    let flight = |dt| Flight {
        start: one,
        input: one,
        dt,
    };
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
        start: One { x: -1.0 },
        ..flight(0.01)
    };
    let failure = diverged.covariance(&model, &[3.0]);
    assert!(
        matches!(failure, Err(CovarianceError::Diverged { name: "x", .. })),
        "{failure:?}"
    );
}

/// Level flight of a model at its trim, with held inputs.
fn level<M>(model: &M, dt: f64) -> Flight<M::State, M::Input>
where
    M: DifferentiableModel<Scalar = f64>,
{
    let trim = trim(model, &SteadyFlight::new(7702.0808, 85_000.0)).expect("it trims");
    Flight {
        start: trim.state,
        input: trim.input,
        dt,
    }
}

/// A trim stays, so that the covariance is that of a constant linear system: its exact transition is another way.
#[test]
fn the_covariance_at_a_trim_is_that_of_the_exact_transition() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let flight = level(&model, 1e-3);
    let spread = flight.covariance(&model, &[0.5]).expect("a flight");
    let (a, _) = model.jacobians(&flight.start, &flight.input);
    let noise = noise_intensity(&model, &flight.start, &flight.input);
    let intensity = std::array::from_fn(|i| std::array::from_fn(|j| noise[(i, j)]));
    let exact: LinearTransition<f64, 8> =
        LinearTransition::new(a.to_matrix(), intensity, 0.5).expect("a step");
    for (index, std) in spread[0].std().into_iter().enumerate() {
        let expected = exact.covariance()[index][index].sqrt();
        assert_relative_eq!(std, expected, max_relative = 1e-7);
    }
}

/// Every standard deviation in its interval of 95 % would be luck: 4.5 such half widths hold each with near certainty.
fn agrees(linear: &Spreading<impl Vector<f64>>, std: &[ahv_analysis::statistics::Estimate]) {
    for (index, (linear, flown)) in linear.std().into_iter().zip(std).enumerate() {
        let half = 0.5 * (flown.high - flown.low);
        assert!(
            (linear - flown.value).abs() <= 2.3 * half,
            "{index}: {linear} {flown:?}"
        );
    }
}

#[test]
fn flights_spread_as_the_linear_covariance_says() {
    let ensemble = Ensemble {
        members: 400,
        seed: 3,
    };
    let times = [0.1, 0.4];
    let exact = sdcom::Model::new(&sdcom::NOMINAL);
    let flight = level(&exact, 2e-3);
    let linear = flight.covariance(&exact, &times).expect("a flight");
    let flown = flight
        .monte_carlo::<_, 6>(&exact, &times, ensemble)
        .expect("flights");
    let modes = dcom::Model::new(&dcom::NOMINAL);
    let flexible = level(&modes, 2e-3);
    let linear_modes = flexible.covariance(&modes, &times).expect("a flight");
    let flown_modes = flexible
        .monte_carlo::<_, 6>(&modes, &times, ensemble)
        .expect("flights");
    for index in 0..times.len() {
        assert_eq!(
            (flown[index].members, flown_modes[index].members),
            (400, 400)
        );
        agrees(&linear[index], &flown[index].std);
        agrees(&linear_modes[index], &flown_modes[index].std);
    }
    // A wrong linearisation is seen: the noise of modes as large again.
    let loud = sdcom::Model::new(&sdcom::Parameters {
        sigma_1: 2.0 * sdcom::NOMINAL.sigma_1,
        ..sdcom::NOMINAL
    });
    let other = flight.covariance(&loud, &times).expect("a flight");
    assert!(!flown[1].std[5].holds(other[1].std()[5]));
}

#[test]
fn threads_do_not_matter() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let flight = level(&model, 5e-3);
    let ensemble = Ensemble {
        members: 40,
        seed: 1,
    };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads")
            .install(|| flight.monte_carlo::<_, 6>(&model, &[0.2], ensemble))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn an_ensemble_that_breaks_down_is_an_error() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let mut flight = level(&model, 0.1);
    // So far down that the density overflows.
    flight.start.altitude = -1e8;
    let ensemble = Ensemble {
        members: 5,
        seed: 1,
    };
    assert_eq!(
        flight.monte_carlo::<_, 6>(&model, &[0.2], ensemble),
        Err(CovarianceError::BrokenDown {
            time: 0.2,
            left: 0,
            members: 5
        })
    );
}
