//! What a change of a table does to a model: its trim and its poles.

use std::path::Path;

use ahv_analysis::erased::AnyModel;
use ahv_analysis::poles::{Pole, damping, frequency, poles};
use serde::Serialize;

use crate::failure::Failure;
use crate::vehicle::VehicleArgs;

/// A model before and after.
#[derive(Serialize)]
pub(super) struct Effect {
    pub(super) model: &'static str,
    /// The default flight condition.
    pub(super) place: String,
    pub(super) trim: Vec<Trimmed>,
    pub(super) poles: Vec<Moved>,
    /// Why there is no more than that.
    pub(super) missing: Option<String>,
}

/// A state, an input or another quantity of the trim.
#[derive(Serialize)]
pub(super) struct Trimmed {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) old: f64,
    pub(super) new: f64,
}

/// A pole; of a pair the upper one.
#[derive(Serialize)]
pub(super) struct Moved {
    /// Its mode.
    pub(super) mode: Option<&'static str>,
    pub(super) old: Root,
    pub(super) new: Root,
}

/// Real and imaginary part, natural frequency in rad/s or 1/s, damping ratio.
#[derive(Clone, Copy, Serialize)]
pub(super) struct Root {
    pub(super) re: f64,
    pub(super) im: f64,
    pub(super) frequency: f64,
    pub(super) damping: f64,
}

/// A model with one of the tables, about its trim.
struct Steady {
    place: String,
    values: Vec<(&'static str, &'static str, f64)>,
    poles: Vec<Pole>,
}

impl Effect {
    /// Of the tables at two paths on a model.
    pub(super) fn new(model: &'static dyn AnyModel, old: &Path, new: &Path) -> Self {
        let mut effect = Self {
            model: model.name(),
            place: String::new(),
            trim: Vec::new(),
            poles: Vec::new(),
            missing: None,
        };
        let steady = [("old", old), ("new", new)].map(|(which, path)| {
            steady(model, path).map_err(|failure| format!("with the {which} table: {failure}"))
        });
        match steady {
            [Ok(old), Ok(new)] => {
                effect.compare(&old, &new);
                effect.place = new.place;
            }
            [Err(missing), _] | [_, Err(missing)] => effect.missing = Some(missing),
        }
        effect
    }

    fn compare(&mut self, old: &Steady, new: &Steady) {
        let values = old.values.iter().zip(&new.values);
        self.trim = values
            .map(|(&(name, unit, old), &(_, _, new))| Trimmed {
                name,
                unit,
                old,
                new,
            })
            .collect();
        let [before, after] = [old, new].map(|it| upper(&it.poles));
        if before.len() != after.len() {
            let message = format!("{} poles and pairs became {}", before.len(), after.len());
            self.missing = Some(message);
            return;
        }
        let moved = before.iter().zip(&after);
        let moved = moved.map(|(old, new)| Moved {
            mode: new.mode,
            old: root(old),
            new: root(new),
        });
        self.poles = moved.collect();
    }
}

/// Real poles and the upper ones of pairs, mode by mode: a mode that overtakes another is not taken for it.
fn upper(poles: &[Pole]) -> Vec<Pole> {
    let mut poles: Vec<Pole> = poles
        .iter()
        .filter(|it| it.value.im >= 0.0)
        .copied()
        .collect();
    poles.sort_by_key(|it| it.mode);
    poles
}

fn root(pole: &Pole) -> Root {
    Root {
        re: pole.value.re,
        im: pole.value.im,
        frequency: frequency(pole.value),
        damping: damping(pole.value),
    }
}

/// The model about its trim; in words why not.
fn steady(model: &'static dyn AnyModel, path: &Path) -> Result<Steady, String> {
    let said = |failure: Failure| match failure {
        Failure::Request(why) | Failure::Numeric(why) | Failure::Interrupted(why) => why,
    };
    let vehicle = VehicleArgs::of(model, path).vehicle().map_err(said)?;
    let flight = vehicle.steady();
    let trim = vehicle.trim(&flight).map_err(said)?;
    let point = (trim.state.as_slice(), trim.input.as_slice());
    let system = vehicle.linear(point, &[], &[]).map_err(said)?;
    let shown = model.trim_problem().shown.iter();
    let values = shown.filter_map(|name| {
        let value = vehicle.value(name, &trim.state, &trim.input)?;
        Some((*name, vehicle.unit(name), value))
    });
    Ok(Steady {
        place: vehicle.at(&flight),
        values: values.collect(),
        poles: poles(&system, model.modes()).map_err(|error| error.to_string())?,
    })
}
