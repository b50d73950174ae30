//! Observed order of convergence.

/// Slope of the least-squares line through (ln h, ln error): the observed order.
pub(crate) fn observed_order(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|&(h, e)| (h.ln(), e.ln())).collect();
    let mean_h = logs.iter().map(|p| p.0).sum::<f64>() / count;
    let mean_e = logs.iter().map(|p| p.1).sum::<f64>() / count;
    let covariance: f64 = logs.iter().map(|p| (p.0 - mean_h) * (p.1 - mean_e)).sum();
    let variance: f64 = logs.iter().map(|p| (p.0 - mean_h).powi(2)).sum();
    covariance / variance
}
