//! Trims over the validity box of velocity and altitude.

use std::path::Path;
use std::str::FromStr;

use ahv_analysis::trim::{SteadyFlight, Trim, TrimError, trim};
use ahv_core::{Bounds, Vector};
use ahv_plot::{Axis, Cells, Colour, Figure, Layer, Mark, Panel, Shape};
use serde::Serialize;

use crate::condition::Vehicle;
use crate::csv_file::CsvFile;
use crate::failure::Failure;
use crate::number;
use crate::output;
use crate::vehicle::FlightModel;

/// Points along velocity and altitude.
#[derive(Clone, Copy)]
pub(super) struct Size {
    velocity: u16,
    altitude: u16,
}

/// Most points along an axis.
const MOST: u16 = 500;

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse().ok().filter(|it| (2..=MOST).contains(it));
        let pair = text.split_once('x');
        let pair = pair.and_then(|(v, h)| Some((number(v)?, number(h)?)));
        let (velocity, altitude) =
            pair.ok_or_else(|| format!("write it like 20x20, with numbers from 2 to {MOST}"))?;
        Ok(Self { velocity, altitude })
    }
}

/// A point of the map.
struct Cell<M: FlightModel> {
    velocity: f64,
    altitude: f64,
    result: Result<Trim<M::State, M::Input>, TrimError>,
}

/// Trims by rows of altitude, velocity running fastest.
pub(super) struct Map<'a, M: FlightModel> {
    vehicle: &'a Vehicle<M>,
    velocities: Vec<f64>,
    altitudes: Vec<f64>,
    cells: Vec<Cell<M>>,
}

/// How many points trim, and what blocks the others.
#[derive(Serialize)]
pub(super) struct Json<'a> {
    model: &'static str,
    set: &'a str,
    points: usize,
    converged: usize,
    blocked: Vec<(String, usize)>,
}

impl<'a, M: FlightModel> Map<'a, M> {
    /// Trims at each point from the cold start of `flight`, whose velocity and altitude do not count.
    pub(super) fn new(
        vehicle: &'a Vehicle<M>,
        flight: &SteadyFlight<M::Input>,
        size: Size,
    ) -> Self {
        let interval = |name| {
            let index = M::State::index_of(name);
            let bounds = index.and_then(|index| vehicle.state_bounds.get(index));
            bounds.unwrap_or(Bounds::new(0.0, 0.0))
        };
        let velocities = spaced(interval("velocity"), size.velocity);
        let altitudes = spaced(interval("altitude"), size.altitude);
        let points = altitudes.iter().flat_map(|&altitude| {
            let point = move |&velocity| (velocity, altitude);
            velocities.iter().map(point)
        });
        let cells = points.map(|(velocity, altitude)| {
            let flight = SteadyFlight {
                velocity,
                altitude,
                ..*flight
            };
            Cell {
                velocity,
                altitude,
                result: trim(&vehicle.model, &flight),
            }
        });
        Self {
            vehicle,
            cells: cells.collect(),
            velocities,
            altitudes,
        }
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
            model: M::NAME,
            set: &self.vehicle.set,
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
            "{}: {converged} of {points} points trim, written to {}\n{}{blocked}",
            M::NAME,
            folder.display(),
            self.vehicle.described()
        )
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

    fn header(&self) -> Vec<String> {
        let label = |name| self.vehicle.units.label::<M::State>(name);
        vec![
            format!("velocity [{}]", label("velocity")),
            format!("altitude [{}]", label("altitude")),
            "converged".to_owned(),
            "alpha [rad]".to_owned(),
            "phi [1]".to_owned(),
            "delta_e [rad]".to_owned(),
            "blocking_bound".to_owned(),
        ]
    }

    fn record(&self, cell: &Cell<M>) -> Vec<String> {
        let mut record = vec![number::cell(cell.velocity), number::cell(cell.altitude)];
        match &cell.result {
            Ok(trim) => {
                record.push("true".to_owned());
                record.extend(QUANTITIES.map(|it| number::cell(it.of::<M>(trim))));
                record.push(String::new());
            }
            Err(error) => {
                record.push("false".to_owned());
                record.extend(QUANTITIES.map(|_| String::new()));
                record.push(self.why(error));
            }
        }
        record
    }

    fn figure(&self) -> Figure {
        let maps = QUANTITIES.into_iter().map(|quantity| {
            let value = |cell: &Cell<M>| {
                let trim = cell.result.as_ref().ok()?;
                Some(quantity.of::<M>(trim) * quantity.shown)
            };
            let cells = Cells {
                x: edges(&self.velocities),
                y: edges(&self.altitudes),
                values: self.cells.iter().map(value).collect(),
                label: quantity.label.to_owned(),
            };
            self.panel(
                quantity.title,
                vec![Layer::new("", Colour::Black, Mark::Cells(cells))],
            )
        });
        let mut panels: Vec<Panel> = maps.collect();
        panels.push(self.panel("Trim, or the bound that blocks it", self.outcomes()));
        let title = format!("Trims of {}, {}", M::NAME, self.vehicle.described());
        Figure::new(title, 2, panels)
    }

    /// The points that trim, and those that do not by the bound that blocks.
    fn outcomes(&self) -> Vec<Layer> {
        let points = |wanted: &dyn Fn(&Cell<M>) -> bool| {
            let cells = self.cells.iter().filter(|cell| wanted(cell));
            cells.map(|cell| (cell.velocity, cell.altitude)).collect()
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
            let unit = self.vehicle.units.label::<M::State>(name);
            let axis = Axis::linear(format!("{name} [{unit}]"));
            match (edges.first(), edges.last()) {
                (Some(&first), Some(&last)) => axis.within(first, last),
                _ => axis,
            }
        };
        Panel {
            title: title.to_owned(),
            x: axis("velocity", &self.velocities),
            y: axis("altitude", &self.altitudes),
            layers,
        }
    }
}

/// What a map shows of a trim.
#[derive(Clone, Copy)]
struct Quantity {
    name: &'static str,
    title: &'static str,
    label: &'static str,
    /// Factor from the model's unit to the shown one.
    shown: f64,
}

/// A radian in degrees.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

const QUANTITIES: [Quantity; 3] = [
    Quantity {
        name: "alpha",
        title: "Angle of attack",
        label: "alpha [deg]",
        shown: DEGREES,
    },
    Quantity {
        name: "phi",
        title: "Fuel equivalence ratio",
        label: "phi [1]",
        shown: 1.0,
    },
    Quantity {
        name: "delta_e",
        title: "Elevator",
        label: "delta_e [deg]",
        shown: DEGREES,
    },
];

impl Quantity {
    /// The value in the model's unit.
    fn of<M: FlightModel>(&self, trim: &Trim<M::State, M::Input>) -> f64 {
        let state = M::State::index_of(self.name).and_then(|index| trim.state.get(index));
        let input = || M::Input::index_of(self.name).and_then(|index| trim.input.get(index));
        state.or_else(input).unwrap_or(f64::NAN)
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
