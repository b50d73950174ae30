//! Samples for the curve fits: beside those of the oracle, and over a box far beyond the envelope.

use ahv_fit::{Ask, Sampler, latin_hypercube};
use ahv_fpm::SOURCE;

const VECTORS: &str = include_str!("../../../tests/vectors/fit_samples.txt");
const QUANTITIES: [&str; 7] = ["C_T", "C_L", "C_D", "C_M", "C_N_1", "C_N_2", "C_N_3"];
const VARIABLES: [&str; 7] = [
    "alpha", "phi", "delta_e", "delta_c", "eta_1", "eta_2", "eta_3",
];

fn parameter(name: &str) -> Option<f64> {
    match name {
        "s" | "c_bar" => Some(17.0),
        "z_t" => Some(8.36),
        _ => None,
    }
}

fn sampler(quantities: &[&str], variables: &[&str]) -> Result<Box<dyn Sampler>, String> {
    SOURCE.sampler(&Ask {
        quantities,
        variables,
        parameter: &parameter,
    })
}

#[test]
fn coefficients_are_those_of_the_oracle() {
    let sampler = sampler(&QUANTITIES, &VARIABLES).expect("a sampler");
    let names: Vec<&str> = sampler.variables().iter().map(|it| it.name).collect();
    let mut lines = VECTORS.lines().skip(1);
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    assert_eq!(header[..names.len()], names);
    let mut count = 0;
    for line in lines {
        let row: Vec<f64> = line
            .split(',')
            .map(|it| it.parse().expect("a number"))
            .collect();
        let (point, wanted) = row.split_at(names.len());
        let found = sampler.at(point).expect("a flow");
        for (index, (found, wanted)) in found.iter().zip(wanted).enumerate() {
            // The ramp's quadrature has twelve nodes.
            let room = 1e-6 * wanted.abs().max(1e-3);
            assert!(
                (found - wanted).abs() < room,
                "{point:?} {}: {found} {wanted}",
                QUANTITIES[index]
            );
        }
        count += 1;
    }
    assert_eq!(count, 25);
}

#[test]
fn a_sample_is_finite_or_has_a_reason() {
    let sampler = sampler(&QUANTITIES, &VARIABLES).expect("a sampler");
    let bounds = [
        (100.0, 40_000.0),
        (-10_000.0, 160_000.0),
        (-1.5, 1.5),
        (-2.0, 20.0),
        (-2.0, 2.0),
        (-2.0, 2.0),
        (-60.0, 60.0),
        (-60.0, 60.0),
        (-60.0, 60.0),
    ];
    let columns = latin_hypercube(bounds.len(), 20_000, 3);
    let (mut sound, mut reasons) = (0, std::collections::BTreeSet::new());
    for row in 0..20_000 {
        let place =
            |(column, (low, high)): (&Vec<f64>, (f64, f64))| low + column[row] * (high - low);
        // Every other point is near the envelope, so that each reason has its turn.
        let near = if row % 2 == 0 { 1.0 } else { 0.1 };
        let mut point: Vec<f64> = columns.iter().zip(bounds).map(place).collect();
        point[2..].iter_mut().for_each(|it| *it *= near);
        match sampler.at(&point) {
            Ok(found) => {
                sound += 1;
                assert!(found.iter().all(|it| it.is_finite()), "{point:?} {found:?}");
            }
            Err(why) => {
                let reason = why.split([':', ',']).next().unwrap_or_default();
                assert!(!why.contains("NaN") && !why.contains("inf"), "{why}");
                reasons.insert(reason.to_owned());
            }
        }
    }
    assert!(sound > 500, "{sound}");
    for part in [
        "forebody",
        "upper surface",
        "combustor",
        "elevator",
        "canard",
    ] {
        assert!(
            reasons.iter().any(|it| it.starts_with(part)),
            "{part}: {reasons:?}"
        );
    }
}

#[test]
fn what_it_does_not_have_is_named() {
    let refused = |quantities: &[&str], variables: &[&str]| {
        sampler(quantities, variables).err().expect("refused")
    };
    assert!(refused(&["C_Y"], &["alpha"]).contains("no quantity `C_Y`"));
    assert!(refused(&["C_L"], &["mach"]).contains("no variable `mach`"));
    // COM has no free-free modes.
    assert!(refused(&["C_L", "N_1"], &["eta_1"]).contains("no variable `eta_1`"));
}
