//! The legend of a figure: every name once.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::canvas::{Area, FONT, Failed, LINE, SUBPIXELS, dashes, draw_marker, px, text_width};
use crate::{Figure, Layer, Mark};

/// Height of a row, in pixels.
const ROW: u32 = 24;
/// Length of a sample of a line, in pixels.
const SAMPLE: u32 = 34;
/// Room between a sample and its name, and between two entries, in pixels.
const GAPS: (u32, u32) = (7, 26);
/// Entries with the places of their samples, in pixels.
pub(crate) struct Legend<'a> {
    entries: Vec<(&'a Layer, u32, u32)>,
    /// Height in pixels.
    pub(crate) height: u32,
}

impl<'a> Legend<'a> {
    /// The names of all panels, in rows of `width` pixels.
    pub(crate) fn new(figure: &'a Figure, width: u32) -> Self {
        let mut entries: Vec<(&Layer, u32, u32)> = Vec::new();
        let (mut x, mut row) = (GAPS.1, 0);
        for layer in figure.panels.iter().flat_map(|panel| &panel.layers) {
            let known = entries.iter().any(|(entry, ..)| entry.name == layer.name);
            if layer.name.is_empty() || known {
                continue;
            }
            let name = text_width(layer.name.chars().count());
            let length = SAMPLE + GAPS.0 + name + GAPS.1;
            if x + length > width && x > GAPS.1 {
                (x, row) = (GAPS.1, row + 1);
            }
            entries.push((layer, x, row));
            x += length;
        }
        let height = if entries.is_empty() {
            0
        } else {
            (row + 1) * ROW + 6
        };
        Self { entries, height }
    }

    /// Draws the entries from the top of `area`.
    pub(crate) fn draw(&self, area: &Area<'_>) -> Result<(), Failed> {
        for &(layer, x, row) in &self.entries {
            let (left, right, y) = (px(x), px(x + SAMPLE), px(row * ROW + ROW / 2));
            let stroke = layer.colour.rgb().stroke_width(LINE * SUBPIXELS);
            match &layer.mark {
                Mark::Line(_) | Mark::HorizontalRule(_) | Mark::VerticalRule(_) if layer.dashed => {
                    let (dash, gap) = dashes();
                    let stride = usize::try_from(dash + gap).unwrap_or(1);
                    for start in (left..right).step_by(stride) {
                        let end = (start + dash).min(right);
                        area.draw(&PathElement::new([(start, y), (end, y)], stroke))?;
                    }
                }
                Mark::Line(_) | Mark::HorizontalRule(_) | Mark::VerticalRule(_) => {
                    area.draw(&PathElement::new([(left, y), (right, y)], stroke))?;
                }
                Mark::Markers(shape, _) => {
                    let centre = (left.midpoint(right), y);
                    draw_marker(area, *shape, centre, layer.colour)?;
                }
                // A text is its own legend.
                Mark::Label { .. } => {}
                Mark::Band(_) | Mark::Bars { .. } | Mark::Cells(_) => {
                    let fill = layer.colour.rgb().mix(0.35).filled();
                    let corners = [(left, y - px(6)), (right, y + px(6))];
                    area.draw(&Rectangle::new(corners, fill))?;
                }
            }
            let font = ("sans-serif", FONT * SUBPIXELS).into_font();
            let style = TextStyle::from(font).pos(Pos::new(HPos::Left, VPos::Center));
            let place = (right + px(GAPS.0), y);
            area.draw(&Text::new(layer.name.clone(), place, style))?;
        }
        Ok(())
    }
}
