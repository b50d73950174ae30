//! The largest magnitude of a function over a box, by points spread evenly, corners, and refinement.
//!
//! Nothing here is random and nothing depends on the platform: a page of the documentation has the same bits everywhere.

use ahv_core::{Lanes, Real};

use crate::evaluate::Tape;

/// A box: bounds of each variable.
pub(super) type Bounds = [(f64, f64)];

/// Points of the low-discrepancy sequence.
const POINTS: u32 = 20_000;
/// With more variables than this only some of the corners are visited.
const CORNER_VARIABLES: usize = 12;
/// Starts of the refinement.
const STARTS: usize = 3;
/// Rounds of the refinement, each through all variables.
const ROUNDS: usize = 4;
/// Points that are evaluated at once.
const LANES: usize = 8;
/// Values of a variable that a round tries before it looks closer.
const GRID: u32 = 16;

/// Where a magnitude is largest, and the value there with its sign.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Largest {
    pub(super) value: f64,
    pub(super) point: Vec<f64>,
}

/// The largest magnitudes of each output of a tape over a box, whose bounds are in the order of the tape's leaves.
pub(super) fn largest(tape: &Tape, outputs: usize, bounds: &Bounds) -> Vec<Largest> {
    let mut survey = Survey {
        tape,
        best: vec![Vec::new(); outputs],
        points: vec![Lanes::ZERO; bounds.len()],
        waiting: 0,
        scratch: Vec::new(),
        values: Vec::new(),
    };
    spread(bounds, &mut |point| survey.visit(point));
    corners(bounds, &mut |point| survey.visit(point));
    survey.evaluate();
    let refined = |(output, starts): (usize, Vec<Largest>)| {
        let alone = tape.only(output);
        let refined = starts
            .into_iter()
            .map(|start| refine(&alone, bounds, start));
        let found = refined.reduce(|a, b| if b.value.abs() > a.value.abs() { b } else { a });
        found.unwrap_or_else(|| Largest {
            value: f64::NAN,
            point: bounds.iter().map(|&range| between(range, 0.5)).collect(),
        })
    };
    survey.best.into_iter().enumerate().map(refined).collect()
}

/// The largest few magnitudes of each output among points, which are evaluated as soon as they fill the lanes.
struct Survey<'a> {
    tape: &'a Tape,
    best: Vec<Vec<Largest>>,
    /// A point a lane, a variable an element.
    points: Vec<Lanes<f64, LANES>>,
    /// Lanes that hold points.
    waiting: usize,
    scratch: Vec<Lanes<f64, LANES>>,
    values: Vec<Lanes<f64, LANES>>,
}

impl Survey<'_> {
    fn visit(&mut self, point: &[f64]) {
        for (lanes, &coordinate) in self.points.iter_mut().zip(point) {
            lanes.0[self.waiting] = coordinate;
        }
        self.waiting += 1;
        if self.waiting == LANES {
            self.evaluate();
        }
    }

    fn evaluate(&mut self) {
        self.tape
            .run(&self.points, &mut self.scratch, &mut self.values);
        for lane in 0..self.waiting {
            let point = || self.points.iter().map(|lanes| lanes.0[lane]).collect();
            for (found, values) in self.best.iter_mut().zip(&self.values) {
                keep(found, values.0[lane], point);
            }
        }
        self.waiting = 0;
    }
}

/// Keeps the largest few.
fn keep(found: &mut Vec<Largest>, value: f64, point: impl Fn() -> Vec<f64>) {
    let size = value.abs();
    if !size.is_finite() || (found.len() == STARTS && size <= found[STARTS - 1].value.abs()) {
        return;
    }
    found.truncate(STARTS - 1);
    let position = found.partition_point(|known| known.value.abs() >= size);
    found.insert(
        position,
        Largest {
            value,
            point: point(),
        },
    );
}

/// Which variables move an output at all, seen from a point: the others say nothing about where it is largest.
pub(super) fn moving(tape: &Tape, output: usize, bounds: &Bounds, at: &Largest) -> Vec<bool> {
    let tape = tape.only(output);
    let (mut scratch, mut values) = (Vec::new(), Vec::new());
    let mut moves = |position: usize, share: f64| {
        let mut point = at.point.clone();
        point[position] = between(bounds[position], share);
        tape.run(&point, &mut scratch, &mut values);
        let value = values.first().copied().unwrap_or(f64::NAN);
        // What rounding leaves of terms that cancel is not a dependence.
        (value - at.value).abs() > 1e-9 * at.value.abs()
    };
    (0..bounds.len())
        .map(|position| [0.0, 0.4, 1.0].iter().any(|&share| moves(position, share)))
        .collect()
}

fn between((min, max): (f64, f64), share: f64) -> f64 {
    min + (max - min) * share
}

/// Points of an additive recurrence: the fractional parts of multiples of square roots of primes.
fn spread(bounds: &Bounds, visit: &mut impl FnMut(&[f64])) {
    let steps: Vec<f64> = primes(bounds.len())
        .into_iter()
        .map(|p| Real::sqrt(f64::from(p)).fract())
        .collect();
    let mut point = vec![0.0; bounds.len()];
    for n in 1..=POINTS {
        for ((coordinate, &step), &range) in point.iter_mut().zip(&steps).zip(bounds) {
            *coordinate = between(range, (0.5 + f64::from(n) * step).fract());
        }
        visit(&point);
    }
}

fn primes(count: usize) -> Vec<u32> {
    let mut found: Vec<u32> = Vec::with_capacity(count);
    let mut candidate = 2;
    while found.len() < count {
        if found.iter().all(|prime| candidate % prime != 0) {
            found.push(candidate);
        }
        candidate += 1;
    }
    found
}

/// The corners of the box; of a box of many variables, those of the first ones.
fn corners(bounds: &Bounds, visit: &mut impl FnMut(&[f64])) {
    let variables = bounds.len().min(CORNER_VARIABLES);
    let mut point: Vec<f64> = bounds.iter().map(|&range| between(range, 0.5)).collect();
    for corner in 0_u32..1 << variables {
        for (position, &(min, max)) in bounds.iter().take(variables).enumerate() {
            point[position] = if corner >> position & 1 == 0 {
                min
            } else {
                max
            };
        }
        visit(&point);
    }
}

/// Better points along one variable after the other.
fn refine(tape: &Tape, bounds: &Bounds, start: Largest) -> Largest {
    let (mut scratch, mut values) = (Vec::new(), Vec::new());
    let mut best = start;
    for _ in 0..ROUNDS {
        let before = best.value.abs();
        for (position, &range) in bounds.iter().enumerate() {
            if !tape.depends_on(position) {
                continue;
            }
            let mut tried = best.point.clone();
            let mut at = |coordinate: f64, best: &mut Largest| {
                tried[position] = coordinate;
                tape.run(&tried, &mut scratch, &mut values);
                let value = values.first().copied().unwrap_or(f64::NAN);
                if value.abs() > best.value.abs() {
                    *best = Largest {
                        value,
                        point: tried.clone(),
                    };
                }
            };
            for step in 0..=GRID {
                at(between(range, f64::from(step) / f64::from(GRID)), &mut best);
            }
            let mut width = (range.1 - range.0) / f64::from(GRID);
            for _ in 0..12 {
                width *= 0.5;
                let centre = best.point[position];
                at((centre - width).max(range.0), &mut best);
                at((centre + width).min(range.1), &mut best);
            }
        }
        if best.value.abs() <= before {
            break;
        }
    }
    best
}
