//! Prandtl–Meyer expansions: a flow that a wall turns away from itself.

use ahv_core::Real;

use crate::area::is_below;

/// An expansion; ratios are behind over ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expansion<R> {
    /// Mach number behind.
    pub mach: R,
    /// Ratio of the static pressures.
    pub pressure: R,
    /// Ratio of the static temperatures.
    pub temperature: R,
    /// What is left of the turn to vacuum, over the Prandtl–Meyer angle of vacuum. At 0 and below there is no flow behind.
    pub margin: R,
}

/// Halley's steps at most, from Hall's start, which is within 6e-4 for γ = 1.4 and 0.2 for 1.2 to 1.67: to rounding.
const STEPS: usize = 3;

/// A step of √(M² − 1) below this share of it is the last: the error that it leaves is of the order of its cube.
const LAST_STEP: f64 = 1e-7;

/// Hall's rational fit of the Mach number over (ν/ν of vacuum)^(2/3): "Inversion of the Prandtl–Meyer relation", 1975.
const NUMERATOR: [f64; 3] = [1.3604, 0.0962, -0.5127];
const DENOMINATOR: [f64; 2] = [-0.6722, -0.3278];

/// The least margin that the search is started with: behind vacuum it has no aim.
const LEAST_MARGIN: f64 = 1e-6;

/// The Prandtl–Meyer angle of a Mach number of 1 or above, in rad: NACA report 1135, (171c).
pub fn prandtl_meyer_angle<R: Real>(gamma: R, mach: R) -> R {
    angle(reach(gamma), (mach * mach - R::ONE).sqrt())
}

/// The Prandtl–Meyer angle of vacuum, in rad.
pub fn vacuum_angle<R: Real>(gamma: R) -> R {
    (reach(gamma) - R::ONE) * R::from_f64(core::f64::consts::FRAC_PI_2)
}

/// √((γ+1)/(γ−1)).
fn reach<R: Real>(gamma: R) -> R {
    ((gamma + R::ONE) / (gamma - R::ONE)).sqrt()
}

/// The angle by y = √(M² − 1).
fn angle<R: Real>(reach: R, y: R) -> R {
    reach * (y / reach).atan() - y.atan()
}

/// The expansion of a flow of Mach number `mach` > 1 by `turn`, in rad, of 0 or above.
pub fn expansion<R: Real>(gamma: R, mach: R, turn: R) -> Expansion<R> {
    let (reach, vacuum) = (reach(gamma), vacuum_angle(gamma));
    let down = (gamma - R::ONE) * R::HALF;
    let mach_2 = mach * mach;
    let wanted = angle(reach, (mach_2 - R::ONE).sqrt()) + turn;
    let margin = R::ONE - wanted / vacuum;
    let wanted = wanted.min(vacuum * R::from_f64(1.0 - LEAST_MARGIN));
    let start = hall(wanted / vacuum);
    let mut y = (start * start - R::ONE).sqrt();
    let reach_2 = reach * reach;
    for _ in 0..STEPS {
        let y_2 = y * y;
        let by_y = y_2 * (reach_2 - R::ONE) / ((R::ONE + y_2) * (reach_2 + y_2));
        let step = (angle(reach, y) - wanted) / by_y;
        // Half the second derivative over the first.
        let bend = y.recip() - y / (R::ONE + y_2) - y / (reach_2 + y_2);
        let before = y;
        y = y - step / (R::ONE - step * bend);
        if is_below(step / before, LAST_STEP) {
            break;
        }
    }
    let behind_2 = R::ONE + y * y;
    let temperature = (R::ONE + down * mach_2) / (R::ONE + down * behind_2);
    Expansion {
        mach: behind_2.sqrt(),
        pressure: (gamma / (gamma - R::ONE) * temperature.ln()).exp(),
        temperature,
        margin,
    }
}

/// The Mach number at a share of the angle of vacuum, about.
fn hall<R: Real>(share: R) -> R {
    let z = (R::from_f64(2.0 / 3.0) * share.ln()).exp();
    let [a, b, c] = NUMERATOR.map(R::from_f64);
    let [d, e] = DENOMINATOR.map(R::from_f64);
    (R::ONE + z * (a + z * (b + z * c))) / (R::ONE + z * (d + z * e))
}
