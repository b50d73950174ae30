//! Functions that a reviewer can hold: what is too long is computed in several pieces.

use std::collections::BTreeSet;

use super::tree::{Body, Expr, Statement};
use crate::ir::{self, Basis};

/// A function of more lines is computed in pieces; what a piece takes besides its statements is above that.
pub(super) const LONGEST: usize = 118;
/// A function that is differentiated by so many things is computed in pieces even if it is short: it would not be for long.
const MANY: usize = 6;
/// A part of a stage takes a further section up to this many lines.
const FULL: usize = 90;
/// Characters of a line.
const WIDTH: usize = 75;

/// The entries of a function that are computed together.
pub(crate) struct Group {
    /// By what they are told from the others, as a part of a name.
    pub(crate) label: String,
    /// The same in words: the components that they are derivatives by, and of which rows.
    pub(crate) about: String,
    /// Positions among all entries of the function.
    pub(crate) entries: Vec<usize>,
}

/// The groups of a function of so many lines, in the order in which their first entries stand; none where it is short
/// and by few variables.
///
/// There is one for each component or group of parameters that entries are derivatives by, those with an index together. One that
/// is too long is divided by the index, then by rows. Short neighbours are not joined: a term more would change which,
/// and with it names that the term has nothing to do with.
pub(super) fn groups(
    function: &ir::Function,
    document: &ir::Document,
    lines: usize,
    mut length: impl FnMut(&Group) -> usize,
) -> Vec<Group> {
    if !function.compressed {
        return Vec::new();
    }
    let outputs = function.outputs.iter();
    let entries = outputs.flat_map(|output| output.entries.iter().map(move |it| (output, it)));
    let entries: Vec<_> = entries.collect();
    let by = |position: &usize| {
        let (output, entry) = entries[*position];
        match (output.basis.get(1), entry.at.get(1)) {
            (Some(Basis::Parameter), Some(name)) => {
                let parameter = document.parameters.iter().find(|it| it.name == *name);
                parameter.map_or_else(String::new, |it| identifier(&it.path.0))
            }
            (_, Some(name)) => name.clone(),
            _ => String::new(),
        }
    };
    let row = |position: &usize| entries[*position].1.at.first().cloned();
    let families = divided((0..entries.len()).collect(), |it| stem(&by(it)));
    if lines <= LONGEST && families.len() < MANY {
        return Vec::new();
    }
    let mut groups = Vec::new();
    for family in families {
        if length(&family) <= LONGEST {
            groups.push(family);
            continue;
        }
        for group in divided(family.entries, by) {
            if length(&group) <= LONGEST {
                groups.push(group);
                continue;
            }
            let rows = divided(group.entries, |it| row(it).unwrap_or_default());
            groups.extend(rows.into_iter().map(|of_row| Group {
                label: format!("{}_of_{}", group.label, of_row.label),
                about: format!("{} in row {}", group.label, of_row.label),
                ..of_row
            }));
        }
    }
    groups
}

/// A label without its index: what differs in that alone is computed together.
fn stem(label: &str) -> String {
    let stem = label.trim_end_matches(|c: char| c.is_ascii_digit());
    if stem.len() < label.len() {
        stem.trim_end_matches('_').to_owned()
    } else {
        label.to_owned()
    }
}

/// Entries by their labels, in the order in which the first of each stand.
fn divided(entries: Vec<usize>, label: impl Fn(&usize) -> String) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for entry in entries {
        let label = label(&entry);
        match groups.iter_mut().find(|it| it.label == label) {
            Some(group) => group.entries.push(entry),
            None => groups.push(Group {
                about: label.clone(),
                label,
                entries: vec![entry],
            }),
        }
    }
    groups
}

/// A text in lower case, as a part of a name.
fn identifier(text: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    text.to_lowercase().chars().map(letter).collect()
}

/// About how many lines a body has.
pub(super) fn length(body: &Body) -> usize {
    body.statements.iter().map(lines).sum::<usize>() + body.results.len()
}

/// About how many lines a statement has.
pub(super) fn lines(statement: &Statement) -> usize {
    match statement {
        Statement::Section(_) => 2,
        Statement::SinCos { .. } => 1,
        Statement::Let { name, value, .. }
        | Statement::Set {
            field: name, value, ..
        } => match value {
            Expr::Sum(addends) if addends.len() > 2 => addends.len(),
            value => 1 + (name.len() + characters(value)) / WIDTH,
        },
    }
}

fn characters(expr: &Expr) -> usize {
    let mut count = 0;
    expr.walk(&mut |part| {
        count += 3 + match part {
            Expr::Component(_, name) | Expr::Name(name) => name.len(),
            _ => 0,
        };
    });
    count
}

/// Statements that fill a struct, in parts that are short enough. No part needs a name of another.
pub(crate) fn sliced(statements: Vec<Statement>) -> Vec<Body> {
    let cuts = cuts(&statements);
    let (mut parts, mut part, mut is_due) = (Vec::new(), Vec::new(), false);
    let mut heading = None;
    for (position, statement) in statements.iter().enumerate() {
        is_due |= cuts.contains(&position);
        if is_due && is_free(&part, &statements[position..]) {
            parts.push(body_of(std::mem::take(&mut part)));
            is_due = false;
            // A part that begins in the middle of a section says which.
            if !is_heading(statement) {
                part.extend(heading.clone());
            }
        }
        if is_heading(statement) {
            heading = Some(statement.clone());
        }
        part.push(statement.clone());
    }
    parts.push(body_of(part));
    parts
}

/// Where statements that fill a struct are cut: between sections, where these are not too long by themselves.
fn cuts(statements: &[Statement]) -> Vec<usize> {
    let total: usize = statements.iter().map(lines).sum();
    let (mut cuts, mut length, mut ahead) = (Vec::new(), 0, 0);
    for (position, statement) in statements.iter().enumerate() {
        if is_heading(statement) || position == 0 {
            let section = statements[position + 1..].iter();
            let section = section.take_while(|it| !is_heading(it));
            ahead = lines(statement) + section.map(lines).sum::<usize>();
        }
        let is_full = if is_heading(statement) {
            length + ahead > FULL
        } else {
            length >= FULL && length + ahead > LONGEST
        };
        if length > 0 && is_full && total > LONGEST {
            cuts.push(position);
            length = 0;
        }
        length += lines(statement);
        ahead -= lines(statement);
    }
    cuts
}

/// The names that parts need of each other.
pub(super) fn crossing(statements: &[Statement]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for cut in cuts(statements) {
        let (before, after) = statements.split_at(cut);
        let bound = bound(before);
        body_of(after.to_vec()).walk(&mut |expr| {
            if let Expr::Name(name) = expr
                && bound.contains(name)
            {
                found.insert(name.clone());
            }
        });
    }
    found
}

fn is_heading(statement: &Statement) -> bool {
    matches!(statement, Statement::Section(_))
}

fn body_of(statements: Vec<Statement>) -> Body {
    Body {
        statements,
        ..Body::default()
    }
}

/// Whether nothing of the rest needs a name of a part.
fn is_free(part: &[Statement], rest: &[Statement]) -> bool {
    let names = bound(part);
    // A heading belongs to what follows it.
    let mut free = !part.last().is_some_and(is_heading);
    body_of(rest.to_vec()).walk(&mut |expr| {
        if let Expr::Name(name) = expr {
            free &= !names.contains(name);
        }
    });
    free
}

/// The names that statements bind.
fn bound(statements: &[Statement]) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for statement in statements {
        match statement {
            Statement::Let { name, .. } => {
                names.insert(name.clone());
            }
            Statement::SinCos { sin, cos, .. } => {
                for value in [sin, cos] {
                    if let Expr::Name(name) = value {
                        names.insert(name.clone());
                    }
                }
            }
            Statement::Section(_) | Statement::Set { .. } => {}
        }
    }
    names
}
