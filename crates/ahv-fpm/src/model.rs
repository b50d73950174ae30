//! The equations of motion: the flow's loads on the rigid body and its two modes.

use ahv_core::{Bounds, DifferentiableModel, Dual, Pattern, Real, Vector, first_outside};

use crate::area::Duct;
use crate::atmosphere::Atmosphere;
use crate::structure::{Beam, Structure};
use crate::table::validity;
use crate::{Fault, Flow, Parameters};

ahv_core::vector! {
    /// State of the first-principles model.
    pub struct State<T> {
        /// Velocity, ft/s.
        velocity: ["ft/s", "m/s", 0.3048],
        /// Altitude, ft.
        altitude: ["ft", "m", 0.3048],
        /// Flight-path angle, rad.
        gamma: ["rad", "rad", 1.0],
        /// Angle of attack, rad.
        alpha: ["rad", "rad", 1.0],
        /// Pitch rate, rad/s.
        pitch_rate: ["rad/s", "rad/s", 1.0],
        /// Coordinate of the forebody, (ft*slug)^0.5.
        eta_1: ["(ft*slug)^0.5", "(m*kg)^0.5", 2.1090807512422325],
        /// Rate of the coordinate of the forebody, (ft*slug)^0.5/s.
        eta_dot_1: ["(ft*slug)^0.5/s", "(m*kg)^0.5/s", 2.1090807512422325],
        /// Coordinate of the aftbody, (ft*slug)^0.5.
        eta_2: ["(ft*slug)^0.5", "(m*kg)^0.5", 2.1090807512422325],
        /// Rate of the coordinate of the aftbody, (ft*slug)^0.5/s.
        eta_dot_2: ["(ft*slug)^0.5/s", "(m*kg)^0.5/s", 2.1090807512422325],
    }
}

ahv_core::vector! {
    /// Input of the first-principles model.
    pub struct Input<T> {
        /// Fuel equivalence ratio, dimensionless.
        phi: ["1", "1", 1.0],
        /// Elevator deflection, rad, trailing edge down.
        delta_e: ["rad", "rad", 1.0],
    }
}

/// The validity box of states.
pub const STATE_BOUNDS: State<Bounds> = State {
    velocity: validity::VELOCITY,
    altitude: validity::ALTITUDE,
    gamma: validity::GAMMA,
    alpha: validity::ALPHA,
    pitch_rate: validity::PITCH_RATE,
    eta_1: validity::ETA,
    eta_dot_1: validity::ETA_DOT,
    eta_2: validity::ETA,
    eta_dot_2: validity::ETA_DOT,
};

/// The validity box of inputs.
pub const INPUT_BOUNDS: Input<Bounds> = Input {
    phi: validity::PHI,
    delta_e: validity::DELTA_E,
};

/// The first-principles model of a vehicle; what depends on its parameters alone is computed once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model<R> {
    /// Numbers of its table.
    pub parameters: Parameters<R>,
    /// Its beams and their modes.
    pub structure: Structure<R>,
    pub(crate) atmosphere: Atmosphere<R>,
    pub(crate) diffuser: Duct<R>,
    pub(crate) nozzle: Duct<R>,
}

impl<R: Real> Model<R> {
    /// The model of these parameters.
    pub fn new(parameters: &Parameters<R>) -> Self {
        Self {
            parameters: *parameters,
            structure: Structure::new(parameters),
            atmosphere: Atmosphere::new(parameters),
            diffuser: Duct::new(parameters.kappa, parameters.a_d),
            nozzle: Duct::new(parameters.kappa, parameters.a_n),
        }
    }

    /// Flow and loads at (x, u). Its `margin` is below 0 where there is none.
    pub fn flow(&self, x: &State<R>, u: &Input<R>) -> Flow<R> {
        Flow::new(self, x, u)
    }

    /// The drift by what acts on the vehicle.
    pub(crate) fn motion(&self, x: &State<R>, flow: &Flow<R>) -> State<R> {
        let (p, structure) = (&self.parameters, &self.structure);
        let load = flow.total();
        let (sin, cos) = x.alpha.sin_cos();
        let (climb, level) = x.gamma.sin_cos();
        let along = (load.axial * cos - load.normal * sin) / p.m;
        let across = (load.normal * cos + load.axial * sin) / p.m;
        let curvature = p.spherical_earth / p.r_e;
        let ratio = (R::ONE + curvature * x.altitude).recip();
        let gravity = p.g * ratio * ratio;
        let turn =
            across / x.velocity - (gravity / x.velocity - curvature * ratio * x.velocity) * level;
        let rest = |beam: &Beam<R>, force, eta, rate| {
            let omega = beam.frequency;
            force - R::TWO * beam.damping * omega * rate - omega * omega * eta
        };
        let (fore, aft) = (&structure.forebody, &structure.aftbody);
        let first = rest(fore, flow.generalized[0], x.eta_1, x.eta_dot_1);
        let second = rest(aft, flow.generalized[1], x.eta_2, x.eta_dot_2);
        let moment = load.moment - fore.coupling * first - aft.coupling * second;
        let pitch = moment / structure.inertia;
        State {
            velocity: along - gravity * climb,
            altitude: x.velocity * climb,
            gamma: turn,
            alpha: x.pitch_rate - turn,
            pitch_rate: pitch,
            eta_1: x.eta_dot_1,
            eta_dot_1: first - fore.coupling * pitch,
            eta_2: x.eta_dot_2,
            eta_dot_2: second - aft.coupling * pitch,
        }
    }
}

impl Model<f64> {
    /// Flow and loads at (x, u) inside the validity box.
    ///
    /// # Errors
    ///
    /// [`Fault`]: what leaves the box, or the surface that has no flow.
    pub fn forces(&self, x: &State<f64>, u: &Input<f64>) -> Result<Flow<f64>, Fault> {
        let outside = first_outside(x, &STATE_BOUNDS).or_else(|| first_outside(u, &INPUT_BOUNDS));
        match outside {
            Some(outside) => Err(Fault::OutsideBox(outside)),
            None => self.forces_beyond(x, u),
        }
    }

    /// The same, outside of the box too.
    ///
    /// # Errors
    ///
    /// [`Fault`]: the surface that has no flow.
    pub fn forces_beyond(&self, x: &State<f64>, u: &Input<f64>) -> Result<Flow<f64>, Fault> {
        let finite = |it: f64| !it.is_finite();
        if let Some((name, _)) = x.find(finite).or_else(|| u.find(finite)) {
            return Err(Fault::NotFinite(name));
        }
        let flow = self.flow(x, u);
        Fault::of(self, &flow).map_or(Ok(flow), Err)
    }
}

impl<R> Model<R> {
    /// The model with another scalar: `f` applied to every number.
    pub fn map_ref<U>(&self, mut f: impl FnMut(&R) -> U) -> Model<U> {
        Model {
            parameters: self.parameters.map_ref(&mut f),
            structure: self.structure.map_ref(&mut f),
            atmosphere: self.atmosphere.map_ref(&mut f),
            diffuser: self.diffuser.map_ref(&mut f),
            nozzle: self.nozzle.map_ref(&mut f),
        }
    }
}

impl<R: Real> ahv_core::Model for Model<R> {
    type Scalar = R;
    type State = State<R>;
    type Input = Input<R>;

    /// NaN where there is no flow: [`Model::forces_beyond`] says why.
    fn drift(&self, x: &State<R>, u: &Input<R>) -> State<R> {
        let flow = self.flow(x, u);
        let nothing = R::from_f64(f64::NAN);
        self.motion(x, &flow)
            .map(|rate| R::ZERO.select(flow.margin, rate, nothing))
    }
}

/// Every row may depend on every state.
const ALL: [[usize; 2]; 81] = {
    let mut all = [[0; 2]; 81];
    let mut at = 0;
    while at < all.len() {
        all[at] = [at / State::<()>::LEN, at % State::<()>::LEN];
        at += 1;
    }
    all
};

impl<R: Real> DifferentiableModel for Model<R> {
    type StateJacobian = State<State<R>>;
    type InputJacobian = State<Input<R>>;

    const STATE_JACOBIAN_PATTERN: Pattern<2> = Pattern::new([State::<()>::LEN; 2], &ALL);

    /// By dual numbers: a drift for each state and input.
    fn jacobians(&self, x: &State<R>, u: &Input<R>) -> (State<State<R>>, State<Input<R>>) {
        let (_, by_state, by_input) = self.drift_and_jacobians(x, u);
        (by_state, by_input)
    }

    fn drift_and_jacobians(
        &self,
        x: &State<R>,
        u: &Input<R>,
    ) -> (State<R>, State<State<R>>, State<Input<R>>) {
        let model = self.map_ref(|&it| Dual::constant(it));
        let (fixed, held) = (
            x.map_ref(|&it| Dual::constant(it)),
            u.map_ref(|&it| Dual::constant(it)),
        );
        let slopes = |x: &State<Dual<R>>, u: &Input<Dual<R>>| ahv_core::Model::drift(&model, x, u);
        let of_state =
            <State<State<Dual<R>>>>::from_fn(|column| slopes(&seeded(fixed, column), &held));
        let of_input =
            <Input<State<Dual<R>>>>::from_fn(|column| slopes(&fixed, &seeded(held, column)));
        let by_state = Vector::from_fn(|row| of_state.map_into(|rates| slope(&rates, row)));
        let by_input = Vector::from_fn(|row| of_input.map_into(|rates| slope(&rates, row)));
        (
            of_state.velocity.map_into(|rate| rate.value),
            by_state,
            by_input,
        )
    }
}

/// The point with component `index` as the variable.
pub(crate) fn seeded<R: Real, V: Vector<Dual<R>>>(mut point: V, index: usize) -> V {
    if let Some(it) = point.get(index) {
        // The index is in range.
        let _ = point.set(index, Dual::variable(it.value));
    }
    point
}

/// The slope of component `row`.
pub(crate) fn slope<R: Real>(rates: &State<Dual<R>>, row: usize) -> R {
    rates.get(row).map_or(R::ZERO, |it| it.slope)
}

/// There is no noise.
pub type Noise<T> = ahv_core::NoNoise<T>;

ahv_core::impl_no_noise!(Model, State, Input);

impl<R: Real> ahv_core::ColouredNoise for Model<R> {}
