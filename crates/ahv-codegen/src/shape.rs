//! The shape of what a function returns: a number, a vector, a matrix, or an array of three indices.

use crate::EmitError;
use crate::ir::{self, Basis, Output};

/// A basis of an output, with the type of its vectors; modes have none.
pub(crate) struct Axis<'a> {
    pub(crate) basis: Basis,
    pub(crate) vector: &'static str,
    /// Names of its components.
    pub(crate) names: Vec<&'a str>,
}

/// An output over its bases; none for a number.
pub(crate) struct Shape<'a> {
    pub(crate) output: &'a Output,
    pub(crate) axes: Vec<Axis<'a>>,
}

impl<'a> Shape<'a> {
    /// The shape of an output; its entries are held against its bases.
    pub(crate) fn of(
        model: &'a ir::Model,
        document: &'a ir::Document,
        output: &'a Output,
    ) -> Result<Self, EmitError> {
        let mut axes = Vec::new();
        for &basis in &output.basis {
            let names = if basis == Basis::Parameter {
                document.parameters.iter().map(|it| &*it.name).collect()
            } else {
                let variables = model.bases.get(&basis).ok_or_else(|| {
                    EmitError::Mismatch(format!("model `{}` has no basis `{basis}`", model.name))
                })?;
                variables.iter().map(|it| &*it.name).collect()
            };
            let vector = match basis {
                Basis::State => "State",
                Basis::Input => "Input",
                Basis::Noise => "Noise",
                Basis::Output => "Outputs",
                Basis::Boundary => "Boundaries",
                Basis::Parameter => "Parameters",
                Basis::Mode => "",
                Basis::Argument => return Err(no_form(model, output)),
            };
            axes.push(Axis {
                basis,
                vector,
                names,
            });
        }
        let known = |at: &[String]| {
            at.len() == axes.len()
                && at
                    .iter()
                    .zip(&axes)
                    .all(|(name, axis)| axis.names.contains(&&**name))
        };
        if let Some(entry) = output.entries.iter().find(|entry| !known(&entry.at)) {
            return Err(EmitError::Mismatch(format!(
                "model `{}` has an entry at {:?}, which its bases do not hold",
                model.name, entry.at
            )));
        }
        if axes.len() > 1 && axes.iter().any(|axis| axis.vector.is_empty()) {
            return Err(no_form(model, output));
        }
        Ok(Self { output, axes })
    }

    /// What the type of the dense form is called, where it has a name of its own.
    pub(crate) fn alias(&self) -> Option<&'static str> {
        let bases: Vec<Basis> = self.axes.iter().map(|axis| axis.basis).collect();
        Self::name_of(&bases)
    }

    /// The name of an array over these bases, where it has one of its own.
    pub(crate) fn name_of(bases: &[Basis]) -> Option<&'static str> {
        Some(match bases {
            [Basis::State, Basis::State] => "StateJacobian",
            [Basis::State, Basis::Input] => "InputJacobian",
            [Basis::State, Basis::Parameter] => "ParameterJacobian",
            [Basis::State, Basis::Noise] => "Diffusion",
            [Basis::State, Basis::State, Basis::State] => "Hessian",
            [Basis::State, Basis::Noise, Basis::Noise] => "NoiseDerivatives",
            _ => return None,
        })
    }

    /// Whether it is a number for each mode.
    pub(crate) fn is_list(&self) -> bool {
        matches!(self.axes.as_slice(), [axis] if axis.vector.is_empty())
    }

    /// The position of the entry that stands at some indices, or mirrored there; `None` for a structural zero.
    pub(crate) fn entry(&self, at: &[&str]) -> Option<usize> {
        let stands = |at: &[&str]| self.output.entries.iter().position(|entry| entry.at == at);
        let mirrored = || match at {
            [head @ .., a, b] if self.output.symmetric => stands(&[head, &[*b, *a]].concat()),
            _ => None,
        };
        stands(at).or_else(mirrored)
    }
}

fn no_form(model: &ir::Model, output: &Output) -> EmitError {
    EmitError::Mismatch(format!(
        "model `{}` has an output over {:?}, which the emitter has no form for",
        model.name, output.basis
    ))
}

/// The name of a type in lower case, its words apart.
pub(crate) fn words(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push('_');
        }
        words.extend(letter.to_lowercase());
    }
    words
}
