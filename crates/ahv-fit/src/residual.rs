//! What a fit leaves of its samples.

use crate::design::{Monomial, Samples, value};

/// Points of a picture, at most.
const SHOWN: usize = 2000;

/// Residuals of a quantity: samples less fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// Share of the weighted variance that the fit explains; `None` where the samples have none.
    pub r_squared: Option<f64>,
    /// The residual of the largest magnitude, and its row.
    pub worst: (f64, usize),
    /// Fitted values with residuals, evenly picked: 2000 at most.
    pub shown: Vec<(f64, f64)>,
}

impl Residuals {
    /// Those of quantity `response`, as the sum of these monomials with these coefficients.
    #[must_use]
    pub fn of(
        samples: &Samples<'_>,
        response: usize,
        monomials: &[&Monomial],
        values: &[f64],
    ) -> Self {
        let wanted = &samples.responses[response];
        let weight = |row: usize| samples.weights.map_or(1.0, |it| it[row]);
        let rows = 0..wanted.len();
        let weights: f64 = rows.clone().map(weight).sum();
        let mean = rows
            .clone()
            .map(|row| weight(row) * wanted[row])
            .sum::<f64>()
            / weights;
        let step = wanted.len().div_ceil(SHOWN).max(1);
        let (mut squares, mut spread) = (0.0, 0.0);
        let mut found = Self {
            r_squared: None,
            worst: (0.0, 0),
            shown: Vec::new(),
        };
        for row in rows {
            let point = || samples.variables.iter().map(|it| it[row]);
            let terms = monomials.iter().zip(values);
            let fitted: f64 = terms.map(|(it, factor)| factor * value(it, point())).sum();
            let residual = wanted[row] - fitted;
            squares += weight(row) * residual * residual;
            spread += weight(row) * (wanted[row] - mean).powi(2);
            if residual.abs() > found.worst.0.abs() {
                found.worst = (residual, row);
            }
            if row % step == 0 {
                found.shown.push((fitted, residual));
            }
        }
        found.r_squared = (spread > 0.0).then(|| 1.0 - squares / spread);
        found
    }
}
