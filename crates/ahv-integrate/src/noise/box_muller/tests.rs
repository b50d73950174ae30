extern crate std;

use std::f64::consts::{FRAC_PI_2, PI};

use super::*;

/// Bits of which all, none, the first or the last are set, and a million drawn ones.
fn words() -> impl Iterator<Item = (u64, u32)> {
    let radii = [
        0,
        1,
        u64::MAX,
        1 << 63,
        (1 << 63) - 1,
        0xFFF,
        0x1000,
        !0xFFF,
    ];
    let angles = [0, 1, u32::MAX, 1 << 31, (1 << 31) - 1, 1 << 30];
    let edges = radii
        .into_iter()
        .flat_map(move |radius| angles.map(|angle| (radius, angle)));
    // SplitMix64.
    let mut state = 20_261_125_u64;
    let mut draw = move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    };
    edges.chain((0..1_000_000).map(move |_| (draw(), draw() as u32)))
}

/// Box and Muller's pair by the functions of `libm`; `uniform` in (0, 1], `half_turn` in the lowest bit of `radius`.
fn exact(uniform: f64, angle: u32, radius: u64) -> [f64; 2] {
    let theta = f64::from(angle as i32) * (FRAC_PI_2 * UNIT_31) + PI * (radius & 1) as f64;
    let r = (-2.0 * libm::log(uniform)).sqrt();
    [r * libm::cos(theta), r * libm::sin(theta)]
}

/// Largest relative error of numbers beyond `least`, and largest absolute error of the others.
#[derive(Debug)]
struct Worst {
    least: f64,
    relative: f64,
    absolute: f64,
}

impl Worst {
    const fn beyond(least: f64) -> Self {
        Self {
            least,
            relative: 0.0,
            absolute: 0.0,
        }
    }

    fn meet(&mut self, found: f64, exact: f64) {
        let error = (found - exact).abs();
        if exact.abs() < self.least {
            self.absolute = self.absolute.max(error);
        } else {
            self.relative = self.relative.max(error / exact.abs());
        }
    }

    fn show(&self) {
        let Self {
            least,
            relative,
            absolute,
        } = self;
        let (relative, absolute) = (relative.log2(), absolute.log2());
        std::println!("relative 2^{relative:.1} beyond {least}, absolute 2^{absolute:.1} below");
    }
}

#[test]
fn doubles_are_those_of_libm_to_forty_bits() {
    let mut worst = Worst::beyond(0.0625);
    for (radius, angle) in words() {
        // 1 − k·2⁻⁵² is exact.
        let uniform = 1.0 - (radius >> 12) as f64 * f64::EPSILON;
        let found = pair(radius, angle);
        for (found, exact) in found.into_iter().zip(exact(uniform, angle, radius)) {
            assert!(
                found.is_finite() && found.abs() < 8.5,
                "{radius:#x}, {angle:#x}"
            );
            worst.meet(found, exact);
        }
    }
    worst.show();
    assert!(worst.relative < 2f64.powi(-40) && worst.absolute < 2f64.powi(-40));
}

#[test]
fn singles_are_those_of_libm_to_eighteen_bits() {
    let mut worst = Worst::beyond(0.25);
    for (radius, angle) in words() {
        let radius = radius as u32;
        // The uniform number is rounded to 24 bits, as a part of the definition.
        let uniform = f64::from((radius >> 1) as f32 + 1.0) * UNIT_31;
        let found = pair_f32(radius, angle);
        let exact = exact(uniform, angle, radius.into());
        for (found, exact) in found.map(f64::from).into_iter().zip(exact) {
            assert!(
                found.is_finite() && found.abs() < 6.6,
                "{radius:#x}, {angle:#x}"
            );
            worst.meet(found, exact);
        }
    }
    worst.show();
    assert!(worst.relative < 2f64.powi(-18) && worst.absolute < 2f64.powi(-18));
}
