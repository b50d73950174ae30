//! The law of keyed normal numbers. Seeds are fixed; the limits hold for all but a few in 10⁵ seeds.
#![forbid(unsafe_code)]

use ahv_integrate::{NormalLanes, Precision};

const LANES: usize = 8;
const STEPS: u64 = 125_000;
const COUNT: f64 = LANES as f64 * STEPS as f64;
/// Standard errors that a mean may be away from what it estimates: 7 in 10⁶ are further.
const ERRORS: f64 = 4.5;

/// Numbers of eight members, one member after the other.
fn numbers<T: Precision>(seed: u64, channel: u64) -> Vec<Vec<f64>> {
    let mut lanes =
        NormalLanes::<T, LANES>::new(seed, std::array::from_fn(|lane| lane as u64), channel);
    let mut members = vec![Vec::new(); LANES];
    for step in 0..STEPS {
        for (member, number) in members.iter_mut().zip(lanes.normal(step).0) {
            member.push(number.to_f64());
        }
    }
    members
}

/// Whether a mean of `count` independent terms of this variance is where it should be.
fn assert_mean(what: &str, terms: impl Iterator<Item = f64>, expected: f64, variance: f64) {
    let (sum, count) = terms.fold((0.0, 0.0), |(sum, count), term| (sum + term, count + 1.0));
    let errors = (sum / count - expected) / (variance / count).sqrt();
    println!("{what}: {errors:+.2} standard errors");
    assert!(errors.abs() < ERRORS, "{what}: {errors} standard errors");
}

/// The distribution of the standard normal law.
fn distribution(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

fn has_the_normal_law<T: Precision>(seed: u64) {
    let all: Vec<f64> = numbers::<T>(seed, 0).concat();
    assert_eq!(all.len() as f64, COUNT);
    // E z^2k = 1, 3, 15, 105 for k = 1 to 4.
    assert_mean("z", all.iter().copied(), 0.0, 1.0);
    assert_mean("z^2", all.iter().map(|z| z.powi(2)), 1.0, 3.0 - 1.0);
    assert_mean("z^3", all.iter().map(|z| z.powi(3)), 0.0, 15.0);
    assert_mean("z^4", all.iter().map(|z| z.powi(4)), 3.0, 105.0 - 9.0);
    for bound in [1.0, 2.0, 3.0, 4.0, 4.5] {
        for side in [1.0, -1.0] {
            let beyond = distribution(-bound);
            let counted = all.iter().map(|z| f64::from(u8::from(side * z > bound)));
            assert_mean(
                &format!("beyond {}", side * bound),
                counted,
                beyond,
                beyond * (1.0 - beyond),
            );
        }
    }
    let mut sorted = all;
    sorted.sort_by(f64::total_cmp);
    let distance = sorted
        .iter()
        .enumerate()
        .fold(0.0_f64, |distance, (index, &z)| {
            let (below, above) = (index as f64 / COUNT, (index + 1) as f64 / COUNT);
            let expected = distribution(z);
            distance.max(expected - below).max(above - expected)
        });
    // Kolmogorov: P(√n D > x) is 2 exp(−2x²) for large x, 1.4·10⁻⁵ at 2.44.
    let scaled = distance * COUNT.sqrt();
    println!("Kolmogorov–Smirnov: {scaled:.3}");
    assert!(scaled < 2.44, "Kolmogorov–Smirnov: {scaled}");
}

#[test]
fn doubles_have_the_normal_law() {
    has_the_normal_law::<f64>(21);
}

#[test]
fn singles_have_the_normal_law() {
    has_the_normal_law::<f32>(22);
}

/// Products of the numbers and of their squares less one, which both have mean 0 where two numbers are independent.
fn assert_independent<'a>(what: &str, pairs: impl Iterator<Item = (&'a f64, &'a f64)> + Clone) {
    assert_mean(what, pairs.clone().map(|(a, b)| a * b), 0.0, 1.0);
    let squares = |(a, b): (&f64, &f64)| (a * a - 1.0) * (b * b - 1.0);
    assert_mean(&format!("{what}, squares"), pairs.map(squares), 0.0, 4.0);
}

fn are_independent<T: Precision>(seed: u64) {
    let first = numbers::<T>(seed, 0);
    let other = numbers::<T>(seed, 1);
    let another_seed = numbers::<T>(seed + (1 << 32), 0);
    // Numbers of a pair share their radius.
    let halves = first
        .iter()
        .flat_map(|member| member.chunks_exact(2).map(|pair| (&pair[0], &pair[1])));
    assert_independent("halves of a pair", halves);
    for lag in [1, 2, 10, 16] {
        let lagged = first
            .iter()
            .flat_map(|member| member.iter().zip(&member[lag..]));
        assert_independent(&format!("lag {lag}"), lagged);
    }
    let channels = first.iter().flatten().zip(other.iter().flatten());
    assert_independent("channels", channels);
    let seeds = first.iter().flatten().zip(another_seed.iter().flatten());
    assert_independent("seeds", seeds);
    for member in 1..LANES {
        assert_independent(
            &format!("members 0 and {member}"),
            first[0].iter().zip(&first[member]),
        );
    }
}

#[test]
fn doubles_are_independent() {
    are_independent::<f64>(23);
}

#[test]
fn singles_are_independent() {
    are_independent::<f32>(24);
}
