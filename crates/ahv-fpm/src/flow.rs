//! The whole flow at a state and input: each surface, the engine's stream, and the loads.

use ahv_core::Real;

use crate::atmosphere::Air;
use crate::fault::LEAST_EXIT_PRESSURE;
use crate::model::{Input, Model, State};
use crate::propulsion::{Flight, Stream};
use crate::structure::quadrature;
use crate::surfaces::{Load, Turned, plate, turned};

/// Flow and loads at a state and input. Pressures of loads are those above the air's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow<R> {
    /// The air.
    pub air: Air<R>,
    /// Mach number of flight.
    pub mach: R,
    /// Along the forebody.
    pub bow: Turned<R>,
    /// Along the upper surface.
    pub upper: Turned<R>,
    /// Along the lower side of the engine.
    pub underside: Turned<R>,
    /// Along the lower and the upper face of the elevator.
    pub elevator: [Turned<R>; 2],
    /// Through the engine.
    pub stream: Stream<R>,
    /// Loads, in the order of [`crate::Surface::ALL`].
    pub loads: [Load<R>; 8],
    /// Generalized forces of the modes, (ft·slug)^½/s².
    pub generalized: [R; 2],
    /// Below 0 there is no such flow, and the rest means nothing.
    pub margin: R,
}

impl<R: Real> Flow<R> {
    /// All loads together.
    pub fn total(&self) -> Load<R> {
        self.loads
            .iter()
            .fold(Load::NONE, |sum, &load| sum.and(load))
    }

    pub(crate) fn new(model: &Model<R>, x: &State<R>, u: &Input<R>) -> Self {
        let p = &model.parameters;
        let gamma = p.kappa;
        let air = model.atmosphere.at(x.altitude);
        let mach = x.velocity / air.sound;
        let nose = model.structure.nose_slope * x.eta_1;
        let slope = p.tau_l + nose;
        let bow = turned(gamma, mach, slope + x.alpha);
        let upper = turned(gamma, mach, p.tau_u - x.alpha - nose);
        let underside = turned(gamma, mach, x.alpha);
        let elevator = plate(gamma, mach, x.alpha + u.delta_e);
        let flight = Flight {
            velocity: x.velocity,
            alpha: x.alpha,
            phi: u.phi,
        };
        let stream = Stream::new(model, &air, flight, &bow, slope);
        let mut flow = Self {
            air,
            mach,
            bow,
            upper,
            underside,
            elevator,
            stream,
            loads: [Load::NONE; 8],
            generalized: [R::ZERO; 2],
            margin: R::ZERO,
        };
        flow.margin = flow.least_margin();
        flow.load(model, slope, u.delta_e);
        flow
    }

    /// Fills loads and generalized forces.
    fn load(&mut self, model: &Model<R>, slope: R, delta_e: R) {
        let (p, structure) = (&model.parameters, &model.structure);
        let pressure = self.air.pressure;
        let gauge = |flow: &Turned<R>| (flow.pressure - R::ONE) * pressure;
        let length = p.l_f + p.l_n + p.l_a;
        let engine = p.x_cm - p.l_f;
        let forebody = gauge(&self.bow);
        let depth = p.l_f * p.tau_l.tan();
        let half = R::HALF;
        let upper = gauge(&self.upper);
        let rise = length * p.tau_u.tan();
        let underside = gauge(&self.underside);
        let [lower, over] = [0, 1].map(|face: usize| gauge(&self.elevator[face]) * p.s_e);
        let (sin, cos) = delta_e.sin_cos();
        let face = |force: R| Load::at(-force * sin, force * cos, -p.x_e, p.z_el);
        let stream = &self.stream;
        let (turn_sin, turn_cos) = slope.sin_cos();
        let momentum = stream.mass_flow * stream.inlet_velocity;
        let down = -momentum * turn_sin;
        let thrust = stream.mass_flow * (R::ONE + stream.fuel) * stream.exit_velocity
            + (stream.exit_pressure - R::ONE) * pressure * stream.exit_height;
        let (aftbody, aft_mode) = ramp(model, stream.exit_pressure, pressure);
        self.loads = [
            plane(
                forebody,
                [depth, p.l_f],
                [p.x_cm - half * p.l_f, half * depth],
            ),
            plane(
                upper,
                [rise, -length],
                [p.x_cm - half * length, -half * rise],
            ),
            Load::at(R::ZERO, underside * p.l_n, engine - half * p.l_n, R::ZERO),
            aftbody,
            face(lower),
            face(-over),
            Load::at(
                -momentum * turn_cos - forebody * p.h_i,
                down,
                engine,
                depth + half * p.h_i,
            ),
            Load::at(thrust, R::ZERO, engine - p.l_n, p.z_e),
        ];
        let (fore, aft) = (&structure.forebody, &structure.aftbody);
        self.generalized = [
            forebody * (fore.whole - fore.engine) + underside * fore.engine - upper * fore.whole
                + down * structure.inlet,
            underside * aft.engine - upper * aft.whole
                + aft_mode
                + (lower - over) * cos * structure.elevator,
        ];
    }

    /// The least of all margins.
    fn least_margin(&self) -> R {
        let stream = &self.stream;
        [
            self.bow.margin,
            self.upper.margin,
            self.underside.margin,
            self.elevator[0].margin,
            self.elevator[1].margin,
            stream.cowl.ahead - R::ONE,
            stream.cowl.margin,
            stream.cowl.mach - R::ONE,
            stream.diffuser.margin,
            stream.heat.margin,
            stream.nozzle.margin,
            stream.exit_pressure - R::from_f64(LEAST_EXIT_PRESSURE),
        ]
        .into_iter()
        .fold(self.mach - R::ONE, R::min)
    }
}

/// The load of a pressure on a plane that it pushes back and up by these projections, ft, with its middle at a point ahead of and
/// below the centre of mass, ft.
fn plane<R: Real>(pressure: R, [back, up]: [R; 2], [ahead, below]: [R; 2]) -> Load<R> {
    Load::at(-pressure * back, pressure * up, ahead, below)
}

/// The load of the exhaust on the aftbody, and its generalized force.
///
/// Along the ramp the pressure is pₑ/(1 + t (pₑ/p∞ − 1)), t from 0 to 1: that of the nozzle at its start, that of the air at its end.
fn ramp<R: Real>(model: &Model<R>, exit_pressure: R, pressure: R) -> (Load<R>, R) {
    let p = &model.parameters;
    let steepness = (p.tau_t + p.tau_u).tan();
    let depth = p.l_f * p.tau_l.tan();
    let start = p.x_cm - p.l_f - p.l_n;
    let quadrature = quadrature();
    let (mut force, mut lever, mut mode) = (R::ZERO, R::ZERO, R::ZERO);
    for (&(place, shape), (_, weight)) in model.structure.ramp.iter().zip(quadrature) {
        let gauge = exit_pressure / (R::ONE + place * (exit_pressure - R::ONE)) - R::ONE;
        let part = R::from_f64(weight) * gauge;
        force = force + part;
        lever = lever + part * place;
        mode = mode + gauge * shape;
    }
    let (force, lever) = (force * pressure * p.l_a, lever * pressure * p.l_a);
    let moment =
        start * force - p.l_a * lever + steepness * (depth * force - p.l_a * steepness * lever);
    let load = Load {
        axial: steepness * force,
        normal: force,
        moment,
    };
    (load, mode * pressure)
}
