//! From a figure to SVG.

use plotters::coord::ranged1d::Ranged;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::canvas::{Area, FONT, Failed, LINE, SUBPIXELS, dashes, draw_marker, px, text_width};
use crate::clip::inside;
use crate::extent::Extent;
use crate::legend::Legend;
use crate::{Axis, Cells, Figure, Layer, Mark, Panel, PlotError, Scale};

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Extent, Extent>>;

/// Heights of the titles of figure and panel, in pixels.
const TITLES: (u32, u32) = (34, 17);
/// Width of a colour bar with its labels, in pixels.
const COLOUR_BAR: u32 = 96;
/// Shades of a colour bar.
const SHADES: u32 = 64;

/// The text of the SVG file.
pub(crate) fn figure(figure: &Figure) -> Result<String, PlotError> {
    if figure.panels.is_empty() || figure.columns == 0 {
        return Err(PlotError::NoPanels {
            figure: figure.title.clone(),
        });
    }
    let columns = figure.columns.min(figure.panels.len());
    let rows = figure.panels.len().div_ceil(columns);
    let mut extents = Vec::new();
    for panel in &figure.panels {
        for layer in &panel.layers {
            layer.check(panel)?;
        }
        extents.push(extent(panel)?);
    }
    let empty = extents.iter().all(Option::is_none);
    if let Some(first) = figure.panels.first().filter(|_| empty) {
        let (panel, axis) = (first.title.clone(), first.x.label.clone());
        return Err(PlotError::NoRange { panel, axis });
    }
    let width = figure.panel_size.0 * columns as u32;
    let legend = Legend::new(figure, width);
    let title = if figure.title.is_empty() { 0 } else { TITLES.0 };
    let height = title + legend.height + figure.panel_size.1 * rows as u32;
    let mut svg = String::new();
    draw(
        figure,
        &extents,
        &legend,
        (width, height),
        (rows, columns),
        &mut svg,
    )
    .map_err(|error| PlotError::Backend(error.to_string()))?;
    let size = |scale: u32| format!("width=\"{}\" height=\"{}\"", width * scale, height * scale);
    Ok(svg.replacen(&size(SUBPIXELS), &size(1), 1))
}

/// What the axes of a panel show; `None` without data.
fn extent(panel: &Panel) -> Result<Option<(Extent, Extent)>, PlotError> {
    match (Extent::x(panel), Extent::y(panel)) {
        (Err(PlotError::NoRange { .. }), _) | (_, Err(PlotError::NoRange { .. })) => Ok(None),
        (x, y) => Ok(Some((x?, y?))),
    }
}

fn draw(
    figure: &Figure,
    extents: &[Option<(Extent, Extent)>],
    legend: &Legend<'_>,
    (width, height): (u32, u32),
    grid: (usize, usize),
    svg: &mut String,
) -> Result<(), Failed> {
    let size = (width * SUBPIXELS, height * SUBPIXELS);
    let area = SVGBackend::with_string(svg, size).into_drawing_area();
    area.fill(&WHITE)?;
    let mut below = area.clone();
    if !figure.title.is_empty() {
        let (title, rest) = below.split_vertically(px(TITLES.0));
        let style = TextStyle::from(("sans-serif", 19 * SUBPIXELS).into_font())
            .pos(Pos::new(HPos::Center, VPos::Center));
        title.draw(&Text::new(
            figure.title.clone(),
            (px(width) / 2, px(TITLES.0) / 2),
            style,
        ))?;
        below = rest;
    }
    let (head, panels) = below.split_vertically(px(legend.height));
    legend.draw(&head)?;
    for ((panel, extent), panel_area) in figure
        .panels
        .iter()
        .zip(extents)
        .zip(panels.split_evenly(grid))
    {
        match extent {
            Some(extent) => draw_panel(panel, *extent, &panel_area, &area)?,
            None => draw_without_data(panel, &panel_area)?,
        }
    }
    area.present()?;
    Ok(())
}

/// Says in the place of a panel that it has no data.
fn draw_without_data(panel: &Panel, area: &Area<'_>) -> Result<(), Failed> {
    let (width, height) = area.dim_in_pixel();
    let font = ("sans-serif", FONT * SUBPIXELS).into_font();
    let style = TextStyle::from(font).pos(Pos::new(HPos::Center, VPos::Center));
    let name = if panel.title.is_empty() {
        &panel.y.label
    } else {
        &panel.title
    };
    let place = (width.cast_signed() / 2, height.cast_signed() / 2);
    area.draw(&Text::new(format!("{name}: no data"), place, style))?;
    Ok(())
}

/// Draws a panel in `area`; `page` is the whole figure.
fn draw_panel(
    panel: &Panel,
    (x, y): (Extent, Extent),
    area: &Area<'_>,
    page: &Area<'_>,
) -> Result<(), Failed> {
    let cells = panel.layers.iter().find_map(|layer| match &layer.mark {
        Mark::Cells(cells) => Some(cells),
        _ => None,
    });
    let (width, _) = area.dim_in_pixel();
    let bar = if cells.is_some() { px(COLOUR_BAR) } else { 0 };
    let (area, bar_area) = area.split_horizontally(width.cast_signed() - bar);
    let mut builder = ChartBuilder::on(&area);
    builder
        .margin(px(10))
        .margin_right(px(16))
        .x_label_area_size(px(44))
        .y_label_area_size(px(label_width(&panel.y)));
    if !panel.title.is_empty() {
        builder.caption(&panel.title, ("sans-serif", TITLES.1 * SUBPIXELS));
    }
    let mut chart = builder.build_cartesian_2d(x, y)?;
    let font = ("sans-serif", FONT * SUBPIXELS);
    chart
        .configure_mesh()
        .x_desc(&panel.x.label)
        .y_desc(&panel.y.label)
        .x_label_formatter(&|tick| x.label(*tick))
        .y_label_formatter(&|tick| match panel.y.names.get((-tick).round() as usize) {
            Some(name) => name.clone(),
            None => y.label(*tick),
        })
        .label_style(font)
        .axis_desc_style(font)
        .axis_style(BLACK.stroke_width(SUBPIXELS))
        .bold_line_style(RGBColor(225, 225, 225).stroke_width(SUBPIXELS))
        .light_line_style(TRANSPARENT)
        .set_all_tick_mark_size(px(4))
        .draw()?;
    for layer in &panel.layers {
        draw_layer(layer, (x, y), &mut chart, page)?;
    }
    match cells {
        Some(cells) => draw_colour_bar(cells, &bar_area),
        None => Ok(()),
    }
}

/// Width of what stands beside an axis upwards, in pixels.
fn label_width(axis: &Axis) -> u32 {
    let letters = axis.names.iter().map(|name| name.chars().count()).max();
    letters.map_or(72, |letters| text_width(letters) + 12)
}

fn draw_layer(
    layer: &Layer,
    (x, y): (Extent, Extent),
    chart: &mut Chart<'_, '_>,
    page: &Area<'_>,
) -> Result<(), Failed> {
    let colour = layer.colour.rgb();
    let scaled = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
        let scaled = points.iter().map(|&(a, b)| (x.scale.of(a), y.scale.of(b)));
        scaled.collect()
    };
    match &layer.mark {
        Mark::Line(points) => draw_line(&scaled(points), layer, x, y, chart)?,
        Mark::HorizontalRule(at) => {
            let at = y.scale.of(*at);
            draw_line(&[(x.min, at), (x.max, at)], layer, x, y, chart)?;
        }
        Mark::VerticalRule(at) => {
            let at = x.scale.of(*at);
            draw_line(&[(at, y.min), (at, y.max)], layer, x, y, chart)?;
        }
        Mark::Band(points) => {
            let upper = points.iter().map(|&(at, _, high)| (at, high));
            let lower = points.iter().rev().map(|&(at, low, _)| (at, low));
            let outline: Vec<_> = upper
                .chain(lower)
                .map(|(a, b)| (x.clamp(a), y.clamp(b)))
                .collect();
            chart.draw_series([Polygon::new(outline, colour.mix(0.25).filled())])?;
        }
        Mark::Markers(shape, points) => {
            let within =
                |&(a, b): &(f64, f64)| (x.min..=x.max).contains(&a) && (y.min..=y.max).contains(&b);
            for place in scaled(points).iter().filter(|place| within(place)) {
                draw_marker(page, *shape, chart.backend_coord(place), layer.colour)?;
            }
        }
        Mark::Bars { edges, heights } => {
            let base = if y.scale == Scale::Linear {
                y.clamp(0.0)
            } else {
                y.min
            };
            let bars = edges
                .windows(2)
                .zip(heights)
                .filter_map(|(edges, &height)| {
                    let &[left, right] = edges else { return None };
                    let tall = y.scale == Scale::Linear || height > 0.0;
                    let top = if tall { y.clamp(height) } else { base };
                    Some([(x.clamp(left), base), (x.clamp(right), top)])
                });
            let bars: Vec<_> = bars.collect();
            let fill = colour.mix(0.35).filled();
            chart.draw_series(bars.iter().map(|&corners| Rectangle::new(corners, fill)))?;
        }
        Mark::Cells(cells) => draw_cells(cells, x, y, chart)?,
        Mark::Label { at, text } => {
            let font = ("sans-serif", FONT * SUBPIXELS).into_font().color(&colour);
            let style = font.pos(Pos::new(HPos::Left, VPos::Center));
            for place in scaled(&[*at]) {
                page.draw(&Text::new(
                    text.clone(),
                    chart.backend_coord(&place),
                    style.clone(),
                ))?;
            }
        }
    }
    Ok(())
}

fn draw_line(
    points: &[(f64, f64)],
    layer: &Layer,
    x: Extent,
    y: Extent,
    chart: &mut Chart<'_, '_>,
) -> Result<(), Failed> {
    let stroke = layer.colour.rgb().stroke_width(LINE * SUBPIXELS);
    for part in inside(points, &x, &y) {
        if layer.dashed {
            let (dash, gap) = dashes();
            chart.draw_series(DashedLineSeries::new(part, dash, gap, stroke))?;
        } else {
            chart.draw_series(LineSeries::new(part, stroke))?;
        }
    }
    Ok(())
}

fn draw_cells(
    cells: &Cells,
    x: Extent,
    y: Extent,
    chart: &mut Chart<'_, '_>,
) -> Result<(), Failed> {
    let (min, max) = cells.shading();
    let columns = cells
        .x
        .windows(2)
        .map(|edges| (x.clamp(edges[0]), x.clamp(edges[1])));
    let rows = cells
        .y
        .windows(2)
        .map(|edges| (y.clamp(edges[0]), y.clamp(edges[1])));
    let corners = rows.flat_map(|(low, high)| {
        columns
            .clone()
            .map(move |(left, right)| [(left, low), (right, high)])
    });
    let shaded = corners.zip(&cells.values).filter_map(|(corners, value)| {
        let colour = ViridisRGB::get_color_normalized((*value)?, min, max);
        Some(Rectangle::new(corners, colour.filled()))
    });
    let shaded: Vec<_> = shaded.collect();
    chart.draw_series(shaded)?;
    Ok(())
}

fn draw_colour_bar(cells: &Cells, area: &Area<'_>) -> Result<(), Failed> {
    let (min, max) = cells.shading();
    let values = Extent {
        scale: Scale::Linear,
        min,
        max,
        named: false,
    };
    let (_, height) = area.dim_in_pixel();
    let (top, bottom) = (px(36), height.cast_signed() - px(54));
    let place = |value: f64| values.map(&value, (bottom, top));
    let shade = (max - min) / f64::from(SHADES);
    for index in 0..SHADES {
        let low = min + shade * f64::from(index);
        let colour = ViridisRGB::get_color_normalized(low + 0.5 * shade, min, max);
        // Shades overlap by a little, so that no gap shows between them.
        let corners = [(0, place(low + 1.2 * shade).max(top)), (px(14), place(low))];
        area.draw(&Rectangle::new(corners, colour.filled()))?;
    }
    let font = ("sans-serif", FONT * SUBPIXELS).into_font();
    let style = TextStyle::from(font).pos(Pos::new(HPos::Left, VPos::Center));
    for tick in values.ticks() {
        area.draw(&Text::new(
            values.label(tick),
            (px(19), place(tick)),
            style.clone(),
        ))?;
    }
    let above = style.pos(Pos::new(HPos::Left, VPos::Bottom));
    area.draw(&Text::new(cells.label.clone(), (0, top - px(7)), above))?;
    Ok(())
}
