//! The documentation of the generated package: Markdown with formulas, from IR and table values.

mod audit;
mod equations;
mod functions;
mod index;
mod latex;
mod lines;
mod model_page;
mod noise;
mod passes_page;
mod structure;
mod subject;
mod symbol;
mod table_page;
#[cfg(test)]
mod tests;
mod tree;
mod typeset;

pub(crate) use audit::audit;
pub(crate) use functions::Costs;
pub(crate) use index::Page;
pub(crate) use passes_page::passes_page;
use subject::Subject;

use crate::ir::Model;
use crate::schedule::effect::Effect;
use crate::{EmitError, Tree};

/// Under this name stands, beside the IRs of the tables, the audit of the printed equations.
pub const AUDIT: &str = "audit";

/// The texts of the templates, for the manifest.
pub(crate) const TEMPLATES: [&str; 5] = [
    audit::TEMPLATE,
    include_str!("../../templates/docs/index.md"),
    include_str!("../../templates/docs/model.md"),
    include_str!("../../templates/docs/passes.md"),
    include_str!("../../templates/docs/table.md"),
];

/// The page of a table, by its path in the generated package.
///
/// # Errors
/// [`EmitError::Template`]
pub(crate) fn emit_table(subject: &Subject<'_>) -> Result<Tree, EmitError> {
    let page = table_page::page(subject)?;
    let path = format!("docs/{}-table.md", subject.table.name);
    Ok(Tree::from([(path, tidy(&page))]))
}

/// The page of a model, by its path in the generated package.
///
/// # Errors
/// [`EmitError::Mismatch`] where the IR names what it does not have.
pub(crate) fn emit_model(
    subject: &Subject<'_>,
    model: &Model,
    costs: &Costs,
) -> Result<Tree, EmitError> {
    let page = model_page::page(subject, model, costs)?;
    Ok(Tree::from([(
        format!("docs/{}.md", model.name),
        tidy(&page),
    )]))
}

/// The page of the passes, by its path in the generated package.
///
/// # Errors
/// [`EmitError::Template`]
pub(crate) fn emit_passes<'a>(
    models: impl Iterator<Item = (&'a Model, &'a Vec<Effect>)>,
) -> Result<Tree, EmitError> {
    let page = passes_page::page(models)?;
    Ok(Tree::from([(
        format!("docs/{}", passes_page::PATH),
        tidy(&page),
    )]))
}

/// The first page, `docs/README.md`; `further` are pages that stand beside those of [`emit_table`].
///
/// # Errors
/// [`EmitError::Template`]
pub(crate) fn emit_index(subjects: &[Subject<'_>], further: &[Page]) -> Result<Tree, EmitError> {
    let page = index::page(subjects, further)?;
    Ok(Tree::from([("docs/README.md".to_owned(), tidy(&page))]))
}

/// Markdown without blanks at the ends of lines, or more than one empty line in a row.
fn tidy(text: &str) -> String {
    let mut tidied = String::with_capacity(text.len());
    let mut blank = true;
    for line in text.lines().map(str::trim_end) {
        if !(line.is_empty() && blank) {
            tidied += line;
            tidied.push('\n');
        }
        blank = line.is_empty();
    }
    tidied.truncate(tidied.trim_end().len());
    tidied + "\n"
}
