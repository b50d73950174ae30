//! What a change does over the whole validity box of the new table: which flight conditions trim, and how far quantities move.

use ahv_analysis::trim::Trim;
use ahv_core::Bounds;
use serde::Serialize;

use crate::vehicle::Vehicle;

/// Trims along each of the two first given states.
const TRIMS: u32 = 8;

/// Points of the box at which the outputs are compared.
const POINTS: u32 = 10_000;

/// Change, over the largest magnitude, up to which an output is the same but for rounding.
const SAME: f64 = 1e-12;

/// What is compared over the box.
#[derive(Default, Serialize)]
pub(super) struct WholeBox {
    /// Of a model of which two states are given.
    pub(super) trims: Option<Trims>,
    /// The outputs that change, such as forces and moments.
    pub(super) outputs: Vec<Farthest>,
    /// Points at which they were compared.
    pub(super) points: u32,
}

/// Trims at a grid over the first two given states, in the box of the new table.
#[derive(Serialize)]
pub(super) struct Trims {
    /// The two states.
    pub(super) states: [&'static str; 2],
    /// Points of the grid.
    pub(super) points: usize,
    /// How many trim with each table.
    pub(super) old: usize,
    pub(super) new: usize,
    /// Those that trim with the new table alone, and with the old one alone.
    pub(super) gained: usize,
    pub(super) lost: usize,
    /// The largest change of each quantity among those that trim with both.
    pub(super) changes: Vec<Farthest>,
    /// Of each point its place, and which tables trim there.
    #[serde(skip)]
    pub(super) cells: Vec<([f64; 2], [bool; 2])>,
}

/// The largest change of a quantity.
#[derive(Serialize)]
pub(super) struct Farthest {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) old: f64,
    pub(super) new: f64,
    /// Of trims: where.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) at: Option<[f64; 2]>,
    /// The change over the largest magnitude that the old quantity has at these points; none where that is 0.
    pub(super) share: Option<f64>,
}

/// The largest change so far, and the largest magnitude.
#[derive(Clone, Copy, Default)]
struct Largest {
    values: Option<([f64; 2], Option<[f64; 2]>)>,
    magnitude: f64,
}

impl Largest {
    fn see(&mut self, old: f64, new: f64, at: Option<[f64; 2]>) {
        if !(old.is_finite() && new.is_finite()) {
            return;
        }
        self.magnitude = self.magnitude.max(old.abs());
        let so_far = self.values.map_or(0.0, |([old, new], _)| (new - old).abs());
        if (new - old).abs() > so_far {
            self.values = Some(([old, new], at));
        }
    }

    fn farthest(self, name: &'static str, unit: &'static str) -> Option<Farthest> {
        let ([old, new], at) = self.values?;
        let change = (new - old).abs();
        (change > SAME * self.magnitude).then_some(Farthest {
            name,
            unit,
            old,
            new,
            at,
            share: Some(change / self.magnitude).filter(|it| it.is_finite()),
        })
    }
}

/// Compares the vehicles of the old and the new table.
pub(super) fn compare(vehicles: &[Vehicle; 2]) -> WholeBox {
    WholeBox {
        trims: trims(vehicles),
        outputs: outputs(vehicles),
        points: POINTS,
    }
}

fn interval(vehicle: &Vehicle, name: &str) -> Option<Bounds> {
    let index = vehicle.states.index_of(name)?;
    let bounds = vehicle.state_bounds.get(index).copied()?;
    (bounds.min.is_finite() && bounds.max.is_finite()).then_some(bounds)
}

fn trims(vehicles: &[Vehicle; 2]) -> Option<Trims> {
    let [old, new] = vehicles;
    let problem = new.model.trim_problem();
    let mut given = problem
        .given
        .iter()
        .filter_map(|it| Some((it.name, interval(new, it.name)?)));
    let axes = [given.next()?, given.next()?];
    let flights = [old, new].map(Vehicle::steady_within);
    let mut found = Trims {
        states: axes.map(|it| it.0),
        points: 0,
        old: 0,
        new: 0,
        gained: 0,
        lost: 0,
        changes: Vec::new(),
        cells: Vec::new(),
    };
    let mut largest = vec![Largest::default(); problem.shown.len()];
    for index in 0..TRIMS * TRIMS {
        let at = [index % TRIMS, index / TRIMS];
        let at = [0, 1].map(|axis: usize| {
            let share = f64::from(at[axis]) / f64::from(TRIMS - 1);
            let Bounds { min, max } = axes[axis].1;
            min * (1.0 - share) + max * share
        });
        let [before, after] = [0, 1].map(|side: usize| {
            let flight = flights[side].clone();
            let flight = flight.with(axes[0].0, at[0]).with(axes[1].0, at[1]);
            let vehicle = &vehicles[side];
            vehicle.model.trim(&vehicle.parameters, &flight).ok()
        });
        found.points += 1;
        found.old += usize::from(before.is_some());
        found.new += usize::from(after.is_some());
        found.gained += usize::from(before.is_none() && after.is_some());
        found.lost += usize::from(before.is_some() && after.is_none());
        found.cells.push((at, [before.is_some(), after.is_some()]));
        let (Some(before), Some(after)) = (before, after) else {
            continue;
        };
        for (largest, name) in largest.iter_mut().zip(problem.shown) {
            let of = |vehicle: &Vehicle, trim: &Trim<Vec<f64>, Vec<f64>>| {
                let value = vehicle.value(name, &trim.state, &trim.input);
                value.unwrap_or(f64::NAN)
            };
            largest.see(of(old, &before), of(new, &after), Some(at));
        }
    }
    let named = largest.into_iter().zip(problem.shown);
    let changes = named.filter_map(|(it, name)| it.farthest(name, new.unit(name)));
    found.changes = changes.collect();
    Some(found)
}

fn outputs([old, new]: &[Vehicle; 2]) -> Vec<Farthest> {
    let points = Points::new(new.states.len() + new.inputs.len());
    let bounds: Vec<Bounds> = new
        .state_bounds
        .iter()
        .chain(&new.input_bounds)
        .copied()
        .collect();
    let mut largest = vec![Largest::default(); new.outputs.len()];
    for index in 1..=POINTS {
        let place = bounds
            .iter()
            .enumerate()
            .map(|(axis, &Bounds { min, max })| {
                let share = points.share(axis, index);
                match min.is_finite() && max.is_finite() {
                    true => min * (1.0 - share) + max * share,
                    // What has no interval has nothing to be in.
                    false => 0.0,
                }
            });
        let place: Vec<f64> = place.collect();
        let (x, u) = place.split_at(new.states.len());
        let [before, after] = [old, new].map(|it| it.model.output_values(&it.parameters, x, u));
        for (largest, (&old, &new)) in largest.iter_mut().zip(before.iter().zip(&after)) {
            largest.see(old, new, None);
        }
    }
    let named = largest.into_iter().zip(new.outputs.iter());
    named
        .filter_map(|(it, (name, unit))| it.farthest(name, unit))
        .collect()
}

/// Points that fill a box evenly, the same each time (Roberts 2018), a third of each coordinate at an end: polynomials are largest
/// there.
struct Points {
    steps: Vec<f64>,
}

impl Points {
    fn new(axes: usize) -> Self {
        // The root of g^(n + 1) = g + 1.
        let power = 1.0 / (axes as f64 + 1.0);
        let root = (0..60).fold(1.5_f64, |g, _| (1.0 + g).powf(power));
        let steps = (1..=axes).map(|axis| root.powf(-(axis as f64)));
        Self {
            steps: steps.collect(),
        }
    }

    fn share(&self, axis: usize, index: u32) -> f64 {
        let step = self.steps.get(axis).copied().unwrap_or(0.0);
        let place = (0.5 + f64::from(index) * step).fract();
        (1.5 * place - 0.25).clamp(0.0, 1.0)
    }
}
