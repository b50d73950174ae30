//! The picture of `ahv covariance`: a panel a state.

use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError};

use super::Outcome;
use crate::output::readable;

/// Panels in a row.
const COLUMNS: usize = 3;

/// Standard deviations over time.
pub(super) fn draw(outcome: &Outcome<'_>) -> Result<String, PlotError> {
    let states = outcome.vehicle.states.iter().enumerate();
    let panels = states.map(|(index, (name, unit))| panel(outcome, index, name, unit));
    Figure::new(outcome.mark(), COLUMNS, panels.collect()).svg()
}

fn panel(outcome: &Outcome<'_>, index: usize, name: &str, unit: &str) -> Panel {
    let (unit, factor) = readable(unit);
    let linear = outcome
        .linear
        .iter()
        .filter_map(|it| Some((it.time, factor * *it.std().get(index)?)));
    let flown = outcome.sampled.iter().filter_map(|it| {
        let std = it.states.get(index)?.std?.closed()?;
        Some((it.time, factor * std.low, factor * std.high))
    });
    Panel {
        title: name.to_owned(),
        x: Axis::linear("time [s]"),
        y: Axis::linear(format!("standard deviation [{unit}]")),
        layers: vec![
            Layer::new(
                format!("{}, 95 %", outcome.flights()),
                Colour::SkyBlue,
                Mark::Band(flown.collect()),
            ),
            Layer::new(
                "first order",
                Colour::Vermillion,
                Mark::Line(linear.collect()),
            ),
        ],
    }
}
