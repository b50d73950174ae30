//! Surfaces of the vehicle: the flow along each, and its load.

use ahv_core::Real;

use crate::oblique_shock::oblique_shock;
use crate::prandtl_meyer::expansion;

/// What a load comes from, in the order of [`Surface::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// Lower side of the forebody.
    Forebody,
    /// Upper side of the vehicle.
    Upper,
    /// Lower side of the engine.
    Underside,
    /// Ramp behind the engine, which the exhaust expands along.
    Aftbody,
    /// Lower face of the elevator.
    ElevatorLower,
    /// Upper face of the elevator.
    ElevatorUpper,
    /// Plane where the stream enters the engine.
    Inlet,
    /// Plane where the stream leaves the engine.
    Nozzle,
}

impl Surface {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Forebody,
        Self::Upper,
        Self::Underside,
        Self::Aftbody,
        Self::ElevatorLower,
        Self::ElevatorUpper,
        Self::Inlet,
        Self::Nozzle,
    ];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Forebody => "forebody",
            Self::Upper => "upper surface",
            Self::Underside => "engine underside",
            Self::Aftbody => "aftbody",
            Self::ElevatorLower => "elevator, lower face",
            Self::ElevatorUpper => "elevator, upper face",
            Self::Inlet => "inlet",
            Self::Nozzle => "nozzle",
        }
    }
}

/// A flow that a wall has turned; ratios are behind over ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turned<R> {
    /// Turn into the flow, rad: above 0 by a shock, below by an expansion.
    pub turn: R,
    /// Mach number ahead.
    pub ahead: R,
    /// Mach number behind.
    pub mach: R,
    /// Ratio of the static pressures.
    pub pressure: R,
    /// Ratio of the static temperatures.
    pub temperature: R,
    /// Cotangent of the angle between the shock, or the first wave of the expansion, and the flow ahead.
    pub cotangent: R,
    /// That of the shock or expansion: below 0 there is none.
    pub margin: R,
}

impl<R: Real> Turned<R> {
    /// Angle between the shock, or the first wave of the expansion, and the flow ahead, rad.
    pub fn wave(&self) -> R {
        R::ONE.atan2(self.cotangent)
    }
}

/// A flow of Mach number `mach` > 1 that a wall turns by `turn`, rad: by a shock if into the flow, else by an expansion.
pub fn turned<R: Real>(gamma: R, mach: R, turn: R) -> Turned<R> {
    both_ways(gamma, mach, turn, turn.max(R::ZERO), (-turn).max(R::ZERO))[0]
}

/// The flows along the two faces of a plate at `incidence`, rad, first that which it turns by the incidence.
pub fn plate<R: Real>(gamma: R, mach: R, incidence: R) -> [Turned<R>; 2] {
    let size = incidence.select(R::ZERO, -incidence, incidence);
    both_ways(gamma, mach, incidence, size, size)
}

/// The flow turned by `turn` and that turned by −`turn`, by the shock of `into` and the expansion of `away`.
fn both_ways<R: Real>(gamma: R, mach: R, turn: R, into: R, away: R) -> [Turned<R>; 2] {
    let shock = oblique_shock(gamma, mach, into);
    let expansion = expansion(gamma, mach, away);
    let first_wave = (mach * mach - R::ONE).sqrt();
    let choose = |turn: R, of: &dyn Fn(R, R) -> R| Turned {
        turn,
        ahead: mach,
        mach: of(expansion.mach, shock.mach),
        pressure: of(expansion.pressure, shock.pressure),
        temperature: of(expansion.temperature, shock.temperature),
        cotangent: of(first_wave, shock.cotangent),
        margin: of(expansion.margin, shock.margin),
    };
    // Without a turn the two agree in value and slope, but the sizes of the turn have each a sign of its own.
    [
        choose(turn, &|away, into| turn.select(R::ZERO, away, into)),
        choose(-turn, &|away, into| turn.select(R::ZERO, into, away)),
    ]
}

/// Force and moment of a surface, per foot of width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load<R> {
    /// Forward along the body axis, lb/ft.
    pub axial: R,
    /// Up across the body axis, lb/ft.
    pub normal: R,
    /// Nose-up about the centre of mass, lb.
    pub moment: R,
}

impl<R: Real> Load<R> {
    /// A force at a point: forward and up, lb/ft; ahead of and below the centre of mass, ft.
    pub(crate) fn at(axial: R, normal: R, ahead: R, below: R) -> Self {
        Self {
            axial,
            normal,
            moment: ahead * normal + below * axial,
        }
    }

    /// No load.
    pub(crate) const NONE: Self = Self {
        axial: R::ZERO,
        normal: R::ZERO,
        moment: R::ZERO,
    };

    /// Both loads.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            axial: self.axial + other.axial,
            normal: self.normal + other.normal,
            moment: self.moment + other.moment,
        }
    }
}
