//! The page of the passes: what each does, and how many operations it saves.

use std::cmp::Ordering;

use askama::Template;

use super::index::Page;
use crate::EmitError;
use crate::graph::passes::Pass;
use crate::ir::Model;
use crate::schedule::Cost;
use crate::schedule::effect::Effect;
use crate::template::render;

/// Where the page stands, relative to the index.
pub(super) const PATH: &str = "passes.md";

#[derive(Template)]
#[template(path = "docs/passes.md")]
struct PassesPage<'a> {
    passes: [Pass; Pass::ALL.len()],
    models: Vec<(&'a Model, &'a Vec<Effect>)>,
}

/// The page in the list of the index.
pub(crate) fn passes_page() -> Page {
    Page {
        path: PATH.to_owned(),
        title: "Passes".to_owned(),
        about: "the rules by which the emitter rewrites expressions, and the operations that each saves".to_owned(),
    }
}

/// The page of the passes for these models.
pub(super) fn page<'a>(
    models: impl Iterator<Item = (&'a Model, &'a Vec<Effect>)>,
) -> Result<String, EmitError> {
    render(&PassesPage {
        passes: Pass::ALL,
        models: models.collect(),
    })
}

impl Effect {
    /// What the operations become without each pass.
    fn differences(&self) -> Vec<String> {
        let without = self.without.iter();
        without
            .map(|without| difference(without, &self.all))
            .collect()
    }
}

/// A difference of operations, in parentheses that of divisions among them; nothing where there is none.
fn difference(without: &Cost, all: &Cost) -> String {
    let divisions = signed(without.divisions, all.divisions);
    match (signed(without.total(), all.total()), divisions.as_str()) {
        (total, "0") if total == "0" => String::new(),
        (total, "0") => total,
        (total, divisions) => format!("{total} ({divisions})"),
    }
}

/// A difference of counts: `+4`, `−3` or `0`.
fn signed(more: usize, fewer: usize) -> String {
    match more.cmp(&fewer) {
        Ordering::Greater => format!("+{}", more - fewer),
        Ordering::Less => format!("−{}", fewer - more),
        Ordering::Equal => "0".to_owned(),
    }
}
