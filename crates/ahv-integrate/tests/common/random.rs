//! Random places.

use ahv_core::{Bounds, Vector};

/// SplitMix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn within<X: Vector<f64>, B: Vector<Bounds>>(&mut self, bounds: &B) -> X {
        X::from_fn(|index| {
            let bounds = bounds.get(index).expect("one interval a component");
            bounds.min + self.unit() * (bounds.max - bounds.min)
        })
    }
}
