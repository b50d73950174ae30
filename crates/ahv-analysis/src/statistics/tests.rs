use super::{
    Estimate, OpenEstimate, chance_of_rank_correlation, kurtosis, mean_and_std, normal_density,
    rank_correlation, ranks, student_95,
};

/// By hand: deviations of ranks -1.5, 0, 0, 1.5 and 1.5, 0.5, -0.5, -1.5.
#[test]
fn ranks_correlate() {
    let found = rank_correlation(&[1.0, 5.0, 5.0, 9.0], &[0.4, 0.3, 0.2, 0.1]);
    let by_hand = -4.5 / (4.5_f64 * 5.0).sqrt();
    assert!(
        (found.expect("a number") - by_hand).abs() < 1e-15,
        "{found:?}"
    );
    assert_eq!(
        rank_correlation(&[1.0, 2.0, 4.0], &[1e3, 1e5, 1e9]),
        Some(1.0)
    );
    assert_eq!(rank_correlation(&[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]), None);
    // 1.96 standard deviations.
    assert!((chance_of_rank_correlation(0.196, 101) - 0.05).abs() < 1e-4);
}

/// Against the sum of the binomial distribution, term by term.
#[test]
fn ranks_leave_at_most_a_tail_on_either_side() {
    // Logarithms of factorials.
    let mut factorials = vec![0.0];
    for number in 1..=2049 {
        factorials.push(factorials[number - 1] + (number as f64).ln());
    }
    for count in [1_u64, 2, 5, 39, 40, 100, 500, 2049] {
        for share in [0.005, 0.05, 0.25, 0.5, 0.95, 0.995] {
            // P(B < rank).
            let factorial = |n: u64| factorials[n as usize];
            let below = |rank: u64| -> f64 {
                let term = |k: u64| {
                    let choices = factorial(count) - factorial(k) - factorial(count - k);
                    choices + k as f64 * f64::ln(share) + (count - k) as f64 * f64::ln(1.0 - share)
                };
                (0..rank).map(|k| term(k).exp()).sum()
            };
            let [low, high] = ranks(share, count);
            let rank = low.unwrap_or(0);
            assert!(
                below(rank) <= 0.025 && below(rank + 1) > 0.025,
                "{count} {share}: {low:?}"
            );
            // The quantile lies above the one of this rank where fewer than so many lie below it.
            let above = |rank: u64| 1.0 - below(rank);
            match high {
                Some(rank) => assert!(above(rank) <= 0.025 + 1e-12 && above(rank - 1) > 0.025),
                None => assert!(above(count) > 0.025, "{count} {share}"),
            }
        }
    }
    // A large number of members: as the normal distribution.
    let [low, high] = ranks(0.5, 1_000_000_000).map(|rank| rank.expect("a rank") as f64);
    let half = 1.959_964 * 0.25e9_f64.sqrt();
    assert!(
        (low - (5e8 - half)).abs() < 5.0 && (high - (5e8 + half)).abs() < 5.0,
        "{low} {high}"
    );
}

#[test]
fn a_side_without_a_rank_is_open() {
    let sample: Vec<f64> = (0..40).map(f64::from).collect();
    let low = OpenEstimate::of_sorted(&sample, 0.005);
    assert_eq!((low.low, low.high), (None, Some(1.0)));
    let high = OpenEstimate::of_sorted(&sample, 0.995);
    assert_eq!((high.low, high.high), (Some(38.0), None));
    // 14 and 27 of 40: the tables of the sign test.
    let median = OpenEstimate::of_sorted(&sample, 0.5);
    assert_eq!(
        (median.value, median.low, median.high),
        (Some(19.5), Some(13.0), Some(26.0))
    );
    assert_eq!(OpenEstimate::of_sorted(&[], 0.5), OpenEstimate::default());
}

/// Student's table.
#[test]
fn students_points_are_those_of_his_table() {
    for (freedom, point) in [
        (1.0, 12.706_205),
        (8.0, 2.306_004),
        (9.0, 2.262_157),
        (30.0, 2.042_272),
        (1000.0, 1.962_339),
    ] {
        assert!((student_95(freedom) - point).abs() < 2e-5, "{freedom}");
    }
}

/// Of a law of kurtosis 9 the interval of many numbers is twice as wide as of a normal one, as √(κ − 1) has it.
#[test]
fn the_interval_of_a_deviation_follows_the_kurtosis() {
    let width = |kurtosis| {
        let it = OpenEstimate::of_std(1.0, kurtosis, 1e6);
        let it = it.closed().expect("many numbers");
        it.high - it.low
    };
    assert!((width(9.0) / width(3.0) - 2.0).abs() < 1e-4);
    let normal = Estimate::of_normal_std(1.0, 1e6);
    assert!((width(3.0) / (normal.high - normal.low) - 1.0).abs() < 1e-4);
    for count in 2..40 {
        let it = OpenEstimate::of_std(1.0, 1.0, f64::from(count));
        assert!(it.is_finite() && it.value == Some(1.0), "{count}: {it:?}");
        let ends = it.closed().map(|it| it.low < 1.0 && it.high > 1.0);
        assert_eq!(ends, (count > 3).then_some(true), "{count}: {it:?}");
    }
    // Two values: m4 = m2².
    assert!((kurtosis(&[1.0, 1.0, 3.0, 3.0]) - 1.0).abs() < 1e-15);
}

#[test]
fn a_quantile_lies_in_its_interval_however_few_the_numbers() {
    for count in 1..40_u32 {
        let sorted: Vec<f64> = (0..count).map(f64::from).collect();
        for share in [0.005, 0.05, 0.5, 0.95, 0.995] {
            let estimate = OpenEstimate::of_sorted(&sorted, share);
            assert!(estimate.value.is_some_and(|value| estimate.holds(value)));
        }
    }
}

/// Two numbers have the kurtosis 1 and three 1.5, whichever they are.
#[test]
fn two_or_three_numbers_say_nothing_of_a_deviation() {
    for sample in [&[1.0, 5.0][..], &[1.0, 2.0, 9.0]] {
        let estimate = OpenEstimate::of_sample_std(sample);
        assert_eq!((estimate.low, estimate.high), (None, None));
        assert_eq!(estimate.value, Some(mean_and_std(sample).1));
    }
    for sample in [&[1.0, 2.0, 4.0, 9.0][..], &[0.0, 0.0, 0.0, 1.0], &[2.0; 4]] {
        let it = OpenEstimate::of_sample_std(sample).closed().expect("four");
        assert!(
            it.low <= it.value && it.value <= it.high && it.high <= 1e4 * it.value,
            "{it:?}"
        );
    }
}

/// Its integrals against 1 and x², and how far it falls within one deviation.
#[test]
fn a_normal_density_has_one_whole_and_its_deviation() {
    for std in [0.03, 1.0, 7.0] {
        let h = 0.05 * std;
        let places = (-240..=240).map(|index| f64::from(index) * h);
        let moment = |power| -> f64 {
            let terms = places.clone();
            terms
                .map(|x| x.powi(power) * normal_density(x, std) * h)
                .sum()
        };
        assert!((moment(0) - 1.0).abs() < 1e-12, "{std}");
        assert!((moment(2) / (std * std) - 1.0).abs() < 1e-12, "{std}");
        let fall = normal_density(-std, std) / normal_density(0.0, std);
        assert!((fall - (-0.5_f64).exp()).abs() < 1e-15, "{std}");
    }
}

/// The table of χ²: the ends for 31 and for 101 numbers, which have 30 and 100 degrees of freedom.
#[test]
fn the_interval_of_a_normal_deviation_is_that_of_chi_squared() {
    for (freedom, tails) in [
        (30.0, [46.979_24, 16.790_77]),
        (100.0, [129.561_2, 74.221_93]),
    ] {
        let [low, high] = tails.map(|tail: f64| 3.0 * (freedom / tail).sqrt());
        let it = Estimate::of_normal_std(3.0, freedom + 1.0);
        assert_eq!(it.value, 3.0);
        let errors = [it.low / low - 1.0, it.high / high - 1.0];
        assert!(errors.iter().all(|error| error.abs() < 5e-4), "{errors:?}");
    }
}
