//! `--table`: a table whose values take the place of those that the models were generated with.

use std::borrow::Cow;
use std::path::Path;
use std::{fs, io};

use ahv_analysis::erased::{AnyModel, Components};
use ahv_core::{Bounds, Table};
use ahv_table::{Checked, Family, Fault, Set, Text};

use crate::failure::Failure;
use crate::names;
use crate::registry::{family, models};

/// More faults than these are counted, not listed.
const MOST_LISTED: usize = 20;

/// What a table says of a model, in the units that the model was generated with.
pub(crate) struct Values {
    /// Set of parameters.
    pub(crate) set: Cow<'static, str>,
    pub(crate) parameters: Vec<f64>,
    /// Relative uncertainties of the parameters.
    pub(crate) uncertainty: Vec<f64>,
    pub(crate) state_bounds: Vec<Bounds>,
    pub(crate) input_bounds: Vec<Bounds>,
}

/// The values of the table at `path` for a model, and for the set called `set` or the table's own.
///
/// # Errors
///
/// [`Failure::Request`] with all faults of the table and their places; also if it lacks the model or the set.
pub(crate) fn values(
    model: &dyn AnyModel,
    path: &Path,
    set: Option<&str>,
) -> Result<Values, Failure> {
    let shown = path.display().to_string();
    let text =
        text_of(path).map_err(|error| Failure::Request(format!("cannot read {shown}: {error}")))?;
    let table = Text::parse(text.clone())
        .map_err(|unreadable| Failure::Request(unreadable.line(&shown, &text)))?;
    let checked = ahv_table::check(&table, &families())
        .map_err(|faults| Failure::Request(listed(&table, &shown, &faults)))?;
    if !checked.models.contains(&model.name()) {
        let fault = Fault::other_model(model.name());
        return Err(Failure::Request(table.line(&shown, &fault)));
    }
    let set = chosen(&checked.sets, set, &shown)?;
    Ok(of_model(model, &checked, set))
}

/// The families of the models that this program has, each once.
fn families() -> Vec<Family> {
    let mut families: Vec<Family> = models().map(family).collect();
    families.dedup_by_key(|family| family.table.models);
    families
}

fn listed(table: &Text, shown: &str, faults: &[Fault]) -> String {
    let mut lines: Vec<String> = faults
        .iter()
        .take(MOST_LISTED)
        .map(|fault| table.line(shown, fault))
        .collect();
    if let more @ 1.. = faults.len().saturating_sub(MOST_LISTED) {
        lines.push(format!("{shown}: {more} more faults"));
    }
    lines.join("\n")
}

fn chosen<'a>(sets: &'a [Set], name: Option<&str>, shown: &str) -> Result<&'a Set, Failure> {
    let mut known = sets.iter();
    let found = known.find(|set| name.is_none_or(|name| name == set.name));
    found.ok_or_else(|| {
        let known: Vec<&str> = sets.iter().map(|set| set.name.as_str()).collect();
        let problem = names::unknown("set of parameters", name.unwrap_or_default(), &known);
        Failure::Request(format!("--set: {problem} (in {shown})"))
    })
}

/// The values of a set, in the units that the model was generated in. What the set does not replace is the table's own.
fn of_model(model: &dyn AnyModel, checked: &Checked, set: &Set) -> Values {
    let from_si = checked.unit_system != model.table().unit_system;
    let own = checked.sets.first();
    let number = |index: usize| {
        let of = |set: &Set| set.entries.get(index).copied().flatten();
        of(set).or_else(|| own.and_then(of))
    };
    let components = model.parameters();
    let all = || 0..components.len();
    // A coefficient that the table does not list is 0, and so is what only other models have.
    let parameters = all().map(|index| {
        let factor = factor(components, index, from_si);
        number(index).map_or(0.0, |number| number.value * factor)
    });
    let mut parameters: Vec<f64> = parameters.collect();
    for option in &checked.choices {
        option.apply_to(components.names, &mut parameters);
    }
    let uncertainty = all().map(|index| number(index).map_or(0.0, |number| number.uncertainty));
    let (states, inputs) = (model.states(), model.inputs());
    let bounds =
        |components, built_in| bounds(model.table(), checked, components, built_in, from_si);
    Values {
        set: set.name.clone().into(),
        parameters,
        uncertainty: uncertainty.collect(),
        state_bounds: bounds(states, model.state_bounds()),
        input_bounds: bounds(inputs, model.input_bounds()),
    }
}

/// The table's intervals in the place of those that the model was generated with.
fn bounds(
    table: &Table,
    checked: &Checked,
    components: Components,
    built_in: Vec<Bounds>,
    from_si: bool,
) -> Vec<Bounds> {
    let named = components.names.iter().zip(built_in).enumerate();
    let bounds = named.map(|(index, (name, built_in))| {
        let mut intervals = table.validity.iter().zip(&checked.validity);
        let interval = intervals.find(|(interval, _)| interval.variables.contains(name));
        match interval {
            Some((_, Some(Bounds { min, max }))) => {
                let factor = factor(components, index, from_si);
                Bounds::new(min * factor, max * factor)
            }
            _ => built_in,
        }
    });
    bounds.collect()
}

/// What turns component `index` of the table into the unit of the generated models.
fn factor(components: Components, index: usize, from_si: bool) -> f64 {
    match components.si_factors.get(index) {
        Some(factor) if from_si => 1.0 / factor,
        _ => 1.0,
    }
}

/// The text of a regular file: a pipe would wait for a writer, a device has no end.
pub(crate) fn text_of(path: &Path) -> io::Result<String> {
    let kind = fs::metadata(path)?.file_type();
    if kind.is_file() || kind.is_dir() {
        fs::read_to_string(path)
    } else {
        let message = "it is a pipe, a socket or a device, not a file";
        Err(io::Error::new(io::ErrorKind::InvalidInput, message))
    }
}
