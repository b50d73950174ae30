//! The structs of a model: its vectors, its matrices, what is prepared and computed once.

use super::print::Printer;
use crate::ir::{self, Basis, capitalised};
use crate::schedule::given::Stage;
use crate::schedule::program::Program;
use crate::schedule::tree::Statement;
use crate::shape::{Axis, Shape};

/// A struct.
pub(super) struct Struct {
    pub(super) name: String,
    pub(super) doc: String,
    /// Type, name and description of each field.
    pub(super) fields: Vec<(String, String, String)>,
}

/// The name of a model or table as the beginning of a type's name.
pub(super) fn camel(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric());
    words.map(capitalised).collect()
}

/// The names of the types of a model.
pub(super) struct Types {
    /// Of the model.
    pub(super) own: String,
    /// Of its table.
    pub(super) table: String,
}

impl Types {
    pub(super) fn of(program: &Program<'_>) -> Self {
        Self {
            own: camel(&program.model.name),
            table: camel(&program.document.provenance.table),
        }
    }

    /// The vector over a basis.
    pub(super) fn vector(&self, axis: &Axis<'_>) -> String {
        match axis.basis {
            Basis::Parameter => format!("{}Parameters", self.table),
            _ => format!("{}{}", self.own, axis.vector),
        }
    }

    /// The type over some axes.
    pub(super) fn nested(&self, axes: &[Axis<'_>]) -> String {
        match axes {
            [] => "double".to_owned(),
            [axis] => self.vector(axis),
            axes => format!("{}{}", self.own, matrix(axes)),
        }
    }

    /// The structs over several axes that the outputs of a program need, inner ones first.
    fn matrices(&self, program: &Program<'_>) -> Vec<Struct> {
        let mut found: Vec<Struct> = Vec::new();
        let shapes = program.functions.iter().flat_map(|it| &it.shapes);
        for shape in shapes {
            for depth in (0..shape.axes.len().saturating_sub(1)).rev() {
                let axes = &shape.axes[depth..];
                let name = self.nested(axes);
                if found.iter().any(|it| it.name == name) {
                    continue;
                }
                let inner = self.nested(&axes[1..]);
                let rows = axes[0].names.iter();
                found.push(Struct {
                    name,
                    doc: described(axes),
                    fields: rows
                        .map(|row| (inner.clone(), (*row).to_owned(), String::new()))
                        .collect(),
                });
            }
        }
        found
    }

    /// All structs of a program, each after those that it holds.
    pub(super) fn structs(&self, program: &Program<'_>) -> Vec<Struct> {
        let model = program.model;
        let vector = |basis, name: &str, doc: &str| {
            let fields: &[ir::Variable] = model.bases.get(&basis).map_or(&[], Vec::as_slice);
            let field = |it: &ir::Variable| (double(), it.name.clone(), it.described());
            Struct {
                name: format!("{}{name}", self.own),
                doc: format!("{doc} of {}.", program.label()),
                fields: fields.iter().map(field).collect(),
            }
        };
        let vectors = [
            vector(Basis::State, "State", "State"),
            vector(Basis::Input, "Input", "Input"),
            vector(
                Basis::Noise,
                "Noise",
                "One value for each independent Wiener process",
            ),
            vector(Basis::Output, "Outputs", "Quantities that are not states"),
            vector(
                Basis::Boundary,
                "Boundaries",
                "One function for each boundary between formulas",
            ),
        ];
        let stages = [&program.prepared].into_iter().chain(&program.stages);
        let vectors = vectors.into_iter().filter(|it| !it.fields.is_empty());
        let matrices = self.matrices(program);
        vectors
            .chain(matrices)
            .chain(stages.map(|stage| self.stage(stage)))
            .collect()
    }

    fn stage(&self, stage: &Stage) -> Struct {
        let fields = stage.fields.iter().map(|field| {
            let about = field.about.clone().or_else(|| formula(stage, &field.name));
            (double(), field.name.clone(), about.unwrap_or_default())
        });
        Struct {
            name: format!("{}{}", self.own, stage.kind.type_name),
            doc: format!("{}.", stage.kind.doc),
            fields: fields.collect(),
        }
    }
}

/// The formula of a field for a reader, where it is short.
fn formula(stage: &Stage, name: &str) -> Option<String> {
    let mut statements = stage.parts.iter().flat_map(|part| &part.statements);
    let value = statements.find_map(|it| match it {
        Statement::Set { field, value, .. } if field == name => Some(value),
        _ => None,
    })?;
    let printer = Printer { holds_stages: true };
    let text = printer.expression(value).replace("->", ".");
    let own = format!("{}.", stage.kind.argument);
    let words = text.split(' ').map(|word| {
        let bare = word.trim_start_matches(['(', '-']);
        let start = &word[..word.len() - bare.len()];
        let bare = bare.strip_prefix("p.").unwrap_or(bare);
        format!("{start}{}", bare.strip_prefix(&own).unwrap_or(bare))
    });
    let text = words.collect::<Vec<_>>().join(" ");
    (text.len() < 100).then_some(text)
}

fn double() -> String {
    "double".to_owned()
}

/// What an array over several axes is.
fn described(axes: &[Axis<'_>]) -> String {
    let bases: Vec<String> = axes.iter().map(|axis| axis.basis.to_string()).collect();
    match bases.as_slice() {
        [row, column] => format!("A matrix: a row for each {row}, a column for each {column}."),
        bases => format!("An array: by {}.", bases.join(", then by ")),
    }
}

/// The name of a type over several axes.
fn matrix(axes: &[Axis<'_>]) -> String {
    let bases: Vec<Basis> = axes.iter().map(|axis| axis.basis).collect();
    match Shape::name_of(&bases) {
        Some(name) => name.to_owned(),
        None => axes.iter().map(|axis| axis.vector).collect(),
    }
}
