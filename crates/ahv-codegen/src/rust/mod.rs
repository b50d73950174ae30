//! The Rust files of one model: its vectors, its prepared parameters and its functions.

mod dense;
#[allow(unreachable_pub, reason = "the functions that `filter_fn` makes are")]
pub(crate) mod filters;
pub(crate) mod format;
pub(crate) mod home;
mod items;
mod print;
mod wording;

use askama::Template;
use std::collections::{BTreeMap, BTreeSet};

use crate::EmitError;
use crate::ir::{self, Basis, Variable};
use crate::schedule::Cost;
use crate::schedule::given::Stage;
use crate::schedule::program::Program;
use crate::schedule::stages;
use crate::schedule::tree::{Source, StageKind, Statement};
use crate::template::render;
use crate::wording::wrapped;
use items::Item;
use print::statement;
use wording::{arguments, formula, vector_impl};

#[derive(Template)]
#[template(path = "model.rs")]
struct ModelTemplate<'a> {
    model: &'a ir::Model,
    label: String,
    home: &'a str,
    shared_parameters: bool,
    modules: Vec<&'a str>,
    groups: Vec<&'a str>,
    has_choices: bool,
    /// What the home of the table shares.
    shared: Vec<String>,
    /// Vectors, each with its implementation.
    vectors: Vec<(Vector<'a>, String)>,
    /// States that decay by themselves, each with its rate as a field of `Prepared`.
    coloured: &'a [(String, String)],
}

impl ModelTemplate<'_> {
    /// Whether no column of the diffusion depends on the state.
    fn is_additive(&self) -> bool {
        let columns = self.model.noise.as_ref().map(|noise| &noise.columns);
        columns.is_some_and(|columns| {
            columns
                .iter()
                .all(|column| column.class == ir::NoiseClass::Constant)
        })
    }

    /// Whether every two columns of the diffusion commute.
    fn is_commutative(&self) -> bool {
        let columns = self.model.noise.as_ref().map(|noise| &noise.columns);
        columns.is_some_and(|all| all.iter().all(|j| all.iter().all(|k| self.commute(j, k))))
    }

    /// Whether two columns of the diffusion commute.
    fn commute(&self, j: &ir::NoiseColumn, k: &ir::NoiseColumn) -> bool {
        let pair = |(a, b): &(String, String)| {
            (*a == j.name && *b == k.name) || (*a == k.name && *b == j.name)
        };
        let noise = self.model.noise.as_ref();
        j.name == k.name || noise.is_some_and(|noise| noise.commuting.iter().any(pair))
    }
}

#[derive(Template)]
#[template(path = "description.rs")]
struct DescriptionTemplate<'a> {
    model: &'a ir::Model,
    label: String,
    /// States of coloured noise.
    coloured: usize,
}

impl DescriptionTemplate<'_> {
    /// Deviations that cost 1, in the order of states and inputs.
    fn deviations(&self) -> Vec<(&str, f64)> {
        let model = self.model;
        let vectors = [Basis::State, Basis::Input].map(|basis| model.bases.get(&basis));
        let variables = vectors.into_iter().flatten().flatten();
        let found = variables.filter_map(|v| Some((&*v.name, *model.deviations.get(&v.name)?)));
        found.collect()
    }

    fn bound(&self, bound: &Option<f64>, open: &str) -> String {
        bound.map_or_else(|| open.to_owned(), filters::literal)
    }

    fn like(&self, equation: &ir::Equation) -> String {
        let like = equation.like.as_ref();
        like.map_or_else(
            || "None".to_owned(),
            |(row, state)| format!("Some(({row:?}, {state:?}))"),
        )
    }
}

struct Vector<'a> {
    name: &'static str,
    doc: &'static str,
    fields: &'a [Variable],
    /// Constant that bounds it, where the table does.
    bounds: Option<&'static str>,
}

#[derive(Template)]
#[template(path = "stages.rs")]
struct StagesTemplate<'a> {
    about: String,
    imports: Vec<&'static str>,
    stages: Vec<StageText<'a>>,
}

struct StageText<'a> {
    kind: &'static StageKind,
    docs: Vec<String>,
    fields: Vec<(&'a str, Vec<String>)>,
    arguments: String,
    /// Whether it is a part of every function that calls it.
    is_inline: bool,
    /// Statements, where one part fills all.
    statements: Vec<String>,
    /// Otherwise what each part takes, its call and its statements.
    parts: Vec<PartText>,
}

struct PartText {
    name: String,
    arguments: String,
    call: String,
    statements: Vec<String>,
}

#[derive(Template)]
#[template(path = "functions.rs")]
struct FunctionsTemplate {
    label: String,
    units: &'static str,
    /// Types of the parent module, in alphabetical order.
    imports: Vec<String>,
    paper_names: bool,
    needs_vector: bool,
    /// Whether a function takes more arguments than the linter likes.
    is_crowded: bool,
    items: Vec<Item>,
}

/// The text of each Rust file of a model, by its name without ending.
pub(crate) fn files(program: &Program<'_>) -> Result<BTreeMap<String, String>, EmitError> {
    let mut files = BTreeMap::new();
    for group in program.groups() {
        files.insert(group.to_owned(), functions(program, group)?);
    }
    files.insert("prepared".to_owned(), prepared(program)?);
    if !program.stages.is_empty() {
        files.insert("stages".to_owned(), stages(program)?);
    }
    let description = DescriptionTemplate {
        model: program.model,
        label: program.label(),
        coloured: program.coloured.len(),
    };
    files.insert("description".to_owned(), render(&description)?);
    files.insert("mod".to_owned(), module(program)?);
    Ok(files)
}

fn module(program: &Program<'_>) -> Result<String, EmitError> {
    let Program {
        model,
        document,
        home,
        ..
    } = *program;
    let mut groups = program.groups();
    let mut modules = groups.clone();
    modules.extend(["description", "prepared"]);
    if !program.stages.is_empty() {
        groups.push("stages");
        modules.push("stages");
    }
    if home == model.name {
        modules.extend(["nominal", "parameters", "provenance", "table"]);
        if !document.choices.is_empty() {
            modules.push("choices");
        }
    }
    groups.sort_unstable();
    modules.sort_unstable();
    let vectors = vectors(model);
    let mut lists = Vec::new();
    for vector in &vectors {
        let fields = vector.fields.iter().map(|v| (&v.name, &v.unit));
        lists.push(vector_impl(vector.name, fields, &document.units)?);
    }
    render(&ModelTemplate {
        model,
        label: program.label(),
        home,
        shared_parameters: home != model.name,
        has_choices: !document.choices.is_empty(),
        shared: home::shared(document),
        modules,
        groups,
        vectors: vectors.into_iter().zip(lists).collect(),
        coloured: &program.coloured,
    })
}

/// The vectors of a model.
fn vectors(model: &ir::Model) -> Vec<Vector<'_>> {
    let vector = |name, doc, basis, bounds| Vector {
        name,
        doc,
        fields: model.bases.get(&basis).map_or(&[], Vec::as_slice),
        bounds,
    };
    let mut vectors = vec![
        vector("State", "State", Basis::State, Some("STATE_BOUNDS")),
        vector("Input", "Input", Basis::Input, Some("INPUT_BOUNDS")),
    ];
    if model.noise.is_some() {
        let doc = "One value for each independent Wiener process";
        vectors.push(vector("Noise", doc, Basis::Noise, None));
    }
    let doc = "Quantities that people look at";
    vectors.push(vector("Outputs", doc, Basis::Output, None));
    if model.bases.contains_key(&Basis::Boundary) {
        let doc = "One function for each boundary at which the equations of motion go over to another formula";
        vectors.push(vector("Boundaries", doc, Basis::Boundary, None));
    }
    vectors
}

fn prepared(program: &Program<'_>) -> Result<String, EmitError> {
    let stage = &program.prepared;
    let mut cost = Cost::default();
    stage.parts.iter().for_each(|part| cost += part.cost());
    let docs = ["Computes everything that depends on parameters alone.", ""];
    let docs = docs.map(str::to_owned).into_iter();
    let text = StageText {
        docs: docs.chain([format!("{}.", cost.describe())]).collect(),
        ..stage_text(stage, &[], "Parameters")
    };
    render(&StagesTemplate {
        about: format!(
            "What {} computes from its parameters once.",
            program.label()
        ),
        imports: vec!["Parameters"],
        stages: vec![text],
    })
}

/// What functions share.
fn stages(program: &Program<'_>) -> Result<String, EmitError> {
    let stages = program.stages.iter();
    let stages = stages.map(|stage| stage_text(stage, &program.stages, "Prepared"));
    render(&StagesTemplate {
        about: format!(
            "What functions of {} share. Units are {}.",
            program.label(),
            program.document.units.in_words()
        ),
        imports: vec!["Input", "Prepared", "State"],
        stages: stages.collect(),
    })
}

/// A stage; `p` are values of this type.
fn stage_text<'a>(stage: &'a Stage, all: &[Stage], parameters: &str) -> StageText<'a> {
    let kind = stage.kind;
    let values = stage.parts.iter().flat_map(|part| &part.statements);
    let value = |name: &str| {
        values.clone().find_map(|it| match it {
            Statement::Set { field, value, .. } if field == name => Some(value),
            _ => None,
        })
    };
    let fields = stage.fields.iter().map(|field| {
        let formula = || {
            format!(
                "`{}`.",
                value(&field.name).map_or_else(String::new, formula)
            )
        };
        let about = field.about.clone().unwrap_or_else(formula);
        (&*field.name, wrapped(&about))
    });
    let arguments = if parameters == "Parameters" {
        format!("p: &{parameters}<R>")
    } else {
        let mut arguments = arguments(|kind| stage.uses(Source::Argument(kind)));
        let earlier = all.iter().map(|it| it.kind).filter(|it| **it != *kind);
        let earlier = earlier.filter(|kind| stage.uses(Source::Stage(kind)));
        arguments.extend(earlier.map(|kind| items::stage_argument(kind, true)));
        arguments.join(", ")
    };
    let is_whole = stage.parts.len() == 1;
    let mut statements = stage.parts.iter();
    let mut statements: Vec<Vec<String>> = statements
        .by_ref()
        .map(|part| part.statements.iter().map(statement).collect())
        .collect();
    let whole = if is_whole {
        statements.remove(0)
    } else {
        Vec::new()
    };
    let parts = stage.parts.iter().zip(statements).zip(1..);
    let parts = parts.map(|((part, statements), number)| {
        let taken = items::taken(|source| part.uses(source), all).into_iter();
        let taken: Vec<(String, String)> =
            taken.filter(|(name, _)| name != kind.argument).collect();
        let name = format!("{}_part_{number}", kind.function);
        let types = taken.iter().map(|(name, of)| {
            let of = if name == "p" { parameters } else { of };
            format!("{name}: &{of}<R>")
        });
        let own = format!("{}: &mut {}<R>", kind.argument, kind.type_name);
        let names = taken.iter().map(|(name, _)| name.clone());
        let names: Vec<String> = [format!("&mut {}", kind.argument)]
            .into_iter()
            .chain(names)
            .collect();
        PartText {
            call: format!("{name}({});", names.join(", ")),
            arguments: [own]
                .into_iter()
                .chain(types)
                .collect::<Vec<_>>()
                .join(", "),
            name,
            statements,
        }
    });
    StageText {
        kind,
        docs: vec![format!("Computes [`{}`].", kind.type_name)],
        fields: fields.collect(),
        arguments,
        is_inline: *kind != stages::PREPARED,
        parts: if is_whole {
            Vec::new()
        } else {
            parts.collect()
        },
        statements: whole,
    }
}

/// The file of a group of functions.
fn functions(program: &Program<'_>, group: &str) -> Result<String, EmitError> {
    let mut items = Vec::new();
    // Functions of one group share the patterns of their results.
    let mut patterns = BTreeSet::new();
    let mut imports: BTreeSet<String> = ["Input", "Prepared", "State"].map(str::to_owned).into();
    let own = program.functions.iter().filter(|it| it.ir.group == group);
    for function in own {
        for shape in &function.shapes {
            imports.extend(shape.vectors().chain(shape.alias()).map(str::to_owned));
            if let Some(entries) = shape.entries().filter(|_| function.ir.compressed) {
                let here = function.parts.is_empty() && patterns.insert(entries.pattern.clone());
                if here {
                    items.push(Item::Entries(entries.definition()));
                } else if !patterns.contains(&entries.pattern) {
                    imports.insert(entries.name);
                }
            }
        }
        imports.extend(items::imports(program, function));
        let texts = items::functions(program, function);
        items.extend(texts.into_iter().map(Item::Function));
        if function.ir.compressed {
            items.push(Item::Function(items::dense(function)));
        }
    }
    let functions = || {
        items.iter().filter_map(|item| match item {
            Item::Function(function) => Some(function),
            Item::Entries(_) => None,
        })
    };
    let paper_names = functions().any(|f| f.name.chars().any(char::is_uppercase));
    let is_crowded = functions().any(|f| f.arguments.len() > 7);
    let needs_vector = functions().any(|f| !f.zeros.is_empty());
    render(&FunctionsTemplate {
        label: program.label(),
        units: program.document.units.in_words(),
        imports: imports.into_iter().collect(),
        paper_names,
        needs_vector,
        is_crowded,
        items,
    })
}

#[cfg(test)]
mod tests;
