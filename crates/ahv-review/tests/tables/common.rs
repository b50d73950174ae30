//! What all tests need: the tables, what their models say of them, and what is found.

use std::fs;
use std::path::{Path, PathBuf};

use ahv_codegen::ir::Document;
use ahv_core::{GeneratedModel, ModelList, ModelVisitor, ParameterSetOf, Vector};
use ahv_review::{Condition, Finding, Limits, Reference, Subject, faults, lint};
use ahv_table::{Family, Text};

/// The tables that come along, with the folders of their generated packages.
pub(crate) const TABLES: [(&str, &str); 5] = [
    ("generator/tables/com.toml", "generated"),
    ("generator/tables/dcom.toml", "generated"),
    ("generator/tables/flexible_mode.toml", "generated"),
    (
        "examples/six-dof/six_dof.toml",
        "examples/six-dof/generated",
    ),
    (
        "examples/winged-cone/winged_cone.toml",
        "examples/winged-cone/generated",
    ),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub(crate) fn text(path: &str) -> String {
    fs::read_to_string(root().join(path)).expect("it is there")
}

/// What the package of this repository says of its models.
struct Compiled {
    table: String,
    subject: Option<Subject>,
}

impl ModelVisitor for Compiled {
    fn visit<M: GeneratedModel>(&mut self) {
        if M::TABLE.name != self.table {
            return;
        }
        let subject = self
            .subject
            .get_or_insert_with(|| Subject::new(Family::of::<M>()));
        if subject.references.is_empty() {
            subject.references = M::SETS.iter().map(reference::<M>).collect();
        }
        subject
            .conditions
            .extend(M::TRIM.given.iter().map(|given| Condition {
                model: M::NAME.to_owned(),
                state: given.name.to_owned(),
                value: given.default,
            }));
    }
}

fn reference<M: GeneratedModel>(set: &ParameterSetOf<M>) -> Reference {
    let values = (0..M::ParametersOf::<f64>::NAMES.len()).filter_map(|it| set.parameters.get(it));
    Reference {
        label: format!("the set `{}`", set.name),
        values: values.collect(),
    }
}

/// By the package of this repository if it has the table's models, else by the IR.
pub(crate) fn subject(path: &str, package: &str) -> Subject {
    let name = Path::new(path)
        .file_stem()
        .expect("a name")
        .to_string_lossy();
    let mut compiled = Compiled {
        table: name.clone().into_owned(),
        subject: None,
    };
    ahv_models::Models::visit(&mut compiled);
    compiled.subject.unwrap_or_else(|| of_ir(&name, package))
}

pub(crate) fn of_ir(name: &str, package: &str) -> Subject {
    let ir = text(&format!("{package}/ir/{name}.json"));
    let document = Document::parse(name, &ir).expect("an IR");
    let models: Vec<String> = document.models.iter().map(|it| it.name.clone()).collect();
    Subject::of_ir(&document, &models)
}

pub(crate) fn found(text: &str, subject: &Subject) -> Vec<Finding> {
    let text = Text::parse(text.to_owned()).expect("TOML");
    lint(&text, subject, &Limits::default(), faults(&text, subject))
}

/// A generator of numbers for changes of tables.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, most: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        usize::try_from(self.0 >> 33).unwrap_or(0) % most
    }
}
