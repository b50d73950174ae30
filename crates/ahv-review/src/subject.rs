//! What is known of the models that a table is for.

use ahv_codegen::ir::{Basis, Document, EntryKind, Model, Sign as IrSign};
use ahv_core::{
    Bounds, Choice, ChoiceOption, Entry, Fit, FitVariable, Interval, Rule, Sign, Table, Term,
};
use ahv_table::Family;

/// The models of a table, as far as a review needs them.
#[derive(Clone, Debug)]
pub struct Subject {
    /// What a table of theirs may hold.
    pub family: Family,
    /// Values that the parameters have elsewhere.
    pub references: Vec<Reference>,
    /// Where the models are flown by default.
    pub conditions: Vec<Condition>,
}

/// Values that the parameters of a family have elsewhere, in its units.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Where, for a message.
    pub label: String,
    /// Values, in the order of [`Family::names`].
    pub values: Vec<f64>,
}

/// A value that a state has in a default flight condition, in the unit of the family.
#[derive(Clone, Debug)]
pub struct Condition {
    /// The model.
    pub model: String,
    /// The state.
    pub state: String,
    /// Its value.
    pub value: f64,
}

impl Subject {
    /// Of a family of which nothing else is known.
    #[must_use]
    pub fn new(family: Family) -> Self {
        Self {
            family,
            references: Vec::new(),
            conditions: Vec::new(),
        }
    }

    /// Of the `models` of a table whose IR is known, with or without models in it. What it holds lives as long as the
    /// process: a program reviews a few tables and ends.
    #[must_use]
    pub fn of_ir(document: &Document, models: &[String]) -> Self {
        let named = document.parameters.iter();
        let units = named.clone().map(|it| it.unit.as_str());
        let in_si = |unit: &str| match document.units.factors.get(unit) {
            Some((other, _)) if document.units.system.name() != "si" => text(other),
            _ => text(unit),
        };
        let family = Family {
            table: Box::leak(Box::new(table(document, texts(models)))),
            names: list(named.map(|it| text(&it.name))),
            units: list(units.clone().map(text)),
            si_units: list(units.map(in_si)),
        };
        let conditions = document.models.iter().flat_map(|model| {
            let given = model.trim.given.iter();
            given.map(|given| Condition {
                model: model.name.clone(),
                state: given.name.clone(),
                value: given.default,
            })
        });
        Self {
            family,
            references: Vec::new(),
            conditions: conditions.collect(),
        }
    }
}

impl Subject {
    /// What is known of the parameters of `other`, which are called as those of this are; where this has no such parameter, not a number.
    #[must_use]
    pub fn references_of(&self, other: &Self) -> Vec<Reference> {
        let names = other.family.names.iter();
        let indices: Vec<Option<usize>> = names
            .map(|name| self.family.names.iter().position(|own| own == name))
            .collect();
        let of = |reference: &Reference| Reference {
            label: reference.label.clone(),
            values: indices
                .iter()
                .map(|index| index.and_then(|it| reference.values.get(it).copied()))
                .map(|value| value.unwrap_or(f64::NAN))
                .collect(),
        };
        self.references.iter().map(of).collect()
    }
}

fn text(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}

fn list<T>(items: impl Iterator<Item = T>) -> &'static [T] {
    Box::leak(items.collect())
}

fn texts(items: &[String]) -> &'static [&'static str] {
    list(items.iter().map(|it| text(it)))
}

/// What the generated package would say of the table (`templates/table.rs`).
fn table(document: &Document, models: &'static [&'static str]) -> Table {
    Table {
        name: text(&document.provenance.table),
        models,
        unit_system: document.units.system.name(),
        entries: list(document.parameters.iter().map(|it| {
            let (section, key, doc) = (text(&it.path.0), text(&it.path.1), text(&it.doc));
            let entry = match it.kind {
                EntryKind::Parameter => Entry::parameter(section, key, doc),
                EntryKind::Coefficient => Entry::coefficient(section, key, doc),
                EntryKind::Required => Entry::required(section, key, doc),
                EntryKind::Switch => Entry::switch(key, doc),
            };
            entry.only_for(texts(&it.models))
        })),
        choices: list(document.choices.iter().map(|choice| {
            let options = choice.options.iter().map(|option| {
                let values = option.values.iter();
                let values = values.map(|(name, value)| (text(name), *value));
                ChoiceOption::new(text(&option.name), text(&option.doc), list(values))
            });
            Choice::new(text(&choice.name), text(&choice.doc), list(options))
        })),
        joins: list(
            document
                .joins
                .iter()
                .map(|it| it.each_ref().map(|it| text(it))),
        ),
        validity: list(document.validity.iter().map(|it| {
            // The IR has no values.
            let bounds = Bounds::new(f64::NEG_INFINITY, f64::INFINITY);
            let variables = list(bounded(&document.models, &it.name));
            let interval = Interval::new(text(&it.name), text(&it.unit), bounds, variables);
            interval.only_for(texts(&it.models))
        })),
        fits: list(document.fits.iter().map(|it| {
            let variables = it.variables.iter().map(|variable| FitVariable {
                name: text(&variable.name),
                unit: text(&variable.unit),
                interval: variable.interval.as_deref().map(text),
            });
            let (section, unit, doc) = (text(&it.section), text(&it.unit), text(&it.doc));
            let fit = Fit::new(section, unit, doc, list(variables), texts(&it.affine));
            fit.only_for(texts(&it.models))
        })),
        rules: list(document.rules.iter().map(|it| {
            let must = match it.must {
                IrSign::Positive => Sign::Positive,
                IrSign::NotNegative => Sign::NotNegative,
                IrSign::NotZero => Sign::NotZero,
            };
            let terms = it.terms.iter();
            let terms = list(terms.map(|(factor, names)| Term::new(*factor, texts(names))));
            Rule::new(text(&it.name), text(&it.reason), must, terms)
        })),
    }
}

/// States and inputs that an entry of the validity box bounds.
fn bounded<'a>(models: &'a [Model], entry: &'a str) -> impl Iterator<Item = &'static str> {
    let vectors = models.iter().flat_map(|model| {
        let bases = [Basis::State, Basis::Input].into_iter();
        bases.filter_map(|basis| model.bases.get(&basis))
    });
    let named = vectors.flatten();
    let mut names: Vec<&str> = named
        .filter(|it| it.validity.as_deref() == Some(entry))
        .map(|it| it.name.as_str())
        .collect();
    names.sort_unstable();
    names.dedup();
    names.into_iter().map(text)
}
