//! Prints a number for each stepper on each model that any bit of any state changes: FNV-1a over flights from random
//! places in the box of validity. `cargo xtask determinism` compares them between builds.
#![forbid(unsafe_code)]

use ahv_core::Bounds;
use ahv_steppers::{Advance, Label, Visitor};
use std::collections::BTreeMap;

const FLIGHTS: u64 = 4;
const STEPS: u64 = 8;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Flies with every stepper.
struct Digest {
    random: Random,
    digests: BTreeMap<Label, u64>,
}

impl Visitor<f64> for Digest {
    fn parameter(&mut self, nominal: f64) -> f64 {
        nominal
    }

    fn within(&mut self, bounds: Bounds) -> f64 {
        bounds.min + (bounds.max - bounds.min) * self.random.unit()
    }

    fn visit(&mut self, label: Label, start: &[f64], advance: &mut Advance<'_, f64>) {
        let digest = self.digests.entry(label).or_insert(0xCBF2_9CE4_8422_2325);
        let mut x = start.to_vec();
        for step in 0..STEPS {
            let succeeded = advance(&mut x, step);
            let bytes = x
                .iter()
                .flat_map(|component| component.to_bits().to_le_bytes());
            for byte in bytes.chain([u8::from(succeeded)]) {
                *digest = (*digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
            }
        }
    }
}

fn main() {
    let mut digest = Digest {
        random: Random(1),
        digests: BTreeMap::new(),
    };
    for _ in 0..FLIGHTS {
        ahv_steppers::all(&mut digest);
    }
    for (label, value) in &digest.digests {
        let Label {
            model,
            stepper,
            source,
        } = label;
        println!("{value:016x} {model} {stepper} {source}");
    }
}
