//! The Cramér–Rao bound, corrected for coloured residuals.

use nalgebra::{DMatrix, DVector};

/// Share of a segment up to which lags count.
const LAGS: usize = 4;

/// Normalised residuals and their sensitivities, sample by sample of a segment.
pub(crate) struct Segment {
    pub(crate) residuals: Vec<DVector<f64>>,
    pub(crate) slopes: Vec<DMatrix<f64>>,
}

/// Covariance of the estimates where residuals are coloured (Morelli and Klein 1997): M⁻¹ J M⁻¹, J being M with the residuals' sample
/// autocorrelation in the place of the unit matrix at lag 0. Lags count with Bartlett's weights, so that J is no difference.
pub(crate) fn corrected(
    information: &DMatrix<f64>,
    inverse: &DMatrix<f64>,
    segments: &[Segment],
) -> DMatrix<f64> {
    let longest = segments
        .iter()
        .map(|it| it.residuals.len())
        .max()
        .unwrap_or(0);
    let most = longest / LAGS;
    let samples: usize = segments.iter().map(|it| it.residuals.len()).sum();
    let outputs = segments
        .iter()
        .find_map(|it| it.residuals.first())
        .map_or(0, |it| it.nrows());
    let mut middle = information.clone();
    for lag in 0..=most {
        let mut correlation = DMatrix::zeros(outputs, outputs);
        for segment in segments {
            for (now, later) in segment
                .residuals
                .iter()
                .zip(segment.residuals.iter().skip(lag))
            {
                correlation += now * later.transpose();
            }
        }
        correlation /= samples as f64;
        if lag == 0 {
            correlation -= DMatrix::identity(outputs, outputs);
        }
        let weight = 1.0 - lag as f64 / (most + 1) as f64;
        let mut sum = DMatrix::zeros(information.nrows(), information.nrows());
        for segment in segments {
            for (now, later) in segment.slopes.iter().zip(segment.slopes.iter().skip(lag)) {
                sum += now.tr_mul(&(&correlation * later));
            }
        }
        let sum = if lag == 0 {
            sum
        } else {
            &sum + sum.transpose()
        };
        middle += sum * weight;
    }
    inverse * middle * inverse
}
