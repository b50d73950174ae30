//! The numbers of a vehicle in trim that are followed from member to member.

use std::cmp::Ordering;

use nalgebra::Complex;

use super::matching::partners;
use super::solution::Solution;
use crate::poles::Pole;

/// What a number tells of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The trim: a component of state or input, or another quantity.
    Trim,
    /// A pole.
    Pole,
    /// A finite transmission zero.
    Zero,
}

/// Which part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// The number itself.
    Value,
    /// The real part.
    Real,
    /// The imaginary part, not negative.
    Imaginary,
}

/// A number of a vehicle in trim, in the units of its model; roots in 1/s and rad/s.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// What it tells of.
    pub kind: Kind,
    /// Name: of a state, an input or another quantity, of a mode, or `zero_1` … from right to left.
    pub name: String,
    /// Which part of a root.
    pub part: Part,
    /// Place in the list of poles or zeros that it is taken from.
    index: usize,
}

/// The quantities of `nominal`, the vehicle about which is drawn: of its trim those that are `shown`, and its roots, of a
/// pair the upper one.
pub(super) fn quantities(nominal: &Solution, shown: &[&str]) -> Vec<Quantity> {
    let trim = |name: &&str| Quantity {
        kind: Kind::Trim,
        name: (*name).to_owned(),
        part: Part::Value,
        index: 0,
    };
    let mut quantities: Vec<Quantity> = shown.iter().map(trim).collect();
    let poles = nominal
        .poles
        .iter()
        .enumerate()
        .map(|(index, pole)| (Kind::Pole, name(&nominal.poles, pole), index, pole.value));
    let mut zeros: Vec<(usize, Complex<f64>)> = nominal.zeros.iter().copied().enumerate().collect();
    zeros.sort_by(|(_, a), (_, b)| from_right(a, b));
    let zeros = zeros.into_iter().filter(|(_, zero)| zero.im >= 0.0);
    let zeros = zeros
        .enumerate()
        .map(|(rank, (index, zero))| (Kind::Zero, format!("zero_{}", rank + 1), index, zero));
    for (kind, name, index, root) in poles.chain(zeros).filter(|(.., root)| root.im >= 0.0) {
        let part = |part| Quantity {
            kind,
            name: name.clone(),
            part,
            index,
        };
        quantities.push(part(Part::Real));
        if root.im > 0.0 {
            quantities.push(part(Part::Imaginary));
        }
    }
    quantities
}

/// Greater real parts first, of equal ones the greater imaginary part.
fn from_right(a: &Complex<f64>, b: &Complex<f64>) -> Ordering {
    b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im))
}

/// The poles of the mode of `pole`, from right to left.
fn of_its_mode<'a>(poles: &'a [Pole], pole: &Pole) -> Vec<&'a Pole> {
    let mut of_mode: Vec<&Pole> = poles.iter().filter(|it| it.mode == pole.mode).collect();
    of_mode.sort_by(|a, b| from_right(&a.value, &b.value));
    of_mode
}

/// The name of a pole: its mode, with a number where the mode has several real poles.
fn name(poles: &[Pole], pole: &Pole) -> String {
    let name = pole.mode.unwrap_or("unnamed").replace(' ', "_");
    let of_mode = of_its_mode(poles, pole);
    if pole.value.im != 0.0 || of_mode.len() == 1 {
        return name;
    }
    let rank = of_mode
        .iter()
        .position(|it| it.value == pole.value)
        .unwrap_or(0);
    format!("{name}_{}", rank + 1)
}

impl Quantity {
    /// Its value in a vehicle whose roots stand in the order of the nominal ones; `None` if it has no such root.
    pub(super) fn value(&self, solution: &Ordered<'_>) -> Option<f64> {
        let Ordered {
            solution,
            poles,
            zeros,
        } = solution;
        let root = match self.kind {
            Kind::Trim => return solution.trim_value(&self.name),
            Kind::Pole => poles.as_ref()?.get(self.index)?,
            Kind::Zero => zeros.as_ref()?.get(self.index)?,
        };
        Some(match self.part {
            Part::Imaginary => root.im.abs(),
            _ => root.re,
        })
    }

    /// The same part of how the root at its place moves.
    pub(super) fn part_of(&self, slope: Complex<f64>) -> f64 {
        match self.part {
            Part::Imaginary => slope.im,
            _ => slope.re,
        }
    }

    /// Place in the list of poles or zeros.
    pub(super) const fn index(&self) -> usize {
        self.index
    }
}

/// A vehicle with its roots in the order of the nominal ones; `None` where there are more or fewer.
///
/// Poles correspond by mode, those of one mode from right to left; zeros such that the sum of the distances is least.
pub(super) struct Ordered<'a> {
    solution: &'a Solution,
    poles: Option<Vec<Complex<f64>>>,
    zeros: Option<Vec<Complex<f64>>>,
}

impl<'a> Ordered<'a> {
    /// The roots of `solution` in the order of those of `nominal`.
    pub(super) fn new(nominal: &Solution, solution: &'a Solution) -> Self {
        let zeros = || {
            let partners = partners(&nominal.zeros, &solution.zeros)?.into_iter();
            partners
                .map(|index| solution.zeros.get(index).copied())
                .collect()
        };
        let pole = |own: &Pole| {
            let (here, there) = (
                of_its_mode(&nominal.poles, own),
                of_its_mode(&solution.poles, own),
            );
            let rank = here.iter().position(|it| it.value == own.value)?;
            (here.len() == there.len()).then(|| there.get(rank).map(|it| it.value))?
        };
        Self {
            poles: nominal.poles.iter().map(pole).collect(),
            zeros: zeros(),
            solution,
        }
    }
}
