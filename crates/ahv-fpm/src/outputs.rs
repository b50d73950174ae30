//! The quantities of the model that people look at.

use ahv_core::Real;

use crate::model::{Input, Model, State};
use crate::surfaces::Load;

ahv_core::vector! {
    /// Quantities that people look at. Lift and drag are those of all surfaces and of the turn at the inlet; thrust is the axial force of
    /// inlet and nozzle.
    pub struct Outputs<T> {
        /// Pitch angle, rad.
        theta: ["rad", "rad", 1.0],
        /// Air density, slug/ft^3.
        density: ["slug/ft^3", "kg/m^3", 515.3788183931962],
        /// Dynamic pressure, lb/ft^2.
        dynamic_pressure: ["lb/ft^2", "N/m^2", 47.880258980335846],
        /// Mach number of flight, dimensionless.
        mach: ["1", "1", 1.0],
        /// Thrust, lb/ft.
        thrust: ["lb/ft", "N/m", 14.593902937206364],
        /// Lift, lb/ft.
        lift: ["lb/ft", "N/m", 14.593902937206364],
        /// Drag, lb/ft.
        drag: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment, lb.
        pitching_moment: ["lb", "N", 4.4482216152605],
        /// Generalized force of the forebody, (ft*slug)^0.5/s^2.
        generalized_force_1: ["(ft*slug)^0.5/s^2", "(m*kg)^0.5/s^2", 2.1090807512422325],
        /// Generalized force of the aftbody, (ft*slug)^0.5/s^2.
        generalized_force_2: ["(ft*slug)^0.5/s^2", "(m*kg)^0.5/s^2", 2.1090807512422325],
        /// Axial force of all, forward, lb/ft.
        axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of all, up, lb/ft.
        normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Axial force of the lower side of the forebody, forward, lb/ft.
        forebody_axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of the lower side of the forebody, up, lb/ft.
        forebody_normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment of the lower side of the forebody, lb.
        forebody_pitching_moment: ["lb", "N", 4.4482216152605],
        /// Axial force of the upper side, forward, lb/ft.
        upper_axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of the upper side, up, lb/ft.
        upper_normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment of the upper side, lb.
        upper_pitching_moment: ["lb", "N", 4.4482216152605],
        /// Axial force of the lower side of the engine, forward, lb/ft.
        underside_axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of the lower side of the engine, up, lb/ft.
        underside_normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment of the lower side of the engine, lb.
        underside_pitching_moment: ["lb", "N", 4.4482216152605],
        /// Axial force of the ramp behind the engine, forward, lb/ft.
        aftbody_axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of the ramp behind the engine, up, lb/ft.
        aftbody_normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment of the ramp behind the engine, lb.
        aftbody_pitching_moment: ["lb", "N", 4.4482216152605],
        /// Axial force of the lower face of the elevator, forward, lb/ft.
        elevator_lower_axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of the lower face of the elevator, up, lb/ft.
        elevator_lower_normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment of the lower face of the elevator, lb.
        elevator_lower_pitching_moment: ["lb", "N", 4.4482216152605],
        /// Axial force of the upper face of the elevator, forward, lb/ft.
        elevator_upper_axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of the upper face of the elevator, up, lb/ft.
        elevator_upper_normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment of the upper face of the elevator, lb.
        elevator_upper_pitching_moment: ["lb", "N", 4.4482216152605],
        /// Axial force of the stream at the inlet, forward, lb/ft.
        inlet_axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of the stream at the inlet, up, lb/ft.
        inlet_normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment of the stream at the inlet, lb.
        inlet_pitching_moment: ["lb", "N", 4.4482216152605],
        /// Axial force of the stream at the nozzle, forward, lb/ft.
        nozzle_axial_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Normal force of the stream at the nozzle, up, lb/ft.
        nozzle_normal_force: ["lb/ft", "N/m", 14.593902937206364],
        /// Pitching moment of the stream at the nozzle, lb.
        nozzle_pitching_moment: ["lb", "N", 4.4482216152605],
    }
}

/// The outputs at (x, u); NaN where there is no flow.
pub(crate) fn outputs<R: Real>(model: &Model<R>, x: &State<R>, u: &Input<R>) -> Outputs<R> {
    let flow = model.flow(x, u);
    let total = flow.total();
    let [
        forebody,
        upper,
        underside,
        aftbody,
        elevator_lower,
        elevator_upper,
        inlet,
        nozzle,
    ] = flow.loads;
    let thrust = inlet.axial + nozzle.axial;
    let rest = Load {
        axial: total.axial - thrust,
        ..total
    };
    let (sin, cos) = x.alpha.sin_cos();
    let found = Outputs {
        theta: x.gamma + x.alpha,
        density: flow.air.density,
        dynamic_pressure: R::HALF * flow.air.density * x.velocity * x.velocity,
        mach: flow.mach,
        thrust,
        lift: rest.normal * cos + rest.axial * sin,
        drag: rest.normal * sin - rest.axial * cos,
        pitching_moment: total.moment,
        generalized_force_1: flow.generalized[0],
        generalized_force_2: flow.generalized[1],
        axial_force: total.axial,
        normal_force: total.normal,
        forebody_axial_force: forebody.axial,
        forebody_normal_force: forebody.normal,
        forebody_pitching_moment: forebody.moment,
        upper_axial_force: upper.axial,
        upper_normal_force: upper.normal,
        upper_pitching_moment: upper.moment,
        underside_axial_force: underside.axial,
        underside_normal_force: underside.normal,
        underside_pitching_moment: underside.moment,
        aftbody_axial_force: aftbody.axial,
        aftbody_normal_force: aftbody.normal,
        aftbody_pitching_moment: aftbody.moment,
        elevator_lower_axial_force: elevator_lower.axial,
        elevator_lower_normal_force: elevator_lower.normal,
        elevator_lower_pitching_moment: elevator_lower.moment,
        elevator_upper_axial_force: elevator_upper.axial,
        elevator_upper_normal_force: elevator_upper.normal,
        elevator_upper_pitching_moment: elevator_upper.moment,
        inlet_axial_force: inlet.axial,
        inlet_normal_force: inlet.normal,
        inlet_pitching_moment: inlet.moment,
        nozzle_axial_force: nozzle.axial,
        nozzle_normal_force: nozzle.normal,
        nozzle_pitching_moment: nozzle.moment,
    };
    let nothing = R::from_f64(f64::NAN);
    found.map_into(|value| R::ZERO.select(flow.margin, value, nothing))
}
