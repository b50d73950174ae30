//! The documentation of the generated package: Markdown with formulas, and pictures, from IR and table values.

mod audit;
mod differences;
mod equations;
mod functions;
mod index;
mod latex;
mod lines;
mod model_page;
mod noise;
mod search;
mod sparsity;
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
pub(crate) use subject::Subject;

use crate::{EmitError, Tree};

/// The texts of the templates, for the manifest.
pub(crate) const TEMPLATES: [&str; 4] = [
    audit::TEMPLATE,
    include_str!("../../templates/docs/index.md"),
    include_str!("../../templates/docs/model.md"),
    include_str!("../../templates/docs/table.md"),
];

/// The pages and pictures of one table and its models, by their path in the generated package.
///
/// # Errors
/// [`EmitError::Mismatch`] where the IR names what it does not have.
pub(crate) fn emit_table(subject: &Subject<'_>, costs: &Costs) -> Result<Tree, EmitError> {
    let mut tree = Tree::new();
    for model in &subject.document.models {
        let page = model_page::page(subject, model, costs)?;
        tree.insert(format!("docs/{}.md", model.name), tidy(&page));
        let picture = sparsity::picture(model, subject.document);
        tree.insert(format!("docs/images/{}-structure.svg", model.name), picture);
    }
    let page = table_page::page(subject);
    tree.insert(format!("docs/{}-table.md", subject.table.name), tidy(&page));
    Ok(tree)
}

/// The first page, `docs/README.md`; `further` are pages that stand beside those of [`emit_table`].
pub(crate) fn emit_index(subjects: &[Subject<'_>], further: &[Page]) -> Tree {
    let page = index::page(subjects, further);
    Tree::from([("docs/README.md".to_owned(), tidy(&page))])
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
