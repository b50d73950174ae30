//! Why there is no flow at a state and input.

use ahv_core::{Outside, Shown};

use crate::oblique_shock::greatest_turn;
use crate::prandtl_meyer::{prandtl_meyer_angle, vacuum_angle};
use crate::rayleigh::choking_ratio;
use crate::surfaces::{Surface, Turned};
use crate::{Flow, Model};

/// A stream that leaves the engine with less of the air's pressure counts as vacuum.
pub(crate) const LEAST_EXIT_PRESSURE: f64 = 1e-3;

/// Why the first-principles model has no forces at a state and input. Angles are in degrees.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A state or input outside the validity box.
    #[error("{} is {}, outside its validity from {} to {}", .0.name, Shown(.0.value), Shown(.0.bounds.min), Shown(.0.bounds.max))]
    OutsideBox(Outside),
    /// A state, an input or a result is infinite or NaN.
    #[error("{0} is not a finite number")]
    NotFinite(&'static str),
    /// Flight is not supersonic.
    #[error("flight at Mach {} is not supersonic: shocks and expansions need that", Shown(*.mach))]
    Subsonic {
        /// Mach number of flight.
        mach: f64,
    },
    /// A wall turns the flow more than an attached shock can.
    #[error("{}: the shock is detached, for at Mach {} it turns at most {} deg, not {} deg", .surface.name(), Shown(*.mach), Shown(*.greatest), Shown(*.turn))]
    DetachedShock {
        /// The surface.
        surface: Surface,
        /// Mach number ahead.
        mach: f64,
        /// Turn that is asked for.
        turn: f64,
        /// Greatest turn of an attached shock.
        greatest: f64,
    },
    /// A wall turns away from the flow by more than takes it to vacuum.
    #[error("{}: vacuum, for at Mach {} the flow follows a turn of at most {} deg, not {} deg", .surface.name(), Shown(*.mach), Shown(*.greatest), Shown(*.turn))]
    Vacuum {
        /// The surface.
        surface: Surface,
        /// Mach number ahead.
        mach: f64,
        /// Turn that is asked for.
        turn: f64,
        /// Turn to vacuum.
        greatest: f64,
    },
    /// The stream that enters the engine is not supersonic.
    #[error("inlet: the stream is at Mach {}, and must be supersonic", Shown(*.mach))]
    SubsonicInlet {
        /// Mach number ahead of the cowl shock if that is the reason, else behind it.
        mach: f64,
    },
    /// A duct that is too narrow for its stream.
    #[error("{}: the duct chokes, for it narrows a stream of Mach {} too far", .surface.name(), Shown(*.mach))]
    ChokedDuct {
        /// Inlet for the diffuser, nozzle for the nozzle.
        surface: Surface,
        /// Mach number at its start.
        mach: f64,
    },
    /// The fuel heats the stream to Mach 1.
    #[error("combustor: thermal choking, for heat multiplies the total temperature by {}, and a stream of Mach {} takes at most {}", Shown(*.heating), Shown(*.mach), Shown(*.greatest))]
    ThermalChoking {
        /// Mach number ahead of the combustor.
        mach: f64,
        /// Ratio of total temperatures that the fuel asks for.
        heating: f64,
        /// The ratio that chokes.
        greatest: f64,
    },
    /// Less than no fuel takes more heat from the stream than it has.
    #[error("combustor: a stream of Mach {} has no total temperature of {} times its own: phi is below 0", Shown(*.mach), Shown(*.heating))]
    Cooling {
        /// Mach number ahead of the combustor.
        mach: f64,
        /// Ratio of total temperatures that is asked for.
        heating: f64,
    },
    /// The stream leaves the engine with next to no pressure.
    #[error("nozzle: vacuum, for the stream leaves at {} of the air's pressure", Shown(*.pressure))]
    VacuumAtNozzle {
        /// Pressure where it leaves, over that of the air.
        pressure: f64,
    },
    /// The modes have more inertia about the centre of mass than the vehicle.
    #[error("structure: the modes' inertia leaves {} slug*ft of I_yy, which must be positive", Shown(*.left))]
    Inertia {
        /// What is left of the pitch moment of inertia, slug·ft.
        left: f64,
    },
}

impl Fault {
    /// The first reason, from the nose to the tail, why there is no such flow.
    pub(crate) fn of(model: &Model<f64>, flow: &Flow<f64>) -> Option<Self> {
        let gamma = model.parameters.kappa;
        let stream = &flow.stream;
        if !flow.mach.is_finite() {
            return Some(Self::NotFinite("the Mach number of flight"));
        }
        if flow.mach <= 1.0 {
            return Some(Self::Subsonic { mach: flow.mach });
        }
        let [lower, upper] = &flow.elevator;
        let outside = [
            (Surface::Forebody, &flow.bow),
            (Surface::Upper, &flow.upper),
            (Surface::Underside, &flow.underside),
            (Surface::ElevatorLower, lower),
            (Surface::ElevatorUpper, upper),
        ];
        let turn = outside
            .into_iter()
            .find_map(|(surface, turned)| of_turn(gamma, surface, turned));
        if turn.is_some() {
            return turn;
        }
        let ahead = stream.cowl.ahead;
        if misses(ahead, 1.0) {
            return Some(Self::SubsonicInlet { mach: ahead });
        }
        let turn = of_turn(gamma, Surface::Inlet, &stream.cowl);
        if turn.is_some() {
            return turn;
        }
        let (mach, diffused, burnt) = (stream.cowl.mach, stream.diffuser.mach, stream.heat.mach);
        if misses(mach, 1.0) {
            return Some(Self::SubsonicInlet { mach });
        }
        if misses(stream.diffuser.margin, 0.0) {
            return Some(Self::ChokedDuct {
                surface: Surface::Inlet,
                mach,
            });
        }
        if misses(stream.heat.margin, 0.0) {
            let heating = stream.heating;
            if heating < 1.0 {
                return Some(Self::Cooling {
                    mach: diffused,
                    heating,
                });
            }
            let greatest = choking_ratio(gamma, diffused);
            return Some(Self::ThermalChoking {
                mach: diffused,
                heating,
                greatest,
            });
        }
        if misses(stream.nozzle.margin, 0.0) {
            return Some(Self::ChokedDuct {
                surface: Surface::Nozzle,
                mach: burnt,
            });
        }
        if misses(stream.exit_pressure, LEAST_EXIT_PRESSURE) {
            return Some(Self::VacuumAtNozzle {
                pressure: stream.exit_pressure,
            });
        }
        let left = model.structure.inertia;
        if misses(left, 0.0) {
            return Some(Self::Inertia { left });
        }
        let total = flow.total();
        let all = [
            total.axial,
            total.normal,
            total.moment,
            flow.generalized[0],
            flow.generalized[1],
        ];
        let names = [
            "the axial force",
            "the normal force",
            "the pitching moment",
            "a generalized force",
            "a generalized force",
        ];
        let found = all.iter().zip(names).find(|(value, _)| !value.is_finite());
        found.map(|(_, name)| Self::NotFinite(name))
    }
}

/// Whether a value misses what it must be above; NaN does.
fn misses(value: f64, bound: f64) -> bool {
    value <= bound || value.is_nan()
}

pub(crate) fn of_turn(gamma: f64, surface: Surface, flow: &Turned<f64>) -> Option<Fault> {
    if flow.margin > 0.0 {
        return None;
    }
    let mach = flow.ahead;
    if !(mach.is_finite() && flow.turn.is_finite()) {
        return Some(Fault::NotFinite("the turn of the flow"));
    }
    let turn = flow.turn.abs().to_degrees();
    Some(if flow.turn >= 0.0 {
        let greatest = greatest_turn(gamma, mach).to_degrees();
        Fault::DetachedShock {
            surface,
            mach,
            turn,
            greatest,
        }
    } else {
        let greatest = (vacuum_angle(gamma) - prandtl_meyer_angle(gamma, mach)).to_degrees();
        Fault::Vacuum {
            surface,
            mach,
            turn,
            greatest,
        }
    })
}
