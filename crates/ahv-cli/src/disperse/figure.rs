//! The pictures of `ahv disperse`.

use ahv_analysis::disperse::{Contribution, Kind, Part, Quantity};
use ahv_analysis::statistics::densities;
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError, Shape};
use nalgebra::Complex;

use super::Outcome;

/// Half the height of a bar, in rows.
const BAR: f64 = 0.32;
/// Bars of a histogram.
const BINS: u32 = 24;
/// Real part, in 1/s, up to which a zero counts as lying at the origin: that of the altitude does.
const AT_ORIGIN: f64 = 1e-6;
/// Width of a bar, relative to the largest number, below which it is rounding.
const ROUNDING: f64 = 1e-12;
/// Colours of the members' roots and of the nominal ones.
const POLES: (Colour, Colour) = (Colour::SkyBlue, Colour::Blue);
const ZEROS: (Colour, Colour) = (Colour::Orange, Colour::Vermillion);
/// Members whose roots are drawn, at most: more hide each other.
const DRAWN: usize = 400;

/// What people look at of a trim over the first of it, a dot a member.
pub(super) fn trim(outcome: &Outcome<'_>) -> Result<String, String> {
    let quantities = &outcome.nominal.quantities;
    let place = |name: &str| {
        quantities
            .iter()
            .position(|it| it.kind == Kind::Trim && it.name == name)
    };
    let shown = outcome.vehicle.model.trim_problem().shown;
    let panels = shown.iter().skip(1).take(3).filter_map(|name| {
        let (x, y) = (place(shown.first()?)?, place(name)?);
        Some(scatter(outcome, x, y))
    });
    let panels: Vec<Panel> = panels.collect();
    if panels.is_empty() {
        return Err("a trim of this model has no two quantities to draw".to_owned());
    }
    let figure = Figure::new(outcome.mark(), 3, panels);
    figure.svg().map_err(|error| error.to_string())
}

fn scatter(outcome: &Outcome<'_>, x: usize, y: usize) -> Panel {
    let labels = [x, y].map(|index| outcome.label(&outcome.nominal.quantities[index]));
    let [(x_label, x_factor), (y_label, y_factor)] = labels;
    let members = outcome.members.iter().filter_map(|it| {
        Some((
            x_factor * (*it.values.get(x)?)?,
            y_factor * (*it.values.get(y)?)?,
        ))
    });
    let values = outcome.nominal.values();
    let nominal = vec![(x_factor * values[x], y_factor * values[y])];
    Panel {
        title: String::new(),
        x: Axis::linear(x_label),
        y: Axis::linear(y_label),
        layers: vec![
            Layer::new(
                "members",
                Colour::SkyBlue,
                Mark::Markers(Shape::Point, members.collect()),
            ),
            Layer::new(
                "nominal",
                Colour::Black,
                Mark::Markers(Shape::Cross, nominal),
            ),
        ],
    }
}

/// Poles and zeros of the members about the nominal ones, those of the upper half plane, and how the fast real ones spread.
pub(super) fn roots(outcome: &Outcome<'_>) -> Result<String, PlotError> {
    let nominal = &outcome.nominal.solution;
    let solved = outcome
        .members
        .iter()
        .filter_map(|it| it.solution.as_ref().ok());
    let drawn = solved.take(DRAWN);
    let poles = drawn
        .clone()
        .flat_map(|it| it.poles.iter().map(|it| it.value));
    let zeros = drawn.flat_map(|it| it.zeros.iter().copied());
    let own_poles = nominal.poles.iter().map(|it| it.value);
    let own_zeros = nominal.zeros.iter().copied();
    let panels = vec![
        cloud("poles", (POLES, Shape::Cross), poles, own_poles),
        cloud("zeros", (ZEROS, Shape::Circle), zeros, own_zeros),
        histograms(outcome),
    ];
    Figure::new(outcome.mark(), 3, panels).svg()
}

fn cloud(
    what: &str,
    ((pale, strong), shape): ((Colour, Colour), Shape),
    members: impl Iterator<Item = Complex<f64>>,
    nominal: impl Iterator<Item = Complex<f64>>,
) -> Panel {
    let upper = |root: Complex<f64>| (root.im >= 0.0).then_some((root.re, root.im));
    let (members, nominal) = (members.filter_map(upper), nominal.filter_map(upper));
    Panel {
        title: what.to_owned(),
        x: Axis::linear("real part [1/s]"),
        y: Axis::linear("imaginary part [rad/s]"),
        layers: vec![
            Layer::new("", Colour::Grey, Mark::VerticalRule(0.0)),
            Layer::new(
                format!("{what} of members"),
                pale,
                Mark::Markers(Shape::Point, members.collect()),
            ),
            Layer::new(
                format!("nominal {what}"),
                strong,
                Mark::Markers(shape, nominal.collect()),
            ),
        ],
    }
}

/// How the poles of the short period and the real zeros off the origin spread.
fn histograms(outcome: &Outcome<'_>) -> Panel {
    let values = outcome.nominal.values();
    let quantities = &outcome.nominal.quantities;
    let real = |it: &Quantity| {
        let pair = |other: &Quantity| other.name == it.name && other.part == Part::Imaginary;
        it.part == Part::Real && !quantities.iter().any(pair)
    };
    let shown = quantities
        .iter()
        .enumerate()
        .filter(|&(index, it)| match it.kind {
            Kind::Pole => real(it) && it.name.starts_with("short_period"),
            Kind::Zero => real(it) && values[index].abs() > AT_ORIGIN,
            Kind::Trim => false,
        });
    let mut layers = Vec::new();
    for (index, quantity) in shown {
        let sample = outcome
            .members
            .iter()
            .filter_map(|it| *it.values.get(index)?);
        let sample: Vec<f64> = sample.collect();
        let (name, (pale, strong)) = match quantity.kind {
            Kind::Zero => ("zeros of members", ZEROS),
            _ => ("poles of members", POLES),
        };
        let Some((edges, heights)) = bins(&sample) else {
            continue;
        };
        layers.push(Layer::new(name, pale, Mark::Bars { edges, heights }));
        layers.push(Layer::new("", strong, Mark::VerticalRule(values[index])));
    }
    layers.push(Layer::new("", Colour::Grey, Mark::VerticalRule(0.0)));
    Panel {
        title: "short period and real zeros".to_owned(),
        x: Axis::linear("real part [1/s]"),
        y: Axis::linear("members per 1/s"),
        layers,
    }
}

/// Edges and heights of a histogram: numbers per unit; `None` of numbers that do not differ.
fn bins(sample: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let low = sample.iter().copied().fold(f64::INFINITY, f64::min);
    let high = sample.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let width = (high - low) / f64::from(BINS);
    // Numbers that rounding parts have no edges between them.
    let least = ROUNDING * low.abs().max(high.abs());
    if !(width > least && width.is_finite()) {
        return None;
    }
    let edges: Vec<f64> = (0..=BINS)
        .map(|index| low + width * f64::from(index))
        .collect();
    let count = sample.len() as f64;
    let heights = densities(sample, &edges)
        .into_iter()
        .map(|it| it * count)
        .collect();
    Some((edges, heights))
}

/// The parameters that matter most to each of the headline quantities, as bars.
pub(super) fn sensitivities(outcome: &Outcome<'_>) -> Result<String, String> {
    let panels = outcome.headline().into_iter().filter_map(|index| {
        let quantity = outcome.nominal.quantities.get(index)?;
        let mut ranked = outcome.ranked(index);
        ranked.truncate(outcome.arguments.top);
        (!ranked.is_empty()).then(|| tornado(outcome, quantity, &ranked))
    });
    let panels: Vec<Panel> = panels.collect();
    if panels.is_empty() {
        return Err("no parameter that varies has an effect on these quantities".to_owned());
    }
    Figure::new(outcome.mark(), 3, panels)
        .svg()
        .map_err(|error| error.to_string())
}

fn tornado(outcome: &Outcome<'_>, quantity: &Quantity, ranked: &[Contribution]) -> Panel {
    let (label, factor) = outcome.label(quantity);
    let names = ranked.iter().map(|it| outcome.parameter(it).to_owned());
    let bars = (0..).zip(ranked).map(|(row, it): (i32, _)| {
        let (at, length) = (-f64::from(row), factor * it.effect);
        let (name, colour) = if length > 0.0 {
            ("raises", Colour::Vermillion)
        } else {
            ("lowers", Colour::Blue)
        };
        let bar = [0.0, length].map(|x| (x, at - BAR, at + BAR));
        Layer::new(name, colour, Mark::Band(bar.to_vec()))
    });
    let zero = Layer::new("", Colour::Black, Mark::VerticalRule(0.0));
    Panel {
        title: String::new(),
        x: Axis::linear(format!("{label}: change by one standard deviation")),
        y: Axis::rows(names.collect()),
        layers: bars.chain([zero]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::bins;

    /// Zeros that a parameter does not move differ by rounding alone.
    #[test]
    fn numbers_that_rounding_parts_have_no_bars() {
        assert!(bins(&[-47.4, -47.4 - 2e-14, -47.4 + 2e-14]).is_none());
        let (_, heights) = bins(&[1.0, 1.5, 2.0]).expect("bars");
        assert!(heights.iter().all(|height| height.is_finite()));
    }
}
