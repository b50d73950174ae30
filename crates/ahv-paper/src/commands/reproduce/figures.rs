//! The pictures of the random parts.

use ahv_analysis::statistics::{densities, normal_density};
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError};

use crate::reproduce::METHODS;
use crate::reproduce::forced::{Forced, ForcedMode};
use crate::reproduce::printed::TABLE_1;
use crate::reproduce::snapshot::{ModeSnapshot, Snapshot};
use crate::reproduce::table1::ErrorCurves;

/// Bins of a histogram, over ± as many standard deviations of η as the second number says.
const BINS: (u32, f64) = (40, 4.0);
/// Unit of η and χ.
const UNIT: &str = "[(ft·slug)^½]";
const COLOURS: [Colour; 3] = [Colour::Vermillion, Colour::Green, Colour::Purple];

fn points(x: &[f64], y: &[f64]) -> Mark {
    Mark::Line(x.iter().copied().zip(y.iter().copied()).collect())
}

/// Fig. 2: errors over time by mode, with the printed maxima as rules. Time is logarithmic, for the maxima arise in the first
/// hundredths of a second.
pub(super) fn errors(curves: &[ErrorCurves; 3]) -> Result<String, PlotError> {
    let panels = (1..)
        .zip(curves)
        .zip(TABLE_1)
        .flat_map(|((mode, curves), printed)| {
            let panel = |title: String, label, mut layers: Vec<Layer>, printed: f64| {
                for bound in [printed, -printed] {
                    layers.push(
                        Layer::new("± Table 1", Colour::Black, Mark::HorizontalRule(bound))
                            .dashed(),
                    );
                }
                Panel {
                    title,
                    x: Axis::log("time [s]"),
                    y: Axis::linear(format!("{label} {UNIT}")),
                    layers,
                }
            };
            // Nothing moves at 0 s, which a logarithmic axis cannot show.
            let sampled = |errors: &[Vec<f64>; 3]| {
                let points = curves.time.iter().copied().zip(errors[0].iter().copied());
                Layer::new(
                    "printed, sampled",
                    Colour::Orange,
                    Mark::Line(points.skip(1).collect()),
                )
            };
            let exact = METHODS.iter().zip(&curves.fine_exact_std).zip(COLOURS).map(
                |((method, errors), colour)| {
                    Layer::new(
                        format!("{}, exact", method.name()),
                        colour,
                        points(&curves.fine_time, errors),
                    )
                },
            );
            let deviations = std::iter::once(sampled(&curves.std)).chain(exact).collect();
            [
                panel(
                    format!("mode {mode}: error of the mean"),
                    "eᵐ",
                    vec![sampled(&curves.mean)],
                    printed.0,
                ),
                panel(
                    format!("mode {mode}: error of the standard deviation"),
                    "eᴰ",
                    deviations,
                    printed.1,
                ),
            ]
        });
    Figure::new("", 2, panels.collect()).svg()
}

/// Fig. 3: histograms of η and χ.
pub(super) fn histograms(snapshot: &Snapshot) -> Result<String, PlotError> {
    let panels = (1..).zip(&snapshot.modes).map(|(mode, of)| {
        let (count, reach) = BINS;
        let std = of.eta_std.1;
        let place = |index: u32| reach * std * (2.0 * f64::from(index) / f64::from(count) - 1.0);
        let edges: Vec<f64> = (0..=count).map(place).collect();
        let bars = |sample: &[f64]| Mark::Bars {
            edges: edges.clone(),
            heights: densities(sample, &edges),
        };
        let curve =
            |std: f64| Mark::Line(edges.iter().map(|&x| (x, normal_density(x, std))).collect());
        let [printed, ..] = &of.methods;
        Panel {
            title: format!("mode {mode}"),
            x: Axis::linear(format!("η, χ {UNIT}")),
            y: Axis::linear("density [1/(ft·slug)^½]"),
            layers: vec![
                Layer::new("η", Colour::Blue, bars(&of.eta)),
                Layer::new("χ, printed", COLOURS[0], bars(&printed.chi)),
                Layer::new("η, closed form", Colour::Blue, curve(std)),
                Layer::new("χ, closed form", COLOURS[0], curve(printed.chi_std.1)).dashed(),
            ],
        }
    });
    Figure::new("", 3, panels.collect()).svg()
}

/// Fig. 4: differences of the distribution functions.
pub(super) fn distributions(snapshot: &Snapshot) -> Result<String, PlotError> {
    let panels = (1..).zip(&snapshot.modes).map(|(mode, of)| {
        let places = places(of);
        let share = |sorted: &[f64], x: f64| {
            sorted.partition_point(|&y| y <= x) as f64 / sorted.len() as f64
        };
        let eta = sorted(&of.eta);
        let lines = METHODS.iter().zip(&of.methods).zip(COLOURS);
        let mut layers: Vec<Layer> = lines
            .map(|((method, of), colour)| {
                let chi = sorted(&of.chi);
                let difference = |&x: &f64| (x, share(&chi, x) - share(&eta, x));
                Layer::new(
                    method.name(),
                    colour,
                    Mark::Line(places.iter().map(difference).collect()),
                )
            })
            .collect();
        for bound in [of.methods[0].critical, -of.methods[0].critical] {
            layers.push(
                Layer::new(
                    "95 % of equal distributions",
                    Colour::Black,
                    Mark::HorizontalRule(bound),
                )
                .dashed(),
            );
        }
        Panel {
            title: format!("mode {mode}"),
            x: Axis::linear(format!("x {UNIT}")),
            y: Axis::linear("P(χ ≤ x) − P(η ≤ x)"),
            layers,
        }
    });
    Figure::new("", 3, panels.collect()).svg()
}

fn sorted(sample: &[f64]) -> Vec<f64> {
    let mut sorted = sample.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Where distribution functions are compared.
fn places(of: &ModeSnapshot) -> Vec<f64> {
    let reach = BINS.1 * of.eta_std.1;
    (0..=300)
        .map(|index| reach * (f64::from(index) / 150.0 - 1.0))
        .collect()
}

/// Fig. 5: η, η̂ and their difference under white noise.
pub(super) fn forced(forced: &Forced) -> Result<String, PlotError> {
    let [(_, white), (_, held)] = &forced.readings;
    let panels = (1..)
        .zip(white.iter().zip(held))
        .flat_map(|(mode, (white, held))| {
            let error = |of: &ForcedMode| {
                let difference: Vec<f64> = of.eta_hat[0]
                    .iter()
                    .zip(&of.eta)
                    .map(|(hat, eta)| hat - eta)
                    .collect();
                points(&of.time, &difference)
            };
            [
                Panel {
                    title: format!("mode {mode}, white noise"),
                    x: Axis::linear("time [s]"),
                    y: Axis::linear(format!("η {UNIT}")),
                    layers: vec![
                        Layer::new("η (5)", Colour::Blue, points(&white.time, &white.eta)),
                        Layer::new(
                            "η̂ (25), printed",
                            COLOURS[0],
                            points(&white.time, &white.eta_hat[0]),
                        )
                        .dashed(),
                    ],
                },
                Panel {
                    title: format!("mode {mode}, error"),
                    x: Axis::linear("time [s]"),
                    y: Axis::linear(format!("η̂ − η {UNIT}")),
                    layers: vec![
                        Layer::new("error, white noise", Colour::Orange, error(white)),
                        Layer::new("error, noise held for a step", Colour::Black, error(held)),
                    ],
                },
            ]
        });
    Figure::new("", 2, panels.collect()).svg()
}
