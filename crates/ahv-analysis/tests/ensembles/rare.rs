//! Rare events against the transition kernel of a process, and against plain sampling.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::chain::{Chain, DT, STEPS, index, steady};
use ahv_analysis::actuator::Actuator;
use ahv_analysis::disperse::{Distribution, Draws};
use ahv_analysis::erased::values;
use ahv_analysis::linearize::linearize;
use ahv_analysis::lqr::{Regulator, bryson, deviations};
use ahv_analysis::monte_carlo::{
    Experiment, Feedback, Mode, MonteCarloError, RareError, RareEstimate, RareEvent, Scheme,
};
use ahv_analysis::ordered::Control;
use ahv_analysis::statistics::{Estimate, Z_95};
use ahv_core::{Bounds, GeneratedModel, Vector};
use ahv_models::sdcom::{INPUT_BOUNDS, Input, NOMINAL, Parameters, State};
use approx::assert_relative_eq;

type Model = ahv_models::sdcom::Model<f64>;

/// SDCOM from its trim, with held inputs.
fn open_loop(seed: u64) -> Experiment {
    let at = steady();
    Experiment {
        parameters: values(&NOMINAL),
        dispersion: None,
        state: [values(&at.state), vec![0.0; 8]],
        input: [values(&at.input), vec![0.0; 3]],
        feedback: None,
        watched: Vec::new(),
        scheme: Scheme::EulerMaruyama,
        mode: Mode::Exact,
        dt: DT,
        snapshots: vec![STEPS],
        seed,
        control_variate: false,
    }
}

/// SDCOM from its trim, with a linear-quadratic regulator through actuators.
fn closed_loop(seed: u64) -> Experiment {
    let at = steady();
    let system = linearize(
        &Model::new(&NOMINAL),
        &at.state,
        &at.input,
        &["phi", "delta_e"],
        &[],
    )
    .expect("a linear system");
    let efforts = deviations::<Input<f64>>(Model::DEVIATIONS);
    let q = bryson(&deviations::<State<f64>>(Model::DEVIATIONS).to_array());
    let r = bryson(&[efforts.phi, efforts.delta_e]);
    let regulator = Regulator::new(&system.a, &system.b, &q, &r).expect("a regulator");
    let actuator = |bandwidth, bounds| Actuator {
        bandwidth,
        rate: 1.0,
        bounds,
    };
    Experiment {
        feedback: Some(Feedback {
            state: values(&at.state),
            rate: vec![0.0; 8],
            input: values(&at.input),
            // The canard is held.
            gain: regulator.gain.insert_row(2, 0.0),
            actuators: vec![
                Some(actuator(10.0, INPUT_BOUNDS.phi)),
                Some(actuator(20.0, INPUT_BOUNDS.delta_e)),
                None,
            ],
        }),
        scheme: Scheme::Splitting,
        ..open_loop(seed)
    }
}

/// The event that chi_1 passes so many standard deviations, upwards or downwards.
fn passage(chain: Chain, deviations: f64) -> RareEvent {
    RareEvent {
        state: index("chi_1"),
        limit: deviations * chain.settled(),
        effort: 160,
        levels: None,
        repetitions: 20,
    }
}

fn estimate(experiment: &Experiment, event: &RareEvent, threads: usize) -> RareEstimate {
    let engine = experiment.engine::<Model>().expect("the scheme goes");
    let found = engine.first_passage(event, threads, &Control::default());
    found.expect("an estimate")
}

fn told(name: &str, estimate: &RareEstimate, known: &str) {
    let Estimate { value, low, high } = estimate.probability;
    println!(
        "{name}: {value:.4e} ({low:.4e} to {high:.4e}), known {known}; {} levels, {} member-steps, plain sampling {:.3e}",
        estimate.levels.len(),
        estimate.member_steps,
        estimate.plain_member_steps
    );
    for level in &estimate.levels {
        println!("    level {:.6}: {:.3}", level.value, level.share);
    }
}

#[test]
fn rare_passages_of_coloured_noise_are_as_likely_as_its_kernel_says() {
    for (scheme, deviations) in [(Scheme::EulerMaruyama, 5.3), (Scheme::Splitting, -5.3)] {
        let chain = Chain::of(scheme);
        let known = chain.passes(f64::abs(deviations) * chain.settled(), 0.0);
        assert!((5e-7..2e-6).contains(&known), "{known}");
        let experiment = Experiment {
            scheme,
            ..open_loop(5)
        };
        let found = estimate(&experiment, &passage(chain, deviations), 2);
        told(scheme.name(), &found, &format!("{known:.4e}"));
        assert!(found.probability.holds(known));
        // Neither so wide that it holds anything.
        assert!(found.probability.high < 1.6 * found.probability.value);
        assert!(100.0 * (found.member_steps as f64) < found.plain_member_steps);
        assert_eq!(found.lost, 0);
        for level in &found.levels[..found.levels.len() - 1] {
            assert!((0.1..0.35).contains(&level.share), "{level:?}");
        }
    }
}

/// After one step chi_1 is a normal number, so that it passes a limit by its tail: who passes at the last step has passed. The
/// second time a level stands between, and the same step leads past both.
#[test]
fn a_flight_of_one_step_passes_as_often_as_a_normal_number() {
    let chain = Chain::of(Scheme::EulerMaruyama);
    let experiment = Experiment {
        snapshots: vec![1],
        ..open_loop(2)
    };
    let known = 0.5 * libm::erfc(1.5 / 2.0_f64.sqrt());
    for levels in [Vec::new(), vec![0.5 * chain.spread]] {
        let event = RareEvent {
            limit: 1.5 * chain.spread,
            levels: Some(levels),
            ..passage(chain, 1.0)
        };
        let found = estimate(&experiment, &event, 1);
        let Estimate { value, low, high } = found.probability;
        assert!(low < known && known < high, "{found:?}, {known}");
        assert!(high < 1.3 * value, "{found:?}");
        // The interval of that many plain flights is as wide: they are of one step.
        let plain = 2.0 * Z_95 * (value * (1.0 - value) / found.plain_member_steps).sqrt();
        assert_relative_eq!(plain, high - low, max_relative = 1e-9);
    }
}

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let chain = Chain::of(Scheme::EulerMaruyama);
    let (limit, start_std) = (3.5 * chain.settled(), 0.5 * chain.settled());
    // Starts and intensities that differ from member to member, and stay with those that descend from one.
    let within = 0.3;
    let uncertainty = Parameters {
        sigma_1: within,
        ..Parameters::splat(0.0)
    };
    let draws = Draws::new(NOMINAL, uncertainty, Distribution::Uniform, Vec::new(), 11);
    let draws = draws.expect("draws");
    let known: f64 = (0..12)
        .map(|part| {
            let sigma = 1.0 + within * ((f64::from(part) + 0.5) / 6.0 - 1.0);
            let spread = sigma * chain.spread;
            Chain { spread, ..chain }.passes(limit, start_std) / 12.0
        })
        .sum();
    // Levels of one's own, one of them near the next: a step may lead past both.
    let levels = [1.0, 1.9, 2.7, 2.75].map(|level| level * chain.settled());
    let event = RareEvent {
        effort: 128,
        levels: Some(levels.to_vec()),
        repetitions: 10,
        ..passage(chain, 3.5)
    };
    let mut held = 0;
    let mut mean = 0.0;
    for seed in 0..20 {
        let mut experiment = open_loop(100 + seed);
        experiment.state[1][index("chi_1")] = start_std;
        experiment.dispersion = Some(draws.clone());
        let found = estimate(&experiment, &event, 2);
        held += u32::from(found.probability.holds(known));
        mean += found.probability.value / 20.0;
    }
    println!("{held} of 20 intervals hold {known:.4e}; mean {mean:.4e}");
    // Of 20 intervals of 95 %, fewer than 16 hold the truth once in 400 times.
    assert!(held >= 16);
    assert!((mean / known - 1.0).abs() < 0.15);
}

/// A damping ratio that is drawn below 0 breaks a rule of the table: such a member does not fly, and passes nothing.
#[test]
fn members_whose_parameters_break_a_rule_are_lost() {
    let uncertainty = Parameters {
        zeta_1: 1.5,
        ..Parameters::splat(0.0)
    };
    let draws = Draws::new(NOMINAL, uncertainty, Distribution::Uniform, Vec::new(), 4);
    let experiment = Experiment {
        dispersion: Some(draws.expect("draws")),
        ..open_loop(4)
    };
    // Nearly all that fly pass the limit.
    let event = RareEvent {
        effort: 256,
        levels: Some(Vec::new()),
        repetitions: 10,
        ..passage(Chain::of(Scheme::EulerMaruyama), 1e-3)
    };
    let found = estimate(&experiment, &event, 2);
    let share = Estimate::of_share(found.lost, 2560);
    // A sixth of what is drawn from −0.5 to 2.5 times the value, and four standard errors.
    let error = (share.value - 1.0 / 6.0).abs();
    assert!(error < 4.0 * (5.0 / 36.0 / 2560.0_f64).sqrt(), "{share:?}");
    assert!(found.probability.value < 5.0 / 6.0, "{found:?}");
}

/// Six parameters that are each below 0 in a third of the draws leave one vehicle of eleven: the levels are those of the vehicles
/// that fly. Where none does, that is the reason.
#[test]
fn levels_are_those_of_members_that_fly() {
    let uncertainty = Parameters {
        zeta_2: 3.0,
        zeta_3: 3.0,
        omega_2: 3.0,
        omega_3: 3.0,
        m: 3.0,
        s: 3.0,
        ..Parameters::splat(0.0)
    };
    let draws = Draws::new(NOMINAL, uncertainty, Distribution::Uniform, Vec::new(), 4);
    let mut experiment = open_loop(4);
    experiment.dispersion = Some(draws.expect("draws"));
    let event = passage(Chain::of(Scheme::EulerMaruyama), 2.0);
    let found = estimate(&experiment, &event, 2);
    assert!(found.probability.value < 0.2 && found.lost > 0, "{found:?}");
    let mut nowhere = open_loop(4);
    nowhere.state[1][index("velocity")] = 1e308;
    let engine = nowhere.engine::<Model>().expect("the scheme goes");
    let error = engine.first_passage(&event, 1, &Control::default());
    assert_eq!(error, Err(RareError::Lost.into()));
}

#[test]
fn alpha_leaves_a_limit_in_closed_loop_as_often_as_in_plain_flights() {
    let mut experiment = closed_loop(7);
    let trimmed = experiment.state[0][index("alpha")];
    let near = trimmed + NEAR;
    let mut limits = vec![Bounds::new(f64::NEG_INFINITY, f64::INFINITY); 8];
    limits[index("alpha")].max = near;
    experiment.watched = vec![limits];
    let engine = experiment.engine::<Model>().expect("the scheme goes");
    let plain = engine.run(15_000, 2, &Control::default());
    let plain = plain.expect("flights");
    let snapshot = &plain.snapshots[0];
    let left = Estimate::of_share(snapshot.left[0][index("alpha")], plain.members);
    println!(
        "alpha: deviation {:?}, plain {left:?}, {} member-steps",
        snapshot.states[index("alpha")].std,
        plain.member_steps
    );
    let event = RareEvent {
        state: index("alpha"),
        limit: near,
        effort: 160,
        levels: None,
        repetitions: 20,
    };
    let found = estimate(&experiment, &event, 2);
    told(
        "near",
        &found,
        &format!("{:.4e} to {:.4e}", left.low, left.high),
    );
    assert!(found.probability.low < left.high && left.low < found.probability.high);

    let far = RareEvent {
        limit: trimmed + FAR,
        ..event
    };
    let found = estimate(&experiment, &far, 2);
    told("far", &found, "to none");
    assert!(found.probability.value < 1e-5);
    assert!(100.0 * (found.member_steps as f64) < found.plain_member_steps);
}

/// Limits of alpha beyond the trim, in rad: one that plain flights leave, and one that they do not.
const NEAR: f64 = 0.0010;
const FAR: f64 = 0.0018;

#[test]
fn threads_change_no_bit() {
    let event = RareEvent {
        effort: 20,
        repetitions: 10,
        ..passage(Chain::of(Scheme::Splitting), 3.0)
    };
    let one = estimate(&closed_loop(3), &event, 1);
    assert_eq!(one, estimate(&closed_loop(3), &event, 2));
    assert_ne!(one, estimate(&closed_loop(4), &event, 2));
}

#[test]
fn requests_without_sense_are_refused() {
    let experiment = open_loop(1);
    let good = passage(Chain::of(Scheme::EulerMaruyama), 4.0);
    let refused = |experiment: &Experiment, event: &RareEvent| {
        let engine = experiment.engine::<Model>().expect("the scheme goes");
        match engine.first_passage(event, 1, &Control::default()) {
            Err(MonteCarloError::Rare(error)) => error,
            other => panic!("{other:?}"),
        }
    };
    for limit in [0.0, f64::NAN, f64::INFINITY] {
        let event = RareEvent {
            limit,
            ..good.clone()
        };
        let error = refused(&experiment, &event);
        assert!(
            matches!(error, RareError::Limit { state: "chi_1", .. }),
            "{error}"
        );
    }
    let nobody = RareEvent {
        effort: 0,
        ..good.clone()
    };
    assert_eq!(refused(&experiment, &nobody), RareError::Effort);
    let once = RareEvent {
        repetitions: 9,
        ..good.clone()
    };
    assert_eq!(
        refused(&experiment, &once),
        RareError::Repetitions { repetitions: 9 }
    );
    let ninth = RareEvent {
        state: 8,
        ..good.clone()
    };
    let error = refused(&experiment, &ninth);
    assert_eq!(
        error,
        RareError::State {
            state: 8,
            states: 8
        }
    );
    for (levels, level) in [
        (vec![-0.1 * good.limit], -0.1 * good.limit),
        (vec![0.5 * good.limit; 2], 0.5 * good.limit),
        (vec![0.5 * good.limit, good.limit], good.limit),
    ] {
        let event = RareEvent {
            levels: Some(levels),
            ..good.clone()
        };
        let error = refused(&experiment, &event);
        assert!(
            matches!(error, RareError::Level { level: found, .. } if found == level),
            "{error}"
        );
    }
    let still = Experiment {
        snapshots: vec![0],
        ..open_loop(1)
    };
    assert_eq!(refused(&still, &good), RareError::Flight);
}

#[test]
fn what_cannot_be_estimated_is_told() {
    let chain = Chain::of(Scheme::EulerMaruyama);
    let experiment = open_loop(1);
    let engine = experiment.engine::<Model>().expect("the scheme goes");
    let find = |event: &RareEvent, control: &Control| engine.first_passage(event, 1, control);
    // One level, and few members: none gets there.
    let far = RareEvent {
        effort: 8,
        levels: Some(Vec::new()),
        repetitions: 10,
        ..passage(chain, 6.0)
    };
    let error = find(&far, &Control::default());
    let limit = far.limit;
    assert_eq!(error, Err(RareError::OutOfReach { level: limit }.into()));
    // Without noise, all pass or none.
    let mut calm = open_loop(1);
    calm.parameters = values(&Parameters {
        sigma_1: 0.0,
        sigma_2: 0.0,
        sigma_3: 0.0,
        w_gamma: 0.0,
        w_alpha: 0.0,
        w_q: 0.0,
        ..NOMINAL
    });
    calm.state[0][index("chi_1")] = 1.0;
    let decayed = RareEvent {
        limit: 0.9,
        effort: 8,
        ..far.clone()
    };
    let engine = calm.engine::<Model>().expect("the scheme goes");
    let error = engine.first_passage(&decayed, 1, &Control::default());
    assert_eq!(error, Err(RareError::NoSpread { value: 1.0 }.into()));
    let stopped = Control {
        done: AtomicU64::new(0),
        stop: AtomicBool::new(true),
    };
    // The limit is the one level that was given; a pilot has set none yet.
    let piloted = RareEvent {
        levels: None,
        ..far.clone()
    };
    for (event, levels) in [(&far, vec![limit]), (&piloted, Vec::new())] {
        let nothing = RareError::Stopped {
            levels,
            repetitions: 0,
            asked: far.repetitions,
            member_steps: 0,
        };
        assert_eq!(find(event, &stopped), Err(nothing.into()));
    }
    assert_eq!(stopped.done.load(Ordering::Relaxed), 0);
}
