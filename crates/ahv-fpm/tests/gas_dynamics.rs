//! Relations of gas dynamics against printed tables, the oracle's roots of conservation laws, and their limits.

use std::collections::HashMap;

use ahv_core::{Dual, Real};
use ahv_fpm::area::{Duct, log_area_ratio};
use ahv_fpm::oblique_shock::{greatest_turn, oblique_shock};
use ahv_fpm::prandtl_meyer::{expansion, prandtl_meyer_angle, vacuum_angle};
use ahv_fpm::rayleigh::{choking_ratio, heat_addition};
use ahv_fpm::surfaces::{plate, turned};

const GAMMA: f64 = 1.4;
/// NACA report 1135 and the usual tables of heat addition.
const PRINTED: &str = include_str!("../../../tests/vectors/gas_tables.csv");
/// By mpmath: `generator/ahv_oracle/gas_dynamics.py`.
const VECTORS: &str = include_str!("../../../tests/vectors/gas_dynamics.txt");

/// Rows of the printed tables by column.
fn printed() -> Vec<HashMap<&'static str, &'static str>> {
    let mut lines = PRINTED.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    lines
        .map(|line| names.iter().copied().zip(line.split(',')).collect())
        .collect()
}

/// Whether a value has the digits that are printed.
fn check(row: &HashMap<&str, &str>, column: &str, value: f64) {
    let text = row[column];
    let digits = text.split_once('.').map_or(0, |(_, digits)| digits.len());
    let half = 0.5001 * 10_f64.powi(-(digits as i32));
    let wanted: f64 = text.parse().expect("a number");
    assert!(
        (value - wanted).abs() <= half,
        "Mach {} {column}: {value}, printed {text}",
        row["mach"]
    );
}

fn mach(row: &HashMap<&str, &str>) -> f64 {
    row["mach"].parse().expect("a number")
}

#[test]
fn isentropic_relations_have_the_printed_digits() {
    assert!(printed().len() >= 20);
    for row in printed() {
        let mach = mach(&row);
        check(&row, "a_a", log_area_ratio(GAMMA, mach).exp());
        // From the sonic state: the inverse, and what it does to pressure and temperature.
        let ratio = log_area_ratio(GAMMA, mach).exp() / log_area_ratio(GAMMA, 1.01).exp();
        let found = Duct::new(GAMMA, ratio).change(1.01);
        assert!((found.mach / mach - 1.0).abs() < 1e-12);
        let start: f64 = 1.0 / (1.0 + 0.2 * 1.01 * 1.01);
        check(&row, "t_tt", start * found.temperature);
        check(&row, "p_pt", start.powf(3.5) * found.pressure);
    }
}

#[test]
fn expansions_have_the_printed_digits() {
    for row in printed() {
        let mach = mach(&row);
        check(&row, "nu", prandtl_meyer_angle(GAMMA, mach).to_degrees());
        let turn = prandtl_meyer_angle(GAMMA, mach) - prandtl_meyer_angle(GAMMA, 1.05);
        let found = expansion(GAMMA, 1.05, turn);
        assert!(
            (found.mach / mach - 1.0).abs() < 1e-12,
            "{mach}: {}",
            found.mach
        );
    }
    assert!((vacuum_angle(GAMMA).to_degrees() - 130.4541).abs() < 1e-4);
}

/// The normal part of an oblique shock is a normal shock: each printed row, at four angles.
#[test]
fn shocks_have_the_printed_digits() {
    for row in printed() {
        let normal = mach(&row);
        for share in [0.3, 0.5, 0.7, 0.85] {
            let angle = std::f64::consts::FRAC_PI_2 * share;
            let ahead = normal / angle.sin();
            let density = 6.0 * normal * normal / (normal * normal + 5.0);
            let turn = angle - (angle.tan() / density).atan();
            let found = oblique_shock(GAMMA, ahead, turn);
            if (found.angle() - angle).abs() > 1e-9 {
                // That angle is the strong shock's.
                assert!(found.angle() < angle);
                continue;
            }
            check(&row, "p2_p1", found.pressure);
            check(&row, "t2_t1", found.temperature);
            check(&row, "rho2_rho1", found.pressure / found.temperature);
            check(&row, "m2", found.mach * (angle - turn).sin());
        }
    }
}

#[test]
fn heat_addition_has_the_printed_digits() {
    for row in printed() {
        let mach = mach(&row);
        let found = heat_addition(GAMMA, mach, choking_ratio(GAMMA, mach) * (1.0 - 1e-14));
        check(&row, "heat_tt", 1.0 / choking_ratio(GAMMA, mach));
        check(&row, "heat_p", 1.0 / found.pressure);
        check(&row, "heat_t", 1.0 / found.temperature);
    }
}

#[test]
fn relations_are_those_of_the_oracle() {
    let mut counts: HashMap<&str, u32> = HashMap::new();
    for line in VECTORS.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let numbers: Vec<f64> = cells[1..].iter().filter_map(|it| it.parse().ok()).collect();
        let (mach, argument) = (numbers[0], numbers[1]);
        let found = match cells[0] {
            "shock" => {
                let it = oblique_shock(GAMMA, mach, argument);
                vec![it.mach, it.pressure, it.temperature, it.angle()]
            }
            "expansion" => {
                let it = expansion(GAMMA, mach, argument);
                vec![it.mach, it.pressure, it.temperature]
            }
            "heat" => {
                let it = heat_addition(GAMMA, mach, argument);
                vec![it.mach, it.pressure, it.temperature]
            }
            _ => {
                let it = Duct::new(GAMMA, argument).change(mach);
                vec![it.mach, it.pressure, it.temperature]
            }
        };
        for (found, wanted) in found.iter().zip(&numbers[2..]) {
            // Near vacuum a last bit of the angle is many of the pressure.
            let room = if cells[0] == "expansion" {
                1e-10
            } else {
                1e-11
            };
            assert!((found / wanted - 1.0).abs() < room, "{line}: {found}");
        }
        *counts.entry(cells[0]).or_default() += 1;
    }
    assert!(
        counts.len() == 4 && counts.values().all(|&count| count >= 20),
        "{counts:?}"
    );
}

/// A weak shock is a Mach wave: linearised theory, Δp/p = γM² θ/√(M² − 1), from both sides, to the second order.
#[test]
fn weak_waves_are_mach_waves() {
    for mach in [1.5, 3.0, 7.85, 15.0] {
        let beta = f64::sqrt(mach * mach - 1.0);
        for turn in [1e-9, 1e-7, 1e-5] {
            let shock = oblique_shock(GAMMA, mach, turn);
            let slope = GAMMA * mach * mach / beta;
            let relative = (shock.pressure - 1.0) / (slope * turn) - 1.0;
            assert!(
                relative.abs() < 40.0 * mach * turn + 1e-6,
                "{mach} {turn} {relative}"
            );
            assert!((shock.angle() - (1.0 / mach).asin()).abs() < 10.0 * turn);
            let fan = expansion(GAMMA, mach, turn);
            assert!((shock.pressure * fan.pressure - 1.0).abs() < 1e3 * turn * turn + 1e-13);
        }
    }
}

/// No heat changes nothing, and no area neither; little heat is the differential relation
/// dM²/M² = (1 + γM²)(1 + (γ−1)M²/2)/(1 − M²) dTt/Tt.
#[test]
fn little_heat_and_no_area_are_isentropic() {
    for mach in [1.3, 2.6, 5.285, 10.0] {
        let none = heat_addition(GAMMA, mach, 1.0);
        assert!((none.mach / mach - 1.0).abs() < 1e-14 && (none.pressure - 1.0).abs() < 1e-13);
        let same = Duct::new(GAMMA, 1.0).change(mach);
        assert!((same.mach / mach - 1.0).abs() < 1e-12 && (same.pressure - 1.0).abs() < 1e-11);
        let little = 1e-7;
        let found = heat_addition(GAMMA, mach, 1.0 + little);
        let m2 = mach * mach;
        let slope = (1.0 + GAMMA * m2) * (1.0 + 0.2 * m2) / (1.0 - m2);
        let change = 2.0 * (found.mach / mach - 1.0) / little;
        assert!(
            (change / slope - 1.0).abs() < 1e-5,
            "{mach}: {change} {slope}"
        );
    }
}

/// The margin of a shock vanishes at the greatest turn; that of heat at choking; that of an expansion at vacuum.
#[test]
fn margins_vanish_where_flows_end() {
    for mach in [1.2, 2.0, 6.17, 12.0] {
        let greatest = greatest_turn(GAMMA, mach);
        assert!(oblique_shock(GAMMA, mach, greatest * 0.999_999).margin > 0.0);
        assert!(oblique_shock(GAMMA, mach, greatest * 1.000_001).margin < 0.0);
        let choked = choking_ratio(GAMMA, mach);
        assert!(heat_addition(GAMMA, mach, choked * 0.999_999).margin > 0.0);
        assert!(heat_addition(GAMMA, mach, choked * 1.000_001).margin < 0.0);
        let vacuum = vacuum_angle(GAMMA) - prandtl_meyer_angle(GAMMA, mach);
        assert!(expansion(GAMMA, mach, vacuum * 0.999_999).margin > 0.0);
        assert!(expansion(GAMMA, mach, vacuum * 1.000_001).margin < 0.0);
    }
}

/// Slopes of dual numbers beside central differences, on both sides of no turn and at it.
#[test]
fn slopes_are_those_of_the_functions() {
    for turn in [-0.2, -1e-3, 0.0, 1e-3, 0.2] {
        let at = |turn: f64| turned(GAMMA, 7.85, turn).pressure;
        let dual = turned(
            Dual::constant(GAMMA),
            Dual::constant(7.85),
            Dual::variable(turn),
        );
        let step = 1e-5;
        let difference = (at(turn + step) - at(turn - step)) / (2.0 * step);
        // Shock and expansion agree in slope, not in curvature.
        assert!(
            (dual.pressure.slope - difference).abs() < 1e-3 * difference,
            "{turn}"
        );
        let [lower, upper] = plate(
            Dual::constant(GAMMA),
            Dual::constant(7.85),
            Dual::variable(turn),
        );
        assert_eq!(lower.pressure, dual.pressure);
        let other = turned(
            Dual::constant(GAMMA),
            Dual::constant(7.85),
            -Dual::variable(turn),
        );
        assert!((upper.pressure.value / other.pressure.value - 1.0).abs() < 1e-13);
        assert!((upper.pressure.slope / other.pressure.slope - 1.0).abs() < 1e-7);
    }
    assert!(Real::is_finite(turned(GAMMA, 1.000_001, 0.0).pressure));
}
