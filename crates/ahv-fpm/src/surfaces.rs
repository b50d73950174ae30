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
    /// Lower face of a canard ([`crate::canard`]), which is no part of the flow's loads.
    CanardLower,
    /// Upper face of a canard.
    CanardUpper,
}

impl Surface {
    /// Those of a flow's loads.
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
            Self::CanardLower => "canard, lower face",
            Self::CanardUpper => "canard, upper face",
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

    /// This flow where `turn` is below 0, else the other.
    fn where_below(self, turn: R, other: Self) -> Self {
        let of = |below, otherwise| turn.select(R::ZERO, below, otherwise);
        Self {
            turn: self.turn,
            ahead: self.ahead,
            mach: of(self.mach, other.mach),
            pressure: of(self.pressure, other.pressure),
            temperature: of(self.temperature, other.temperature),
            cotangent: of(self.cotangent, other.cotangent),
            margin: of(self.margin, other.margin),
        }
    }
}

/// A flow of Mach number `mach` > 1 that a wall turns by `turn`, rad: by a shock if into the flow, else by an expansion.
///
/// Of numbers side by side that all turn to one side only that one is computed.
pub fn turned<R: Real>(gamma: R, mach: R, turn: R) -> Turned<R> {
    let (into, away) = (turn.max(R::ZERO), (-turn).max(R::ZERO));
    match (none_below(turn), none_below(-turn)) {
        (true, false) => by_shock(gamma, mach, turn, into),
        (false, true) => by_expansion(gamma, mach, turn, away),
        _ => {
            let shock = by_shock(gamma, mach, turn, into);
            by_expansion(gamma, mach, turn, away).where_below(turn, shock)
        }
    }
}

/// The flows along the two faces of a plate at `incidence`, rad, first that which it turns by the incidence.
pub fn plate<R: Real>(gamma: R, mach: R, incidence: R) -> [Turned<R>; 2] {
    // Without incidence shock and expansion agree in value and slope, but each size of the turn has a sign of its own.
    let size = incidence.select(R::ZERO, -incidence, incidence);
    let shock = |turn| by_shock(gamma, mach, turn, size);
    let expansion = |turn| by_expansion(gamma, mach, turn, size);
    match (none_below(incidence), none_below(-incidence)) {
        (true, false) => [shock(incidence), expansion(-incidence)],
        (false, true) => [expansion(incidence), shock(-incidence)],
        _ => [
            expansion(incidence).where_below(incidence, shock(incidence)),
            shock(-incidence).where_below(incidence, expansion(-incidence)),
        ],
    }
}

/// Whether no lane is below 0. Where numbers do not say whether they are finite, this holds for a number and its negative.
pub(crate) fn none_below<R: Real>(value: R) -> bool {
    let nothing = R::from_f64(f64::NAN);
    value.select(R::ZERO, nothing, R::ZERO).is_finite()
}

fn by_shock<R: Real>(gamma: R, mach: R, turn: R, size: R) -> Turned<R> {
    let shock = oblique_shock(gamma, mach, size);
    Turned {
        turn,
        ahead: mach,
        mach: shock.mach,
        pressure: shock.pressure,
        temperature: shock.temperature,
        cotangent: shock.cotangent,
        margin: shock.margin,
    }
}

fn by_expansion<R: Real>(gamma: R, mach: R, turn: R, size: R) -> Turned<R> {
    let expansion = expansion(gamma, mach, size);
    Turned {
        turn,
        ahead: mach,
        mach: expansion.mach,
        pressure: expansion.pressure,
        temperature: expansion.temperature,
        cotangent: (mach * mach - R::ONE).sqrt(),
        margin: expansion.margin,
    }
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
