//! The Rust files of one model: its vectors, its prepared parameters and its functions.

pub(crate) mod checks;
mod dense;
#[allow(unreachable_pub, reason = "the functions that `filter_fn` makes are")]
pub(crate) mod filters;
mod format;
mod home;
mod items;
mod layout;
mod package;
mod places;
mod print;
mod records;
mod stages;
mod wording;

use askama::Template;
use std::collections::{BTreeMap, BTreeSet};

use crate::EmitError;
use crate::ir::{self, Basis, Variable};
use crate::schedule::program::Program;
use crate::template::render;
use items::Item;
pub(crate) use package::Package;

/// The texts of the templates, for the manifest.
pub(crate) const TEMPLATES: [&str; 11] = [
    include_str!("../../templates/manifest.toml"),
    include_str!("../../templates/choices.rs"),
    include_str!("../../templates/description.rs"),
    include_str!("../../templates/functions.rs"),
    include_str!("../../templates/lib.rs"),
    include_str!("../../templates/model.rs"),
    include_str!("../../templates/nominal.rs"),
    include_str!("../../templates/parameters.rs"),
    include_str!("../../templates/provenance.rs"),
    include_str!("../../templates/stages.rs"),
    include_str!("../../templates/table.rs"),
];

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
    /// Vectors, each with its definition.
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
    has_boundaries: bool,
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
fn files(program: &Program<'_>) -> Result<BTreeMap<String, String>, EmitError> {
    let mut files = BTreeMap::new();
    for group in program.groups() {
        files.insert(group.to_owned(), functions(program, group)?);
    }
    files.insert("prepared".to_owned(), stages::prepared(program)?);
    if !program.stages.is_empty() {
        files.insert("stages".to_owned(), stages::shared(program)?);
    }
    let description = DescriptionTemplate {
        model: program.model,
        label: program.label(),
        coloured: program.coloured.len(),
        has_boundaries: program.groups().contains(&"boundaries"),
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
        let about = format!("{} of {}.", vector.doc, program.label());
        let fields = vector
            .fields
            .iter()
            .map(|it| (&*it.name, it.described(), &*it.unit));
        lists.push(records::vector(
            &about,
            vector.name,
            fields,
            &document.units,
        )?);
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
