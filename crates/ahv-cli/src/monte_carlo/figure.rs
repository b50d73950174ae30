//! The picture of `ahv montecarlo`: for each state a fan of quantiles over time, and its distribution at the end.

use ahv_analysis::monte_carlo::{QUANTILES, StateSpread};
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError};

use super::Summary;
use crate::output::readable;
use crate::signals::interrupted;

/// Panels in a row: fan and distribution of two states.
const COLUMNS: usize = 4;

/// Fans and distributions.
pub(super) fn draw(told: &Summary<'_>) -> Result<String, PlotError> {
    let states = told.ready.vehicle.states.iter().enumerate();
    let panels = states.flat_map(|(index, (name, unit))| {
        let (unit, factor) = readable(unit);
        [
            fan(told, index, name, &unit, factor),
            distribution(told, index, name, &unit, factor),
        ]
    });
    let title = interrupted(told.outcome.members, told.outcome.asked, "members");
    Figure::new(title, COLUMNS, panels.collect()).svg()
}

fn fan(told: &Summary<'_>, index: usize, name: &str, unit: &str, factor: f64) -> Panel {
    let states = || {
        let snapshots = told.outcome.snapshots.iter();
        snapshots.filter_map(move |it| Some((it.time, it.states.get(index)?)))
    };
    let quantile =
        |state: &StateSpread, place: usize| Some(factor * state.quantiles.get(place)?.value?);
    let outer = QUANTILES.len() - 1;
    let band = |low: usize| {
        let rows = states().filter_map(|(time, state)| {
            Some((time, quantile(state, low)?, quantile(state, outer - low)?))
        });
        Mark::Band(rows.collect())
    };
    let percent = |low: usize| {
        let share = |place: usize| 100.0 * QUANTILES.get(place).copied().unwrap_or(0.0);
        format!("{} % to {} %", share(low), share(outer - low))
    };
    let median = states().filter_map(|(time, state)| Some((time, quantile(state, outer / 2)?)));
    Panel {
        title: name.to_owned(),
        x: Axis::linear("time [s]"),
        y: Axis::linear(format!("[{unit}]")),
        layers: vec![
            Layer::new(percent(0), Colour::SkyBlue, band(0)),
            Layer::new(percent(1), Colour::Orange, band(1)),
            Layer::new(percent(2), Colour::Vermillion, band(2)),
            Layer::new("median", Colour::Black, Mark::Line(median.collect())),
        ],
    }
}

fn distribution(told: &Summary<'_>, index: usize, name: &str, unit: &str, factor: f64) -> Panel {
    let last = told.outcome.snapshots.last();
    let bins = last
        .and_then(|it| it.states.get(index))
        .map(|it| it.histogram.as_slice());
    let bins = bins.unwrap_or_default();
    let lows = bins.iter().map(|bin| factor * bin.low);
    let edges = lows.chain(bins.last().map(|bin| factor * bin.high));
    Panel {
        title: format!("{name} at the end"),
        x: Axis::linear(format!("[{unit}]")),
        y: Axis::linear("members"),
        layers: vec![Layer::new(
            "",
            Colour::SkyBlue,
            Mark::Bars {
                edges: edges.collect(),
                heights: bins.iter().map(|bin| bin.count as f64).collect(),
            },
        )],
    }
}
