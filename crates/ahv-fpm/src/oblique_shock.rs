//! Oblique shocks: a flow that a wall turns into itself.

use ahv_core::Real;

/// An oblique shock; ratios are behind over ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shock<R> {
    /// Mach number behind the shock.
    pub mach: R,
    /// Ratio of the static pressures.
    pub pressure: R,
    /// Ratio of the static temperatures.
    pub temperature: R,
    /// Cotangent of the angle between the shock and the flow ahead.
    pub cotangent: R,
    /// Below 0 the shock is detached, and the rest means nothing; 1 is a Mach wave.
    pub margin: R,
}

impl<R: Real> Shock<R> {
    /// Angle between the shock and the flow ahead, rad.
    pub fn angle(&self) -> R {
        R::ONE.atan2(self.cotangent)
    }
}

/// The weak oblique shock that turns a flow of Mach number `mach` > 1 by `turn`, in rad, of 0 or above.
///
/// The cotangent w of the shock angle is a root of w³ + a w² + b w + c with t = tan `turn`, a = (1 + (γ+1)M²/2) t, b = 1 − M²,
/// c = (1 + (γ−1)M²/2) t: NACA report 1135, (138), in w. The weak shock is the greatest root, which stays apart from the others
/// until the shock detaches, so that a Mach wave is no special case. No difference of nearly equal numbers is left: a
/// shock of 10⁻⁸ rad has all its digits.
pub fn oblique_shock<R: Real>(gamma: R, mach: R, turn: R) -> Shock<R> {
    let [three, nine] = [3.0, 9.0].map(R::from_f64);
    let tangent = turn.tan();
    let (up, down) = ((gamma + R::ONE) * R::HALF, (gamma - R::ONE) * R::HALF);
    let mach_2 = mach * mach;
    let stagnation = R::ONE + down * mach_2;
    let (a, b, c) = (
        (R::ONE + up * mach_2) * tangent,
        R::ONE - mach_2,
        stagnation * tangent,
    );
    let q = (a * a - three * b) / nine;
    let p = (R::TWO * a * a * a - nine * a * b + R::from_f64(27.0) * c) / R::from_f64(54.0);
    let cube = q * q * q;
    let discriminant = cube - p * p;
    let third = discriminant.max(R::ZERO).sqrt().atan2(-p) / three;
    let w = R::TWO * q.sqrt() * third.cos() - a / three;
    let sine_2 = (R::ONE + w * w).recip();
    // M² sin² − 1, as the cubic has it: (M² − 1 − w²) w = a w² + c.
    let excess = sine_2 * (a * w * w + c) / w;
    let normal_2 = R::ONE + excess;
    let pressure = R::ONE + gamma / up * excess;
    let density = up * normal_2 / (down * normal_2 + R::ONE);
    let temperature = pressure / density;
    Shock {
        mach: ((stagnation / temperature - R::ONE) / down).sqrt(),
        pressure,
        temperature,
        cotangent: w,
        margin: discriminant / cube,
    }
}

/// The greatest turn, in rad, of an attached shock at Mach number `mach` > 1: NACA report 1135, (168) and (138).
pub fn greatest_turn<R: Real>(gamma: R, mach: R) -> R {
    let (up, down) = ((gamma + R::ONE) * R::HALF, (gamma - R::ONE) * R::HALF);
    let mach_2 = mach * mach;
    let root =
        (R::TWO * up * (up * mach_2 * mach_2 / R::from_f64(8.0) + down * mach_2 + R::ONE)).sqrt();
    let sine_2 = (up * mach_2 * R::HALF - R::ONE + root) / (gamma * mach_2);
    let cotangent = (sine_2.recip() - R::ONE).sqrt();
    let tangent = cotangent * (mach_2 * sine_2 - R::ONE) / (R::ONE + mach_2 * (up - sine_2));
    tangent.atan()
}
