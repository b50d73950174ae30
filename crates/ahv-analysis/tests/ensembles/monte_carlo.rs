//! The engine against the steppers of `ahv-integrate`, member by member, and against laws that are known.

use std::sync::atomic::Ordering;
use std::time::Duration;

use crate::common::level;
use ahv_analysis::erased::{values, vector};
use ahv_analysis::monte_carlo::{
    BLOCK, Experiment, MemberRecord, Mode, MonteCarloError, Outcome, QUANTILES, Scheme, Tally,
};
use ahv_analysis::ordered::Control;
use ahv_analysis::statistics::{Estimate, OpenEstimate};
use ahv_analysis::trim::trim;
use ahv_core::{Bounds, ColouredNoise, GeneratedModel, Vector};
use ahv_integrate::{
    ItoDri1, ItoEulerMaruyama, ItoHeun, ItoStrangSplitting, NoiseError, NormalStream,
    WeakIncrements, WienerSource,
};
use ahv_models::{com, dcom, flexible_mode, sdcom, sdcom_gust};
use approx::{assert_abs_diff_eq, assert_relative_eq};

pub(super) type Sdcom = sdcom::Model<f64>;

const SEED: u64 = 5;
const CHANNELS: usize = sdcom::Noise::<()>::LEN;

/// Near the level trim of the nominal table.
pub(super) const STATE: sdcom::State<f64> = sdcom::State {
    velocity: 7702.0,
    altitude: 85_000.0,
    gamma: 0.0,
    alpha: 0.026,
    pitch_rate: 0.0,
    chi_1: 0.0,
    chi_2: 0.0,
    chi_3: 0.0,
};
pub(super) const INPUT: sdcom::Input<f64> = sdcom::Input {
    phi: 0.25,
    delta_e: 0.2,
    delta_c: 0.0,
};

pub(super) fn experiment(scheme: Scheme, dt: f64, snapshots: Vec<u64>) -> Experiment {
    Experiment {
        parameters: values(&sdcom::NOMINAL),
        dispersion: None,
        state: [values(&STATE), vec![0.0; 8]],
        input: [values(&INPUT), vec![0.0; 3]],
        feedback: None,
        watched: vec![values(&sdcom::STATE_BOUNDS)],
        scheme,
        mode: Mode::Exact,
        dt,
        snapshots,
        seed: SEED,
        control_variate: false,
    }
}

/// Of these members, the last states and how they were lost.
fn fly<M: GeneratedModel>(
    experiment: &Experiment,
    members: &[u64],
) -> Result<Vec<MemberRecord>, MonteCarloError> {
    let seen = experiment
        .engine::<M>()?
        .fly(members, &Control::default())?;
    Ok(seen.expect("nobody stops it"))
}

fn last(experiment: &Experiment, members: &[u64]) -> Vec<sdcom::State<f64>> {
    let seen = fly::<Sdcom>(experiment, members).expect("the scheme goes");
    seen.into_iter().map(|seen| vector(&seen.last)).collect()
}

fn run<M: GeneratedModel>(experiment: &Experiment, members: u64, threads: usize) -> Outcome {
    let engine = experiment.engine::<M>().expect("the scheme goes");
    let outcome = engine.run(members, threads, &Control::default());
    outcome.expect("it goes")
}

pub(super) fn index(name: &str) -> usize {
    sdcom::State::<f64>::index_of(name).expect("a state")
}

/// One member by the stepper of `ahv-integrate`, its noise from `WienerSource`.
fn alone(
    member: u64,
    steps: u64,
    dt: f64,
    step: impl Fn(&sdcom::Model<f64>, &mut sdcom::State<f64>, &sdcom::Noise<f64>, [[f64; 3]; 2]),
) -> sdcom::State<f64> {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let mut wiener = WienerSource::<CHANNELS>::new(SEED, member);
    let mut extra: Vec<NormalStream> = (0..6)
        .map(|index| NormalStream::new(SEED, member, CHANNELS as u64 + index))
        .collect();
    let mut x = STATE;
    for index in 0..steps {
        let dw = wiener.increments(index, dt);
        let halves = [0, 1].map(|half| [0, 1, 2].map(|k| extra[3 * half + k].normal(index)));
        step(&model, &mut x, &dw, halves);
    }
    x
}

#[test]
fn a_member_has_the_bits_that_its_stepper_gives_it_alone() {
    let (dt, steps) = (1e-3, 60);
    // Not a multiple of the lanes, and not from 0 on.
    let members = [3, 4, 5, 6, 900, 1 << 40];
    let euler = last(
        &experiment(Scheme::EulerMaruyama, dt, vec![steps]),
        &members,
    );
    let heun = last(&experiment(Scheme::Heun, dt, vec![steps]), &members);
    let splitting = last(&experiment(Scheme::Splitting, dt, vec![steps]), &members);
    for (index, &member) in members.iter().enumerate() {
        let expected = alone(member, steps, dt, |model, x, dw, _| {
            ItoEulerMaruyama::new(dt)
                .step(model, x, &INPUT, dw)
                .expect("finite");
        });
        assert_eq!(euler[index], expected, "Euler-Maruyama, member {member}");
        let expected = alone(member, steps, dt, |model, x, dw, _| {
            ItoHeun::new(dt).step(model, x, &INPUT, dw).expect("finite");
        });
        assert_eq!(heun[index], expected, "Heun, member {member}");
        let expected = alone(member, steps, dt, |model, x, dw, halves| {
            let splitting: ItoStrangSplitting<f64, 3> =
                ItoStrangSplitting::new(model, x, &INPUT, dt).expect("three states of noise");
            splitting
                .step_heun(model, x, &INPUT, dw, &halves)
                .expect("finite");
        });
        assert_eq!(splitting[index], expected, "splitting, member {member}");
    }
}

/// It takes two numbers a channel. Without the second ones, of which only the sign counts, its iterated integrals have a mean.
#[test]
fn dri1_has_both_kinds_of_its_numbers() {
    let (dt, steps, members) = (1e-2, 40, [2, 7]);
    let flown = last(&experiment(Scheme::Dri1, dt, vec![steps]), &members);
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    for (found, member) in flown.into_iter().zip(members) {
        let mut streams: Vec<NormalStream> = (0..2 * CHANNELS as u64)
            .map(|channel| NormalStream::new(SEED, member, channel))
            .collect();
        let mut x = STATE;
        for step in 0..steps {
            let weak = WeakIncrements::from_normals(dt, |index| streams[index].normal(step));
            ItoDri1::new(dt)
                .step(&model, &mut x, &INPUT, &weak)
                .expect("finite");
        }
        assert_eq!(found, x, "member {member}");
    }
}

#[test]
fn threads_and_chunks_change_no_bit() {
    let experiment = experiment(Scheme::EulerMaruyama, 1e-3, vec![0, 10, 20]);
    let [one, three] = [1, 3].map(|threads| run::<Sdcom>(&experiment, 300, threads));
    assert_eq!(one.digest, three.digest);
    for (a, b) in one.snapshots.iter().zip(&three.snapshots) {
        assert_eq!(a.covariance, b.covariance);
        assert_eq!(a.members, 300);
        for (a, b) in a.states.iter().zip(&b.states) {
            assert_eq!((a.mean, a.std, a.quantiles), (b.mean, b.std, b.quantiles));
        }
    }
}

/// Parts of six blocks, one of which is not whole, with lost members among them.
#[test]
fn parts_wherever_they_are_cut_change_no_bit() {
    let members = 5 * BLOCK + 77;
    let mut experiment = experiment(Scheme::EulerMaruyama, 1e-2, vec![0, 1, 5]);
    experiment.state[1][index("alpha")] = 15.0;
    let whole = run::<Sdcom>(&experiment, members, 2);
    assert!(whole.lost > 0, "none is lost");
    let engine = experiment.engine::<Sdcom>().expect("an engine");
    let control = Control::default();
    let reference = engine.reference(members, 1, &control).expect("flown");
    let shown = |it: Outcome| format!("{:?} {:?} {}", it.snapshots, it.losses, it.digest);
    let whole = shown(whole);
    for cuts in [vec![], vec![1], vec![3], vec![1, 2, 5], vec![2, 4]] {
        let ends = cuts.iter().map(|it| it * BLOCK).chain([members]);
        let mut tally = Tally::new(&experiment, reference.clone());
        for end in ends {
            let mut records = Vec::new();
            let part = engine.part(tally.members()..end, &reference, 2, &control, |_, seen| {
                records.extend_from_slice(seen);
            });
            let part = part.expect("flown");
            let fits = part.is_of(
                &experiment,
                &reference,
                tally.members(),
                end - tally.members(),
            );
            assert!(fits);
            tally.join(&records, part);
        }
        assert_eq!(
            shown(tally.outcome(members, Duration::ZERO)),
            whole,
            "{cuts:?}"
        );
    }
}

/// Sums over the members give what their numbers give, beyond the first group of 2048 too.
#[test]
fn moments_and_quantiles_are_those_of_the_members() {
    let experiment = experiment(Scheme::EulerMaruyama, 1e-2, vec![10]);
    for members in [300, 2300] {
        let outcome = run::<Sdcom>(&experiment, members, 2);
        let spread = &outcome.snapshots[0].states[index("altitude")];
        let numbers: Vec<u64> = (0..members).collect();
        let batches = numbers.chunks(8).flat_map(|batch| last(&experiment, batch));
        let mut sample: Vec<f64> = batches.map(|x| x.altitude).collect();
        let expected = OpenEstimate::of_sample_std(&sample).closed();
        let expected = expected.expect("many members");
        let std = spread.std.and_then(|it| it.closed()).expect("a deviation");
        for (found, expected) in [
            (std.value, expected.value),
            (std.low, expected.low),
            (std.high, expected.high),
        ] {
            assert_relative_eq!(found, expected, max_relative = 1e-9);
        }
        sample.sort_by(f64::total_cmp);
        for (found, share) in spread.quantiles.iter().zip(QUANTILES) {
            let expected = OpenEstimate::of_sorted(&sample, share);
            // A side is open for both, and bins widen the interval by one at most.
            let near = |found: Option<f64>, expected: Option<f64>, sides: [f64; 2]| {
                assert_eq!(found.is_some(), expected.is_some(), "{share}");
                let off = found
                    .zip(expected)
                    .map_or(0.0, |(found, expected)| found - expected);
                let [low, high] = sides.map(|side| side * spread.resolution);
                assert!((low - 1e-9..=high + 1e-9).contains(&off), "{share}: {off}");
            };
            // Between neighbouring numbers a quantile is a matter of definition.
            let rank = share * members as f64;
            let [below, above] = [rank.floor() as usize - 1, rank.ceil() as usize];
            let range = sample[below] - spread.resolution..=sample[above] + spread.resolution;
            assert!(range.contains(&found.value.expect("a value")), "{share}");
            near(found.low, expected.low, [-1.0, 0.0]);
            near(found.high, expected.high, [0.0, 1.0]);
        }
        assert_eq!(spread.resolution > 0.0, members > 2048);
    }
}

/// The stationary deviation of coloured noise in closed form: by the exact transition it has no error at any step.
#[test]
fn coloured_noise_has_its_stationary_deviation_at_a_long_step() {
    let experiment = experiment(Scheme::Splitting, 0.05, vec![12]);
    let outcome = run::<Sdcom>(&experiment, 4096, 2);
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let chi_1 = index("chi_1");
    let rate = model.decay(chi_1).expect("coloured noise");
    let gain = model.prepared.chi_diffusion_1;
    let time = 0.6;
    let exact = (gain * gain / (2.0 * rate) * (1.0 - (-2.0 * rate * time).exp())).sqrt();
    let std = outcome.snapshots[0].states[chi_1].std.expect("finite");
    assert!(std.holds(exact), "{exact} is not in {std:?}");
}

#[test]
fn members_that_are_lost_are_counted_and_touch_no_other() {
    // With deviations of 30 rad of the angle of attack the curve fits soon have no finite value.
    let mut wild = experiment(Scheme::EulerMaruyama, 0.05, vec![0, 400]);
    wild.state[1][index("alpha")] = 30.0;
    let members: Vec<u64> = (0..8).collect();
    let seen = fly::<Sdcom>(&wild, &members).expect("it goes");
    assert!(seen.iter().any(|seen| seen.lost.is_some()), "some are lost");
    for (seen, &member) in seen.iter().zip(&members) {
        let alone = fly::<Sdcom>(&wild, &[member]).expect("it goes");
        assert_eq!(alone[0].last, seen.last, "member {member}");
        assert_eq!(alone[0].lost, seen.lost);
        assert!(seen.last.iter().all(|value| value.is_finite()));
    }
    let outcome = run::<Sdcom>(&wild, 64, 1);
    assert_eq!(outcome.snapshots[0].members, 64);
    assert_eq!(outcome.snapshots[1].members, 64 - outcome.lost);
}

#[test]
fn the_first_step_outside_is_found() {
    let mut experiment = experiment(Scheme::EulerMaruyama, 1e-3, (0..=200).collect());
    let (alpha, interval) = (index("alpha"), Bounds::new(0.0255, 0.0265));
    let mut limits = vec![Bounds::new(f64::NEG_INFINITY, f64::INFINITY); 8];
    limits[alpha] = interval;
    experiment.watched.push(limits);
    for seen in fly::<Sdcom>(&experiment, &[0, 1, 2]).expect("it goes") {
        let outside = |x: &[f64]| !interval.contains(x[alpha]);
        let first = seen.states.chunks(8).position(outside);
        let first = first.map(|step| step as u64);
        assert_eq!(seen.left[1][alpha], first);
        assert!(first.is_some(), "it leaves");
    }
}

/// Numbers whose squares are none have no deviation, and no interval of the mean, in the place of one of width 0.
#[test]
fn a_moment_beyond_numbers_is_open() {
    let mut far = experiment(Scheme::EulerMaruyama, 1e-3, vec![0, 1]);
    far.state[1][index("chi_1")] = 1e200;
    let outcome = run::<Sdcom>(&far, 64, 1);
    let start = &outcome.snapshots[0];
    let chi = &start.states[index("chi_1")];
    assert_eq!((chi.mean, chi.std), (None, None));
    assert!(chi.quantiles[3].value.is_some_and(f64::is_finite));
    assert!(start.states[index("chi_2")].std.is_some());
}

#[test]
fn normal_numbers_in_single_precision_have_the_same_law() {
    let exact = experiment(Scheme::Splitting, 0.01, vec![20]);
    let mode = |mode| {
        let experiment = Experiment {
            mode,
            ..exact.clone()
        };
        run::<Sdcom>(&experiment, 4096, 2)
    };
    let stds = |outcome: &Outcome| -> Vec<Estimate> {
        outcome.snapshots[0]
            .states
            .iter()
            .filter_map(|state| state.std?.closed())
            .collect()
    };
    let reference = stds(&mode(Mode::Exact));
    let single = stds(&mode(Mode::F32Noise));
    for (a, b) in single.iter().zip(&reference) {
        assert!(a.low < b.high && b.low < a.high, "{a:?}, {b:?}");
    }
}

#[test]
fn a_scheme_that_does_not_go_says_why() {
    let flown = |scheme| fly::<Sdcom>(&experiment(scheme, 1e-3, vec![1]), &[0]);
    for scheme in [Scheme::Milstein, Scheme::Sra1] {
        assert!(matches!(flown(scheme), Err(MonteCarloError::Scheme { .. })));
    }
    assert!(flown(Scheme::Dri1).is_ok() && flown(Scheme::StratonovichHeun).is_ok());
    // No state of it is coloured noise.
    let deterministic = held::<dcom::Model<f64>>(&dcom::NOMINAL, Scheme::Splitting, 1e-3, vec![1]);
    assert_eq!(
        fly::<dcom::Model<f64>>(&deterministic, &[0]).err(),
        Some(MonteCarloError::NoColouredNoise { model: "dcom" })
    );
    // Every model goes by every scheme that is for its noise.
    let gust = held::<sdcom_gust::Model<f64>>(&sdcom::NOMINAL, Scheme::Heun, 1e-3, vec![1]);
    assert!(fly::<sdcom_gust::Model<f64>>(&gust, &[0]).is_ok());
}

#[test]
fn what_is_stopped_tells_of_what_was_flown() {
    let control = Control::default();
    control.stop.store(true, Ordering::Relaxed);
    let experiment = experiment(Scheme::Heun, 1e-3, vec![10]);
    let engine = experiment.engine::<Sdcom>().expect("the scheme goes");
    let stopped = engine.run(100, 1, &control);
    assert_eq!(stopped.err(), Some(MonteCarloError::Stopped));
}

/// Whatever is complete is reported, of one group of members or more, with the bits of a run of so many.
#[test]
fn a_stopped_run_is_a_run_of_the_members_that_were_flown() {
    // A task of 16 members is in flight, or of 64. On one thread: on two, the first task may be left behind.
    for (steps, enough, in_flight) in [(400, 40, 16), (10, 2100, 64)] {
        let experiment = experiment(Scheme::EulerMaruyama, 1e-3, vec![0, steps / 2, steps]);
        let control = Control::default();
        let mut listed = Vec::new();
        let stopped = std::thread::scope(|scope| {
            scope.spawn(|| {
                while control.done.load(Ordering::Relaxed) < enough * steps {
                    std::thread::yield_now();
                }
                control.stop.store(true, Ordering::Relaxed);
            });
            let engine = experiment.engine::<Sdcom>().expect("the scheme goes");
            engine.run_and_list(1_000_000, 1, &control, |first, seen| {
                let seen = (first..).zip(seen);
                listed.extend(seen.map(|(member, seen)| (member, seen.last.clone())));
            })
        });
        let stopped = stopped.expect("some are flown");
        assert!((enough - in_flight..1_000_000).contains(&stopped.members));
        assert_eq!((stopped.asked, stopped.members % 8), (1_000_000, 0));
        let whole = run::<Sdcom>(&experiment, stopped.members, 1);
        assert_eq!(stopped.digest, whole.digest);
        assert_eq!(stopped.member_steps, stopped.members * steps);
        for (a, b) in stopped.snapshots.iter().zip(&whole.snapshots) {
            assert_eq!((a.members, &a.covariance), (b.members, &b.covariance));
            for (a, b) in a.states.iter().zip(&b.states) {
                assert_eq!((a.mean, a.std, a.quantiles), (b.mean, b.std, b.quantiles));
                assert_eq!(a.std_of_stayed, b.std_of_stayed);
            }
        }
        let members: Vec<u64> = (0..stopped.members).collect();
        assert!(listed.iter().map(|it| &it.0).eq(&members));
        let last = members.len() - 1;
        assert_eq!(
            listed[last].1,
            fly::<Sdcom>(&experiment, &members[last..]).expect("it goes")[0].last
        );
    }
}

/// By SciPy 1.17: `binomtest(count, of).proportion_ci(method="wilson")`.
#[test]
fn the_interval_of_a_share_is_wilsons() {
    let share = Estimate::of_share(8, 10);
    assert_abs_diff_eq!(share.low, 0.490_162_471_536_641_8, epsilon = 1e-14);
    assert_abs_diff_eq!(share.high, 0.943_317_848_545_624_8, epsilon = 1e-14);
    let none = Estimate::of_share(0, 100);
    assert_eq!(none.low, 0.0);
    assert_abs_diff_eq!(none.high, 0.036_993_5, epsilon = 1e-6);
    let unknown = Estimate::of_share(0, 0);
    assert_eq!((unknown.low, unknown.high), (0.0, 1.0));
}

/// A model from its trim, at its inputs.
fn held<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    scheme: Scheme,
    dt: f64,
    snapshots: Vec<u64>,
) -> Experiment {
    let rest = trim(&M::with_parameters(parameters), &level::<M>()).expect("it trims");
    Experiment {
        parameters: values(parameters),
        dispersion: None,
        state: [values(&rest.state), vec![0.0; M::State::LEN]],
        input: [values(&rest.input), vec![0.0; M::Input::LEN]],
        feedback: None,
        watched: vec![values(&M::STATE_BOUNDS)],
        scheme,
        mode: Mode::Exact,
        dt,
        snapshots,
        seed: SEED,
        control_variate: false,
    }
}

/// Without noise members differ by where they start alone, and each has the bits of a flight without noise from there.
#[test]
fn a_model_without_noise_is_flown_from_dispersed_starts() {
    let (dt, steps) = (1e-3, 200);
    let mut experiment = held::<com::Model<f64>>(&com::NOMINAL, Scheme::Heun, dt, vec![0, steps]);
    let calm = fly::<com::Model<f64>>(&experiment, &[0, 1]).expect("it goes");
    assert_eq!(calm[0].last, calm[1].last);
    experiment.state[1][index("alpha")] = 1e-3;
    experiment.state[1][index("velocity")] = 10.0;
    let members: Vec<u64> = (0..8).collect();
    let model = com::Model::new(&com::NOMINAL);
    for seen in fly::<com::Model<f64>>(&experiment, &members).expect("it goes") {
        let start = seen.state(0).expect("the start");
        assert_ne!(start, experiment.state[0]);
        let altitude = index("altitude");
        assert_eq!(start[altitude], experiment.state[0][altitude]);
        let (mut x, input): (com::State<f64>, com::Input<f64>) =
            (vector(start), vector(&seen.inputs[..3]));
        let calm = com::Noise::splat(0.0);
        for _ in 0..steps {
            ItoHeun::new(dt)
                .step(&model, &mut x, &input, &calm)
                .expect("finite");
        }
        assert_eq!(seen.last, values(&x));
    }
    let outcome = run::<com::Model<f64>>(&experiment, 2000, 2);
    assert_eq!(outcome.lost, 0);
    let start = outcome.snapshots[0].states[index("alpha")]
        .std
        .expect("a deviation");
    let std = start.closed().expect("many members").value;
    // Five standard errors of a normal deviation.
    assert!(
        (std / 1e-3 - 1.0).abs() < 5.0 / (2.0 * 2000.0_f64).sqrt(),
        "{std}"
    );
}

/// Of η̈ + 2ζω η̇ + ω² η = σ ξ: Var η = σ²/(4ζω³), Var η̇ = σ²/(4ζω). Its reduction has the decay rate ζω and the gain σ/ω² at
/// zero frequency: Var χ = ζσ²/(2ω³).
#[test]
fn a_flexible_mode_and_its_coloured_noise_have_their_stationary_variances() {
    const MEMBERS: u64 = 32_768;
    let p = flexible_mode::NOMINAL;
    // Nine time constants: e⁻¹⁸ of the variance is left to come.
    let dt = std::f64::consts::TAU / p.omega / 200.0;
    let steps = (9.0 / (p.zeta * p.omega * dt)).ceil() as u64;
    let fly_by = |scheme| held::<flexible_mode::Model<f64>>(&p, scheme, dt, vec![steps]);
    // One Wiener process moves both: they cannot be stepped one after the other.
    assert_eq!(
        fly::<flexible_mode::Model<f64>>(&fly_by(Scheme::Splitting), &[0]).err(),
        Some(MonteCarloError::Scheme {
            scheme: "splitting",
            reason: NoiseError::SharedChannel {
                channel: "xi",
                state: "eta_dot"
            },
        })
    );
    for scheme in [Scheme::Heun, Scheme::Sra1] {
        let experiment = fly_by(scheme);
        let outcome = run::<flexible_mode::Model<f64>>(&experiment, MEMBERS, 2);
        let snapshot = &outcome.snapshots[0];
        let rate = p.sigma * p.sigma / (4.0 * p.zeta * p.omega);
        let stiffness = p.omega * p.omega;
        let coloured = p.zeta * p.sigma * p.sigma / (2.0 * p.omega * stiffness);
        for (index, exact) in [rate / stiffness, rate, coloured].into_iter().enumerate() {
            // Five standard errors of the variance of normal numbers.
            let bound = 5.0 * (2.0 / (MEMBERS - 1) as f64).sqrt();
            let found = snapshot.covariance[index][index];
            assert!(
                (found / exact - 1.0).abs() < bound,
                "{scheme:?} {index}: {found}, {exact}"
            );
        }
    }
}
