//! Normal numbers for the tests of stochastic steppers.

use ahv_core::Vector;
use ahv_integrate::WienerIntegrals;

/// SplitMix64 and Box–Muller.
pub(crate) struct Normal(pub(crate) u64);

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (((z ^ (z >> 31)) >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn draw(&mut self) -> f64 {
        let (radius, angle) = (self.uniform(), self.uniform());
        (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
    }

    pub(crate) fn draws<W: Vector<f64>>(&mut self) -> W {
        W::from_fn(|_| self.draw())
    }
}

/// The same path at levels 0 to `deepest`: level l has 2^l steps.
#[allow(dead_code, reason = "not every test file refines")]
pub(crate) fn refined<W: Vector<f64>>(
    normal: &mut Normal,
    duration: f64,
    deepest: usize,
) -> Vec<Vec<WienerIntegrals<W>>> {
    let root = WienerIntegrals::from_normals(duration, normal.draws(), normal.draws());
    let mut levels = vec![vec![root]];
    for level in 0..deepest {
        let dt = duration / (1_u64 << level) as f64;
        let finer = levels[level]
            .iter()
            .flat_map(|step| {
                let (left, right) = step.bisect(dt, normal.draws(), normal.draws());
                [left, right]
            })
            .collect();
        levels.push(finer);
    }
    levels
}
