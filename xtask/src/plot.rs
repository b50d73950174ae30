//! A picture of the demo's flights.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

use crate::demo::Change;
use crate::trajectory::Trajectory;

/// One model with the table's value of the coefficient and with another.
pub(crate) struct Pair {
    pub(crate) model: String,
    pub(crate) nominal: Trajectory,
    pub(crate) changed: Trajectory,
}

/// A row of charts: the states to show (the first that a model has), and what to call them.
struct Row {
    states: &'static [&'static str],
    title: &'static str,
}

const ROWS: [Row; 5] = [
    Row {
        states: &["velocity"],
        title: "velocity",
    },
    Row {
        states: &["altitude"],
        title: "altitude",
    },
    Row {
        states: &["alpha"],
        title: "angle of attack",
    },
    Row {
        states: &["pitch_rate"],
        title: "pitch rate",
    },
    Row {
        states: &["eta_1", "chi_1"],
        title: "flexible coordinate",
    },
];
/// Okabe and Ito's palette: told apart by colour-blind readers too.
const NOMINAL: RGBColor = RGBColor(0, 114, 178);
const CHANGED: RGBColor = RGBColor(213, 94, 0);
const SIZE: (u32, u32) = (1100, 1400);
const LEGEND_HEIGHT: u32 = 44;
const FONT: (&str, u32) = ("sans-serif", 15);

/// Draws one column a model and one row a state.
pub(crate) fn draw(pairs: &[Pair], change: &Change, path: &Path) -> Result<(), String> {
    try_draw(pairs, change, path)
        .map_err(|error| format!("error: cannot draw {}: {error}", path.display()))
}

fn try_draw(pairs: &[Pair], change: &Change, path: &Path) -> Result<(), Box<dyn Error>> {
    let area = SVGBackend::new(path, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let (legend, charts) = area.split_vertically(LEGEND_HEIGHT);
    draw_legend(&legend, change)?;
    let charts = charts.split_evenly((ROWS.len(), pairs.len()));
    for (index, chart) in charts.iter().enumerate() {
        let (row, pair) = (&ROWS[index / pairs.len()], &pairs[index % pairs.len()]);
        draw_chart(chart, row, pair)?;
    }
    area.present()?;
    Ok(())
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// A number without the sign that rounding leaves on zero.
fn axis_label(value: &f64) -> String {
    let text = format!("{:.6}", if value.abs() < 1e-9 { 0.0 } else { *value });
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.to_owned()
}

fn draw_chart(area: &Area<'_>, row: &Row, pair: &Pair) -> Result<(), Box<dyn Error>> {
    let state = row
        .states
        .iter()
        .find(|state| pair.nominal.series(state).is_some());
    let state = state.ok_or_else(|| format!("{} has no {}", pair.model, row.title))?;
    let series = |flight: &Trajectory| {
        let (unit, points) = flight.series(state).unwrap_or_default();
        in_degrees(unit, points)
    };
    let (unit, nominal) = series(&pair.nominal);
    let (_, changed) = series(&pair.changed);
    let (times, values) = ranges(nominal.iter().chain(&changed));

    let title = format!("{}: {}", pair.model, row.title);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 18))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(85)
        .build_cartesian_2d(times, values)?;
    chart
        .configure_mesh()
        .x_desc("time [s]")
        .y_desc(format!("{state} [{unit}]"))
        .x_labels(7)
        .y_labels(5)
        .y_label_formatter(&axis_label)
        .label_style(FONT)
        .light_line_style(TRANSPARENT)
        .draw()?;
    chart.draw_series(LineSeries::new(nominal, NOMINAL.stroke_width(2)))?;
    // Dashes as well as a colour, for a printout in grey.
    chart.draw_series(DashedLineSeries::new(
        changed,
        8,
        5,
        CHANGED.stroke_width(2),
    ))?;
    Ok(())
}

fn draw_legend(area: &Area<'_>, change: &Change) -> Result<(), Box<dyn Error>> {
    let (y, length) = (i32::try_from(LEGEND_HEIGHT / 2)?, 44);
    let text = |x: i32, value: &str| {
        let text = format!("C_L alpha = {value} / rad");
        Text::new(text, (x + length + 8, y - 8), FONT)
    };
    let (x, style) = (260, NOMINAL.stroke_width(2));
    area.draw(&PathElement::new([(x, y), (x + length, y)], style))?;
    area.draw(&text(x, &change.nominal))?;
    let (x, style) = (600, CHANGED.stroke_width(2));
    for dash in (x..x + length).step_by(13) {
        area.draw(&PathElement::new([(dash, y), (dash + 8, y)], style))?;
    }
    area.draw(&text(x, &change.changed))?;
    Ok(())
}

/// Angles are read in degrees.
fn in_degrees(unit: &str, mut points: Vec<(f64, f64)>) -> (String, Vec<(f64, f64)>) {
    if !unit.starts_with("rad") {
        return (unit.to_owned(), points);
    }
    for (_, value) in &mut points {
        *value = value.to_degrees();
    }
    (unit.replacen("rad", "deg", 1), points)
}

type Range = std::ops::Range<f64>;

/// The ranges of the axes, with a little room above and below.
fn ranges<'a>(points: impl Iterator<Item = &'a (f64, f64)>) -> (Range, Range) {
    let start = (
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::INFINITY,
        f64::NEG_INFINITY,
    );
    let (t_min, t_max, min, max) = points.fold(start, |(t_min, t_max, min, max), &(t, value)| {
        (t_min.min(t), t_max.max(t), min.min(value), max.max(value))
    });
    let room = (0.05 * (max - min)).max(1e-9 * max.abs()).max(1e-9);
    (t_min..t_max, min - room..max + room)
}
