//! What coefficients must obey.

use nalgebra::{DMatrix, DVector};

use crate::FitError;

/// What one coefficient must obey. Coefficients are numbered as the columns of their problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint {
    /// It has this value.
    Fixed(usize, f64),
    /// It is `factor` times another one.
    Tied {
        /// The coefficient.
        coefficient: usize,
        /// What it is a multiple of.
        other: usize,
        /// The factor.
        factor: f64,
    },
    /// It is 0 or above.
    NotNegative(usize),
    /// It is 0 or below.
    NotPositive(usize),
}

impl Constraint {
    /// The coefficients that it names.
    #[must_use]
    pub fn coefficients(&self) -> Vec<usize> {
        match *self {
            Self::Tied {
                coefficient, other, ..
            } => vec![coefficient, other],
            one => vec![one.coefficient()],
        }
    }

    /// The same on coefficients that have other numbers.
    #[must_use]
    pub fn renumbered(self, number: impl Fn(usize) -> usize) -> Self {
        match self {
            Self::Fixed(it, value) => Self::Fixed(number(it), value),
            Self::NotNegative(it) => Self::NotNegative(number(it)),
            Self::NotPositive(it) => Self::NotPositive(number(it)),
            Self::Tied {
                coefficient,
                other,
                factor,
            } => Self::Tied {
                coefficient: number(coefficient),
                other: number(other),
                factor,
            },
        }
    }

    /// The coefficient that it is about.
    pub(crate) fn coefficient(self) -> usize {
        match self {
            Self::Fixed(it, _) | Self::NotNegative(it) | Self::NotPositive(it) => it,
            Self::Tied { coefficient, .. } => coefficient,
        }
    }
}

/// Coefficients as a map of those that are free: β = M t + b, where some t must not be negative.
pub(crate) struct Map {
    pub(crate) matrix: DMatrix<f64>,
    pub(crate) offset: DVector<f64>,
    /// For each free one whether it must not be negative.
    pub(crate) signed: Vec<bool>,
}

impl Map {
    /// That of some constraints on so many coefficients. A coefficient with a sign of below is the negative of its free one.
    pub(crate) fn new(count: usize, constraints: &[Constraint]) -> Result<Self, FitError> {
        let mut of: Vec<Option<Constraint>> = vec![None; count];
        for &it in constraints {
            let slot = &mut of[it.coefficient()];
            if slot.is_some() {
                return Err(FitError::Contradiction(it.coefficient()));
            }
            *slot = Some(it);
        }
        let is_free = |it: &usize| {
            !matches!(
                of[*it],
                Some(Constraint::Fixed(..) | Constraint::Tied { .. })
            )
        };
        let free: Vec<usize> = (0..count).filter(is_free).collect();
        let mut map = Self {
            matrix: DMatrix::zeros(count, free.len()),
            offset: DVector::zeros(count),
            signed: Vec::new(),
        };
        for (column, &row) in free.iter().enumerate() {
            let negative = matches!(of[row], Some(Constraint::NotPositive(_)));
            map.matrix[(row, column)] = if negative { -1.0 } else { 1.0 };
            map.signed.push(of[row].is_some());
        }
        for constraint in of.iter().flatten() {
            match *constraint {
                Constraint::Fixed(row, value) => map.offset[row] = value,
                Constraint::Tied {
                    coefficient,
                    other,
                    factor,
                } => {
                    // Of another that is free, or has a value.
                    if matches!(of[other], Some(Constraint::Tied { .. })) {
                        return Err(FitError::Contradiction(coefficient));
                    }
                    let row = map.matrix.row(other) * factor;
                    map.matrix.row_mut(coefficient).copy_from(&row);
                    let fixed = match of[other] {
                        Some(Constraint::Fixed(_, value)) => value,
                        _ => 0.0,
                    };
                    map.offset[coefficient] = factor * fixed;
                }
                Constraint::NotNegative(_) | Constraint::NotPositive(_) => {}
            }
        }
        Ok(map)
    }
}

/// The least squares of ‖A t − z‖ where `signed` t are not negative: Lawson and Hanson, "Solving least squares problems", 1974, chapter 23, with
/// variables of any sign always among those that move. Gives t, and which are held at 0.
pub(crate) fn signed_least(
    a: &DMatrix<f64>,
    z: &DVector<f64>,
    signed: &[bool],
) -> Option<(DVector<f64>, Vec<bool>)> {
    let count = a.ncols();
    let mut held: Vec<bool> = signed.to_vec();
    let mut t = DVector::zeros(count);
    // Each round moves one; more rounds than this are rounding going to and fro.
    for round in 0..=10 * count {
        if round > 0 || !held.iter().any(|it| !it) {
            let gradient = a.tr_mul(&(z - a * &t));
            let norm = |it: usize| a.column(it).norm() * z.norm() * 1e-13;
            let pulled = (0..count).filter(|&it| held[it] && gradient[it] > norm(it));
            let Some(next) = pulled.max_by(|&p, &q| gradient[p].total_cmp(&gradient[q])) else {
                return Some((t, held));
            };
            held[next] = false;
        }
        loop {
            let trial = least(a, z, &held)?;
            let beyond = (0..count).filter(|&it| signed[it] && !held[it] && trial[it] < 0.0);
            let reach = |it: usize| t[it] / (t[it] - trial[it]);
            let Some(first) = beyond.min_by(|&p, &q| reach(p).total_cmp(&reach(q))) else {
                t = trial;
                break;
            };
            let share = reach(first);
            t += (trial - &t) * share;
            t[first] = 0.0;
            held[first] = true;
        }
    }
    Some((t, held))
}

/// Least squares with some t held at 0.
fn least(a: &DMatrix<f64>, z: &DVector<f64>, held: &[bool]) -> Option<DVector<f64>> {
    let moving: Vec<usize> = (0..a.ncols()).filter(|&it| !held[it]).collect();
    let mut found = DVector::zeros(a.ncols());
    if moving.is_empty() {
        return Some(found);
    }
    let qr = a.select_columns(&moving).qr();
    let solved = qr
        .r()
        .solve_upper_triangular(&qr.q().tr_mul(z))
        .filter(|it| it.iter().all(|it| it.is_finite()))?;
    for (&index, value) in moving.iter().zip(&solved) {
        found[index] = *value;
    }
    Some(found)
}
