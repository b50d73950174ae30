//! Section 5 of the paper in small: what is computed agrees with what is known in closed form.
#![forbid(unsafe_code)]

use std::sync::OnceLock;

use ahv_paper::ensemble::{Drive, Reading};
use ahv_paper::reduce::{Mode, ReducedMode, Reduction, section_5_1};
use ahv_paper::reproduce::pairing::Kind;
use ahv_paper::reproduce::vehicle::{Vehicle, vehicles};
use ahv_paper::reproduce::{Random, Size, printed, random};
use approx::{assert_abs_diff_eq, assert_relative_eq};

const SMALL: Size = Size {
    repeats: 20,
    most_repeats: 40,
    runs: 40,
    snapshot_runs: 400,
    forced_runs: 20,
    steps: 1000,
    dt: 0.01,
    seed: 1,
};

fn small() -> &'static Random {
    static RANDOM: OnceLock<Random> = OnceLock::new();
    RANDOM.get_or_init(|| random(&SMALL, |_| ()).expect("computed"))
}

/// Numbers of `science.md`, section 3, at the samples; the noise of 40 runs is about five times that of 1000.
#[test]
fn table_1_has_both_readings() {
    let random = small();
    let [held, common, white, ..] = random.table1.cases.as_slice() else {
        panic!("there are five cases");
    };
    assert_eq!(
        (held.case.reading, held.case.drive),
        (Reading::Held, Drive::Independent)
    );
    assert_eq!(
        (white.case.reading, white.case.drive),
        (Reading::White, Drive::Independent)
    );
    for ((held, common), (white, checked)) in
        (held.modes.iter().zip(&common.modes)).zip(white.modes.iter().zip([0.0311, 0.0068, 0.0021]))
    {
        assert_relative_eq!(held.exact_std[0], checked, epsilon = 6e-5);
        // Common noise makes the error of the mean smaller; white noise is ten times as strong.
        assert!(common.mean[0].high < held.mean[0].low);
        assert_relative_eq!(
            white.mean[0].value,
            10.0 * held.mean[0].value,
            max_relative = 0.3
        );
        // Sampling can only add to the greatest error, and not much with 40 runs.
        assert!(held.std[0].high > held.exact_std[0]);
    }
}

/// With noises of their own, the means of n runs of η and χ differ by a Gaussian process whose deviation is known: at its
/// greatest it passes 2 deviations in nearly every run of 10 s, and 6 in none.
#[test]
fn the_greatest_error_of_the_mean_has_the_size_of_its_law() {
    let random = small();
    let white = &random.table1.cases[2];
    for (mode, result) in section_5_1().into_iter().zip(&white.modes) {
        let reduced = ReducedMode::new(mode, Reduction::Printed).expect("a mode");
        let variance = reduced.eta_variance() + reduced.chi_variance();
        let deviation = (variance / SMALL.runs as f64).sqrt();
        assert!(
            result.mean[0].low > 2.0 * deviation,
            "{result:?} {deviation}"
        );
        assert!(
            result.mean[0].high < 6.0 * deviation,
            "{result:?} {deviation}"
        );
    }
}

#[test]
fn snapshots_and_forced_modes_agree_with_closed_forms() {
    let random = small();
    for mode in &random.snapshot.modes {
        let within = |(sampled, exact): (ahv_analysis::statistics::Estimate, f64)| {
            // 95 % intervals, stretched: twelve of them are looked at.
            let slack = 0.8 * (sampled.high - sampled.low);
            assert_relative_eq!(sampled.value, exact, epsilon = slack);
        };
        within(mode.eta_std);
        mode.methods
            .iter()
            .for_each(|method| within(method.chi_std));
        assert!(mode.eta_kurtosis.abs() < 4.0 * f64::sqrt(24.0 / 400.0));
    }
    let [(_, white), (_, held)] = &random.forced.readings;
    for (white, held) in white.iter().zip(held) {
        for (sampled, exact) in &white.error_rms {
            assert_relative_eq!(
                sampled.value,
                exact.expect("in closed form"),
                max_relative = 0.08
            );
        }
        // Held noise is weak: what is left is the lag.
        assert!(held.error_rms[0].0.value >= 0.95 * white.error_rms_without_noise);
    }
}

/// The force (37): mean squares of sine and noise add, and that of the noise is σ²/(4ζω³) soon.
#[test]
fn forced_modes_feel_the_noise_of_their_input() {
    let [(_, white), _] = &small().forced.readings;
    let modes = section_5_1().into_iter().zip(printed::INPUT_37);
    for ((Mode { omega, zeta, .. }, (amplitude, sigma)), forced) in modes.zip(white) {
        let sine = amplitude / (omega * omega - 1.0).hypot(2.0 * zeta * omega);
        let noise = sigma * sigma / (4.0 * zeta * omega.powi(3));
        let rms = (0.5 * sine * sine + noise).sqrt();
        assert_relative_eq!(forced.eta_rms, rms, max_relative = 0.08);
    }
}

#[test]
fn results_depend_on_the_seed_and_not_on_the_threads() {
    let tiny = Size {
        repeats: 2,
        most_repeats: 4,
        runs: 30,
        snapshot_runs: 40,
        forced_runs: 4,
        steps: 50,
        ..SMALL
    };
    let with = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| {
            let mut reported = 0;
            let size = Size { seed, ..tiny };
            let random = random(&size, |done| reported = done).expect("computed");
            assert_eq!(reported, size.work());
            random
        })
    };
    assert_eq!(with(1, 1), with(2, 1));
    assert_ne!(with(1, 1).table1, with(1, 2).table1);
}

/// White noise in Fig. 2: from 1 ms to the end of the runs, where the curve ends as that of the samples does.
#[test]
fn the_curves_of_white_noise_go_from_the_first_millisecond_to_the_end() {
    let [_, white] = small().table1.curves.as_slice() else {
        panic!("two cases have curves");
    };
    for curves in white {
        let times = [curves.fine_time.first(), curves.fine_time.last()];
        let [first, last] = times.map(|time| *time.expect("times"));
        assert_relative_eq!(first, 1e-3, max_relative = 1e-12);
        assert_relative_eq!(last, 10.0, max_relative = 1e-12);
        for (fine, exact) in curves.fine_exact_std.iter().zip(&curves.exact_std) {
            let ends = [fine, exact].map(|errors| *errors.last().expect("errors"));
            assert_relative_eq!(ends[0], ends[1], max_relative = 1e-9);
        }
    }
}

/// The vehicle of this model, set, Earth and canard.
fn find<'a>(
    vehicles: &'a [Vehicle],
    model: &str,
    set: &str,
    earth: &str,
    canard: Option<&str>,
) -> &'a Vehicle {
    let mut found = vehicles.iter().filter(|vehicle| {
        let condition = &vehicle.condition;
        (
            condition.model,
            condition.set,
            condition.earth,
            condition.canard,
        ) == (model, set, earth, canard)
    });
    found.next().expect("it is among the vehicles")
}

/// Deflections at the trim that were computed independently of this project: states of DCOM, and what SDCOM's modes follow.
#[test]
fn the_modes_stand_where_they_were_recomputed() {
    let vehicles = vehicles();
    let eta = |model, canard| {
        let trim = &find(&vehicles, model, "section5.1", "flat", canard).trim;
        trim.as_ref().expect("a trim").eta.as_slice()
    };
    for model in ["dcom", "sdcom"] {
        let expected = [0.6276, -0.0137, -0.0372];
        assert_abs_diff_eq!(eta(model, Some("none")), &expected[..], epsilon = 6e-5);
    }
    assert!(eta("com_rigid", None).is_empty());
}

/// Checked numbers of `science.md`, sections 5 and 6.
#[test]
fn trims_and_counts_of_roots_are_the_checked_ones() {
    let vehicles = vehicles();
    let find = |model, set, earth, canard| find(&vehicles, model, set, earth, canard);
    for (model, set, earth, canard, [alpha, phi, delta_e]) in [
        (
            "com_rigid",
            "section5.1",
            "flat",
            None,
            [1.64457, 0.26809, 12.53998],
        ),
        (
            "com_rigid",
            "section5.1",
            "spherical",
            None,
            [1.4056, 0.2505, 11.984],
        ),
        (
            "dcom",
            "section5.1",
            "flat",
            Some("none"),
            [1.5018, 0.2821, 13.1006],
        ),
        (
            "sdcom",
            "section5.1",
            "flat",
            Some("slaved"),
            [3.6558, 0.2957, 7.1364],
        ),
        (
            "dcom",
            "section5.3",
            "flat",
            Some("none"),
            [0.606, 0.2216, 10.996],
        ),
    ] {
        let trim = find(model, set, earth, canard)
            .trim
            .as_ref()
            .expect("a trim");
        assert_relative_eq!(trim.alpha_deg, alpha, max_relative = 1e-4);
        assert_relative_eq!(trim.phi, phi, max_relative = 2e-4);
        assert_relative_eq!(trim.delta_e_deg, delta_e, max_relative = 1e-4);
        assert!(trim.residual_max < 1e-9);
    }
    let dcom = find("dcom", "section5.3", "flat", Some("none"))
        .roots
        .as_ref()
        .expect("roots");
    assert_eq!((dcom.poles.len(), dcom.zeros.len()), (11, 9));
    let sdcom = find("sdcom", "section5.1", "flat", Some("none"))
        .roots
        .as_ref()
        .expect("roots");
    assert_eq!(sdcom.poles.len(), 8);
    // Three flexible pairs, or three coloured noises, which no input reaches: a zero stands on the pole of each.
    for (roots, of, count) in [(dcom, Kind::Flexible, 6), (sdcom, Kind::Noise, 3)] {
        for kinds in [&roots.pole_kinds, &roots.zero_kinds] {
            let found = kinds.iter().filter(|&&kind| kind == of);
            assert_eq!(found.count(), count, "{roots:?}");
        }
    }
    let real = |at: f64| {
        dcom.poles
            .iter()
            .any(|&[re, im]| im == 0.0 && (re - at).abs() < 5e-4)
    };
    assert!(real(-3.9694) && real(3.8612), "{dcom:?}");
}

/// Of Table 3, the FPM, COM have 9 poles and 7 zeros, DCOM and SDCOM 11 and 9, as the text of section 5.3 says.
#[test]
fn the_printed_roots_are_as_many_as_the_text_says() {
    let count = |roots: &[printed::Root]| -> usize {
        roots
            .iter()
            .map(|root| if root[1] > 0.0 { 2 } else { 1 })
            .sum()
    };
    for roots in &printed::TABLE_3 {
        let expected = if matches!(roots.model, "fpm" | "com") {
            (9, 7)
        } else {
            (11, 9)
        };
        assert_eq!(
            (count(roots.poles), count(roots.zeros)),
            expected,
            "{}",
            roots.model
        );
    }
}

/// What section 5.3 says of the places in Table 3: the flexible pairs decay, both poles and zeros; a pair of real zeros lies on
/// either side of the imaginary axis, and one at the origin; all models are unstable, by a pole of about the size of a stable one.
/// Besides, the slow poles decay in the two older models and grow in the two newer ones.
#[test]
fn the_printed_roots_lie_where_the_text_says() {
    for roots in &printed::TABLE_3 {
        let older = matches!(roots.model, "fpm" | "com");
        let flexible = |&&[re, im]: &&printed::Root| f64::hypot(re, im) > 0.1 && im != 0.0;
        let real = |roots: &[printed::Root]| -> Vec<f64> {
            let real = roots.iter().filter(|[_, im]| *im == 0.0);
            let mut real: Vec<f64> = real.map(|[re, _]| *re).collect();
            real.sort_by(f64::total_cmp);
            real
        };
        for place in [roots.poles, roots.zeros] {
            let pairs: Vec<_> = place.iter().filter(flexible).collect();
            assert_eq!(pairs.len(), if older { 2 } else { 3 }, "{}", roots.model);
            let light = |root: &&printed::Root| (-0.04 * root[1]..0.0).contains(&root[0]);
            assert!(pairs.iter().all(light), "{pairs:?}");
        }
        let zeros = real(roots.zeros);
        assert_eq!(zeros, [-zeros[2], 0.0, zeros[2]], "{}", roots.model);
        assert!(zeros[2] > 1.0);
        let poles = real(roots.poles);
        let [stable, slow, unstable] = poles[..] else {
            panic!("{poles:?}");
        };
        let ratio = -stable / unstable;
        assert!(unstable > 1.0 && (1.0..1.05).contains(&ratio), "{poles:?}");
        let phugoid = roots
            .poles
            .iter()
            .find(|&root| root[1] != 0.0 && !flexible(&root));
        let phugoid = phugoid.expect("a slow pair")[0];
        for slow in [slow, phugoid] {
            assert!(slow != 0.0 && (slow < 0.0) == older, "{slow}");
        }
    }
}
