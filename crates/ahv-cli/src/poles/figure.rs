//! Poles and zeros in the complex plane, whole and near the origin.

use ahv_analysis::poles::{Mode, frequency};
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, Shape};
use nalgebra::Complex;

use super::Roots;
use crate::vehicle::FlightModel;

/// Share of an axis that is left free around the roots.
const MARGIN: f64 = 1.15;

/// The picture of `roots`.
pub(super) fn figure<M: FlightModel>(roots: &Roots<'_, M>) -> Figure {
    let flexible = roots
        .poles
        .iter()
        .filter(|pole| matches!(pole.mode, Some(Mode::Flexible(_) | Mode::ColouredNoise(_))));
    let slowest = flexible
        .map(|pole| frequency(pole.value))
        .fold(f64::INFINITY, f64::min);
    let all = panel("All".to_owned(), roots, f64::INFINITY);
    let title = format!(
        "Poles and zeros of {}, set {}, {}",
        M::NAME,
        roots.vehicle.set,
        roots.place
    );
    if slowest.is_finite() {
        let near = panel("Rigid body".to_owned(), roots, 0.9 * slowest);
        Figure::new(title, 2, vec![all, near])
    } else {
        Figure::new(title, 1, vec![all])
    }
}

/// The roots whose frequency is below `limit`.
fn panel<M: FlightModel>(title: String, roots: &Roots<'_, M>, limit: f64) -> Panel {
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
