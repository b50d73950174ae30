//! A flexible mode and its reductions: closed forms against quadrature, printed numbers and Monte Carlo.
#![forbid(unsafe_code)]

use ahv_analysis::statistics::{Estimate, kolmogorov_smirnov};
use ahv_paper::ensemble::{Drive, Experiment, Reading, process_of};
use ahv_paper::reduce::{Mode, ReduceError, ReducedMode, Reduction, section_5_1};
use approx::{assert_abs_diff_eq, assert_relative_eq};

/// ∫ f over [0, end] by Simpson's rule.
fn integral(f: impl Fn(f64) -> f64, end: f64) -> f64 {
    let (parts, mut sum) = (40_000_u32, 0.0);
    let h = end / f64::from(parts);
    for i in 0..=parts {
        let weight = match i {
            0 => 1.0,
            i if i == parts => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        sum += weight * f(f64::from(i) * h);
    }
    sum * h / 3.0
}

/// The impulse response of the mode.
fn impulse(mode: Mode, s: f64) -> f64 {
    let Mode { omega, zeta, .. } = mode;
    let root = omega * (zeta * zeta - 1.0).abs().sqrt();
    let shape = if zeta < 1.0 {
        (root * s).sin() / root
    } else if zeta > 1.0 {
        (root * s).sinh() / root
    } else {
        s
    };
    shape * (-zeta * omega * s).exp()
}

fn reduced(mode: Mode, method: Reduction) -> ReducedMode {
    ReducedMode::new(mode, method).expect("a mode")
}

#[test]
fn moments_agree_with_quadrature_for_every_damping() {
    for zeta in [0.02, 0.5, 0.7, 1.0, 1.0 + 1e-9, 1.0 - 1e-13, 3.0] {
        let mode = Mode {
            omega: 19.7437,
            zeta,
            sigma: 100.0,
        };
        for method in Reduction::ALL {
            let reduced = reduced(mode, method);
            let power = |shape: &dyn Fn(f64) -> f64, end| integral(|s| shape(s).powi(2), end);
            let (a, b) = (reduced.decay(), reduced.intensity());
            for time in [0.01, 0.1, 0.7] {
                let eta = 1e4 * power(&|s| impulse(mode, s), time);
                assert_relative_eq!(reduced.eta_variance_at(time), eta, max_relative = 1e-7);
                let chi = b * b * power(&|s| (-a * s).exp(), time);
                assert_relative_eq!(reduced.chi_variance_at(time), chi, max_relative = 1e-7);
            }
            // Autocorrelation at a lag: ∫ h(s) h(s + lag) ds.
            let (lag, end) = (0.03, 40.0 / (zeta * 19.7437).min(5.0 / zeta));
            let product = |s| impulse(mode, s) * impulse(mode, s + lag);
            let eta = 1e4 * integral(product, end.min(200.0 / 19.7437));
            if zeta > 0.1 {
                assert_relative_eq!(reduced.eta_autocorrelation(lag), eta, max_relative = 1e-6);
            }
            let product = |s: f64| (-a * s).exp() * (-a * (s + lag)).exp();
            let chi = b * b * integral(product, 20.0 / a);
            assert_relative_eq!(reduced.chi_autocorrelation(lag), chi, max_relative = 1e-6);
            // The spectrum's integral over frequency is 2π times the variance.
            let tail = 1e5;
            let whole = integral(|x| reduced.eta_spectrum(x * x) * 2.0 * x, f64::sqrt(tail));
            assert_relative_eq!(
                whole / std::f64::consts::PI,
                reduced.eta_variance(),
                max_relative = 1e-5
            );
        }
    }
}

/// `science.md`, section 3.
#[test]
fn the_greatest_errors_are_the_checked_ones() {
    let expected = [
        (0.3074, 0.0311, 0.0311),
        (0.0664, 0.0068, 0.0068),
        (0.0225, 0.0021, 0.0027),
    ];
    for (mode, (white, at_samples, between)) in section_5_1().into_iter().zip(expected) {
        let reduced = reduced(mode, Reduction::Printed);
        let peak = reduced.largest_std_errors().greatest;
        assert_abs_diff_eq!(peak.value, white, epsilon = 5e-5);
        // The summit is one: both neighbours are below.
        let time = peak.time.expect("a time");
        for near in [0.99 * time, 1.01 * time] {
            assert!(reduced.std_error_at(near).abs() < peak.value);
        }
        let held = reduced.largest_std_error_held(0.01).expect("a period");
        assert_abs_diff_eq!(held.at_samples, at_samples, epsilon = 6e-5);
        assert_abs_diff_eq!(held.between_samples, between, epsilon = 1.1e-4);
    }
}

#[test]
fn each_method_keeps_what_it_promises() {
    let mode = Mode {
        omega: 52.5,
        zeta: 0.02,
        sigma: 10.0,
    };
    let [printed, variance, moment] = Reduction::ALL.map(|method| reduced(mode, method));
    assert_relative_eq!(printed.variance_ratio(), 0.0008, max_relative = 1e-12);
    assert_relative_eq!(printed.spectrum_ratio(), 1.0, max_relative = 1e-12);
    assert_relative_eq!(variance.variance_ratio(), 1.0, max_relative = 1e-12);
    assert_relative_eq!(variance.spectrum_ratio(), 1250.0, max_relative = 1e-12);
    assert_relative_eq!(moment.variance_ratio(), 1.0, max_relative = 1e-12);
    assert_relative_eq!(moment.spectrum_ratio(), 1.0, max_relative = 1e-12);
    // χ of the printed method is all but nothing: the error grows to the deviation of η itself.
    let peak = printed.largest_std_errors().greatest;
    assert_eq!(peak.time, None);
    let limit = (1.0 - 0.0008_f64.sqrt()) * printed.eta_variance().sqrt();
    assert_relative_eq!(peak.value, limit, max_relative = 1e-9);
}

/// By looking at many times: how far the deviations are apart until η catches up, and afterwards.
#[test]
fn the_greatest_distance_is_of_the_rise_where_none_after_it_is_as_far() {
    let mut found = Vec::new();
    for zeta in [0.02, 0.3, 0.7, 1.0, 2.0] {
        let mode = Mode {
            omega: 20.0,
            zeta,
            sigma: 10.0,
        };
        for method in Reduction::ALL {
            let reduced = reduced(mode, method);
            let errors = (1..400_000_u32).map(|it| reduced.std_error_at(f64::from(it) * 1e-4));
            let (mut rise, mut after, mut rises) = (0.0_f64, 0.0_f64, true);
            for error in errors {
                rises &= error < 0.0;
                let greatest = if rises { &mut rise } else { &mut after };
                *greatest = greatest.max(error.abs());
            }
            // Where they are all but equally far, times in between may decide.
            assert!((rise / after - 1.0).abs() > 1e-3, "{zeta} {method:?}");
            let errors = reduced.largest_std_errors();
            assert_eq!(errors.greatest_in_rise(), rise > after, "{zeta} {method:?}");
            found.push(rise > after);
        }
    }
    assert!(found.contains(&true) && found.contains(&false), "{found:?}");
}

/// σ² ∫ h² from its power series, Σ (A· + ·Aᵀ)ⁿ Q tⁿ⁺¹/(n + 1)!: without cancellation for ωt below 1.
fn eta_variance_early(Mode { omega, zeta, sigma }: Mode, time: f64) -> f64 {
    // Of the covariance over σ² as [ηη, ηη̇/ω… ] with time in 1/ω: d/dτ of (p, q, r) = (2q, r − p − 2ζq, −2q − 4ζr).
    let tau = omega * time;
    let (mut term, mut sum) = ([0.0, 0.0, tau], 0.0);
    for n in 2..40 {
        let [p, q, r] = term;
        term = [2.0 * q, r - p - 2.0 * zeta * q, -2.0 * q - 4.0 * zeta * r]
            .map(|it| it * tau / f64::from(n));
        sum += term[0];
    }
    sigma * sigma / omega.powi(3) * sum
}

/// Tiny and huge frequencies, damping ratios and intensities, at times short and long against every rate: variances in
/// closed form, and those of an ensemble's exact steps.
#[test]
fn variances_and_ensembles_hold_from_tiny_to_huge_modes() {
    for omega in [1e-6, 30.0, 1e7] {
        for zeta in [3e-8, 1e-3, 0.7, 1.0, 20.0] {
            for sigma in [1e-9, 10.0, 1e9] {
                let mode = Mode { omega, zeta, sigma };
                for method in Reduction::ALL {
                    let reduced = reduced(mode, method);
                    let (a, b) = (reduced.decay(), reduced.intensity());
                    for early in [1e-6, 1e-3, 0.3 / (1.0 + zeta)] {
                        let time = early / omega;
                        let exact = eta_variance_early(mode, time);
                        let found = reduced.eta_variance_at(time);
                        assert_relative_eq!(found, exact, max_relative = 1e-9);
                        let exact = -b * b / (2.0 * a) * (-2.0 * a * time).exp_m1();
                        assert_relative_eq!(
                            reduced.chi_variance_at(time),
                            exact,
                            max_relative = 1e-12
                        );
                    }
                    let settled = reduced.settling_time();
                    let found = reduced.eta_variance_at(settled);
                    assert_relative_eq!(found, reduced.eta_variance(), max_relative = 1e-9);
                    for dt in [0.1 / omega, 100.0 / omega, settled] {
                        a_step_has_the_law(&reduced, dt);
                    }
                }
            }
        }
    }
}

/// One step of an ensemble has the deviations of the closed forms: 400 runs, 6 standard errors.
fn a_step_has_the_law(reduced: &ReducedMode, dt: f64) {
    let experiment = Experiment {
        reading: Reading::White,
        drive: Drive::Common,
        runs: 400,
        steps: 1,
        dt,
        seed: 3,
    };
    let ends = experiment.ends(&reduced.mode, 0).expect("an ensemble");
    let chi = &ends[process_of(reduced.method)];
    for (sample, exact) in [
        (&ends[0], reduced.eta_variance_at(dt)),
        (chi, reduced.chi_variance_at(dt)),
    ] {
        let (_, std) = ahv_analysis::statistics::mean_and_std(sample);
        let ratio = std / exact.sqrt();
        assert!(
            (ratio - 1.0).abs() < 6.0 / f64::sqrt(800.0),
            "{reduced:?} {dt} {ratio}"
        );
    }
}

#[test]
fn modes_without_sense_are_refused() {
    let mode =
        |omega, zeta, sigma| ReducedMode::new(Mode { omega, zeta, sigma }, Reduction::Printed);
    for (bad, name) in [
        (mode(0.0, 0.5, 1.0), "omega"),
        (mode(-3.0, 0.5, 1.0), "omega"),
        (mode(20.0, 0.0, 1.0), "zeta"),
        (mode(20.0, f64::NAN, 1.0), "zeta"),
        (mode(20.0, 0.5, f64::INFINITY), "sigma"),
    ] {
        let error = bad.expect_err("refused");
        assert!(matches!(error, ReduceError::NotPositive { name: found, .. } if found == name));
    }
    let error = mode(1e200, 0.5, 1.0).expect_err("refused");
    assert!(matches!(error, ReduceError::OutOfRange { .. }), "{error}");
    let good = mode(20.0, 0.5, 1.0).expect("a mode");
    assert!(good.largest_std_error_held(0.0).is_err());
}

fn experiment(reading: Reading, drive: Drive) -> Experiment {
    Experiment {
        reading,
        drive,
        runs: 2000,
        steps: 60,
        dt: 0.01,
        seed: 3,
    }
}

/// Each sample deviation within 4.5 standard errors of the closed form, and means about 0.
#[test]
fn monte_carlo_agrees_with_the_closed_forms() {
    let [mode, ..] = section_5_1();
    for drive in [Drive::Common, Drive::Independent] {
        let experiment = experiment(Reading::White, drive);
        let sampled = experiment.moments(&mode, 0, 0).expect("an ensemble");
        let times = experiment.times();
        for method in Reduction::ALL {
            let reduced = reduced(mode, method);
            let chi = &sampled[process_of(method)];
            for (i, &time) in times.iter().enumerate().skip(1) {
                for (moments, variance) in [
                    (&sampled[0], reduced.eta_variance_at(time)),
                    (chi, reduced.chi_variance_at(time)),
                ] {
                    let exact = variance.sqrt();
                    let slack = 4.5 * exact / f64::sqrt(2.0 * 2000.0);
                    assert_abs_diff_eq!(moments.std[i], exact, epsilon = slack);
                    let slack = 4.5 * exact / f64::sqrt(2000.0);
                    assert_abs_diff_eq!(moments.mean[i], 0.0, epsilon = slack);
                }
            }
        }
    }
}

/// Held numbers of variance σ² have, over times long against the period, the intensity σ²·dt.
#[test]
fn held_noise_is_weaker_by_the_step() {
    let [mode, ..] = section_5_1();
    let ends = experiment(Reading::Held, Drive::Independent)
        .ends(&mode, 0)
        .expect("an ensemble");
    let (_, std) = ahv_analysis::statistics::mean_and_std(&ends[0]);
    let estimate = Estimate::of_normal_std(std, 2000.0);
    let white = reduced(mode, Reduction::Printed).eta_variance().sqrt();
    assert!(estimate.holds(0.1 * white), "{estimate:?} {white}");
}

/// What shares its noise moves together; what does not, does not.
#[test]
fn the_drive_decides_the_correlation() {
    let [mode, ..] = section_5_1();
    let correlation = |drive| {
        let ends = experiment(Reading::White, drive)
            .ends(&mode, 0)
            .expect("an ensemble");
        let [eta, chi, ..] = ends;
        let product: f64 = eta.iter().zip(&chi).map(|(a, b)| a * b).sum();
        let square = |values: &[f64]| values.iter().map(|a| a * a).sum::<f64>().sqrt();
        product / (square(&eta) * square(&chi))
    };
    assert!(correlation(Drive::Independent).abs() < 0.1);
    // Of η with the response exp(−ζωt) sin(ω_d t)/ω_d and χ with exp(−at) to one noise; the standard error is 0.008.
    let (Mode { omega, zeta, .. }, a) = (mode, reduced(mode, Reduction::Printed).decay());
    let shared = 1.0 / (a * a + 2.0 * zeta * omega * a + omega * omega);
    let exact = shared * (4.0 * zeta * omega.powi(3) * 2.0 * a).sqrt();
    assert_abs_diff_eq!(correlation(Drive::Common), exact, epsilon = 0.03);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let [mode, ..] = section_5_1();
    let experiment = experiment(Reading::Held, Drive::Independent);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| experiment.moments(&mode, 0, 0).expect("an ensemble"))
    };
    assert_eq!(with(1), with(2));
    let other = Experiment {
        seed: 4,
        ..experiment
    };
    assert_ne!(with(1), other.moments(&mode, 0, 0).expect("an ensemble"));
}

#[test]
fn intervals_and_distances_are_the_tabulated_ones() {
    // χ² quantiles with 99 degrees of freedom (SciPy): 73.361, 128.422.
    let std = Estimate::of_normal_std(1.0, 100.0);
    assert_abs_diff_eq!(std.low, f64::sqrt(99.0 / 128.422), epsilon = 5e-4);
    assert_abs_diff_eq!(std.high, f64::sqrt(99.0 / 73.361), epsilon = 5e-4);
    let sample: Vec<f64> = (0..=100).rev().map(f64::from).collect();
    let spread = Estimate::of_distribution(&sample).expect("numbers");
    assert_eq!((spread.low, spread.value, spread.high), (5.0, 50.0, 95.0));
    assert_eq!(Estimate::of_distribution(&[]), None);
    let shifted: Vec<f64> = sample.iter().map(|x| x + 10.0).collect();
    let (distance, critical) = kolmogorov_smirnov(&sample, &shifted);
    assert_relative_eq!(distance, 10.0 / 101.0, max_relative = 1e-12);
    assert_relative_eq!(
        critical,
        1.3581 * f64::sqrt(2.0 / 101.0),
        max_relative = 1e-4
    );
}

#[test]
fn the_rise_of_a_lightly_damped_mode_is_found_however_short_it_is() {
    for zeta in [1e-6, 1e-3, 2.5e-3] {
        let mode = Mode {
            omega: 20.0,
            zeta,
            sigma: 10.0,
        };
        let reduced = ReducedMode::new(mode, Reduction::Printed).expect("a mode");
        let rise = reduced.largest_std_errors().rise;
        // Where b √t − σ t^³⁄²/√3 is greatest; what both leave out is of the order of ω t.
        let time = zeta / (mode.omega * 3.0_f64.sqrt());
        let value = 2.0 / 3.0 * reduced.intensity() * time.sqrt();
        assert!(rise.chi_leads);
        assert_relative_eq!(rise.value, value, max_relative = 3.0 * zeta);
        assert_relative_eq!(
            rise.time.expect("a time"),
            time,
            max_relative = 1e-4 + 3.0 * zeta
        );
    }
}
