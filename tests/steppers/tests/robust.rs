//! From anywhere in the validity box, and from far outside, every stepper ends finite or says that it failed.
#![forbid(unsafe_code)]

use std::collections::BTreeMap;

use ahv_core::Bounds;
use ahv_steppers::{Advance, Label, Visitor};

/// Draws places, and steps from them.
struct Random {
    word: u64,
    /// Steps that succeeded and steps that failed, of each stepper.
    counts: BTreeMap<&'static str, [u32; 2]>,
}

impl Random {
    /// SplitMix64.
    fn unit(&mut self) -> f64 {
        self.word = self.word.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.word;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Takes steps until one fails; the state is finite throughout, and after a failed step the one before it.
    fn steps(&mut self, label: Label, x: &mut [f64], advance: &mut Advance<'_, f64>, steps: u64) {
        // A run may get somewhere before it fails.
        let run = label.stepper == "TimeGrid" || label.stepper.starts_with("Adaptive");
        for step in 0..steps {
            let before = x.to_vec();
            let succeeded = advance(x, step);
            let finite = x.iter().all(|value| value.is_finite());
            assert!(finite, "{label:?} made {x:?} of {before:?}");
            let counts = self.counts.entry(label.stepper).or_default();
            counts[usize::from(!succeeded)] += 1;
            if !succeeded {
                assert!(run || x == before, "{label:?} failed and left {x:?}");
                return;
            }
        }
    }
}

impl Visitor<f64> for Random {
    /// Up to a tenth off.
    fn parameter(&mut self, nominal: f64) -> f64 {
        nominal * (0.9 + 0.2 * self.unit())
    }

    fn within(&mut self, bounds: Bounds) -> f64 {
        bounds.min + self.unit() * (bounds.max - bounds.min)
    }

    fn visit(&mut self, label: Label, start: &[f64], advance: &mut Advance<'_, f64>) {
        self.steps(label, &mut start.to_vec(), advance, 40);
        let mut far: Vec<f64> = start.iter().map(|x| 1e150 * x.signum()).collect();
        self.steps(label, &mut far, advance, 3);
        let mut still = vec![0.0; start.len()];
        self.steps(label, &mut still, advance, 3);
    }
}

#[test]
fn no_stepper_leaves_the_finite_numbers() {
    let mut random = Random {
        word: 17,
        counts: BTreeMap::new(),
    };
    for _ in 0..12 {
        ahv_steppers::all(&mut random);
    }
    for (stepper, [succeeded, failed]) in &random.counts {
        println!("{stepper}: {succeeded} steps succeeded, {failed} failed");
        assert!(*succeeded > 0, "{stepper} never succeeds");
        // The linear equations of an exact transition have no edge.
        let linear = stepper.starts_with("LinearTransition");
        assert!(linear || *failed > 0, "{stepper} never fails");
    }
}
