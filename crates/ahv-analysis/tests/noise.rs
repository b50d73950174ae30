//! Wiener increments.
#![forbid(unsafe_code)]

use ahv_analysis::noise::WienerSource;
use ahv_core::Vector;
use ahv_models::sdcom::Noise;
use approx::{assert_abs_diff_eq, assert_relative_eq};

const CHANNELS: usize = 6;

fn increments(source: &mut WienerSource, step: u64, dt: f64) -> Noise<f64> {
    source.increments(step, dt)
}

/// A value that differs in its last bit on another machine would change every recorded run.
#[test]
fn the_numbers_are_fixed() {
    let dw = increments(&mut WienerSource::new(1, 2, CHANNELS), 3, 1.0);
    assert_eq!(dw.to_array().map(f64::to_bits), FIXED);
}

/// Computed apart from this project's code, in Python: ChaCha8 after RFC 8439's layout, then Box–Muller.
const FIXED: [u64; 6] = [
    0x3FF3_672B_6EBA_0FB1,
    0x3FF7_D82B_DE0B_C1D8,
    0xBFF0_FA72_90E1_F3B7,
    0xBFFF_BA5D_F99D_F3D9,
    0x3FD3_0379_4BBF_91FA,
    0x3FA3_A2BA_6850_60B4,
];

#[test]
fn a_step_does_not_depend_on_the_steps_before_it() {
    let mut source = WienerSource::new(7, 0, CHANNELS);
    let forward: Vec<_> = (0..40)
        .map(|step| increments(&mut source, step, 0.01))
        .collect();
    for step in [39, 0, 5, 4, 4, 5, 5, 38, 1, 2] {
        assert_eq!(increments(&mut source, step, 0.01), forward[step as usize]);
    }
    for step in [17, 32] {
        let mut fresh = WienerSource::new(7, 0, CHANNELS);
        assert_eq!(increments(&mut fresh, step, 0.01), forward[step as usize]);
    }
}

#[test]
fn seeds_members_channels_and_steps_differ() {
    let mut seen = std::collections::BTreeSet::new();
    for seed in [0, 1] {
        for member in [0, 1] {
            let mut source = WienerSource::new(seed, member, CHANNELS);
            for step in 0..50 {
                let dw = increments(&mut source, step, 1.0);
                seen.extend(dw.to_array().map(f64::to_bits));
            }
        }
    }
    assert_eq!(seen.len(), 2 * 2 * 50 * CHANNELS);
}

#[test]
fn the_increments_are_normal_and_independent() {
    let (steps, dt) = (100_000, 0.04);
    let mut source = WienerSource::new(3, 0, CHANNELS);
    let draws: Vec<_> = (0..steps)
        .map(|step| increments(&mut source, step, dt))
        .collect();
    let mean = |f: &dyn Fn(usize) -> f64| (0..draws.len()).map(f).sum::<f64>() / draws.len() as f64;
    let value = |i: usize, channel: usize| draws[i].get(channel).expect("six channels") / dt.sqrt();
    // A standard error of a mean of 100 000 products is 0.0032; of fourth powers, 0.031.
    for a in 0..CHANNELS {
        assert_abs_diff_eq!(mean(&|i| value(i, a)), 0.0, epsilon = 0.015);
        assert_relative_eq!(mean(&|i| value(i, a).powi(2)), 1.0, epsilon = 0.02);
        assert_abs_diff_eq!(mean(&|i| value(i, a).powi(4)), 3.0, epsilon = 0.15);
        assert_abs_diff_eq!(
            mean(&|i| value(i, a) * value(i / 2, a)),
            0.0,
            epsilon = 0.02
        );
        for b in 0..a {
            assert_abs_diff_eq!(mean(&|i| value(i, a) * value(i, b)), 0.0, epsilon = 0.015);
        }
    }
}
