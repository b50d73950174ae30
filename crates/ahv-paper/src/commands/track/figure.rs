//! The picture of `ahv track`.

use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError};

use super::Outcome;
use crate::track::{Sample, bands};

const COMMAND: (&str, Colour) = ("command", Colour::Black);

/// A quantity over time: title, axis, value and command of a sample.
type Quantity = (
    &'static str,
    &'static str,
    fn(&Sample) -> f64,
    Option<fn(&Sample) -> f64>,
);

const QUANTITIES: [Quantity; 9] = [
    (
        "velocity",
        "V [ft/s]",
        |s| s.state.velocity,
        Some(|s| s.reference.velocity),
    ),
    (
        "altitude",
        "h [ft]",
        |s| s.state.altitude,
        Some(|s| s.reference.altitude),
    ),
    (
        "flight path",
        "γ [deg]",
        |s| s.state.gamma.to_degrees(),
        Some(|s| s.reference.gamma().to_degrees()),
    ),
    (
        "error of velocity",
        "V − V_c [ft/s]",
        |s| s.state.velocity - s.reference.velocity,
        None,
    ),
    (
        "error of altitude",
        "h − h_c [ft]",
        |s| s.state.altitude - s.reference.altitude,
        None,
    ),
    (
        "angle of attack",
        "α [deg]",
        |s| s.state.alpha.to_degrees(),
        None,
    ),
    ("fuel equivalence ratio", "φ [1]", |s| s.input.phi, None),
    (
        "elevator",
        "δe [deg]",
        |s| s.input.delta_e.to_degrees(),
        None,
    ),
    (
        "first flexible mode",
        "η₁ [(ft·slug)^½]",
        |s| s.state.eta_1,
        None,
    ),
];

/// Medians and bands from 5 to 95 % of the flights, with the commands.
pub(super) fn draw(outcomes: &[Outcome], title: String) -> Result<String, PlotError> {
    let panels = QUANTITIES.map(|quantity| panel(quantity, outcomes));
    Figure::new(title, 3, panels.to_vec()).svg()
}

fn panel((title, label, value, command): Quantity, outcomes: &[Outcome]) -> Panel {
    let (mut layers, mut medians) = (Vec::new(), Vec::new());
    for (outcome, colour) in outcomes.iter().zip(Colour::CYCLE) {
        let bands = bands(&outcome.flights, value);
        let name = outcome.controller;
        let band = bands
            .iter()
            .map(|at| (at.time, at.spread.low, at.spread.high));
        let band = Mark::Band(band.collect());
        let median = bands.iter().map(|at| (at.time, at.spread.value));
        let median = Mark::Line(median.collect());
        layers.push(Layer::new(format!("{name}, 5 to 95 %"), colour, band));
        medians.push(Layer::new(format!("{name}, median"), colour, median));
    }
    // No band may dim a line.
    layers.extend(medians);
    let first = outcomes.first().and_then(|outcome| outcome.flights.first());
    if let (Some(command), Some(flight)) = (command, first) {
        let points = flight
            .samples
            .iter()
            .map(|sample| (sample.time, command(sample)));
        layers.push(Layer::new(COMMAND.0, COMMAND.1, Mark::Line(points.collect())).dashed());
    }
    Panel {
        title: title.to_owned(),
        x: Axis::linear("time [s]"),
        y: Axis::linear(label),
        layers,
    }
}
