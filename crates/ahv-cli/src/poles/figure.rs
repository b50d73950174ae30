//! Poles and zeros in the complex plane, whole and near the origin.

use ahv_analysis::poles::frequency;
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, Shape};
use nalgebra::Complex;

use super::Roots;

/// Share of an axis that is left free around the roots.
const MARGIN: f64 = 1.15;

/// Ratio of two frequencies from which on the slower one is hard to see.
const HIDING: f64 = 3.0;

/// The picture of `roots`.
pub(super) fn figure(roots: &Roots<'_>) -> Figure {
    let all = panel("All".to_owned(), roots, f64::INFINITY);
    let title = format!(
        "Poles and zeros of {}, set {}, {}",
        roots.vehicle.name(),
        roots.vehicle.set,
        roots.place
    );
    let panels = match gap(roots.poles.iter().map(|pole| frequency(pole.value))) {
        Some(limit) => vec![all, panel("Near the origin".to_owned(), roots, limit)],
        None => vec![all],
    };
    Figure::new(title, panels.len(), panels)
}

/// A frequency in the widest gap among the poles', where one is wide enough to hide the slow ones in a picture of all.
fn gap(frequencies: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = frequencies.filter(|&frequency| frequency > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let gaps = sorted
        .windows(2)
        .map(|pair| (pair[1] / pair[0], (pair[0] * pair[1]).sqrt()));
    let widest = gaps.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (widest.0 > HIDING).then_some(widest.1)
}

/// The roots whose frequency is below `limit`.
fn panel(title: String, roots: &Roots<'_>, limit: f64) -> Panel {
    let near = |roots: Vec<Complex<f64>>| -> Vec<(f64, f64)> {
        let near = roots.into_iter().filter(|&root| frequency(root) < limit);
        near.map(|root| (root.re, root.im)).collect()
    };
    let poles = near(roots.poles.iter().map(|it| it.value).collect());
    let zeros = near(roots.zeros.finite.iter().map(|it| it.value).collect());
    let reach = |of: fn(&(f64, f64)) -> f64| {
        let largest = poles.iter().chain(&zeros).map(of).fold(0.0, f64::max);
        if largest > 0.0 { MARGIN * largest } else { 1.0 }
    };
    let (right, up) = (reach(|point| point.0.abs()), reach(|point| point.1.abs()));
    let rule = |mark| Layer::new("", Colour::Grey, mark);
    let markers =
        |name, colour, shape, points| Layer::new(name, colour, Mark::Markers(shape, points));
    Panel {
        title,
        x: Axis::linear("real part [1/s]").within(-right, right),
        y: Axis::linear("imaginary part [1/s]").within(-up, up),
        layers: vec![
            rule(Mark::VerticalRule(0.0)),
            rule(Mark::HorizontalRule(0.0)),
            markers("poles", Colour::Blue, Shape::Cross, poles),
            markers("zeros", Colour::Vermillion, Shape::Circle, zeros),
        ],
    }
}
