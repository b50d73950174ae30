//! The shape of what a function returns: a number, a vector, a matrix, or an array of three indices.

use crate::EmitError;
use crate::ir::{self, Output, Variable};
use crate::print::literal;

/// A basis with the type of its vectors.
#[derive(Clone, Copy)]
struct Basis<'a> {
    name: &'a str,
    vector: &'static str,
    variables: &'a [Variable],
}

/// An output over its bases; none for a number.
pub(crate) struct Shape<'a> {
    output: &'a Output,
    bases: Vec<Basis<'a>>,
}

/// Zeros that a result needs, by name, each with the vector type that it is a splat of and its component.
pub(crate) type Zeros = Vec<(String, &'static str, String)>;

impl<'a> Shape<'a> {
    /// The shape of an output; its entries are held against its bases.
    pub(crate) fn of(
        model: &'a ir::Model,
        parameters: &'a [Variable],
        output: &'a Output,
    ) -> Result<Self, EmitError> {
        let mut bases = Vec::new();
        for name in &output.basis {
            let variables = if name == "parameter" {
                parameters
            } else {
                model.bases.get(name).ok_or_else(|| {
                    EmitError::Mismatch(format!("model `{}` has no basis `{name}`", model.name))
                })?
            };
            let vector = match name.as_str() {
                "state" => "State",
                "input" => "Input",
                "noise" => "Noise",
                "parameter" => "Parameters",
                "mode" => "",
                _ => return Err(no_form(model, output)),
            };
            bases.push(Basis {
                name,
                vector,
                variables,
            });
        }
        let known = |at: &[String]| {
            at.len() == bases.len()
                && at
                    .iter()
                    .zip(&bases)
                    .all(|(name, basis)| basis.variables.iter().any(|v| v.name == *name))
        };
        if let Some(entry) = output.entries.iter().find(|entry| !known(&entry.at)) {
            return Err(EmitError::Mismatch(format!(
                "model `{}` has an entry at {:?}, which its bases do not hold",
                model.name, entry.at
            )));
        }
        if bases.len() > 1 && bases.iter().any(|basis| basis.vector.is_empty()) {
            return Err(no_form(model, output));
        }
        Ok(Self { output, bases })
    }

    /// What the type of the dense form is called, where it has a name of its own.
    pub(crate) fn alias(&self) -> Option<&'static str> {
        let names: Vec<&str> = self.bases.iter().map(|basis| basis.name).collect();
        Some(match names.as_slice() {
            ["state", "state"] => "StateJacobian",
            ["state", "input"] => "InputJacobian",
            ["state", "parameter"] => "ParameterJacobian",
            ["state", "noise"] => "Diffusion",
            ["state", "state", "state"] => "Hessian",
            ["state", "noise", "noise"] => "NoiseDerivatives",
            _ => return None,
        })
    }

    /// The type of the dense form.
    pub(crate) fn result(&self) -> String {
        match (self.alias(), self.bases.as_slice()) {
            (Some(alias), _) => format!("{alias}<R>"),
            (None, [basis]) if basis.vector.is_empty() => format!("[R; {}]", basis.variables.len()),
            (None, _) => self.nested(0),
        }
    }

    fn nested(&self, depth: usize) -> String {
        match self.bases.get(depth) {
            None => "R".to_owned(),
            Some(basis) => format!("{}<{}>", basis.vector, self.nested(depth + 1)),
        }
    }

    /// Types that the dense form is written in, besides its alias.
    pub(crate) fn vectors(&self) -> impl Iterator<Item = &'static str> {
        self.bases
            .iter()
            .map(|basis| basis.vector)
            .filter(|vector| !vector.is_empty())
    }

    /// The dense form as an expression of its entries' values, which stand in the order of the entries.
    pub(crate) fn dense(&self, values: &[String], zeros: &mut Zeros) -> String {
        if let [basis] = self.bases.as_slice()
            && basis.vector.is_empty()
        {
            let entries = basis
                .variables
                .iter()
                .map(|v| self.value(&[&v.name], values));
            let entries: Vec<String> = entries.map(|v| v.unwrap_or_else(|| literal(0.0))).collect();
            return format!("[{}]", entries.join(", "));
        }
        self.level(&[], values, zeros)
            .unwrap_or_else(|| self.zero(0, zeros))
    }

    /// The part of the dense form below some leading indices; `None` where all of it is zero.
    fn level(&self, at: &[&str], values: &[String], zeros: &mut Zeros) -> Option<String> {
        let Some(basis) = self.bases.get(at.len()) else {
            return self.value(at, values);
        };
        let is_last = at.len() + 1 == self.bases.len();
        let (mut fields, mut any_zero, mut any_value) = (Vec::new(), false, false);
        for variable in basis.variables {
            let inner = [at, &[variable.name.as_str()]].concat();
            match self.level(&inner, values, zeros) {
                Some(value) => {
                    any_value = true;
                    fields.push(field(&variable.name, value));
                }
                // A vector lists its zeros, a matrix has them from a vector of zeros.
                None if is_last && self.bases.len() == 1 => {
                    fields.push(field(&variable.name, literal(0.0)));
                }
                None => any_zero = true,
            }
        }
        if !any_value && self.bases.len() > 1 {
            return None;
        }
        if any_zero {
            fields.push(format!("..{}", self.zero(at.len(), zeros)));
        }
        Some(format!("{} {{ {} }}", basis.vector, fields.join(", ")))
    }

    /// The name of the zero of this depth, noted among the zeros that are needed.
    fn zero(&self, depth: usize, zeros: &mut Zeros) -> String {
        let Some(basis) = self.bases.get(depth) else {
            return literal(0.0);
        };
        let component = self.zero(depth + 1, zeros);
        let names: Vec<&str> = self.bases[depth..].iter().map(|basis| basis.name).collect();
        let name = format!("no_{}", names.join("_"));
        if !zeros.iter().any(|(known, ..)| *known == name) {
            zeros.push((name.clone(), basis.vector, component));
        }
        name
    }

    fn value(&self, at: &[&str], values: &[String]) -> Option<String> {
        let stands = |at: &[&str]| self.output.entries.iter().position(|entry| entry.at == at);
        let mirrored = || match at {
            [head @ .., a, b] if self.output.symmetric => stands(&[head, &[*b, *a]].concat()),
            _ => None,
        };
        stands(at)
            .or_else(mirrored)
            .map(|position| values[position].clone())
    }

    /// Number of entries of the compressed form.
    pub(crate) fn entries(&self) -> usize {
        self.output.entries.len()
    }

    /// The name of the function from the compressed to the dense form, where there is one. A literal is several times
    /// as quick as a walk along the pattern; but where every new coefficient is a new entry, it would be rewritten each time.
    pub(crate) fn scatter(&self) -> Option<String> {
        let is_small = self.bases.len() == 2 && self.bases.iter().all(|b| b.name != "parameter");
        is_small.then(|| Some(format!("dense_{}", words(self.alias()?))))?
    }

    /// The dense form as an expression of the compressed one; none for what has no compressed form.
    pub(crate) fn scattered(&self, values: &str) -> Option<String> {
        if let Some(function) = self.scatter() {
            return Some(format!("{function}(&{values})"));
        }
        let method = if self.output.symmetric {
            "symmetric"
        } else {
            "dense"
        };
        let pattern = self.pattern()?.name;
        Some(format!("{pattern}.{method}(&{values})"))
    }

    /// The pattern of the compressed form, one entry a line: its name, its indices, its shape.
    pub(crate) fn pattern(&self) -> Option<PatternText> {
        let alias = self.alias()?;
        let name = words(alias).to_uppercase();
        let entries = self.output.entries.iter().map(|entry| {
            let indices = entry.at.iter().zip(&self.bases);
            let indices = indices.map(|(name, basis)| format!("{}.{name}", basis.vector));
            format!("ahv_core::at!({})", indices.collect::<Vec<_>>().join(", "))
        });
        let shape = self
            .bases
            .iter()
            .map(|basis| format!("{}::<u8>::LEN", basis.vector));
        Some(PatternText {
            name: format!("{name}_PATTERN"),
            alias,
            dimensions: self.bases.len(),
            shape: shape.collect::<Vec<_>>().join(", "),
            entries: entries.collect(),
        })
    }
}

/// A constant that says where the entries of a compressed form stand.
pub(crate) struct PatternText {
    pub(crate) name: String,
    pub(crate) alias: &'static str,
    pub(crate) dimensions: usize,
    pub(crate) shape: String,
    pub(crate) entries: Vec<String>,
}

fn no_form(model: &ir::Model, output: &Output) -> EmitError {
    EmitError::Mismatch(format!(
        "model `{}` has an output over {:?}, which the emitter has no form for",
        model.name, output.basis
    ))
}

/// The name of a type in lower case, its words apart.
fn words(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push('_');
        }
        words.extend(letter.to_lowercase());
    }
    words
}

fn field(name: &str, value: String) -> String {
    if value == name {
        value
    } else {
        format!("{name}: {value}")
    }
}
