//! How far the printed model is from the exact one: the largest magnitudes of `delta_*` over the validity box.

use std::collections::BTreeMap;

use super::functions::paper_symbol;
use super::search::{largest, moving};
use super::subject::{Subject, inline_math, readable, unit_text};
use crate::EmitError;
use crate::evaluate::Tape;
use crate::ir::{Basis, ChoiceOption, Expr, Function, Model, Variable};

/// The model whose rows the differences are measured against.
const EXACT: &str = "sdcom";
/// The states of the rows that `delta_f_*` belong to.
const ROWS: [(&str, &str); 4] = [
    ("V", "velocity"),
    ("gamma", "gamma"),
    ("alpha", "alpha"),
    ("Q", "pitch_rate"),
];
/// The reference condition, in foot, second and radian or degree; all other variables are 0 there.
const REFERENCE: [(&str, &str, f64); 5] = [
    ("velocity", "ft/s", 7702.0808),
    ("altitude", "ft", 85_000.0),
    ("alpha", "deg", 1.5),
    ("phi", "1", 0.28),
    ("delta_e", "deg", 13.0),
];

/// The differences under one choice of canard.
pub(super) struct Differences {
    /// Name of the choice and what it means.
    pub(super) title: String,
    pub(super) rows: Vec<Row>,
}

/// A difference, beside the exact row that it is a difference of.
pub(super) struct Row {
    pub(super) symbol: String,
    pub(super) unit: String,
    pub(super) largest: String,
    pub(super) place: String,
    pub(super) exact: String,
    pub(super) reference: String,
    pub(super) exact_reference: String,
}

/// A difference and its exact row.
struct Pair<'a> {
    function: &'a Function,
    difference: &'a Expr,
    exact: Option<&'a Expr>,
}

/// The differences of a model, for each canard but the free one; empty for a model without.
pub(super) fn of(subject: &Subject<'_>, model: &Model) -> Result<Vec<Differences>, EmitError> {
    let exact_model = subject.document.models.iter().find(|m| m.name == EXACT);
    let pairs = pairs(model, exact_model);
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let canard = subject
        .document
        .choices
        .iter()
        .find(|choice| choice.name == "canard");
    let options: Vec<Option<&ChoiceOption>> = canard.map_or_else(
        || vec![None],
        |choice| {
            choice
                .options
                .iter()
                .filter(|o| o.name != "free")
                .map(Some)
                .collect()
        },
    );
    options
        .into_iter()
        .map(|option| under(subject, model, exact_model, &pairs, option))
        .collect()
}

fn pairs<'a>(model: &'a Model, exact: Option<&'a Model>) -> Vec<Pair<'a>> {
    let differences = model
        .functions
        .iter()
        .filter(|f| f.name.starts_with("delta_"));
    differences
        .filter_map(|function| {
            let difference = &function.outputs.first()?.entries.first()?.expr;
            let exact = exact.and_then(|exact| exact_row(exact, &function.name["delta_".len()..]));
            Some(Pair {
                function,
                difference,
                exact,
            })
        })
        .collect()
}

/// The row of the drift that `f_V` belongs to, or the function `H_V` itself.
fn exact_row<'a>(exact: &'a Model, name: &str) -> Option<&'a Expr> {
    let row = name
        .strip_prefix("f_")
        .and_then(|row| ROWS.iter().find(|(label, _)| *label == row));
    let function = |name: &str| exact.functions.iter().find(|f| f.name == name);
    match row {
        Some((_, state)) => {
            let entries = &function("drift")?.outputs.first()?.entries;
            entries
                .iter()
                .find(|entry| entry.at == [*state])
                .map(|entry| &entry.expr)
        }
        None => Some(&function(name)?.outputs.first()?.entries.first()?.expr),
    }
}

fn under(
    subject: &Subject<'_>,
    model: &Model,
    exact_model: Option<&Model>,
    pairs: &[Pair<'_>],
    option: Option<&ChoiceOption>,
) -> Result<Differences, EmitError> {
    let mut values = BTreeMap::new();
    for parameter in &subject.document.parameters {
        values.insert(format!("p.{}", parameter.name), subject.value(parameter));
    }
    for (name, &value) in option.iter().flat_map(|option| &option.values) {
        values.insert(format!("p.{name}"), value);
    }
    let differences: Vec<&Expr> = pairs.iter().map(|pair| pair.difference).collect();
    let found = magnitudes(subject, model, &differences, &values)?;
    // The exact rows are all there or none is asked for.
    let exact: Option<Vec<&Expr>> = pairs.iter().map(|pair| pair.exact).collect();
    let exact = match (exact, exact_model) {
        (Some(exact), Some(model)) => magnitudes(subject, model, &exact, &values)?,
        _ => Vec::new(),
    };
    let row = |(position, (pair, found)): (usize, (&Pair<'_>, Magnitudes))| {
        let outputs = &pair.function.outputs;
        let unit = outputs.first().and_then(|output| output.unit.as_deref());
        let exact_text = |number: fn(&Magnitudes) -> f64| {
            let exact = exact.get(position);
            exact.map_or_else(|| "–".to_owned(), |found| three_digits(number(found)))
        };
        Row {
            symbol: inline_math(&paper_symbol(&pair.function.name)),
            unit: unit_text(unit.unwrap_or("1")).to_owned(),
            largest: three_digits(found.largest.abs()),
            place: found.place,
            exact: exact_text(|found| found.largest.abs()),
            reference: three_digits(found.reference),
            exact_reference: exact_text(|found| found.reference),
        }
    };
    let rows = pairs.iter().zip(found).enumerate().map(row).collect();
    let title = option.map_or_else(
        || "The table's parameters".to_owned(),
        |option| format!("canard = \"{}\": {}", option.name, option.doc),
    );
    Ok(Differences { title, rows })
}

/// An expression at its largest and at the reference condition.
struct Magnitudes {
    largest: f64,
    place: String,
    reference: f64,
}

/// A variable that expressions depend on, its bounds, and its value at the reference condition.
struct Known<'a> {
    variable: &'a Variable,
    /// Its place among states and inputs.
    order: usize,
    bounds: (f64, f64),
    reference: f64,
}

/// Expressions of one model at their largest and at the reference condition.
fn magnitudes(
    subject: &Subject<'_>,
    model: &Model,
    exprs: &[&Expr],
    values: &BTreeMap<String, f64>,
) -> Result<Vec<Magnitudes>, EmitError> {
    let tape = Tape::compile(model, exprs.iter().copied())?;
    let tape = tape.fixed(|leaf| values.get(leaf).copied());
    let known: Result<Vec<Known<'_>>, EmitError> = tape
        .leaves()
        .iter()
        .map(|leaf| variable(subject, model, leaf))
        .collect();
    let known = known?;
    let bounds: Vec<(f64, f64)> = known.iter().map(|known| known.bounds).collect();
    let condition: Vec<f64> = known.iter().map(|known| known.reference).collect();
    let mut references = Vec::new();
    tape.run(&condition, &mut Vec::new(), &mut references);
    let largest = largest(&tape, exprs.len(), &bounds);
    let found = largest.iter().zip(references).enumerate();
    let told = found.map(|(output, (largest, reference))| {
        let moving = moving(&tape, output, &bounds, largest);
        let moving = known.iter().zip(&largest.point).zip(moving);
        let mut place: Vec<(usize, String)> = moving
            .filter(|(_, moves)| *moves)
            .map(|((known, &value), _)| (known.order, setting(known.variable, value)))
            .collect();
        place.sort();
        let place: Vec<String> = place.into_iter().map(|(_, text)| text).collect();
        Magnitudes {
            largest: largest.value,
            place: place.join(", "),
            reference,
        }
    });
    Ok(told.collect())
}

/// The variable of a leaf.
fn variable<'a>(
    subject: &Subject<'_>,
    model: &'a Model,
    leaf: &str,
) -> Result<Known<'a>, EmitError> {
    let name = leaf.split_once('.').map_or(leaf, |(_, name)| name);
    let bases = [Basis::State, Basis::Input]
        .iter()
        .filter_map(|basis| model.bases.get(basis));
    let mut variables = bases.flatten().enumerate();
    let found = variables.find(|(_, variable)| variable.name == name);
    let known = found.and_then(|(order, variable)| {
        Some(Known {
            variable,
            order,
            bounds: subject.bounds(variable.validity.as_deref()?)?,
            reference: reference(subject, name, &variable.unit),
        })
    });
    known.ok_or_else(|| {
        EmitError::Mismatch(format!(
            "the validity box of table `{}` does not bound `{name}` of model `{}`",
            subject.table.name, model.name
        ))
    })
}

/// A variable and its value.
fn setting(variable: &Variable, value: f64) -> String {
    let (value, unit) = readable(value, &variable.unit);
    let unit = if unit == "1" {
        String::new()
    } else {
        format!(" {unit}")
    };
    format!(
        "{} {}{unit}",
        inline_math(&variable.symbol),
        three_digits(value)
    )
}

/// The value of a variable at the reference condition, in the table's units.
fn reference(subject: &Subject<'_>, name: &str, unit: &str) -> f64 {
    let Some(&(_, given, value)) = REFERENCE.iter().find(|(known, ..)| *known == name) else {
        return 0.0;
    };
    if given == "deg" {
        return value.to_radians();
    }
    match subject.document.units.factors.get(unit) {
        Some((other, factor)) if unit != given && other == given => value / factor,
        _ => value,
    }
}

/// A number with three significant digits.
pub(super) fn three_digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let text = format!("{value:.2e}");
    let Some((digits, exponent)) = text.split_once('e') else {
        return text;
    };
    match exponent.parse::<i32>() {
        Ok(exponent @ -3..=2) => {
            // The mantissa decides the exponent: 9.999 rounds to 10.0.
            let decimals = usize::try_from(2 - exponent).unwrap_or(0);
            format!("{value:.decimals$}")
        }
        Ok(exponent @ 3..=5) => {
            let zeros = "0".repeat(usize::try_from(exponent - 2).unwrap_or(0));
            format!("{}{zeros}", digits.replace('.', ""))
        }
        _ => format!("{digits}e{exponent}"),
    }
}
