//! A small picture of what a change does to a model: its poles before and after, and where it trims.

use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, Shape};

use super::effect::{Effect, Root};
use super::whole_box::Trims;

/// Width and height of a panel, in pixels.
const PANEL: (u32, u32) = (360, 220);

/// The name of the picture's file.
pub(super) fn file_name(table: &str, model: &str) -> String {
    let stem = table.strip_suffix(".toml").unwrap_or(table);
    let plain = |letter: char| match letter.is_ascii_alphanumeric() || letter == '_' {
        true => letter,
        false => '-',
    };
    format!(
        "{}-{model}.svg",
        stem.chars().map(plain).collect::<String>()
    )
}

/// The picture.
pub(super) fn figure(effect: &Effect) -> Figure {
    let trims = effect
        .whole_box
        .trims
        .as_ref()
        .map(|trims| trims_panel(effect, trims));
    let mut panels = vec![poles_panel(effect)];
    panels.extend(trims);
    let mut figure = Figure::new("", panels.len(), panels);
    figure.panel_size = PANEL;
    figure
}

fn poles_panel(effect: &Effect) -> Panel {
    let of = |side: fn(&super::effect::Moved) -> Root| -> Vec<(f64, f64)> {
        effect
            .poles
            .iter()
            .map(side)
            .map(|it| (it.re, it.im))
            .collect()
    };
    let markers =
        |name, colour, shape, points| Layer::new(name, colour, Mark::Markers(shape, points));
    let mut panel = Panel {
        title: format!("{}: poles", effect.model),
        x: Axis::linear("real part [1/s]"),
        y: Axis::linear("imaginary part [1/s]"),
        layers: vec![
            markers("old", Colour::Grey, Shape::Square, of(|it| it.old)),
            markers("new", Colour::Blue, Shape::Cross, of(|it| it.new)),
        ],
    };
    if effect.poles.is_empty() {
        // Without a trim there are none, and an axis needs something to show.
        panel.title += ": none, without a trim";
        panel.x = panel.x.within(-1.0, 1.0);
        panel.y = panel.y.within(0.0, 1.0);
    }
    panel
}

fn trims_panel(effect: &Effect, trims: &Trims) -> Panel {
    let unit = |name: &str| {
        effect
            .units
            .iter()
            .find(|it| it.0 == name)
            .map_or("1", |it| it.1)
    };
    let axis = |index: usize| {
        let name = trims.states[index];
        let places = || trims.cells.iter().map(|it| it.0[index]);
        let low = places().fold(f64::INFINITY, f64::min);
        let high = places().fold(f64::NEG_INFINITY, f64::max);
        let margin = 0.05 * (high - low);
        Axis::linear(format!("{name} [{}]", unit(name))).within(low - margin, high + margin)
    };
    let layer = |name, colour, shape, wanted: [bool; 2]| {
        let cells = trims.cells.iter().filter(|it| it.1 == wanted);
        Layer::new(
            name,
            colour,
            Mark::Markers(shape, cells.map(|it| (it.0[0], it.0[1])).collect()),
        )
    };
    Panel {
        title: format!("{}: trims", effect.model),
        x: axis(0),
        y: axis(1),
        layers: vec![
            layer("trims with both", Colour::Blue, Shape::Dot, [true, true]),
            layer(
                "with the old table alone",
                Colour::Vermillion,
                Shape::Cross,
                [true, false],
            ),
            layer(
                "with the new table alone",
                Colour::Green,
                Shape::Plus,
                [false, true],
            ),
        ],
    }
}
