//! Ensembles beside the linear covariance of the same flight.

use ahv_analysis::covariance::{Flight, Spreading, noise_intensity};
use ahv_analysis::erased::{values, vector};
use ahv_analysis::monte_carlo::{Experiment, Mode, Scheme, Snapshot};
use ahv_analysis::ordered::Control;
use ahv_analysis::statistics::Estimate;
use ahv_core::{DifferentiableModel, GeneratedModel};
use ahv_models::{dcom, sdcom, sdcom_gust, sdcom_printed};
use approx::assert_relative_eq;

use super::covariance::held;

/// The ensemble of the same flight, by the default scheme of its model.
fn sample<M: GeneratedModel>(
    flight: &Flight,
    parameters: &M::ParametersOf<f64>,
    scheme: Scheme,
    snapshots: Vec<u64>,
    members: u64,
) -> Vec<Snapshot> {
    let still = |it: &[f64]| vec![0.0; it.len()];
    let experiment = Experiment {
        parameters: values(parameters),
        dispersion: None,
        state: [flight.start.clone(), still(&flight.start)],
        input: [flight.input.clone(), still(&flight.input)],
        feedback: None,
        watched: Vec::new(),
        scheme,
        mode: Mode::Exact,
        dt: flight.dt,
        snapshots,
        seed: 3,
        control_variate: false,
    };
    let engine = experiment.engine::<M>().expect("the scheme goes");
    let outcome = engine.run(members, 2, &Control::default());
    outcome.expect("flights").snapshots
}

/// Every standard deviation in its interval of 95 % would be luck: 2.3 half widths hold each with near certainty.
fn agrees(linear: &Spreading, sampled: &Snapshot) {
    for (index, (linear, state)) in linear.std().into_iter().zip(&sampled.states).enumerate() {
        let Estimate { value, low, high } =
            state.std.and_then(|it| it.closed()).expect("a deviation");
        let half = 0.5 * (high - low);
        assert!(
            (linear - value).abs() <= 2.3 * half + 1e-12 * linear,
            "{index}: {linear} {value} {low} {high}"
        );
    }
}

/// Flights of 0.1 s and 0.3 s, by both; what is sampled.
fn compare<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    scheme: Scheme,
    dt: f64,
) -> Vec<Snapshot> {
    let model = M::with_parameters(parameters);
    let flight = held(&model, dt);
    let steps = [0.1, 0.3].map(|time: f64| (time / dt).round() as u64);
    let linear = flight.covariance(&model, &[0.1, 0.3]).expect("a flight");
    let sampled = sample::<M>(&flight, parameters, scheme, steps.to_vec(), 400);
    for (linear, sampled) in linear.iter().zip(&sampled) {
        assert_eq!(sampled.members, 400);
        agrees(linear, sampled);
    }
    sampled
}

#[test]
fn flights_of_every_model_spread_as_the_linear_covariance_says() {
    let dt = 5e-3;
    let exact = compare::<sdcom::Model<f64>>(&sdcom::NOMINAL, Scheme::Splitting, dt);
    compare::<sdcom_gust::Model<f64>>(&sdcom_gust::NOMINAL, Scheme::Splitting, dt);
    compare::<sdcom_printed::Model<f64>>(&sdcom_printed::NOMINAL, Scheme::Splitting, dt);
    // The modes of DCOM want shorter steps.
    compare::<dcom::Model<f64>>(&dcom::NOMINAL, Scheme::Heun, 2e-3);
    // A wrong linearisation is seen: the noise of modes as large again.
    let loud = sdcom::Model::new(&sdcom::Parameters {
        sigma_1: 2.0 * sdcom::NOMINAL.sigma_1,
        ..sdcom::NOMINAL
    });
    let other = held(&loud, dt).covariance(&loud, &[0.3]).expect("a flight");
    let std = exact[1].states[5].std.expect("a deviation");
    assert!(!std.holds(other[0].std()[5]));
}

/// The fast decay of a reduction that keeps the moments, a = 2625 1/s, at steps of 5 and 1.3 times its time constant: the linear
/// covariance and the ensemble have the exact deviation of the coloured noise.
#[test]
fn stiff_coloured_noise_has_its_exact_deviation_at_any_step() {
    let parameters = sdcom::SECTION5_3.with_reduction(sdcom::Reduction::Moment);
    let model = sdcom::Model::new(&parameters);
    let chi = 7;
    let exact = {
        let flight = held(&model, 1.0);
        let (x, u) = (vector(&flight.start), vector(&flight.input));
        let (a, _) = model.jacobians(&x, &u);
        let rate = -a.chi_3.chi_3;
        assert!((2600.0..2650.0).contains(&rate), "{rate}");
        let noise = noise_intensity(&model, &x, &u);
        (noise[(chi, chi)] / (2.0 * rate)).sqrt()
    };
    assert!((exact - 0.0329).abs() < 5e-5, "{exact}");
    for (dt, steps) in [(2e-3, 50), (5e-4, 200)] {
        let flight = held(&model, dt);
        let linear = flight.covariance(&model, &[0.1]).expect("a flight");
        assert_relative_eq!(linear[0].std()[chi], exact, max_relative = 1e-9);
        let least = linear[0].covariance.clone().symmetric_eigenvalues().min();
        assert!(least >= -1e-12 * linear[0].covariance.amax(), "{least}");
        let sampled =
            sample::<sdcom::Model<f64>>(&flight, &parameters, Scheme::Splitting, vec![steps], 2000);
        let std = sampled[0].states[chi].std.and_then(|it| it.closed());
        let std = std.expect("a deviation");
        assert!((std.value / exact - 1.0).abs() < 0.06, "{std:?}, {exact}");
    }
}
