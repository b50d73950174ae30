//! Plots in one house style, as SVG.
//!
//! A [`Figure`] is a grid of [`Panel`]s, a panel has two [`Axis`] and [`Layer`]s that are drawn one over the other.
//! Colours are Okabe and Ito's; dashes and shapes tell layers apart in a printout in grey. Text stays text. What is not
//! finite is refused, and never drawn. A panel without data says so beside others that have some.
//!
//! ```
//! use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel};
//!
//! let decay = (0..=50).map(|k| f64::from(k) / 10.0).map(|t| (t, (-t).exp()));
//! let panel = Panel {
//!     title: String::new(),
//!     x: Axis::linear("time [s]"),
//!     y: Axis::log("amplitude [1]"),
//!     layers: vec![Layer::new("decay", Colour::Blue, Mark::Line(decay.collect()))],
//! };
//! let svg = Figure::new("A decay", 1, vec![panel]).svg()?;
//! assert!(svg.starts_with("<svg") && svg.contains("amplitude [1]"));
//! # Ok::<(), ahv_plot::PlotError>(())
//! ```
#![forbid(unsafe_code)]

mod canvas;
mod clip;
mod draw;
mod extent;
mod layer;
mod legend;

pub use layer::{Cells, Colour, Layer, Mark, Shape};

/// A picture: panels in rows, under a title and a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Title; none where it is empty.
    pub title: String,
    /// Panels in a row.
    pub columns: usize,
    /// Width and height of a panel, in pixels.
    pub panel_size: (u32, u32),
    /// Panels, row by row.
    pub panels: Vec<Panel>,
}

/// A pair of axes with what is drawn between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title; none where it is empty.
    pub title: String,
    /// The axis to the right.
    pub x: Axis,
    /// The axis upwards.
    pub y: Axis,
    /// What is drawn, the last on top.
    pub layers: Vec<Layer>,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit, e.g. `time [s]`.
    pub label: String,
    /// How values become places.
    pub scale: Scale,
    /// Least and greatest value shown; what lies outside is cut off. Without it, all data are shown.
    pub range: Option<(f64, f64)>,
    /// What stands at 0, −1, −2 … in the place of numbers; empty for numbers.
    pub names: Vec<String>,
}

/// How values become places on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equally long.
    Linear,
    /// Equal ratios are equally long; values must be positive.
    Log,
}

impl Axis {
    /// A linear axis that shows all data.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
            range: None,
            names: Vec::new(),
        }
    }

    /// An axis upwards with a row for each of `names`, the first on top: row k lies at −k.
    pub fn rows(names: Vec<String>) -> Self {
        Self {
            range: Some((0.4 - names.len() as f64, 0.6)),
            names,
            ..Self::linear("")
        }
    }

    /// A logarithmic axis that shows all data.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    /// The axis from `min` to `max`.
    pub fn within(self, min: f64, max: f64) -> Self {
        Self {
            range: Some((min, max)),
            ..self
        }
    }
}

/// Why a figure cannot be drawn. Each names the panel by its title.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// A figure without panels or columns.
    #[error("figure \"{figure}\" has no panels or no columns")]
    NoPanels {
        /// Title of the figure.
        figure: String,
    },
    /// No panel has data or a range to show; this is the first.
    #[error("panel \"{panel}\": the axis \"{axis}\" has neither data nor a range")]
    NoRange {
        /// Title of the panel.
        panel: String,
        /// Label of the axis.
        axis: String,
    },
    /// A range whose ends are not finite or not in order.
    #[error(
        "panel \"{panel}\": the axis \"{axis}\" has a range whose ends are not finite or not in order"
    )]
    BadRange {
        /// Title of the panel.
        panel: String,
        /// Label of the axis.
        axis: String,
        /// Its lower end.
        min: f64,
        /// Its upper end.
        max: f64,
    },
    /// A value is infinite or NaN.
    #[error(
        "panel \"{panel}\": layer \"{layer}\" holds a value that is not finite, which cannot be drawn"
    )]
    NonFinite {
        /// Title of the panel.
        panel: String,
        /// Name of the layer.
        layer: String,
        /// The value.
        value: f64,
    },
    /// A value that a logarithmic axis cannot show.
    #[error("panel \"{panel}\": layer \"{layer}\" holds {value:?} on a logarithmic axis")]
    NotPositive {
        /// Title of the panel.
        panel: String,
        /// Name of the layer.
        layer: String,
        /// The value.
        value: f64,
    },
    /// Lists of a layer that do not fit each other.
    #[error("panel \"{panel}\": layer \"{layer}\" needs {expected} values and has {found}")]
    Length {
        /// Title of the panel.
        panel: String,
        /// Name of the layer.
        layer: String,
        /// Values that its edges ask for.
        expected: usize,
        /// Values that it has.
        found: usize,
    },
    /// The drawing library failed.
    #[error("cannot draw: {0}")]
    Backend(String),
}

impl Figure {
    /// A figure with panels of the usual size.
    pub fn new(title: impl Into<String>, columns: usize, panels: Vec<Panel>) -> Self {
        Self {
            title: title.into(),
            columns,
            panel_size: (500, 300),
            panels,
        }
    }

    /// The picture as the text of an SVG file.
    ///
    /// # Errors
    ///
    /// [`PlotError`] for data that cannot be drawn.
    pub fn svg(&self) -> Result<String, PlotError> {
        draw::figure(self)
    }
}
