//! What a change of a table does to a model about its trim: trim, poles, zeros, slopes, margins.

use std::path::Path;

use ahv_analysis::erased::AnyModel;
use ahv_analysis::linearize::LinearSystem;
use ahv_analysis::poles::{Pole, damping, frequency, poles, zeros};
use ahv_analysis::trim::{SteadyState, Trim};
use nalgebra::{Complex, DMatrix};
use serde::Serialize;

use super::flown::{self, Flown};
use super::regulated::{self, Regulated};
use super::whole_box::{self, WholeBox};
use crate::failure::Failure;
use crate::vehicle::{Vehicle, VehicleArgs};

/// A model before and after.
#[derive(Serialize)]
pub(super) struct Effect {
    pub(super) model: &'static str,
    /// The default flight condition.
    pub(super) place: String,
    pub(super) trim: Vec<Trimmed>,
    pub(super) poles: Vec<Moved>,
    /// From the default inputs to the default outputs.
    pub(super) zeros: Roots,
    /// Those that change of the outputs with a unit, such as forces and moments, by the states.
    pub(super) slopes: Vec<Slope>,
    /// With the gains of the old table.
    pub(super) regulated: Option<Regulated>,
    #[serde(flatten)]
    pub(super) whole_box: WholeBox,
    /// With --flights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) flights: Option<Flown>,
    /// Why there is no trim, or no more than that.
    pub(super) missing: Option<String>,
    /// Of the states.
    #[serde(skip)]
    pub(super) units: Vec<(&'static str, &'static str)>,
}

/// Roots before and after, of pairs the upper ones.
#[derive(Default, Serialize)]
pub(super) struct Roots {
    pub(super) old: Vec<Root>,
    pub(super) new: Vec<Root>,
}

/// The derivative of an output by a state about the trim, with all else held.
#[derive(Serialize)]
pub(super) struct Slope {
    pub(super) output: &'static str,
    pub(super) state: &'static str,
    /// Of the output over that of the state.
    pub(super) unit: String,
    pub(super) old: f64,
    pub(super) new: f64,
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
pub(super) struct Steady {
    pub(super) flight: SteadyState,
    pub(super) trim: Trim<Vec<f64>, Vec<f64>>,
    /// Of all outputs with a unit.
    system: LinearSystem,
    values: Vec<(&'static str, &'static str, f64)>,
    poles: Vec<Pole>,
    zeros: Vec<Complex<f64>>,
}

/// What is asked for beside what is always compared.
pub(super) struct Asked {
    /// Flights of each table.
    pub(super) flights: Option<u64>,
}

impl Effect {
    /// Of the tables at two paths on a model.
    ///
    /// # Errors
    ///
    /// [`Failure::Interrupted`]
    pub(super) fn new(
        model: &'static dyn AnyModel,
        [old, new]: [&Path; 2],
        asked: &Asked,
    ) -> Result<Self, Failure> {
        let mut effect = Self {
            model: model.name(),
            place: String::new(),
            trim: Vec::new(),
            poles: Vec::new(),
            zeros: Roots::default(),
            slopes: Vec::new(),
            regulated: None,
            whole_box: WholeBox::default(),
            flights: None,
            missing: None,
            units: Vec::new(),
        };
        let vehicle = |path| VehicleArgs::of(model, path).vehicle().map_err(said);
        let with = |which: &str, why: String| format!("with the {which} table: {why}");
        let vehicles = match [("old", old), ("new", new)]
            .map(|(which, path)| vehicle(path).map_err(|why| with(which, why)))
        {
            [Ok(old), Ok(new)] => [old, new],
            [Err(missing), _] | [_, Err(missing)] => {
                effect.missing = Some(missing);
                return Ok(effect);
            }
        };
        effect.whole_box = whole_box::compare(&vehicles);
        let [old, new] = &vehicles;
        effect.units = new.states.iter().collect();
        let steady = [("old", old), ("new", new)]
            .map(|(which, vehicle)| steady(vehicle).map_err(|why| with(which, why)));
        match steady {
            [Ok(before), Ok(after)] => {
                let steady = [before, after];
                effect.compare(&steady[0], &steady[1]);
                effect.place = new.at(&steady[1].flight);
                effect.slopes = slopes(new, &steady);
                let gains = regulated::gains(old, &steady[0]);
                effect.regulated = Some(match &gains {
                    Ok(gains) => regulated::compare(&vehicles, &steady, gains),
                    Err(why) => Regulated::without(why.clone()),
                });
                if let Some(members) = asked.flights {
                    let gains = gains.ok();
                    effect.flights =
                        Some(flown::compare(&vehicles, &steady, gains.as_ref(), members)?);
                }
            }
            [Err(missing), _] | [_, Err(missing)] => effect.missing = Some(missing),
        }
        Ok(effect)
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
        self.zeros = Roots {
            old: upper_roots(&old.zeros),
            new: upper_roots(&new.zeros),
        };
        let [before, after] = [old, new].map(|it| upper(&it.poles));
        if before.len() != after.len() {
            let message = format!("{} poles and pairs became {}", before.len(), after.len());
            self.missing = Some(message);
            return;
        }
        let moved = before.iter().zip(&after);
        let moved = moved.map(|(old, new)| Moved {
            mode: new.mode,
            old: root(old.value),
            new: root(new.value),
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

fn root(value: Complex<f64>) -> Root {
    Root {
        re: value.re,
        im: value.im,
        frequency: frequency(value),
        damping: damping(value),
    }
}

/// Real roots and the upper ones of pairs.
fn upper_roots(roots: &[Complex<f64>]) -> Vec<Root> {
    let upper = roots.iter().filter(|it| it.im >= 0.0);
    upper.map(|&it| root(it)).collect()
}

/// A failure in words.
pub(super) fn said(failure: Failure) -> String {
    match failure {
        Failure::Request(why) | Failure::Numeric(why) | Failure::Interrupted(why) => why,
    }
}

/// The vehicle about its trim; in words why not.
fn steady(vehicle: &Vehicle) -> Result<Steady, String> {
    let model = vehicle.model;
    let flight = vehicle.steady_within();
    let trim = vehicle.trim(&flight).map_err(said)?;
    let point = (trim.state.as_slice(), trim.input.as_slice());
    let system = vehicle.linear(point, &[], &[]).map_err(said)?;
    let unreached = |error: &dyn std::fmt::Display| error.to_string();
    let found = zeros(&system).map_err(|error| unreached(&error))?;
    let poles = poles(&system, model.modes()).map_err(|error| unreached(&error))?;
    let outputs = vehicle.outputs.iter().filter(|(_, unit)| *unit != "1");
    let outputs: Vec<String> = outputs.map(|(name, _)| name.to_owned()).collect();
    let system = match outputs.is_empty() {
        // No names ask for the default ones.
        true => LinearSystem {
            outputs: Vec::new(),
            c: DMatrix::zeros(0, system.states.len()),
            ..system
        },
        false => vehicle.linear(point, &[], &outputs).map_err(said)?,
    };
    let shown = model.trim_problem().shown.iter();
    let values = shown.filter_map(|name| {
        let value = vehicle.value(name, &trim.state, &trim.input)?;
        Some((*name, vehicle.unit(name), value))
    });
    Ok(Steady {
        values: values.collect(),
        poles,
        zeros: found.finite.iter().map(|it| it.value).collect(),
        system,
        flight,
        trim,
    })
}

/// Change below which a slope is the same but for rounding, as a share of what the state with the largest effect on the output does over
/// its box.
const SAME: f64 = 1e-9;

fn slopes(vehicle: &Vehicle, [old, new]: &[Steady; 2]) -> Vec<Slope> {
    let mut found = Vec::new();
    let width = |column: usize| {
        let bounds = vehicle.state_bounds.get(column);
        let width = bounds.map_or(1.0, |it| it.max - it.min);
        if width.is_finite() { width } else { 1.0 }
    };
    for (row, &output) in new.system.outputs.iter().enumerate() {
        let effects = (0..new.system.states.len())
            .map(|column| new.system.c[(row, column)].abs() * width(column));
        let largest = effects.fold(0.0, f64::max);
        for (column, &state) in new.system.states.iter().enumerate() {
            let [before, after] = [old, new].map(|it| it.system.c[(row, column)]);
            if (after - before).abs() * width(column) <= SAME * largest {
                continue;
            }
            found.push(Slope {
                output,
                state,
                unit: match (vehicle.unit(output), vehicle.states.unit(state)) {
                    (unit, "1") => unit.to_owned(),
                    (unit, by) => format!("{unit} by {by}"),
                },
                old: before,
                new: after,
            });
        }
    }
    found
}
