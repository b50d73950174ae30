//! What is drawn between the axes.

use plotters::style::RGBColor;

use crate::extent::bad_range;
use crate::{Panel, PlotError, Scale};

/// A series of data and how it looks.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name in the legend; layers without one are not in it. Layers of one name look alike in all panels.
    pub name: String,
    /// Colour of Okabe and Ito's palette.
    pub colour: Colour,
    /// Lines and rules in dashes.
    pub dashed: bool,
    /// The data, and what is made of them.
    pub mark: Mark,
}

/// Data in the units of the axes, and what is made of them.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// Points (x, y) joined by straight lines.
    Line(Vec<(f64, f64)>),
    /// The area between two curves: x, lower y, upper y.
    Band(Vec<(f64, f64, f64)>),
    /// A shape at each point (x, y).
    Markers(Shape, Vec<(f64, f64)>),
    /// Bars from 0, one between each two edges. On a logarithmic axis they start at its lower end.
    Bars {
        /// Edges in x, ascending.
        edges: Vec<f64>,
        /// Heights in y, one fewer than edges.
        heights: Vec<f64>,
    },
    /// A line across the panel at this y.
    HorizontalRule(f64),
    /// A line across the panel at this x.
    VerticalRule(f64),
    /// A heat map with its colour bar.
    Cells(Cells),
    /// A text that starts at a point.
    Label {
        /// Its left end, half up.
        at: (f64, f64),
        /// What it says.
        text: String,
    },
}

/// Values on a grid of rectangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// Edges in x, ascending.
    pub x: Vec<f64>,
    /// Edges in y, ascending.
    pub y: Vec<f64>,
    /// Values by rows of y, x running fastest; a cell without value stays empty.
    pub values: Vec<Option<f64>>,
    /// Quantity and unit at the colour bar.
    pub label: String,
}

impl Cells {
    /// Least and greatest value; a little apart if they are equal.
    pub(crate) fn shading(&self) -> (f64, f64) {
        let values = self.values.iter().flatten().copied();
        let min = values.clone().fold(f64::INFINITY, f64::min);
        let max = values.fold(f64::NEG_INFINITY, f64::max);
        if min > max {
            return (0.0, 1.0);
        }
        let room = (1e-6 * min.abs()).max(1e-9);
        if max - min < room {
            (min - room, max + room)
        } else {
            (min, max)
        }
    }
}

/// A marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A ring.
    Circle,
    /// A filled disc.
    Dot,
    /// A small filled disc, for clouds.
    Point,
    /// A diagonal cross.
    Cross,
    /// An upright cross.
    Plus,
    /// A square.
    Square,
    /// A square on its corner.
    Diamond,
}

/// Okabe and Ito's colours, which colour-blind readers tell apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Black.
    Black,
    /// Blue.
    Blue,
    /// Vermillion.
    Vermillion,
    /// Bluish green.
    Green,
    /// Orange.
    Orange,
    /// Sky blue.
    SkyBlue,
    /// Reddish purple.
    Purple,
    /// Grey, for what is of less interest.
    Grey,
}

impl Colour {
    /// Colours in the order in which layers of equal rank take them.
    pub const CYCLE: [Self; 6] = [
        Self::Blue,
        Self::Vermillion,
        Self::Green,
        Self::Orange,
        Self::SkyBlue,
        Self::Purple,
    ];

    pub(crate) const fn rgb(self) -> RGBColor {
        match self {
            Self::Black => RGBColor(0, 0, 0),
            Self::Blue => RGBColor(0, 114, 178),
            Self::Vermillion => RGBColor(213, 94, 0),
            Self::Green => RGBColor(0, 158, 115),
            Self::Orange => RGBColor(230, 159, 0),
            Self::SkyBlue => RGBColor(86, 180, 233),
            Self::Purple => RGBColor(204, 121, 167),
            Self::Grey => RGBColor(127, 127, 127),
        }
    }
}

impl Layer {
    /// A layer drawn with full lines.
    pub fn new(name: impl Into<String>, colour: Colour, mark: Mark) -> Self {
        Self {
            name: name.into(),
            colour,
            dashed: false,
            mark,
        }
    }

    /// The layer in dashes.
    pub fn dashed(self) -> Self {
        Self {
            dashed: true,
            ..self
        }
    }

    /// Values along x.
    pub(crate) fn xs(&self) -> Vec<f64> {
        match &self.mark {
            Mark::Line(points) | Mark::Markers(_, points) => points.iter().map(|p| p.0).collect(),
            Mark::Band(points) => points.iter().map(|p| p.0).collect(),
            Mark::Bars { edges, .. } => edges.clone(),
            Mark::HorizontalRule(_) => Vec::new(),
            Mark::Label { at, .. } => vec![at.0],
            Mark::VerticalRule(x) => vec![*x],
            Mark::Cells(cells) => cells.x.clone(),
        }
    }

    /// Values along y.
    pub(crate) fn ys(&self) -> Vec<f64> {
        match &self.mark {
            Mark::Line(points) | Mark::Markers(_, points) => points.iter().map(|p| p.1).collect(),
            Mark::Band(points) => points.iter().flat_map(|p| [p.1, p.2]).collect(),
            Mark::Bars { heights, .. } => heights.clone(),
            Mark::HorizontalRule(y) => vec![*y],
            Mark::VerticalRule(_) => Vec::new(),
            Mark::Label { at, .. } => vec![at.1],
            Mark::Cells(cells) => cells.y.clone(),
        }
    }

    /// Refuses what cannot be drawn in `panel`.
    pub(crate) fn check(&self, panel: &Panel) -> Result<(), PlotError> {
        let names = || (panel.title.clone(), self.name.clone());
        let others: Vec<f64> = match &self.mark {
            Mark::Cells(cells) => cells.values.iter().copied().flatten().collect(),
            _ => Vec::new(),
        };
        for (values, scale) in [
            (self.xs(), panel.x.scale),
            (self.ys(), panel.y.scale),
            (others, Scale::Linear),
        ] {
            if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
                let (panel, layer) = names();
                return Err(PlotError::NonFinite {
                    panel,
                    layer,
                    value,
                });
            }
            // An empty bar is no bar on a logarithmic axis.
            let least = |value: f64| match self.mark {
                Mark::Bars { .. } => value < 0.0,
                _ => value <= 0.0,
            };
            let value = values.iter().copied().find(|&value| least(value));
            if let (Scale::Log, Some(value)) = (scale, value) {
                let (panel, layer) = names();
                return Err(PlotError::NotPositive {
                    panel,
                    layer,
                    value,
                });
            }
        }
        if let Mark::Cells(cells) = &self.mark {
            let (min, max) = cells.shading();
            if !(max - min).is_finite() {
                return Err(bad_range(panel, &cells.label, (min, max)));
            }
        }
        let (expected, found) = match &self.mark {
            Mark::Bars { edges, heights } => (edges.len().saturating_sub(1), heights.len()),
            Mark::Cells(Cells { x, y, values, .. }) => {
                let cells = x.len().saturating_sub(1) * y.len().saturating_sub(1);
                (cells, values.len())
            }
            _ => return Ok(()),
        };
        if expected == found {
            return Ok(());
        }
        let (panel, layer) = names();
        Err(PlotError::Length {
            panel,
            layer,
            expected,
            found,
        })
    }
}
