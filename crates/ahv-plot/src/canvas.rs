//! What is drawn on, its measures, and the marks that both a panel and the legend show.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::{Colour, Shape};

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(crate) type Failed = Box<dyn Error>;

/// The drawing library places on whole pixels; the figure is drawn this much larger and shown smaller.
pub(crate) const SUBPIXELS: u32 = 8;
/// Size of small text, in pixels.
pub(crate) const FONT: u32 = 14;
/// Width of lines, in pixels.
pub(crate) const LINE: u32 = 2;
/// Half a marker, in pixels.
const MARKER: u32 = 5;
/// Width of a letter as a share of the size of the font; SVG does not tell.
const LETTER: f64 = 0.53;

/// Pixels as the drawing library counts them.
pub(crate) fn px(pixels: u32) -> i32 {
    (pixels * SUBPIXELS).cast_signed()
}

/// Length of a dash and of the gap after it.
pub(crate) fn dashes() -> (i32, i32) {
    (px(7), px(4))
}

/// Width of small text of so many letters, in pixels.
pub(crate) fn text_width(letters: usize) -> u32 {
    (letters as f64 * LETTER * f64::from(FONT)).ceil() as u32
}

/// Draws a marker at a place of `area`.
pub(crate) fn draw_marker(
    area: &Area<'_>,
    shape: Shape,
    (x, y): (i32, i32),
    colour: Colour,
) -> Result<(), Failed> {
    let (r, style) = (px(MARKER), colour.rgb().stroke_width(LINE * SUBPIXELS));
    let path = |places: &[(i32, i32)]| {
        let places: Vec<_> = places
            .iter()
            .map(|&(a, b)| (x + a * r, y + b * r))
            .collect();
        area.draw(&PathElement::new(places, style))
    };
    match shape {
        Shape::Circle => area.draw(&Circle::new((x, y), r, style))?,
        Shape::Dot => area.draw(&Circle::new((x, y), r, style.filled()))?,
        Shape::Point => area.draw(&Circle::new((x, y), r / 3, style.filled()))?,
        Shape::Cross => area.draw(&Cross::new((x, y), r, style))?,
        Shape::Plus => {
            path(&[(-1, 0), (1, 0)])?;
            path(&[(0, -1), (0, 1)])?;
        }
        Shape::Square => path(&[(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)])?,
        Shape::Diamond => path(&[(-1, 0), (0, -1), (1, 0), (0, 1), (-1, 0)])?,
    }
    Ok(())
}
