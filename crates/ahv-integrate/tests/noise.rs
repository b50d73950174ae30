//! Sources of noise, and the path that can be refined. Their law: `noise_law.rs`.
#![forbid(unsafe_code)]

mod common;

use std::array::from_fn;
use std::cell::RefCell;
use std::collections::BTreeSet;

use ahv_core::Vector;
use ahv_integrate::{
    BrownianPath, KeyedNormals, NormalLanes, NormalSource, NormalStream, RandNormals,
    WeakIncrements, WienerIntegrals, WienerSource, bisect,
};
use ahv_models::sdcom::Noise;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use common::vector;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

vector!(Two, w_1, w_2);

const SOURCE: KeyedNormals = KeyedNormals { seed: 1, member: 2 };
const CHANNELS: usize = Noise::<()>::LEN;

/// A number of `tests/vectors/normals.txt`: bits and values computed apart from this project's Rust, in Python, by
/// `generator/ahv_oracle/normals.py`.
struct Reference {
    precision: &'static str,
    /// Seed, member, channel, step.
    key: [u64; 4],
    bits: u64,
    exact: f64,
}

fn references() -> Vec<Reference> {
    let text = include_str!("../../../tests/vectors/normals.txt");
    let rows = text.lines().skip(1).map(|line| {
        let fields: Vec<&'static str> = line.split(',').collect();
        let [precision, key @ .., bits, exact] = &fields[..] else {
            panic!("precision,seed,member,channel,step,bits,hi");
        };
        let key: Vec<u64> = key
            .iter()
            .map(|word| word.parse().expect("a word"))
            .collect();
        Reference {
            precision,
            key: key.try_into().expect("four words"),
            bits: u64::from_str_radix(bits, 16).expect("bits"),
            exact: exact.parse().expect("a number"),
        }
    });
    rows.collect()
}

/// A value that differs in its last bit on another machine would change every recorded run.
#[test]
fn keyed_numbers_have_the_bits_that_python_gives_them() {
    let references = references();
    assert!(references.len() > 90);
    for Reference {
        precision,
        key: [seed, member, channel, step],
        bits,
        exact,
    } in references
    {
        let members = [member ^ 1, member, member.wrapping_add(5)];
        if precision == "f64" {
            let found = NormalStream::new(seed, member, channel).normal(step);
            assert_eq!(found.to_bits(), bits);
            assert_abs_diff_eq!(found, exact, epsilon = 2f64.powi(-40));
            let lanes = NormalLanes::<f64, 3>::new(seed, members, channel).normal(step);
            assert_eq!(lanes.0[1].to_bits(), bits);
            assert_eq!(
                lanes.0[0],
                NormalStream::new(seed, members[0], channel).normal(step)
            );
        } else {
            let [_, found, _] = NormalLanes::<f32, 3>::new(seed, members, channel)
                .normal(step)
                .0;
            assert_eq!(u64::from(found.to_bits()), bits);
            assert_abs_diff_eq!(f64::from(found), exact, epsilon = 2f64.powi(-18));
        }
    }
}

#[test]
fn keyed_numbers_do_not_depend_on_order() {
    for channel in 0..CHANNELS {
        let mut stream = NormalStream::new(1, 2, channel as u64);
        for step in [3, 0, 3, 2, 3, 1000, 3, 9, 10, 1 << 60] {
            assert_eq!(stream.normal(step), { SOURCE }.normal(step, channel));
        }
    }
    let dw: Noise<f64> = WienerSource::<CHANNELS>::new(1, 2).increments(3, 1.0);
    let alone = [0, 1, 2, 3, 4, 5].map(|channel| { SOURCE }.normal(3, channel));
    assert_eq!(dw.to_array(), alone);
}

/// Every lane has the bits of the stream of its member, whatever the width.
#[test]
fn lanes_are_the_streams_of_their_members() {
    fn width<const N: usize>() {
        let members: [u64; N] = from_fn(|lane| (lane as u64) << (5 * lane));
        let mut single = members.map(|member| NormalLanes::<f32, 1>::new(9, [member], 4));
        let mut double = members.map(|member| NormalStream::new(9, member, 4));
        let mut lanes = NormalLanes::<f64, N>::new(9, members, 4);
        let mut narrow = NormalLanes::<f32, N>::new(9, members, 4);
        for step in 0..200 {
            let alone = double
                .each_mut()
                .map(|stream| stream.normal(step).to_bits());
            assert_eq!(lanes.normal(step).0.map(f64::to_bits), alone);
            let alone = single
                .each_mut()
                .map(|stream| stream.normal(step).0[0].to_bits());
            assert_eq!(narrow.normal(step).0.map(f32::to_bits), alone);
        }
    }
    width::<1>();
    width::<2>();
    width::<5>();
    width::<8>();
}

#[test]
fn a_step_of_a_source_does_not_depend_on_the_steps_before_it() {
    let mut source = WienerSource::<CHANNELS>::new(7, 0);
    let forward: Vec<Noise<f64>> = (0..40).map(|step| source.increments(step, 0.01)).collect();
    for step in [39, 0, 5, 4, 4, 5, 5, 38, 1, 2] {
        assert_eq!(
            source.increments::<_, Noise<_>>(step, 0.01),
            forward[step as usize]
        );
    }
    for step in [17, 32] {
        let mut fresh = WienerSource::<CHANNELS>::new(7, 0);
        assert_eq!(
            fresh.increments::<_, Noise<_>>(step, 0.01),
            forward[step as usize]
        );
    }
}

#[test]
fn seeds_members_channels_and_steps_differ() {
    let mut seen = BTreeSet::new();
    for (seed, member) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let mut source = WienerSource::<CHANNELS>::new(seed, member);
        for step in 0..50 {
            let dw: Noise<f64> = source.increments(step, 1.0);
            seen.extend(dw.to_array().map(f64::to_bits));
        }
    }
    assert_eq!(seen.len(), 2 * 2 * 50 * CHANNELS);
}

#[test]
fn the_increments_are_normal_and_independent() {
    let (steps, dt) = (100_000, 0.04);
    let mut source = WienerSource::<CHANNELS>::new(3, 0);
    let draws: Vec<Noise<f64>> = (0..steps).map(|step| source.increments(step, dt)).collect();
    let mean = |f: &dyn Fn(usize) -> f64| (0..draws.len()).map(f).sum::<f64>() / draws.len() as f64;
    let value = |i: usize, channel: usize| draws[i].get(channel).expect("six channels") / dt.sqrt();
    // A standard error of a mean of 100 000 products is 0.0032; of fourth powers, 0.031.
    for a in 0..CHANNELS {
        assert_abs_diff_eq!(mean(&|i| value(i, a)), 0.0, epsilon = 0.015);
        assert_relative_eq!(mean(&|i| value(i, a).powi(2)), 1.0, epsilon = 0.02);
        assert_abs_diff_eq!(mean(&|i| value(i, a).powi(4)), 3.0, epsilon = 0.15);
        assert_abs_diff_eq!(
            mean(&|i| value(i, a) * value(i / 2, a)),
            0.0,
            epsilon = 0.02
        );
        for b in 0..a {
            assert_abs_diff_eq!(mean(&|i| value(i, a) * value(i, b)), 0.0, epsilon = 0.015);
        }
    }
}

/// Variances of ΔW and ΔZ, their covariance, and the covariance of neighbours.
fn moments(steps: &[WienerIntegrals<Two<f64>>]) -> [f64; 4] {
    let mean = |f: &dyn Fn(usize) -> f64| {
        (0..steps.len() - 1).map(f).sum::<f64>() / (steps.len() - 1) as f64
    };
    [
        mean(&|i| steps[i].dw.w_1 * steps[i].dw.w_1),
        mean(&|i| steps[i].dw.w_2 * steps[i].dz.w_2),
        mean(&|i| steps[i].dz.w_1 * steps[i].dz.w_1),
        mean(&|i| steps[i].dw.w_1 * steps[i + 1].dw.w_1),
    ]
}

#[test]
fn finer_steps_add_up_to_coarser_ones() {
    let mut path = BrownianPath::new(SOURCE, 3.0);
    for level in 0..6 {
        assert_eq!(path.dt(level), 3.0 / f64::from(1 << level));
        for index in 0..1 << level {
            let whole: WienerIntegrals<Two<f64>> = path.integrals(level, index).expect("a step");
            let halves = [0, 1].map(|half| path.integrals(level + 1, 2 * index + half));
            let [Some(left), Some(right)] = halves else {
                panic!("both halves are steps of the path");
            };
            let again = left.then(right, path.dt(level + 1));
            for channel in 0..2 {
                let pair = |w: &Two<f64>| w.get(channel).expect("two channels");
                assert_abs_diff_eq!(pair(&again.dw), pair(&whole.dw), epsilon = 1e-14);
                assert_abs_diff_eq!(pair(&again.dz), pair(&whole.dz), epsilon = 1e-14);
            }
        }
    }
    for (level, index) in [(0, 1), (3, 8), (3, u64::MAX), (63, 0), (64, 0), (200, 0)] {
        assert_eq!(path.integrals::<f64, Two<f64>>(level, index), None);
    }
    assert!(path.integrals::<f64, Two<f64>>(62, (1 << 62) - 1).is_some());
}

/// Covariances of numbers that `linear` makes of `N` independent standard normal ones.
fn covariances<const N: usize, const M: usize>(
    linear: impl Fn([f64; N]) -> [f64; M],
) -> [[f64; M]; M] {
    let unit = |k: usize| from_fn(|i| if i == k { 1.0 } else { 0.0 });
    let responses: [[f64; M]; N] = from_fn(|k| linear(unit(k)));
    from_fn(|a| {
        from_fn(|b| {
            responses
                .iter()
                .map(|response| response[a] * response[b])
                .sum()
        })
    })
}

/// Covariances of ΔW and ΔZ over steps of these lengths one after the other.
fn law<const M: usize>(steps: &[f64]) -> [[f64; M]; M] {
    let of_pair = |h: f64| [[h, h * h / 2.0], [h * h / 2.0, h * h * h / 3.0]];
    from_fn(|a| {
        from_fn(|b| {
            if a / 2 == b / 2 {
                of_pair(steps[a / 2])[a % 2][b % 2]
            } else {
                0.0
            }
        })
    })
}

#[track_caller]
fn assert_covariances<const M: usize>(found: [[f64; M]; M], expected: [[f64; M]; M]) {
    for (a, b) in (0..M).flat_map(|a| (0..M).map(move |b| (a, b))) {
        let scale = (expected[a][a] * expected[b][b]).sqrt();
        assert_abs_diff_eq!(found[a][b], expected[a][b], epsilon = 1e-14 * scale);
    }
}

fn both(value: f64) -> Two<f64> {
    Two {
        w_1: value,
        w_2: value,
    }
}

fn pair(steps: [WienerIntegrals<Two<f64>>; 2]) -> [f64; 4] {
    let [left, right] = steps;
    [left.dw.w_1, left.dz.w_2, right.dw.w_2, right.dz.w_1]
}

/// All are linear in normal numbers, so that covariances are the whole law.
#[test]
fn integrals_over_one_step_two_steps_and_both_together_have_the_law_of_a_wiener_process() {
    let [first, second] = [0.5, 3.0];
    let steps = |[a, b, c, d]: [f64; 4]| {
        [
            WienerIntegrals::from_normals(first, both(a), both(b)),
            WienerIntegrals::from_normals(second, both(c), both(d)),
        ]
    };
    assert_covariances(covariances(|z| pair(steps(z))), law(&[first, second]));
    let together = |z| {
        let [left, right] = steps(z);
        let whole = left.then(right, second);
        [whole.dw.w_1, whole.dz.w_1]
    };
    assert_covariances(covariances(together), law(&[first + second]));
}

/// The halves of any step are two independent steps that make up the step: the law of the process given the step.
#[test]
fn a_bisected_step_is_two_independent_steps() {
    for dt in [0.01, 1.0, 6.0] {
        let whole = |a, b| WienerIntegrals::from_normals(dt, both(a), both(b));
        let halves = |[a, b, c, d]: [f64; 4]| {
            let (left, right) = whole(a, b).bisect(dt, both(c), both(d));
            let again = left.then(right, dt / 2.0);
            assert_abs_diff_eq!(
                again.dw.w_1,
                whole(a, b).dw.w_1,
                epsilon = 1e-14 * dt.sqrt()
            );
            assert_abs_diff_eq!(
                again.dz.w_1,
                whole(a, b).dz.w_1,
                epsilon = 1e-14 * dt.powf(1.5)
            );
            [left, right]
        };
        assert_covariances(covariances(|z| pair(halves(z))), law(&[dt / 2.0; 2]));
        // The plain bridge, of ΔW alone.
        let plain = |[a, b]: [f64; 2]| {
            let (left, right) = bisect(both(dt.sqrt() * a), dt, both(b));
            [left.w_1, right.w_2]
        };
        let expected = [[dt / 2.0, 0.0], [0.0, dt / 2.0]];
        assert_covariances(covariances(plain), expected);
    }
}

/// A source whose number at one place is 1, everywhere else 0; it notes what it is asked for.
struct Impulse<'a> {
    at: (u64, usize),
    asked: &'a RefCell<BTreeSet<(u64, usize)>>,
}

impl NormalSource for Impulse<'_> {
    fn normal(&mut self, step: u64, channel: usize) -> f64 {
        self.asked.borrow_mut().insert((step, channel));
        if self.at == (step, channel) { 1.0 } else { 0.0 }
    }
}

/// Two steps, or two channels, that share a normal number are correlated; one that a number is missing from has another
/// variance.
#[test]
fn the_steps_of_every_level_are_independent_and_so_are_the_channels() {
    for level in 0..=4 {
        let asked = RefCell::new(BTreeSet::new());
        // ΔW and ΔZ of each step, of the first channel and then of the second.
        let response = |at: (u64, usize)| {
            let source = Impulse { at, asked: &asked };
            let mut path = BrownianPath::new(source, 3.0);
            let steps = (0..1 << level).map(|index| path.integrals(level, index));
            let steps: Vec<WienerIntegrals<Two<f64>>> = steps.map(|w| w.expect("a step")).collect();
            let first = steps.iter().flat_map(|step| [step.dw.w_1, step.dz.w_1]);
            let second = steps.iter().flat_map(|step| [step.dw.w_2, step.dz.w_2]);
            first.chain(second).collect::<Vec<f64>>()
        };
        response((0, 0));
        let places = asked.borrow().clone();
        let responses: Vec<Vec<f64>> = places.into_iter().map(response).collect();
        let dt = 3.0 / f64::from(1 << level);
        let expected: [[f64; 64]; 64] = law(&[dt; 32]);
        let count = 4 << level;
        for (a, b) in (0..count).flat_map(|a| (0..count).map(move |b| (a, b))) {
            let found: f64 = responses
                .iter()
                .map(|response| response[a] * response[b])
                .sum();
            let scale = (expected[a][a] * expected[b][b]).sqrt();
            assert_abs_diff_eq!(found, expected[a][b], epsilon = 1e-13 * scale);
        }
    }
}

#[test]
fn the_plain_bridge_halves_an_increment() {
    let dw = Two {
        w_1: 0.3,
        w_2: -0.1,
    };
    let (left, right) = bisect(
        dw,
        0.04,
        Two {
            w_1: 1.0,
            w_2: -2.0,
        },
    );
    assert_relative_eq!(left.w_1 + right.w_1, dw.w_1, max_relative = 1e-15);
    // Var = dt/4 given the whole.
    assert_relative_eq!(left.w_1, 0.15 + 0.1, max_relative = 1e-15);
    assert_relative_eq!(left.w_2, -0.05 - 0.2, max_relative = 1e-15);
}

#[test]
fn any_generator_of_rand_gives_wiener_increments() {
    let mut source = RandNormals::new(ChaCha8Rng::from_seed([7; 32]));
    let h = 0.04;
    let steps: Vec<WienerIntegrals<Two<f64>>> = (0..20_000).map(|_| source.integrals(h)).collect();
    let [dw, both, dz, neighbours] = moments(&steps);
    assert_relative_eq!(dw, h, max_relative = 0.03);
    assert_relative_eq!(both, h * h / 2.0, max_relative = 0.03);
    assert_relative_eq!(dz, h.powi(3) / 3.0, max_relative = 0.03);
    assert_abs_diff_eq!(neighbours, 0.0, epsilon = 0.03 * h);

    let again = RandNormals::new(ChaCha8Rng::from_seed([7; 32])).integrals::<f64, _>(h);
    assert_eq!(steps[0], again);
    let mut borrowed = ChaCha8Rng::from_seed([7; 32]);
    let dw: Two<f64> = RandNormals::new(&mut borrowed).increments(h);
    assert_eq!(dw, steps[0].dw);
}

#[test]
fn weak_increments_take_their_values_with_their_probabilities() {
    let mut source = RandNormals::new(ChaCha8Rng::from_seed([9; 32]));
    let (h, count) = (0.01_f64, 60_000);
    let mut found = [0; 3];
    let mut positive = 0;
    for _ in 0..count {
        let weak: WeakIncrements<Two<f64>> = source.weak_increments(h);
        let level = weak.three_point.w_1 / (3.0 * h).sqrt();
        assert!(level == 0.0 || level.abs() == 1.0);
        found[(level + 1.0) as usize] += 1;
        assert_relative_eq!(weak.two_point.w_2.abs(), h.sqrt());
        positive += i32::from(weak.two_point.w_2 > 0.0);
    }
    for (count_here, probability) in found.into_iter().zip([1.0, 4.0, 1.0].map(|p| p / 6.0)) {
        let share = f64::from(count_here) / f64::from(count);
        assert_abs_diff_eq!(share, probability, epsilon = 0.006);
    }
    assert_abs_diff_eq!(f64::from(positive) / f64::from(count), 0.5, epsilon = 0.007);
}
