//! Tables 2 and 3, and Fig. 6: trims, poles and zeros of COM, DCOM and SDCOM.

use ahv_analysis::linearize::{PATH_INPUTS, PATH_OUTPUTS, linearize};
use ahv_analysis::parametric::Parametric;
use ahv_analysis::poles::{Mode, Pole, poles, zeros};
use ahv_analysis::trim::{SteadyFlight, Trim, trim};
use ahv_core::Vector;
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
        let [(set, parameters), ..] = com::SETS;
        let parameters = parameters.with_earth(of_com);
        let rigid = com_rigid::Model::with_parameters(&parameters);
        vehicles.push(vehicle(condition("com_rigid", set, None), &rigid));
        let model = com::Model::with_parameters(&parameters);
        vehicles.push(vehicle(condition("com", set, None), &model));
        for (set, parameters) in dcom::SETS {
            for canard in [Canard::None, Canard::Slaved] {
                let parameters = parameters.with_earth(earth).with_canard(canard);
                let model = dcom::Model::with_parameters(&parameters);
                vehicles.push(vehicle(condition("dcom", set, Some(canard)), &model));
                let model = sdcom::Model::with_parameters(&parameters);
                vehicles.push(vehicle(condition("sdcom", set, Some(canard)), &model));
            }
        }
    }
    vehicles
}

fn vehicle<M: Parametric>(condition: Condition, model: &M) -> Vehicle {
    let flight = SteadyFlight::new(TABLE_2.velocity, TABLE_2.altitude);
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
            eta: model.deflections(&trim.state, &trim.input),
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

fn roots_at<M: Parametric>(model: &M, trim: &Trim<M::State, M::Input>) -> Result<Roots, String> {
    let system = linearize(model, &trim.state, &trim.input, &PATH_INPUTS, &PATH_OUTPUTS);
    let system = system.map_err(|error| error.to_string())?;
    let poles = poles(&system).map_err(|error| error.to_string())?;
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
    match pole.mode {
        Some(Mode::Flexible(_)) => Kind::Flexible,
        Some(Mode::ColouredNoise(_) | Mode::Gust) => Kind::Noise,
        Some(Mode::ShortPeriod | Mode::Phugoid | Mode::Height) => Kind::Rigid,
        None => Kind::of_place([pole.value.re, pole.value.im]),
    }
}

/// A component that every vehicle has.
fn named<V: Vector<f64>>(vector: &V, name: &str) -> f64 {
    V::index_of(name)
        .and_then(|index| vector.get(index))
        .unwrap_or_default()
}
