//! Tables 2 and 3, and Fig. 6: trims, poles and zeros of FPM, COM, DCOM and SDCOM.

use ahv_analysis::linearize::linearize;
use ahv_analysis::poles::{Pole, poles, zeros};
use ahv_analysis::trim::{SteadyState, Trim, trim};
use ahv_core::{GeneratedModel, Vector};
use ahv_models::dcom::{Canard, Earth};
use ahv_models::{com, com_rigid, dcom, sdcom};

use super::pairing::{Kind, NOTHING, SLOW, relative_distance, size};
use super::printed::{Root, TABLE_2};

/// Relative distance below which a zero lies on a pole.
const CANCELLED: f64 = 1e-5;

/// A model in its condition.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Condition {
    /// Model.
    pub model: &'static str,
    /// Set of parameters.
    pub set: &'static str,
    /// Canard; `None` if the model has none.
    pub canard: Option<&'static str>,
    /// Earth.
    pub earth: &'static str,
}

/// A model at the velocity and altitude of Table 2.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Vehicle {
    /// The condition.
    pub condition: Condition,
    /// Its trim.
    pub trim: Option<TrimPoint>,
    /// Poles and zeros at the trim.
    pub roots: Option<Roots>,
    /// Why one of them is missing.
    pub problem: Option<String>,
}

/// Poles and zeros of y = [V, γ], u = [δe, φ].
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Roots {
    /// Poles by rising frequency, in rad/s.
    pub poles: Vec<Root>,
    /// What each pole belongs to, by the participation of the states.
    pub pole_kinds: Vec<Kind>,
    /// Finite zeros by rising frequency, in rad/s.
    pub zeros: Vec<Root>,
    /// What each zero belongs to: one that decouples and lies on a pole of noise is that of the noise; pairs above 0.1 rad/s of
    /// a model with flexible states are flexible.
    pub zero_kinds: Vec<Kind>,
}

/// A trim in the units of Table 2.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct TrimPoint {
    /// Angle of attack, in deg.
    pub alpha_deg: f64,
    /// Fuel equivalence ratio.
    pub phi: f64,
    /// Elevator, in deg.
    pub delta_e_deg: f64,
    /// Deflections of the flexible modes.
    pub eta: Vec<f64>,
    /// Largest residual, in the unit of its row.
    pub residual_max: f64,
}

/// All models at the velocity and altitude of Table 2.
pub fn vehicles() -> Vec<Vehicle> {
    let mut vehicles = Vec::new();
    for earth in Earth::ALL {
        let of_com = com::Earth::from_name(earth.name()).unwrap_or(com::Earth::Flat);
        let condition = |model, set, canard: Option<Canard>| Condition {
            model,
            set,
            canard: canard.map(Canard::name),
            earth: earth.name(),
        };
        let mut parameters = ahv_fpm::NOMINAL;
        parameters.spherical_earth = f64::from(u8::from(earth == Earth::Spherical));
        let first_principles = condition("fpm", fpm_set(), None);
        vehicles.push(vehicle::<ahv_fpm::Model<f64>>(
            first_principles,
            &parameters,
        ));
        let [own, ..] = com::SETS;
        let (set, parameters) = (own.name, own.parameters.with_earth(of_com));
        let rigid = condition("com_rigid", set, None);
        vehicles.push(vehicle::<com_rigid::Model<f64>>(rigid, &parameters));
        let flexible = condition("com", set, None);
        vehicles.push(vehicle::<com::Model<f64>>(flexible, &parameters));
        for set in dcom::SETS {
            for canard in [Canard::None, Canard::Slaved] {
                let parameters = set.parameters.with_earth(earth).with_canard(canard);
                let of = |model| condition(model, set.name, Some(canard));
                vehicles.push(vehicle::<dcom::Model<f64>>(of("dcom"), &parameters));
                vehicles.push(vehicle::<sdcom::Model<f64>>(of("sdcom"), &parameters));
            }
        }
    }
    vehicles
}

/// The set of the first-principles model.
fn fpm_set() -> &'static str {
    let own = <ahv_fpm::Model<f64> as GeneratedModel>::SETS.first();
    own.map_or("", |set| set.name)
}

fn vehicle<M: GeneratedModel>(condition: Condition, parameters: &M::ParametersOf<f64>) -> Vehicle {
    let flight = SteadyState::new(&M::TRIM)
        .with("velocity", TABLE_2.velocity)
        .with("altitude", TABLE_2.altitude);
    let model = &M::with_parameters(parameters);
    let mut vehicle = Vehicle {
        condition,
        trim: None,
        roots: None,
        problem: None,
    };
    let found = trim(model, &flight).map_err(|error| error.to_string());
    let roots = found.and_then(|trim| {
        vehicle.trim = Some(TrimPoint {
            alpha_deg: named(&trim.state, "alpha").to_degrees(),
            phi: named(&trim.input, "phi"),
            delta_e_deg: named(&trim.input, "delta_e").to_degrees(),
            eta: deflections::<M>(parameters, &trim),
            residual_max: trim.residual_max,
        });
        roots_at(model, &trim)
    });
    match roots {
        Ok(roots) => vehicle.roots = Some(roots),
        Err(problem) => vehicle.problem = Some(problem),
    }
    vehicle
}

fn roots_at<M: GeneratedModel>(
    model: &M,
    trim: &Trim<M::State, M::Input>,
) -> Result<Roots, String> {
    let system = linearize(
        model,
        &trim.state,
        &trim.input,
        M::DEFAULT_INPUTS,
        M::DEFAULT_OUTPUTS,
    );
    let system = system.map_err(|error| error.to_string())?;
    let poles = poles(&system, M::MODES).map_err(|error| error.to_string())?;
    let zeros = zeros(&system).map_err(|error| error.to_string())?;
    let pole_kinds: Vec<Kind> = poles.iter().map(kind_of_pole).collect();
    let poles: Vec<Root> = poles
        .iter()
        .map(|pole| [pole.value.re, pole.value.im])
        .collect();
    let flexible = pole_kinds.contains(&Kind::Flexible);
    let zero_kinds = zeros.finite.iter().map(|zero| {
        let root = [zero.value.re, zero.value.im];
        let mut noise = poles.iter().zip(&pole_kinds);
        let cancels = |(&pole, &kind): (&Root, &Kind)| {
            kind == Kind::Noise && relative_distance(pole, root) < CANCELLED
        };
        if zero.decoupling.is_some() && noise.any(cancels) {
            Kind::Noise
        } else if flexible && root[1].abs() > NOTHING && size(root) > SLOW {
            Kind::Flexible
        } else {
            Kind::Rigid
        }
    });
    let zero_kinds = zero_kinds.collect();
    Ok(Roots {
        poles,
        pole_kinds,
        zeros: zeros
            .finite
            .iter()
            .map(|zero| [zero.value.re, zero.value.im])
            .collect(),
        zero_kinds,
    })
}

fn kind_of_pole(pole: &Pole) -> Kind {
    let is = |name: &str| pole.mode.is_some_and(|mode| mode.starts_with(name));
    match pole.mode {
        None => Kind::of_place([pole.value.re, pole.value.im]),
        _ if is("flexible") => Kind::Flexible,
        _ if is("coloured noise") || is("gust") => Kind::Noise,
        _ => Kind::Rigid,
    }
}

/// The deflections of the flexible modes: states, or what follows the rigid body.
fn deflections<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    trim: &Trim<M::State, M::Input>,
) -> Vec<f64> {
    let outputs = M::outputs(&M::generic(parameters), &trim.state, &trim.input);
    let value = |name: &&str| {
        let state = M::State::index_of(name).and_then(|index| trim.state.get(index));
        state.or_else(|| outputs.get(M::OutputsOf::<f64>::index_of(name)?))
    };
    let names = M::TRIM.shown.iter().filter(|name| name.starts_with("eta_"));
    names.filter_map(value).collect()
}

/// A component that every vehicle has.
fn named<V: Vector<f64>>(vector: &V, name: &str) -> f64 {
    V::index_of(name)
        .and_then(|index| vector.get(index))
        .unwrap_or_default()
}
