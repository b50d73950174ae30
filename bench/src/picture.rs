//! The picture of docs/benchmarks.md.

use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, Shape};

use crate::found::Found;
use crate::race::Finish;
use crate::subject::SUBJECTS;

/// Where it lies in the repository.
pub(crate) const PATH: &str = "docs/images/benchmarks.svg";
/// Where it lies for docs/benchmarks.md.
pub(crate) const LINK: &str = "images/benchmarks.svg";
/// What it shows.
pub(crate) const CAPTION: &str =
    "Times of the kernels over those of CasADi's C, and rates of the ensembles";
const SIZE: (u32, u32) = (560, 380);

/// A candidate with lower quartile, median and upper quartile.
type Row = (String, [f64; 3]);

/// Medians as dots, quartiles as lines.
///
/// # Errors
/// Figures that cannot be drawn.
pub(crate) fn draw(found: &Found) -> Result<String, String> {
    let mut panels = Vec::new();
    for subject in &SUBJECTS {
        let timings = found
            .timings
            .iter()
            .filter(|it| it.function == subject.symbol);
        let row = |it: &crate::timing::Timing| {
            let ratio = it.ratio;
            let range = [ratio.lower_quartile, ratio.median, ratio.upper_quartile];
            (it.candidate.to_owned(), range)
        };
        let label = "time over that of CasADi's C";
        panels.push(panel(subject.title, label, timings.map(row).collect()));
    }
    let trajectories = &found.trajectories.finishes;
    let ratio = |it: &Finish| {
        let ratio = it.ratio;
        let range = [ratio.lower_quartile, ratio.median, ratio.upper_quartile];
        (it.candidate.to_owned(), range)
    };
    let rows = trajectories.iter().map(ratio).collect();
    panels.push(panel("RK4 of DCOM", "time over that of CasADi's C", rows));
    for (title, label, finishes) in [
        (
            "Monte Carlo of SDCOM",
            "million member-steps per second",
            &found.monte_carlo.finishes,
        ),
        (
            "Section 5.1",
            "million mode-steps per second",
            &found.modes.finishes,
        ),
    ] {
        let row = |it: &Finish| {
            let threads = if it.threads == 1 { "thread" } else { "threads" };
            let name = format!("{}, {} {threads}", it.candidate, it.threads);
            (name, it.seconds.rates(1e-6))
        };
        panels.push(panel(title, label, finishes.iter().map(row).collect()));
    }
    let mut figure = Figure::new("", 2, panels);
    figure.panel_size = SIZE;
    figure
        .svg()
        .map_err(|error| format!("error: {PATH}: {error}"))
}

fn panel(title: &str, label: &str, rows: Vec<Row>) -> Panel {
    let names = rows.iter().map(|(name, _)| name.replace('`', ""));
    let names: Vec<String> = names.collect();
    let mut layers = Vec::new();
    for own in [false, true] {
        let colour = if own {
            Colour::Vermillion
        } else {
            Colour::Blue
        };
        let name = if own { "ahv" } else { "peers" };
        let chosen = rows.iter().enumerate();
        let chosen = chosen.filter(|(_, (name, _))| name.starts_with("ahv") == own);
        let mut medians = Vec::new();
        for (place, (_, [lower, median, upper])) in chosen {
            let y = -(place as f64);
            medians.push((*median, y));
            layers.push(Layer::new(
                "",
                colour,
                Mark::Line(vec![(*lower, y), (*upper, y)]),
            ));
        }
        let shape = if own { Shape::Dot } else { Shape::Circle };
        layers.push(Layer::new(name, colour, Mark::Markers(shape, medians)));
    }
    Panel {
        title: title.to_owned(),
        x: Axis::log(label),
        y: Axis::rows(names),
        layers,
    }
}
