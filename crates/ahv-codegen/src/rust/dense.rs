//! Results as Rust: the type of an output, its dense form as an expression, its pattern.

use crate::schedule::tree::Expr;
use crate::shape::{Shape, words};

use super::print::{expression, literal};
use super::records;

/// Zeros that a result needs, by name, each with the vector type that it is a splat of and its component.
pub(crate) type Zeros = Vec<(String, &'static str, String)>;

impl Shape<'_> {
    /// The type of the dense form.
    pub(crate) fn result(&self) -> String {
        match (self.alias(), self.axes.as_slice()) {
            (Some(alias), _) => format!("{alias}<R>"),
            (None, [axis]) if self.is_list() => format!("[R; {}]", axis.names.len()),
            (None, _) => self.nested(0),
        }
    }

    fn nested(&self, depth: usize) -> String {
        match self.axes.get(depth) {
            None => "R".to_owned(),
            Some(axis) => format!("{}<{}>", axis.vector, self.nested(depth + 1)),
        }
    }

    /// Types that the dense form is written in, besides its alias.
    pub(crate) fn vectors(&self) -> impl Iterator<Item = &'static str> {
        self.axes
            .iter()
            .map(|axis| axis.vector)
            .filter(|vector| !vector.is_empty())
    }

    /// The dense form as an expression of its entries' values, which stand in the order of the entries.
    pub(crate) fn dense(&self, values: &[Expr], zeros: &mut Zeros) -> String {
        if self.is_list() {
            let entries = self.axes[0].names.iter();
            let entries = entries.map(|name| self.value(&[name], values));
            let entries: Vec<String> = entries.map(|v| v.unwrap_or_else(|| literal(0.0))).collect();
            return format!("[{}]", entries.join(", "));
        }
        self.level(&[], values, zeros)
            .unwrap_or_else(|| self.zero(0, zeros))
    }

    /// The part of the dense form below some leading indices; `None` where all of it is zero.
    fn level(&self, at: &[&str], values: &[Expr], zeros: &mut Zeros) -> Option<String> {
        let Some(axis) = self.axes.get(at.len()) else {
            return self.value(at, values);
        };
        let is_last = at.len() + 1 == self.axes.len();
        let (mut fields, mut any_zero, mut any_value) = (Vec::new(), false, false);
        for name in &axis.names {
            let inner = [at, &[*name]].concat();
            match self.level(&inner, values, zeros) {
                Some(value) => {
                    any_value = true;
                    fields.push(field(name, value));
                }
                // A vector lists its zeros, a matrix has them from a vector of zeros.
                None if is_last && self.axes.len() == 1 => {
                    fields.push(field(name, literal(0.0)));
                }
                None => any_zero = true,
            }
        }
        if !any_value && self.axes.len() > 1 {
            return None;
        }
        if any_zero {
            fields.push(format!("..{}", self.zero(at.len(), zeros)));
        }
        Some(format!("{} {{ {} }}", axis.vector, fields.join(", ")))
    }

    /// The name of the zero of this depth, noted among the zeros that are needed.
    fn zero(&self, depth: usize, zeros: &mut Zeros) -> String {
        let Some(axis) = self.axes.get(depth) else {
            return literal(0.0);
        };
        let component = self.zero(depth + 1, zeros);
        let bases = self.axes[depth..].iter().map(|axis| axis.basis.to_string());
        let names: Vec<String> = bases.collect();
        let name = format!("no_{}", names.join("_"));
        if !zeros.iter().any(|(known, ..)| *known == name) {
            zeros.push((name.clone(), axis.vector, component));
        }
        name
    }

    fn value(&self, at: &[&str], values: &[Expr]) -> Option<String> {
        Some(expression(&values[self.entry(at)?]))
    }

    /// The struct of the structurally non-zero entries; none for what has no compressed form.
    pub(super) fn entries(&self) -> Option<EntriesText<'_>> {
        let alias = self.alias()?;
        let vectors: Vec<&str> = self.vectors().collect();
        let symmetric = if self.output.symmetric {
            "symmetric "
        } else {
            ""
        };
        let open = vectors.join("<");
        let close = ">".repeat(vectors.len() - 1);
        let entries = self.output.entries.iter();
        Some(EntriesText {
            name: format!("{alias}Entries"),
            alias,
            pattern: format!("{}_PATTERN", words(alias).to_uppercase()),
            shape: format!("{symmetric}{open}{close}"),
            entries: entries.map(|entry| &*entry.at).collect(),
        })
    }
}

/// A struct of entries, and the constant that says where they stand.
pub(super) struct EntriesText<'a> {
    pub(super) name: String,
    pub(super) alias: &'static str,
    pub(super) pattern: String,
    shape: String,
    /// The place of each.
    entries: Vec<&'a [String]>,
}

impl EntriesText<'_> {
    /// Its definition, as the formatter's marker.
    pub(super) fn definition(&self) -> String {
        let Self {
            name,
            alias,
            pattern,
            shape,
            entries,
        } = self;
        let about = format!("The structurally non-zero entries of a [`{alias}`].");
        let rows = format!("{}_entries", words(alias));
        let head = format!("pub struct {name} in {rows}, {pattern}: {shape}");
        records::entries(&about, &head, entries)
    }
}

fn field(name: &str, value: String) -> String {
    if value == name {
        value
    } else {
        format!("{name}: {value}")
    }
}
