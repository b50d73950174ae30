//! The structural pattern of a model as a picture: which rows of the drift depend on what.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::subject::is_fit;
use super::symbol::{Run, runs};
use crate::ir::{Basis, Document, Expr, Model, Output};

/// Side of a cell, in pixels.
const CELL: usize = 24;
/// Room for the labels of rows and of columns.
const ROW_LABELS: usize = 44;
const COLUMN_LABELS: usize = 30;
/// Room for the names of sections, which stand upright.
const SECTION_LABELS: usize = 104;
const TITLE: usize = 26;
const MARGIN: usize = 16;
const GAP: usize = 26;
/// Two blues that differ in lightness, for whoever does not tell colours apart; and what is empty.
const VARYING: &str = "#0b5394";
const CONSTANT: &str = "#8fbfe8";
const EMPTY: &str = "#f1f3f5";
const TEXT: &str = "#1b1f24";

/// What a cell of the pattern holds.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Cell {
    Empty,
    /// It depends on parameters alone.
    Constant,
    /// It depends on state or input.
    Varying,
    /// So many entries of a group, and whether one of them depends on state or input.
    Count(usize, bool),
}

/// A matrix of cells with labels.
struct Panel {
    title: Vec<Run>,
    columns: Vec<Vec<Run>>,
    /// Labels of the columns stand upright.
    upright: bool,
    cells: Vec<Vec<Cell>>,
}

/// The picture of a model.
pub(super) fn picture(model: &Model, document: &Document) -> String {
    let rows = labels(model, Basis::State);
    let varying = varying_quantities(model);
    let mut first = Vec::new();
    for (function, columns, title) in [
        ("jacobians", Basis::State, "\\partial f/\\partial x"),
        ("jacobians", Basis::Input, "\\partial f/\\partial u"),
        ("diffusion", Basis::Noise, "G"),
    ] {
        if let Some(output) = find(model, function, columns) {
            first.push(Panel {
                title: heading(title),
                columns: labels(model, columns),
                upright: false,
                cells: cells(model, output, columns, &varying),
            });
        }
    }
    let by_parameter = find(model, "parameter_jacobian", Basis::Parameter);
    let second = by_parameter.map(|output| grouped(model, document, output, &varying));
    draw(&model.name, &rows, &first, second.as_ref())
}

/// An output over states and another basis.
fn find<'a>(model: &'a Model, function: &str, columns: Basis) -> Option<&'a Output> {
    let function = model.functions.iter().find(|f| f.name == function)?;
    function
        .outputs
        .iter()
        .find(|output| output.basis == [Basis::State, columns])
}

fn labels(model: &Model, basis: Basis) -> Vec<Vec<Run>> {
    let members = model.bases.get(&basis).map_or(&[] as &[_], Vec::as_slice);
    let label = |symbol: &str, name: &str| {
        if symbol.is_empty() {
            words(name)
        } else {
            runs(symbol)
        }
    };
    members.iter().map(|v| label(&v.symbol, &v.name)).collect()
}

/// A partial derivative in one line.
fn heading(latex: &str) -> Vec<Run> {
    runs(latex)
}

fn words(text: &str) -> Vec<Run> {
    vec![Run {
        text: text.to_owned(),
        level: 0,
    }]
}

/// Quantities that depend on state or input.
fn varying_quantities(model: &Model) -> BTreeSet<&str> {
    let mut varying = BTreeSet::new();
    for quantity in &model.quantities {
        if depends(&quantity.expr, &varying) {
            varying.insert(quantity.name.as_str());
        }
    }
    varying
}

fn depends(expr: &Expr, varying: &BTreeSet<&str>) -> bool {
    match expr {
        Expr::Number(_) => false,
        Expr::Name(name) => {
            name.starts_with("x.") || name.starts_with("u.") || varying.contains(name.as_str())
        }
        Expr::Apply(parts) => parts.iter().skip(1).any(|part| depends(part, varying)),
    }
}

fn cells(
    model: &Model,
    output: &Output,
    columns: Basis,
    varying: &BTreeSet<&str>,
) -> Vec<Vec<Cell>> {
    let names = |basis| model.bases.get(&basis).map_or(&[] as &[_], Vec::as_slice);
    let cell = |row: &str, column: &str| {
        let entry = output
            .entries
            .iter()
            .find(|entry| entry.at == [row, column]);
        entry.map_or(Cell::Empty, |entry| {
            if depends(&entry.expr, varying) {
                Cell::Varying
            } else {
                Cell::Constant
            }
        })
    };
    names(Basis::State)
        .iter()
        .map(|row| {
            names(columns)
                .iter()
                .map(|column| cell(&row.name, &column.name))
                .collect()
        })
        .collect()
}

/// The parameter Jacobian, its columns counted by section of the table.
fn grouped(model: &Model, document: &Document, output: &Output, varying: &BTreeSet<&str>) -> Panel {
    let mut sections: Vec<&str> = Vec::new();
    let mut section_of = BTreeMap::new();
    for parameter in &document.parameters {
        let section = parameter.path.0.as_str();
        if !sections.contains(&section) {
            sections.push(section);
        }
        section_of.insert(parameter.name.as_str(), section);
    }
    let states = model
        .bases
        .get(&Basis::State)
        .map_or(&[] as &[_], Vec::as_slice);
    let cell = |row: &str, section: &str| {
        let mut count = 0;
        let mut changes = false;
        for entry in &output.entries {
            let [at, parameter] = entry.at.as_slice() else {
                continue;
            };
            if at == row && section_of.get(parameter.as_str()) == Some(&section) {
                count += 1;
                changes |= depends(&entry.expr, varying);
            }
        }
        if count == 0 {
            Cell::Empty
        } else {
            Cell::Count(count, changes)
        }
    };
    let cells = states
        .iter()
        .map(|row| sections.iter().map(|s| cell(&row.name, s)).collect())
        .collect();
    let mut title = heading("\\partial f/\\partial p");
    title.push(Run {
        text: ", entries by section of the table".to_owned(),
        level: 0,
    });
    Panel {
        title,
        columns: sections
            .iter()
            .map(|section| section_label(section))
            .collect(),
        upright: true,
        cells,
    }
}

fn section_label(section: &str) -> Vec<Run> {
    match section.split_once('_') {
        Some((letter, rest)) if is_fit(section) => vec![
            Run {
                text: letter.to_owned(),
                level: 0,
            },
            Run {
                text: rest.replace('_', ""),
                level: -1,
            },
        ],
        _ => words(section),
    }
}

fn draw(name: &str, rows: &[Vec<Run>], first: &[Panel], second: Option<&Panel>) -> String {
    let height = rows.len() * CELL;
    let first_width: usize = first.iter().map(|panel| panel_width(panel) + GAP).sum();
    let second_width = second.map_or(0, panel_width);
    // The heading of the second panel is wider than a narrow panel.
    let width = 2 * MARGIN + ROW_LABELS + first_width.max(second_width).max(420);
    let second_top = MARGIN + TITLE + COLUMN_LABELS + height + GAP;
    let legend_top = second.map_or(second_top, |_| {
        second_top + TITLE + SECTION_LABELS + height + GAP
    });
    let total = legend_top + CELL + MARGIN;
    let mut svg = String::new();
    let _ = writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{total}\" viewBox=\"0 0 {width} {total}\" \
         role=\"img\" font-family=\"'DejaVu Sans', 'Segoe UI', Arial, sans-serif\" font-size=\"13\" fill=\"{TEXT}\">"
    );
    let _ = writeln!(svg, "<title>Structural pattern of {name}</title>");
    let _ = writeln!(
        svg,
        "<rect width=\"{width}\" height=\"{total}\" fill=\"#ffffff\"/>"
    );
    let mut left = MARGIN + ROW_LABELS;
    let top = MARGIN + TITLE + COLUMN_LABELS;
    row_labels(&mut svg, rows, top);
    for panel in first {
        draw_panel(&mut svg, panel, left, top);
        left += panel_width(panel) + GAP;
    }
    if let Some(panel) = second {
        let top = second_top + TITLE + SECTION_LABELS;
        row_labels(&mut svg, rows, top);
        draw_panel(&mut svg, panel, MARGIN + ROW_LABELS, top);
    }
    legend(&mut svg, legend_top);
    svg.push_str("</svg>\n");
    svg
}

/// Width of a panel; its heading needs some.
fn panel_width(panel: &Panel) -> usize {
    (panel.columns.len() * CELL).max(44)
}

fn row_labels(svg: &mut String, rows: &[Vec<Run>], top: usize) {
    for (position, label) in rows.iter().enumerate() {
        let y = top + position * CELL + 16;
        let x = MARGIN + ROW_LABELS - 8;
        let _ = writeln!(
            svg,
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"end\">{}</text>",
            spans(label)
        );
    }
}

fn draw_panel(svg: &mut String, panel: &Panel, left: usize, top: usize) {
    let labels = if panel.upright {
        SECTION_LABELS
    } else {
        COLUMN_LABELS
    };
    let title_y = top - labels - 6;
    let title = spans(&panel.title);
    let _ = writeln!(
        svg,
        "<text x=\"{left}\" y=\"{title_y}\" font-weight=\"bold\">{title}</text>"
    );
    for (position, label) in panel.columns.iter().enumerate() {
        let x = left + position * CELL + CELL / 2;
        let (y, label) = (top - 8, spans(label));
        let _ = if panel.upright {
            let x = x + 4;
            writeln!(
                svg,
                "<text x=\"{x}\" y=\"{y}\" transform=\"rotate(-90 {x} {y})\">{label}</text>"
            )
        } else {
            writeln!(
                svg,
                "<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">{label}</text>"
            )
        };
    }
    for (row, cells) in panel.cells.iter().enumerate() {
        for (column, cell) in cells.iter().enumerate() {
            draw_cell(svg, cell, left + column * CELL, top + row * CELL);
        }
    }
}

fn draw_cell(svg: &mut String, cell: &Cell, x: usize, y: usize) {
    let (fill, count) = match cell {
        Cell::Empty => (EMPTY, None),
        Cell::Constant => (CONSTANT, None),
        Cell::Varying => (VARYING, None),
        Cell::Count(count, true) => (VARYING, Some((count, "#ffffff"))),
        Cell::Count(count, false) => (CONSTANT, Some((count, TEXT))),
    };
    let side = CELL - 2;
    let (left, top) = (x + 1, y + 1);
    let _ = writeln!(
        svg,
        "<rect x=\"{left}\" y=\"{top}\" width=\"{side}\" height=\"{side}\" rx=\"2\" fill=\"{fill}\"/>"
    );
    if let Some((count, ink)) = count {
        let (x, y) = (x + CELL / 2, y + 16);
        let _ = writeln!(
            svg,
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\" font-size=\"11\" fill=\"{ink}\">{count}</text>"
        );
    }
}

fn legend(svg: &mut String, top: usize) {
    let mut x = MARGIN;
    for (cell, text, width) in [
        (Cell::Varying, "depends on state or input", 210),
        (Cell::Constant, "constant", 100),
        (Cell::Empty, "zero", 0),
    ] {
        draw_cell(svg, &cell, x, top);
        let (left, y) = (x + CELL + 6, top + 16);
        let _ = writeln!(
            svg,
            "<text x=\"{left}\" y=\"{y}\" font-size=\"12\">{text}</text>"
        );
        x += width;
    }
}

/// Runs as SVG; what stands below or above the line is smaller.
fn spans(runs: &[Run]) -> String {
    let mut text = String::new();
    let mut level = 0;
    for run in runs {
        let escaped = run
            .text
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;");
        let shift = match run.level - level {
            0 => String::new(),
            by => format!(" dy=\"{}\"", -4 * i32::from(by)),
        };
        let size = if run.level == 0 {
            ""
        } else {
            " font-size=\"10\""
        };
        if shift.is_empty() && size.is_empty() {
            text += &escaped;
        } else {
            let _ = write!(text, "<tspan{shift}{size}>{escaped}</tspan>");
        }
        level = run.level;
    }
    text
}
