//! `--table`: a table whose values take the place of those that the models were generated with.

use std::path::Path;
use std::{fs, io};

use ahv_core::{Bounds, GeneratedModel, Table, Vector};
use ahv_table::{Checked, Family, Fault, Set, Text};

use crate::failure::Failure;
use crate::names;
use crate::registry::models;
use crate::vehicle::Values;

/// More faults than these are counted, not listed.
const MOST_LISTED: usize = 20;

/// The values of the table at `path` for the model `M`, and for the set called `set` or the table's own.
///
/// # Errors
///
/// [`Failure::Request`] with all faults of the table and their places; also if it lacks the model or the set.
pub(crate) fn values<M: GeneratedModel>(
    path: &Path,
    set: Option<&str>,
) -> Result<Values<M>, Failure> {
    let shown = path.display().to_string();
    let text =
        text_of(path).map_err(|error| Failure::Request(format!("cannot read {shown}: {error}")))?;
    let table = Text::parse(text.clone())
        .map_err(|unreadable| Failure::Request(unreadable.line(&shown, &text)))?;
    let checked = ahv_table::check(&table, &families())
        .map_err(|faults| Failure::Request(listed(&table, &shown, &faults)))?;
    if !checked.models.contains(&M::NAME) {
        let fault = Fault::other_model(M::NAME);
        return Err(Failure::Request(table.line(&shown, &fault)));
    }
    let set = chosen(&checked.sets, set, &shown)?;
    Ok(of_model(&checked, set))
}

/// The families of the models that this program has, each once.
fn families() -> Vec<Family> {
    let mut families: Vec<Family> = models().iter().map(|model| model.family).collect();
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
fn of_model<M: GeneratedModel>(checked: &Checked, set: &Set) -> Values<M> {
    let from_si = checked.unit_system != M::TABLE.unit_system;
    let own = checked.sets.first();
    let number = |index: usize| {
        let of = |set: &Set| set.entries.get(index).copied().flatten();
        of(set).or_else(|| own.and_then(of))
    };
    // A coefficient that the table does not list is 0, and so is what only other models have.
    let parameters = M::ParametersOf::<f64>::from_fn(|index| {
        let factor = factor::<M::ParametersOf<f64>, f64>(index, from_si);
        number(index).map_or(0.0, |number| number.value * factor)
    });
    let choices = checked.choices.iter();
    Values {
        set: set.name.clone().into(),
        parameters: choices.fold(parameters, |parameters, option| option.apply(parameters)),
        uncertainty: M::ParametersOf::<f64>::from_fn(|index| {
            number(index).map_or(0.0, |number| number.uncertainty)
        }),
        state_bounds: bounds(M::TABLE, checked, M::STATE_BOUNDS, from_si),
        input_bounds: bounds(M::TABLE, checked, M::INPUT_BOUNDS, from_si),
    }
}

/// The table's intervals for the components of `built_in`.
fn bounds<B: Vector<Bounds>>(table: &Table, checked: &Checked, built_in: B, from_si: bool) -> B {
    let mut bounds = built_in;
    for (index, name) in B::NAMES.iter().enumerate() {
        let mut intervals = table.validity.iter().zip(&checked.validity);
        let interval = intervals.find(|(interval, _)| interval.variables.contains(name));
        if let Some((_, Some(Bounds { min, max }))) = interval {
            let factor = factor::<B, Bounds>(index, from_si);
            // The index is one of the names.
            let _ = bounds.set(index, Bounds::new(min * factor, max * factor));
        }
    }
    bounds
}

/// What turns component `index` of a `V` of the table into the unit of the generated models.
fn factor<V: Vector<T>, T>(index: usize, from_si: bool) -> f64 {
    match V::SI_FACTORS.get(index) {
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
