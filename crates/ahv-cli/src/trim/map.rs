//! Trims over the validity box of the first two given states, such as velocity and altitude.

use std::path::Path;
use std::str::FromStr;

use ahv_analysis::trim::{SteadyState, Trim, TrimError};
use ahv_core::Bounds;
use ahv_plot::{Axis, Cells, Colour, Figure, Layer, Mark, Panel, Shape};
use serde::Serialize;

use crate::csv_file::CsvFile;
use crate::failure::Failure;
use crate::named::{Named, shown_as};
use crate::number;
use crate::output::{self, Pairs, readable};
use crate::show::show;
use crate::vehicle::{Heading, Vehicle};

/// Points along the two given states.
#[derive(Clone, Copy)]
pub(super) struct Size([u16; 2]);

/// Most points along an axis.
const MOST: u16 = 500;

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse().ok().filter(|it| (2..=MOST).contains(it));
        let pair = text.split_once('x');
        let pair = pair.and_then(|(x, y)| Some([number(x)?, number(y)?]));
        let pair =
            pair.ok_or_else(|| format!("write it like 20x20, with numbers from 2 to {MOST}"));
        pair.map(Self)
    }
}

/// A point of the map.
struct Cell {
    at: [f64; 2],
    result: Result<Trim<Vec<f64>, Vec<f64>>, TrimError>,
}

/// Trims by rows of the second state, the first running fastest.
pub(super) struct Map<'a> {
    vehicle: &'a Vehicle,
    /// What else is given, and the inputs that are held.
    condition: Vec<(&'static str, f64)>,
    /// The two given states.
    names: [&'static str; 2],
    /// Their values.
    axes: [Vec<f64>; 2],
    /// What is mapped: what people look at of a trim, but for what there is one of for each mode.
    quantities: Vec<&'static str>,
    cells: Vec<Cell>,
}

/// How many points trim, and what blocks the others.
#[derive(Serialize)]
pub(super) struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    /// What else is given, with the inputs that are held; angles in deg, as their names say.
    #[serde(flatten)]
    condition: Named<f64>,
    units: Pairs<&'static str>,
    points: usize,
    converged: usize,
    blocked: Vec<(String, usize)>,
}

impl<'a> Map<'a> {
    /// Trims at each point from the cold start of `flight`, in which the two states are not `given` otherwise. Outputs that
    /// are given have no interval of validity, and so are not mapped.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for a model of which fewer than two states are given, and for one that is.
    pub(super) fn new(
        vehicle: &'a Vehicle,
        flight: &SteadyState,
        Size(size): Size,
        mut given: impl Iterator<Item = &'static str>,
    ) -> Result<Self, Failure> {
        let problem = vehicle.model.trim_problem();
        let states = problem.given.iter().map(|it| it.name);
        let states = states.filter(|name| vehicle.states.index_of(name).is_some());
        let [first, second, ..] = *states.collect::<Vec<_>>() else {
            let few = format!(
                "--map: fewer than two states of {} are given",
                vehicle.name()
            );
            return Err(Failure::Request(few));
        };
        let names = [first, second];
        if let Some(name) = given.find(|name| names.contains(name)) {
            return Err(Failure::Request(format!(
                "--map: {name} is mapped; leave --{name} out"
            )));
        }
        let interval = |name| {
            let index = vehicle.states.index_of(name);
            let bounds = index.and_then(|index| vehicle.state_bounds.get(index));
            bounds.copied().unwrap_or(Bounds::new(0.0, 0.0))
        };
        let axes = [0, 1].map(|axis| spaced(interval(names[axis]), size[axis]));
        let [fast, slow] = &axes;
        let points = slow.iter().flat_map(|&y| fast.iter().map(move |&x| [x, y]));
        let cells = points.map(|at| {
            let pairs = names.iter().zip(at);
            let flight = pairs.fold(flight.clone(), |flight, (name, at)| flight.with(name, at));
            Cell {
                at,
                result: vehicle.model.trim(&vehicle.parameters, &flight),
            }
        });
        let single = |name: &&&str| !name.ends_with(|last: char| last.is_ascii_digit());
        let others = flight.given().filter(|(name, _)| !names.contains(name));
        let held = vehicle.held(flight).into_iter().filter(|it| it.1 != 0.0);
        Ok(Self {
            vehicle,
            condition: others.chain(held).collect(),
            cells: cells.collect(),
            quantities: problem.shown.iter().filter(single).copied().collect(),
            names,
            axes,
        })
    }

    /// A quantity of a trim, in the model's unit.
    fn value(&self, name: &str, trim: &Trim<Vec<f64>, Vec<f64>>) -> f64 {
        let value = self.vehicle.value(name, &trim.state, &trim.input);
        value.unwrap_or(f64::NAN)
    }

    /// Why a point does not trim, in a few words.
    fn why(&self, error: &TrimError) -> String {
        let mut bounds = self.vehicle.blocking(error);
        // In one order, whichever was met first.
        bounds.sort();
        match bounds.as_slice() {
            [] => "no convergence".to_owned(),
            bounds => bounds.join(" and "),
        }
    }

    /// What blocks, and how often, in the order in which it is met.
    fn blocked(&self) -> Vec<(String, usize)> {
        let mut blocked: Vec<(String, usize)> = Vec::new();
        for error in self.cells.iter().filter_map(|it| it.result.as_ref().err()) {
            let why = self.why(error);
            match blocked.iter_mut().find(|(known, _)| *known == why) {
                Some((_, count)) => *count += 1,
                None => blocked.push((why, 1)),
            }
        }
        blocked
    }

    pub(super) fn json(&self) -> Json<'_> {
        let blocked = self.blocked();
        let failed: usize = blocked.iter().map(|it| it.1).sum();
        Json {
            heading: self.vehicle.heading(),
            condition: Named::new(self.condition.iter().map(|&(name, value)| {
                let unit = self.vehicle.unit(name);
                shown_as(name, value, unit)
            })),
            units: self.vehicle.point_units(),
            points: self.cells.len(),
            converged: self.cells.len() - failed,
            blocked,
        }
    }

    pub(super) fn text(&self, folder: &Path) -> String {
        let Json {
            points, converged, ..
        } = self.json();
        let blocked = self.blocked().into_iter();
        let blocked: String = blocked
            .map(|(why, count)| format!("\n  {count} are blocked by {why}"))
            .collect();
        format!(
            "{}: {converged} of {points} points trim{}, written to {}\n{}{blocked}",
            self.vehicle.name(),
            self.at(),
            folder.display(),
            self.vehicle.described()
        )
    }

    /// What else is given, for a person.
    fn at(&self) -> String {
        let given = self.condition.iter().map(|&(name, value)| {
            let unit = self.vehicle.unit(name);
            format!(", {name} {}", show(value, unit))
        });
        given.collect()
    }

    /// Writes the points as CSV.
    ///
    /// # Errors
    ///
    /// [`Failure`] if a file cannot be written.
    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let mut csv = CsvFile::create(&folder.join("trim_map.csv"))?;
        csv.row(&self.header())?;
        for cell in &self.cells {
            csv.row(&self.record(cell))?;
        }
        csv.finish()
    }

    /// Draws the picture.
    ///
    /// # Errors
    ///
    /// [`Failure`] if the file cannot be written.
    pub(super) fn draw(&self, folder: &Path) -> Result<(), Failure> {
        output::picture(&folder.join("trim_map.svg"), self.figure().svg())
    }

    /// What else is given or held elsewhere than at 0.
    fn elsewhere(&self) -> impl Iterator<Item = &(&'static str, f64)> {
        self.condition.iter().filter(|it| it.1 != 0.0)
    }

    fn header(&self) -> Vec<String> {
        let label = |name: &&str| format!("{name} [{}]", self.vehicle.unit(name));
        let mut header: Vec<String> = self.names.iter().map(label).collect();
        header.extend(self.elsewhere().map(|(name, _)| label(name)));
        header.push("converged".to_owned());
        header.extend(self.quantities.iter().map(label));
        header.push("blocking_bound".to_owned());
        header
    }

    fn record(&self, cell: &Cell) -> Vec<String> {
        let mut record: Vec<String> = cell.at.map(number::cell).into();
        record.extend(self.elsewhere().map(|it| number::cell(it.1)));
        record.push(cell.result.is_ok().to_string());
        record.extend(self.quantities.iter().map(|name| match &cell.result {
            Ok(trim) => number::cell(self.value(name, trim)),
            Err(_) => String::new(),
        }));
        let why = cell.result.as_ref().err().map(|error| self.why(error));
        record.push(why.unwrap_or_default());
        record
    }

    fn figure(&self) -> Figure {
        let maps = self.quantities.iter().map(|name| {
            let (unit, factor) = readable(self.vehicle.unit(name));
            let value = |cell: &Cell| {
                let trim = cell.result.as_ref().ok()?;
                Some(self.value(name, trim) * factor)
            };
            let cells = Cells {
                x: edges(&self.axes[0]),
                y: edges(&self.axes[1]),
                values: self.cells.iter().map(value).collect(),
                label: format!("{name} [{unit}]"),
            };
            self.panel(
                name,
                vec![Layer::new("", Colour::Black, Mark::Cells(cells))],
            )
        });
        let mut panels: Vec<Panel> = maps.collect();
        panels.push(self.panel("Trim, or the bound that blocks it", self.outcomes()));
        let title = format!(
            "Trims of {}{}, {}",
            self.vehicle.name(),
            self.at(),
            self.vehicle.described()
        );
        Figure::new(title, 2, panels)
    }

    /// The points that trim, and those that do not by the bound that blocks.
    fn outcomes(&self) -> Vec<Layer> {
        let points = |wanted: &dyn Fn(&Cell) -> bool| {
            let cells = self.cells.iter().filter(|cell| wanted(cell));
            cells.map(|cell| (cell.at[0], cell.at[1])).collect()
        };
        let trims = points(&|cell| cell.result.is_ok());
        let mut layers = vec![Layer::new(
            "trims",
            Colour::Blue,
            Mark::Markers(Shape::Dot, trims),
        )];
        let shapes = [Shape::Cross, Shape::Square, Shape::Diamond, Shape::Plus];
        let looks = Colour::CYCLE
            .into_iter()
            .skip(1)
            .zip(shapes.into_iter().cycle());
        for ((why, _), (colour, shape)) in self.blocked().into_iter().zip(looks) {
            let blocked = points(&|cell| {
                cell.result
                    .as_ref()
                    .is_err_and(|error| self.why(error) == why)
            });
            layers.push(Layer::new(why, colour, Mark::Markers(shape, blocked)));
        }
        layers
    }

    fn panel(&self, title: &str, layers: Vec<Layer>) -> Panel {
        let axis = |name: &str, places: &[f64]| {
            let edges = edges(places);
            let unit = self.vehicle.states.unit(name);
            let axis = Axis::linear(format!("{name} [{unit}]"));
            match (edges.first(), edges.last()) {
                (Some(&first), Some(&last)) => axis.within(first, last),
                _ => axis,
            }
        };
        Panel {
            title: title.to_owned(),
            x: axis(self.names[0], &self.axes[0]),
            y: axis(self.names[1], &self.axes[1]),
            layers,
        }
    }
}

/// `count` places from end to end.
fn spaced(bounds: Bounds, count: u16) -> Vec<f64> {
    let last = f64::from(count - 1);
    let place = |index| {
        let share = f64::from(index) / last;
        bounds.min * (1.0 - share) + bounds.max * share
    };
    (0..count).map(place).collect()
}

/// Edges of cells around places that lie equally far apart.
fn edges(places: &[f64]) -> Vec<f64> {
    let [first, second, ..] = places else {
        return places.to_vec();
    };
    let half = 0.5 * (second - first);
    let upper = places.iter().map(|place| place + half);
    std::iter::once(first - half).chain(upper).collect()
}
