//! What is flown in the paper's section 5.1, and what is kept of it.

use ahv_models::flexible_mode::SETS;

/// Number of modes.
pub(crate) const MODES: usize = SETS.len();
/// Step size in s.
pub(crate) const DT: f64 = 1e-3;
/// Runs of each mode.
pub(crate) const RUNS: usize = 10_000;
/// Steps of a turn; the paper's runs have 10 000.
pub(crate) const STEPS: usize = 200;
/// Stiffness, damping, intensity of the noise, decay of χ and its intensity.
pub(crate) type Rates = [f64; 5];

/// After each step, sums over runs of η, η², χ and χ².
pub(crate) type Sums = [[f64; 4]; STEPS];

/// Parts of each mode, part by part, added up mode by mode.
pub(crate) fn added(parts: &[Sums]) -> Vec<Sums> {
    let mut total = vec![[[0.0; 4]; STEPS]; MODES];
    for part in parts.chunks_exact(MODES) {
        for (total, part) in total.iter_mut().flatten().zip(part.iter().flatten()) {
            for (total, part) in total.iter_mut().zip(part) {
                *total += part;
            }
        }
    }
    total
}
