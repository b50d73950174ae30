//! Records that models make with known coefficients: how often the estimates lie within three of their own standard errors.

use crate::common::{Case, estimates};
use ahv_identify::{filter, output_error};

const REPETITIONS: u64 = 200;
/// Of so many estimates three standard errors must hold the truth.
const SHARE: f64 = 0.95;

fn covered(case: &Case, method: crate::common::Method) -> Vec<f64> {
    let all = estimates(case, method, REPETITIONS);
    assert_eq!(all.len() as u64, REPETITIONS);
    let truth = case.truth();
    let share = |index: usize| {
        let held = all.iter().filter(|estimate| {
            let it = &estimate.parameters[index];
            (it.value - truth[index]).abs() <= 3.0 * it.standard_error
        });
        held.count() as f64 / REPETITIONS as f64
    };
    let z = |index: usize| {
        let all = all.iter().map(|it| &it.parameters[index]);
        let sum: f64 = all
            .map(|it| ((it.value - truth[index]) / it.standard_error).powi(2))
            .sum();
        (sum / REPETITIONS as f64).sqrt()
    };
    let shares: Vec<f64> = (0..truth.len()).map(share).collect();
    let spreads: Vec<f64> = (0..truth.len()).map(z).collect();
    println!(
        "{:?}: within three {shares:?}, root mean square in standard errors {spreads:?}",
        case.free
    );
    // Standard errors are those of the estimates, not just large.
    for spread in spreads {
        assert!((0.7..1.4).contains(&spread), "{spread}");
    }
    shares
}

#[test]
fn the_filter_covers_a_flexible_mode_driven_by_noise() {
    let case = Case::flexible_mode();
    let shares = covered(&case, filter);
    assert!(shares.iter().all(|&it| it >= SHARE), "{shares:?}");
}

/// A few records: two hundred would take minutes.
#[test]
fn the_filter_finds_the_coefficients_of_an_unstable_airframe_in_gusts() {
    let case = Case::airframe();
    for estimate in estimates(&case, filter, 3) {
        for (it, truth) in estimate.parameters.iter().zip(case.truth()) {
            assert!(
                (it.value - truth).abs() < 4.0 * it.standard_error,
                "{it:?} {truth}"
            );
            assert!(it.standard_error < 0.1 * truth.abs(), "{it:?}");
        }
    }
}

#[test]
fn output_error_covers_short_segments_of_an_unstable_airframe() {
    let case = Case::rigid();
    let shares = covered(&case, output_error);
    assert!(shares.iter().all(|&it| it >= SHARE), "{shares:?}");
}
