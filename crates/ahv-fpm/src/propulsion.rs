//! The stream through the engine: capture, cowl shock, diffuser, combustor, nozzle.

use ahv_core::Real;

use crate::Model;
use crate::area::AreaChange;
use crate::atmosphere::Air;
use crate::rayleigh::{HeatAddition, heat_addition};
use crate::surfaces::{Turned, turned};

/// The stream through the engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stream<R> {
    /// Captured air, slug/(s·ft).
    pub mass_flow: R,
    /// Of the air that the inlet can hold behind the bow shock, the share that the shock leaves it: below 1 the shock is inside the lip.
    pub capture: R,
    /// Velocity of the flow along the forebody, ft/s.
    pub inlet_velocity: R,
    /// The turn to axial at the cowl.
    pub cowl: Turned<R>,
    /// Height of the stream behind the cowl shock, ft.
    pub height: R,
    /// The diffuser.
    pub diffuser: AreaChange<R>,
    /// The combustor.
    pub heat: HeatAddition<R>,
    /// Fuel–air ratio.
    pub fuel: R,
    /// Ratio of total temperatures over the combustor.
    pub heating: R,
    /// The nozzle.
    pub nozzle: AreaChange<R>,
    /// Velocity where the stream leaves, ft/s.
    pub exit_velocity: R,
    /// Pressure where the stream leaves, over that of the air.
    pub exit_pressure: R,
    /// Height of the stream where it leaves, ft: the area ratio of the nozzle times the height behind the diffuser.
    pub exit_height: R,
}

impl<R: Real> Stream<R> {
    /// The stream at the flow `bow` along the forebody, which lies at `slope` to the body axis, rad.
    ///
    /// Behind the bow shock the inlet takes ρ₁V₁ times its height across that flow; a shock inside the lip leaves it only what lies
    /// between nose and lip in the air ahead. Where the shock meets the lip both are equal.
    pub(crate) fn new(
        model: &Model<R>,
        air: &Air<R>,
        flight: Flight<R>,
        bow: &Turned<R>,
        slope: R,
    ) -> Self {
        let p = &model.parameters;
        let gamma = p.kappa;
        let down = (gamma - R::ONE) * R::HALF;
        let density = air.density * bow.pressure / bow.temperature;
        let inlet_velocity = bow.mach * air.sound * bow.temperature.sqrt();
        let held = density * inlet_velocity * p.h_i * slope.cos();
        let (sin, cos) = flight.alpha.sin_cos();
        let lip = p.l_f * p.tau_l.tan() + p.h_i;
        let reached = air.density * flight.velocity * (lip * cos + p.l_f * sin);
        let mass_flow = held.min(reached);
        let cowl = turned(gamma, bow.mach, slope);
        let warm = air.temperature * bow.temperature * cowl.temperature;
        let velocity = cowl.mach * air.sound * (bow.temperature * cowl.temperature).sqrt();
        let height = mass_flow / (density * cowl.pressure / cowl.temperature * velocity);
        let diffuser = model.diffuser.change(cowl.mach);
        // Energy of a unit of air, and of the air and fuel that it becomes.
        let total = warm * (R::ONE + down * cowl.mach * cowl.mach);
        let specific_heat = gamma * p.r_air / (gamma - R::ONE);
        let fuel = p.f_st * flight.phi;
        let heating = (R::ONE + p.eta_c * fuel * p.h_f / (specific_heat * total)) / (R::ONE + fuel);
        let heat = heat_addition(gamma, diffuser.mach, heating);
        let nozzle = model.nozzle.change(heat.mach);
        let exit_total = total * heating;
        let exit = exit_total / (R::ONE + down * nozzle.mach * nozzle.mach);
        let compression = bow.pressure * cowl.pressure * diffuser.pressure;
        Self {
            mass_flow,
            capture: reached / held,
            inlet_velocity,
            cowl,
            height,
            diffuser,
            heat,
            fuel,
            heating,
            nozzle,
            exit_velocity: nozzle.mach * (gamma * p.r_air * exit).sqrt(),
            exit_pressure: compression * heat.pressure * nozzle.pressure,
            exit_height: height * p.a_d * p.a_n,
        }
    }
}

/// What the vehicle flies at, as far as the flow goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flight<R> {
    pub(crate) velocity: R,
    pub(crate) alpha: R,
    pub(crate) phi: R,
}
