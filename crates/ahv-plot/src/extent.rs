//! What an axis shows, and its ticks.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

use crate::{Axis, Layer, Mark, Panel, PlotError, Scale};

/// Room beyond the data, as a fraction of their extent.
const ROOM: f64 = 0.04;
/// Ticks of a linear axis, at most.
const MOST_TICKS: f64 = 7.0;
/// Length of the shortest axis.
const SHORTEST: f64 = 1e3 * f64::MIN_POSITIVE;
/// Decades that a logarithmic axis must span to have ticks at decades only.
const FEW_DECADES: f64 = 2.5;

/// The interval that an axis shows. Coordinates in it are scaled: logarithms on a logarithmic axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub(crate) scale: Scale,
    pub(crate) min: f64,
    pub(crate) max: f64,
    /// Whether every whole number has a tick, for it has a name.
    pub(crate) named: bool,
}

impl Extent {
    /// Of the axis to the right.
    pub(crate) fn x(panel: &Panel) -> Result<Self, PlotError> {
        Self::new(panel, &panel.x, Layer::xs, false)
    }

    /// Of the axis upwards.
    pub(crate) fn y(panel: &Panel) -> Result<Self, PlotError> {
        let bars = |layer: &Layer| matches!(layer.mark, Mark::Bars { .. });
        let from_zero = panel.y.scale == Scale::Linear && panel.layers.iter().any(bars);
        Self::new(panel, &panel.y, Layer::ys, from_zero)
    }

    fn new(
        panel: &Panel,
        axis: &Axis,
        values: fn(&Layer) -> Vec<f64>,
        from_zero: bool,
    ) -> Result<Self, PlotError> {
        let scale = axis.scale;
        if let Some((min, max)) = axis.range {
            if scale == Scale::Log && min <= 0.0 {
                return Err(bad_range(panel, &axis.label, (min, max)));
            }
            return Self::between(panel, axis, (scale.of(min), scale.of(max)));
        }
        let mut data: Vec<f64> = panel.layers.iter().flat_map(values).collect();
        data.retain(|&value| scale == Scale::Linear || value > 0.0);
        if from_zero {
            data.push(0.0);
        }
        let ends = data.iter().map(|&value| scale.of(value));
        let min = ends.clone().fold(f64::INFINITY, f64::min);
        let max = ends.fold(f64::NEG_INFINITY, f64::max);
        if data.is_empty() {
            let (panel, axis) = (panel.title.clone(), axis.label.clone());
            return Err(PlotError::NoRange { panel, axis });
        }
        // Equal data get an axis all the same.
        let room = (ROOM * (max - min))
            .max(1e-6 * max.abs().max(min.abs()))
            .max(1e-9);
        let cells = |layer: &Layer| matches!(layer.mark, Mark::Cells(_));
        let room_at = |end: f64| {
            let flush = (from_zero && end == 0.0) || panel.layers.iter().any(cells);
            if flush { 0.0 } else { room }
        };
        Self::between(panel, axis, (min - room_at(min), max + room_at(max)))
    }

    /// From one end to the other, scaled.
    fn between(panel: &Panel, axis: &Axis, (min, max): (f64, f64)) -> Result<Self, PlotError> {
        // Ticks of a shorter one would be too small for numbers.
        if !(max - min >= SHORTEST && (max - min).is_finite()) {
            return Err(bad_range(panel, &axis.label, (min, max)));
        }
        Ok(Self {
            scale: axis.scale,
            min,
            max,
            named: !axis.names.is_empty(),
        })
    }

    /// `value`, scaled and moved to the next end if it lies outside.
    pub(crate) fn clamp(&self, value: f64) -> f64 {
        self.scale.of(value).clamp(self.min, self.max)
    }

    /// Where ticks are, scaled.
    pub(crate) fn ticks(&self) -> Vec<f64> {
        match self.scale {
            Scale::Linear if self.named => {
                let (first, last) = (self.min.ceil() as i32, self.max.floor() as i32);
                (first..=last).map(f64::from).collect()
            }
            Scale::Linear => linear_ticks(self.min, self.max),
            Scale::Log => log_ticks(self.min, self.max),
        }
    }

    /// What stands at the tick `scaled`.
    pub(crate) fn label(&self, scaled: f64) -> String {
        match self.scale {
            Scale::Linear => decimal(scaled, step(self.min, self.max)),
            Scale::Log if self.max - self.min < FEW_DECADES => {
                let value = 10_f64.powf(scaled);
                decimal(value, 10_f64.powf(scaled.floor()))
            }
            Scale::Log => format!("10{}", superscript(scaled.round())),
        }
    }
}

/// An axis that cannot be drawn.
pub(crate) fn bad_range(panel: &Panel, axis: &str, (min, max): (f64, f64)) -> PlotError {
    PlotError::BadRange {
        panel: panel.title.clone(),
        axis: axis.to_owned(),
        min,
        max,
    }
}

impl Scale {
    /// The coordinate of a value.
    pub(crate) fn of(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Log => value.log10(),
        }
    }
}

impl Ranged for Extent {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let fraction = (value - self.min) / (self.max - self.min);
        let length = f64::from(limit.1 - limit.0);
        limit.0 + (fraction * length).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> Range<f64> {
        self.min..self.max
    }
}

/// 1, 2 or 5 times a power of ten, such that the ticks are not too many.
fn step(min: f64, max: f64) -> f64 {
    let rough = (max - min) / MOST_TICKS;
    let power = 10_f64.powf(rough.log10().floor());
    let factors = [1.0, 2.0, 5.0, 10.0];
    let factor = factors.into_iter().find(|factor| factor * power >= rough);
    factor.unwrap_or(10.0) * power
}

fn linear_ticks(min: f64, max: f64) -> Vec<f64> {
    let step = step(min, max);
    let (first, last) = ((min / step).ceil(), (max / step).floor());
    let count = (last - first).clamp(0.0, 2.0 * MOST_TICKS) as u32;
    (0..=count)
        .map(|index| (first + f64::from(index)) * step)
        .collect()
}

fn log_ticks(min: f64, max: f64) -> Vec<f64> {
    let decades = max - min;
    let stride = (decades / MOST_TICKS).ceil().max(1.0);
    let within: &[f64] = if decades < FEW_DECADES {
        &[1.0, 2.0, 5.0]
    } else {
        &[1.0]
    };
    let mut ticks = Vec::new();
    let mut decade = (min / stride).floor() * stride;
    while decade <= max {
        ticks.extend(within.iter().map(|factor| decade + factor.log10()));
        decade += stride;
    }
    let slack = 1e-9 * decades;
    ticks.retain(|tick| (min - slack..=max + slack).contains(tick));
    ticks
}

/// `value` to the decimals that `step` resolves.
fn decimal(value: f64, step: f64) -> String {
    // A tick next to zero is zero, without the sign that rounding leaves.
    let value = if value.abs() < 1e-9 * step {
        0.0
    } else {
        value
    };
    let decimals = (-step.log10().floor()).max(0.0) as usize;
    let text = if decimals > 5 || value.abs() >= 1e7 {
        format!("{value:.1e}").replace(".0e", "e")
    } else {
        format!("{value:.decimals$}")
    };
    text.replace('-', "\u{2212}")
}

fn superscript(exponent: f64) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32('⁰' as u32 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    format!("{exponent:.0}").chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::{Extent, linear_ticks};
    use crate::Scale;

    #[test]
    fn ticks_are_round_numbers_with_as_many_digits_as_they_need() {
        let labels = |scale, min, max| -> Vec<String> {
            let named = false;
            let extent = Extent {
                scale,
                min,
                max,
                named,
            };
            let ticks = extent.ticks();
            ticks.into_iter().map(|tick| extent.label(tick)).collect()
        };
        assert_eq!(
            labels(Scale::Linear, -0.11, 0.21),
            ["−0.10", "−0.05", "0.00", "0.05", "0.10", "0.15", "0.20"]
        );
        assert_eq!(labels(Scale::Linear, 84_999.0, 85_004.0).len(), 6);
        assert_eq!(
            labels(Scale::Log, -4.0, 1.0),
            ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]
        );
        assert_eq!(
            labels(Scale::Log, -1.0, 0.5),
            ["0.1", "0.2", "0.5", "1", "2"]
        );
        assert_eq!(linear_ticks(0.0, 1e-12).len(), 6);
    }
}
