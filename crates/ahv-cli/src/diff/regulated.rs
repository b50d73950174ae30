//! The old gains on the vehicle of the new table: gain and phase margins of each loop.

use ahv_analysis::margins::{Margin, margins};
use nalgebra::DMatrix;
use serde::Serialize;

use super::effect::{Steady, said};
use crate::gains::Gains;
use crate::lqr;
use crate::vehicle::Vehicle;

/// The loops of the regulator that `ahv lqr` designs for the old table.
#[derive(Serialize)]
pub(super) struct Regulated {
    pub(super) loops: Vec<Opened>,
    /// Why there are none.
    pub(super) missing: Option<String>,
}

/// The loop that is opened at an input.
#[derive(Serialize)]
pub(super) struct Opened {
    pub(super) input: String,
    pub(super) old: Side,
    pub(super) new: Side,
}

/// Its margins; what is null has no bound.
#[derive(Serialize)]
pub(super) struct Side {
    /// The factor of the gain below which the loop is unstable.
    pub(super) least_gain: Option<f64>,
    /// The factor above which it is unstable.
    pub(super) most_gain: Option<f64>,
    /// In deg.
    pub(super) phase: Option<f64>,
}

impl Regulated {
    /// No loops, and why.
    pub(super) fn without(why: String) -> Self {
        Self {
            loops: Vec::new(),
            missing: Some(why),
        }
    }
}

/// The gains for a vehicle; in words why there are none.
pub(super) fn gains(vehicle: &Vehicle, steady: &Steady) -> Result<Gains, String> {
    lqr::customary(vehicle, &steady.flight, &steady.trim).map_err(said)
}

/// Of both vehicles with the gains of the old one.
pub(super) fn compare(
    [old, new]: &[Vehicle; 2],
    [before, after]: &[Steady; 2],
    gains: &Gains,
) -> Regulated {
    let sides = [("old", old, before), ("new", new, after)].map(|(which, vehicle, steady)| {
        of(vehicle, steady, gains)
            .map_err(|why| format!("the old gains with the {which} table: {why}"))
    });
    match sides {
        [Ok(old), Ok(new)] => {
            let loops = gains.inputs.iter().zip(old.iter().zip(&new));
            let opened = loops.map(|(input, (old, new))| Opened {
                input: input.clone(),
                old: side(old),
                new: side(new),
            });
            Regulated {
                loops: opened.collect(),
                missing: None,
            }
        }
        [Err(why), _] | [_, Err(why)] => Regulated::without(why),
    }
}

fn of(vehicle: &Vehicle, steady: &Steady, gains: &Gains) -> Result<Vec<Margin>, String> {
    let point = (steady.trim.state.as_slice(), steady.trim.input.as_slice());
    let system = vehicle
        .model
        .linearize(&vehicle.parameters, point, &gains.inputs, &[]);
    let system = system.map_err(|error| error.to_string())?;
    let entry = |row: usize, column: usize| {
        let row = gains.gain.get(row);
        row.and_then(|row| row.get(column)).copied().unwrap_or(0.0)
    };
    let gain = DMatrix::from_fn(system.b.ncols(), system.a.nrows(), entry);
    margins(&system.a, &system.b, &gain).map_err(|error| error.to_string())
}

fn side(margin: &Margin) -> Side {
    Side {
        least_gain: margin.least_gain,
        most_gain: margin.most_gain,
        phase: margin.phase.map(f64::to_degrees),
    }
}
