//! The noise of a model: classes of its columns, which of them commute, and what follows from the diffusion.

use super::functions::right_side;
use super::latex::{Printer, Style};
use super::lines::equation;
use super::subject::inline_math;
use super::typeset::signed;
use crate::ir::{Entry, Function, NoiseClass, NoiseStructure};

/// Formulas longer than this are named and counted.
const LONGEST_FORMULA: usize = 160;

/// What the page says about the noise.
pub(super) struct Noise {
    pub(super) columns: Vec<Column>,
    /// Heads of the matrix of commuting pairs, and its lines.
    pub(super) heads: Vec<String>,
    pub(super) matrix: Vec<Vec<String>>,
    /// One sentence about pairs that do not commute.
    pub(super) commutation: String,
    /// Entries of the diffusion.
    pub(super) diffusion: Vec<Vec<String>>,
    pub(super) derivatives: Formulas,
    pub(super) correction: Formulas,
}

/// A column of the diffusion.
pub(super) struct Column {
    pub(super) symbol: String,
    pub(super) name: String,
    pub(super) class: String,
    pub(super) meaning: &'static str,
    pub(super) rows: String,
}

/// Formulas that are short enough to be read, and the names of the others.
pub(super) struct Formulas {
    pub(super) printed: Vec<Vec<String>>,
    pub(super) others: String,
    /// What is zero.
    pub(super) zeros: &'static str,
}

/// The noise of a model; `None` without.
pub(super) fn of(printer: &Printer<'_>) -> Option<Noise> {
    let model = printer.model();
    let structure = model.noise.as_ref()?;
    let function = |name: &str| model.functions.iter().find(|f| f.name == name);
    let diffusion = function("diffusion");
    let names: Vec<&str> = structure.columns.iter().map(|c| c.name.as_str()).collect();
    let symbol = |name: &str| inline_math(&printer.variable(name));
    Some(Noise {
        columns: columns(printer, structure, diffusion),
        heads: names.iter().map(|name| symbol(name)).collect(),
        matrix: matrix(structure, &names, symbol),
        commutation: commutation(structure, &names, symbol),
        diffusion: entries(diffusion)
            .filter_map(|entry| diffusion_entry(printer, entry))
            .collect(),
        derivatives: formulas(printer, function("noise_derivatives"), |at| {
            let [row, j, k] = at else {
                return String::new();
            };
            format!("\\left(L^{{{j}}} b^{{{k}}}\\right)_{{{row}}}")
        }),
        correction: formulas(printer, function("ito_correction"), |at| {
            format!("c_{{{}}}", at.join(","))
        }),
    })
}

fn entries(function: Option<&Function>) -> impl Iterator<Item = &Entry> {
    function
        .into_iter()
        .flat_map(|function| &function.outputs)
        .flat_map(|output| &output.entries)
}

fn columns(
    printer: &Printer<'_>,
    structure: &NoiseStructure,
    diffusion: Option<&Function>,
) -> Vec<Column> {
    let column = |column: &crate::ir::NoiseColumn| {
        let rows: Vec<String> = entries(diffusion)
            .filter(|entry| entry.at.get(1) == Some(&column.name))
            .filter_map(|entry| entry.at.first())
            .map(|row| inline_math(&printer.variable(row)))
            .collect();
        Column {
            symbol: inline_math(&printer.variable(&column.name)),
            name: column.name.clone(),
            class: column.class.to_string(),
            meaning: match column.class {
                NoiseClass::Constant => "no entry depends on the state",
                NoiseClass::Diagonal => "an entry depends on the state of its own row alone",
                NoiseClass::General => "entries depend on states of other rows",
            },
            rows: rows.join(" "),
        }
    };
    structure.columns.iter().map(column).collect()
}

fn commutes(structure: &NoiseStructure, a: &str, b: &str) -> bool {
    let is = |(first, second): &(String, String)| {
        (first == a && second == b) || (first == b && second == a)
    };
    a == b || structure.commuting.iter().any(is)
}

fn matrix(
    structure: &NoiseStructure,
    names: &[&str],
    symbol: impl Fn(&str) -> String,
) -> Vec<Vec<String>> {
    let cell = |a: &str, b: &str| {
        if commutes(structure, a, b) {
            "yes"
        } else {
            "**no**"
        }
        .to_owned()
    };
    names
        .iter()
        .map(|a| {
            [symbol(a)]
                .into_iter()
                .chain(names.iter().map(|b| cell(a, b)))
                .collect()
        })
        .collect()
}

fn commutation(
    structure: &NoiseStructure,
    names: &[&str],
    symbol: impl Fn(&str) -> String,
) -> String {
    let mut open = Vec::new();
    for (position, a) in names.iter().enumerate() {
        for b in &names[position + 1..] {
            if !commutes(structure, a, b) {
                open.push(format!("{} and {}", symbol(a), symbol(b)));
            }
        }
    }
    if names.len() == 1 {
        return "There is one column, which commutes with itself.".to_owned();
    }
    if open.is_empty() {
        return "All pairs of columns commute: $L^j b^k = L^k b^j$, and a scheme of strong order 1 needs no iterated \
                integrals of two different Wiener processes."
            .to_owned();
    }
    let (pairs, verb) = if open.len() == 1 {
        ("pair", "does")
    } else {
        ("pairs", "do")
    };
    format!(
        "{} {pairs} of columns {verb} not commute: {}.",
        open.len(),
        open.join("; ")
    )
}

fn diffusion_entry(printer: &Printer<'_>, entry: &Entry) -> Option<Vec<String>> {
    let [row, column] = entry.at.as_slice() else {
        return None;
    };
    let left = format!(
        "G_{{{},{}}}",
        printer.variable(row),
        printer.variable(column)
    );
    let right = right_side(printer, &entry.expr, 400)
        .or_else(|| printer.expression(&entry.expr, Style::NAMED))?;
    Some(equation(&left, &right, ""))
}

fn formulas(
    printer: &Printer<'_>,
    function: Option<&Function>,
    left: impl Fn(&[String]) -> String,
) -> Formulas {
    let mut printed = Vec::new();
    let mut others = Vec::new();
    for entry in entries(function) {
        let at: Vec<String> = entry.at.iter().map(|name| printer.variable(name)).collect();
        let left = left(&at);
        let short = right_side(printer, &entry.expr, LONGEST_FORMULA);
        match short.filter(|tex| signed(tex).len() <= LONGEST_FORMULA) {
            Some(right) => printed.push(equation(&left, &right, "")),
            None => others.push(inline_math(&left)),
        }
    }
    Formulas {
        zeros: if printed.is_empty() && others.is_empty() {
            "All entries are zero."
        } else {
            "Entries that are not listed are zero."
        },
        printed,
        others: match others.len() {
            0 => String::new(),
            1 => format!("One entry is longer: {}.", others[0]),
            count => format!("{count} entries are longer: {}.", others.join(", ")),
        },
    }
}
