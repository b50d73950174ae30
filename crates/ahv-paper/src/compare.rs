//! The first-principles model beside the published curve fits of the COM: axial force, normal force and pitching moment.
//!
//! Bookkeepings of thrust differ, so lift, drag and thrust are compared as what they add up to in body axes.

use ahv_core::{GeneratedModel, Vector};
use ahv_fpm::{Fault, Surface};
use ahv_models::com;

use crate::reproduce::printed::TABLE_2;

/// Angles of attack, in deg; elevator, in deg; fuel equivalence ratios: the box of the comparison.
pub const ALPHAS: [f64; 7] = [-1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
/// Elevator deflections, in deg.
pub const ELEVATORS: [f64; 4] = [0.0, 5.0, 10.0, 15.0];
/// Fuel equivalence ratios.
pub const RATIOS: [f64; 5] = [0.1, 0.2, 0.3, 0.4, 0.5];

/// What is compared: names and units.
pub const COMPARED: [(&str, &str); 3] = [
    ("axial force", "lb/ft"),
    ("normal force", "lb/ft"),
    ("pitching moment", "lb"),
];

/// A point of the box, with what is compared of both models.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Point {
    /// Angle of attack, in deg.
    pub alpha_deg: f64,
    /// Elevator, in deg.
    pub delta_e_deg: f64,
    /// Fuel equivalence ratio.
    pub phi: f64,
    /// Of the first-principles model, in the order of [`COMPARED`].
    pub fpm: [f64; 3],
    /// Of the COM.
    pub com: [f64; 3],
}

/// How far one quantity is off over the box.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Deviation {
    /// Root mean square of the difference.
    pub difference: f64,
    /// Root mean square of the COM's.
    pub size: f64,
    /// Mean of the difference.
    pub mean: f64,
    /// Root mean square of the difference less its mean: what is left if only a constant is off.
    pub rest: f64,
    /// Mean slope by α, φ and δe of the first-principles model: by a change over the box.
    pub fpm_changes: [f64; 3],
    /// The same of the COM.
    pub com_changes: [f64; 3],
}

/// Both models over the box, at velocity and altitude of Table 2, rigid.
///
/// # Errors
///
/// [`Fault`] where the first-principles model has no flow.
pub fn points() -> Result<Vec<Point>, Fault> {
    points_of(&ahv_fpm::NOMINAL, true)
}

/// A change of the geometry table that is tried as the reason of a deviation.
pub struct Variation {
    /// What is changed.
    pub name: &'static str,
    change: fn(&mut ahv_fpm::Parameters<f64>),
    /// Whether the stream pushes the nose down where it turns at the inlet.
    turning: bool,
}

impl Variation {
    const fn new(name: &'static str, change: fn(&mut ahv_fpm::Parameters<f64>)) -> Self {
        Self {
            name,
            change,
            turning: true,
        }
    }

    /// Both models over the box, the first-principles model with the change.
    ///
    /// # Errors
    ///
    /// [`Fault`] where it has no flow.
    pub fn points(&self) -> Result<Vec<Point>, Fault> {
        let mut parameters = ahv_fpm::NOMINAL;
        (self.change)(&mut parameters);
        points_of(&parameters, self.turning)
    }
}

/// What was tried where a deviation exceeds 25 %. The table keeps the quoted numbers.
pub const VARIATIONS: [Variation; 8] = [
    Variation::new("as quoted", |_| {}),
    Variation::new("combustion efficiency 0.65", |p| p.eta_c = 0.65),
    Variation::new("inlet 2.5 ft high", |p| p.h_i = 2.5),
    Variation::new("exhaust 7.5 ft below the nose", |p| p.z_e = 7.5),
    Variation::new("0.86 of the elevator", |p| p.s_e *= 0.86),
    Variation::new("exhaust at 7.5 ft, 0.86 of the elevator", |p| {
        p.z_e = 7.5;
        p.s_e *= 0.86;
    }),
    Variation::new("nozzle area ratio 4", |p| p.a_n = 4.0),
    Variation {
        name: "no normal force of the turn at the inlet",
        change: |_| {},
        turning: false,
    },
];

/// The points for these parameters, without the normal force of the inlet unless it is `turning` the stream.
fn points_of(vehicle: &ahv_fpm::Parameters<f64>, turning: bool) -> Result<Vec<Point>, Fault> {
    let fpm = ahv_fpm::Model::new(vehicle);
    let parameters = com::NOMINAL;
    let com_model = <com::Model<f64> as GeneratedModel>::generic(&parameters);
    let mut points = Vec::new();
    for phi in RATIOS {
        for delta_e_deg in ELEVATORS {
            for alpha_deg in ALPHAS {
                let (alpha, delta_e) = (alpha_deg.to_radians(), delta_e_deg.to_radians());
                let rest = ahv_fpm::State::splat(0.0);
                let (velocity, altitude) = (TABLE_2.velocity, TABLE_2.altitude);
                let x = ahv_fpm::State {
                    velocity,
                    altitude,
                    alpha,
                    ..rest
                };
                let mut flow = fpm.forces(&x, &ahv_fpm::Input { phi, delta_e })?;
                if !turning {
                    let inlet = &mut flow.loads[Surface::Inlet as usize];
                    inlet.moment -= (vehicle.x_cm - vehicle.l_f) * inlet.normal;
                    inlet.normal = 0.0;
                }
                let total = flow.total();
                let x = com::State {
                    velocity,
                    altitude,
                    alpha,
                    ..com::State::splat(0.0)
                };
                let it = com::Model::outputs(&com_model, &x, &com::Input { phi, delta_e });
                let (sin, cos) = alpha.sin_cos();
                let axial = it.thrust - it.drag * cos + it.lift * sin;
                let normal = it.lift * cos + it.drag * sin;
                points.push(Point {
                    alpha_deg,
                    delta_e_deg,
                    phi,
                    fpm: [total.axial, total.normal, total.moment],
                    com: [axial, normal, it.pitching_moment],
                });
            }
        }
    }
    Ok(points)
}

/// The deviations over some points, in the order of [`COMPARED`].
pub fn deviations(points: &[Point]) -> [Deviation; 3] {
    std::array::from_fn(|index| {
        let count = points.len() as f64;
        let differences = || points.iter().map(|it| it.fpm[index] - it.com[index]);
        let mean = differences().sum::<f64>() / count;
        let rms = |values: &mut dyn Iterator<Item = f64>| {
            (values.map(|it| it * it).sum::<f64>() / count).sqrt()
        };
        Deviation {
            difference: rms(&mut differences()),
            size: rms(&mut points.iter().map(|it| it.com[index])),
            mean,
            rest: rms(&mut differences().map(|it| it - mean)),
            fpm_changes: changes(points, |it| it.fpm[index]),
            com_changes: changes(points, |it| it.com[index]),
        }
    })
}

/// By how much a value changes over the box with α, φ and δe, by a straight line each, the others held.
fn changes(points: &[Point], value: impl Fn(&Point) -> f64) -> [f64; 3] {
    let variables: [fn(&Point) -> f64; 3] = [|it| it.alpha_deg, |it| it.phi, |it| it.delta_e_deg];
    // The grid is full, so that its variables are uncorrelated.
    variables.map(|variable| {
        let count = points.len() as f64;
        let middle = points.iter().map(variable).sum::<f64>() / count;
        let away = |it: &Point| variable(it) - middle;
        let [low, high] = points
            .iter()
            .map(variable)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| {
                [low.min(it), high.max(it)]
            });
        let square: f64 = points.iter().map(|it| away(it) * away(it)).sum();
        let product: f64 = points.iter().map(|it| away(it) * value(it)).sum();
        product / square * (high - low)
    })
}
