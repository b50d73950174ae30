//! What a table of coefficients says beside its numbers: which entries it has, in which units, and what they must obey.

use crate::{Bounds, Provenance, Vector};

/// A table, as the models that it makes were generated from it. What holds for it holds for every table that takes its
/// place at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// Its name.
    pub name: &'static str,
    /// The models that it lists, in order.
    pub models: &'static [&'static str],
    /// Its unit system: `ft-slug-s-rad` or `si`.
    pub unit_system: &'static str,
    /// Its entries, one for each parameter, in their order.
    pub entries: &'static [Entry],
    /// What can be chosen by name.
    pub choices: &'static [Choice],
    /// What `[parts]` and `[joined]` say: section, name, key, and the text that stands there, of a list its texts with
    /// `, ` between.
    pub joins: &'static [[&'static str; 4]],
    /// The entries of its validity box.
    pub validity: &'static [Interval],
    /// What the monomials of its polynomials may be.
    pub fits: &'static [Fit],
    /// What its numbers must obey.
    pub rules: &'static [Rule],
}

impl Table {
    /// Whether a table that lists `models` has what is for the models `only`: one of them, or any where `only` is empty.
    pub fn has(only: &[&str], models: &[&str]) -> bool {
        only.is_empty() || only.iter().any(|model| models.contains(model))
    }
}

/// Where a parameter stands in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Section.
    pub section: &'static str,
    /// Key: a name, or a monomial. For a switch the choice that sets it.
    pub key: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// What kind of entry it is.
    pub kind: EntryKind,
    /// The models whose tables have it; empty if all have it.
    pub models: &'static [&'static str],
}

/// A kind of [`Entry`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryKind {
    /// A parameter, which a table must list.
    Parameter,
    /// A coefficient of a polynomial; one that a table does not list is 0.
    Coefficient,
    /// A coefficient that a table must list.
    RequiredCoefficient,
    /// A parameter that a choice sets.
    Switch,
}

impl Entry {
    /// A parameter of a section.
    pub const fn parameter(section: &'static str, key: &'static str, doc: &'static str) -> Self {
        Self::new(EntryKind::Parameter, section, key, doc)
    }

    /// The coefficient of the monomial `key` in the polynomial `section`.
    pub const fn coefficient(section: &'static str, key: &'static str, doc: &'static str) -> Self {
        Self::new(EntryKind::Coefficient, section, key, doc)
    }

    /// A coefficient that a table must list.
    pub const fn required(section: &'static str, key: &'static str, doc: &'static str) -> Self {
        Self::new(EntryKind::RequiredCoefficient, section, key, doc)
    }

    /// A parameter that the choice `choice` sets.
    pub const fn switch(choice: &'static str, doc: &'static str) -> Self {
        Self::new(EntryKind::Switch, "choices", choice, doc)
    }

    /// The entry, in tables of these models alone.
    #[must_use]
    pub const fn only_for(self, models: &'static [&'static str]) -> Self {
        Self { models, ..self }
    }

    const fn new(
        kind: EntryKind,
        section: &'static str,
        key: &'static str,
        doc: &'static str,
    ) -> Self {
        Self {
            section,
            key,
            doc,
            kind,
            models: &[],
        }
    }
}

/// Something that is chosen by name, and sets parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Its key in `[choices]`, and its flag on command lines.
    pub name: &'static str,
    /// What is chosen.
    pub doc: &'static str,
    /// What there is to choose from.
    pub options: &'static [ChoiceOption],
}

impl Choice {
    /// From its fields.
    pub const fn new(
        name: &'static str,
        doc: &'static str,
        options: &'static [ChoiceOption],
    ) -> Self {
        Self { name, doc, options }
    }

    /// The option of this name.
    pub fn option(&self, name: &str) -> Option<&'static ChoiceOption> {
        self.options.iter().find(|option| option.name == name)
    }
}

/// One way to choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChoiceOption {
    /// Its name.
    pub name: &'static str,
    /// What it means.
    pub doc: &'static str,
    /// The parameters that it sets, by name, with their values.
    pub values: &'static [(&'static str, f64)],
}

impl ChoiceOption {
    /// From its fields.
    pub const fn new(
        name: &'static str,
        doc: &'static str,
        values: &'static [(&'static str, f64)],
    ) -> Self {
        Self { name, doc, values }
    }

    /// The parameters with this option.
    pub fn apply<P: Vector<f64>>(&self, mut parameters: P) -> P {
        for (name, value) in self.values {
            if let Some(index) = P::index_of(name) {
                // An index of a name is in range.
                let _ = parameters.set(index, *value);
            }
        }
        parameters
    }

    /// Makes those of `parameters`, in the order of their `names`, the ones with this option.
    pub fn apply_to(&self, names: &[&str], parameters: &mut [f64]) {
        for (name, value) in self.values {
            let mut pairs = names.iter().zip(&mut *parameters);
            if let Some((_, parameter)) = pairs.find(|(own, _)| *own == name) {
                *parameter = *value;
            }
        }
    }
}

/// An entry of the validity box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Its key in `[validity]`.
    pub name: &'static str,
    /// Unit, angles in rad.
    pub unit: &'static str,
    /// The interval of the table that the models were generated from, in that unit.
    pub bounds: Bounds,
    /// The states and inputs of the table's models that it bounds.
    pub variables: &'static [&'static str],
    /// The models whose tables have it; empty if all have it.
    pub models: &'static [&'static str],
}

impl Interval {
    /// From its fields.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        bounds: Bounds,
        variables: &'static [&'static str],
    ) -> Self {
        Self {
            name,
            unit,
            bounds,
            variables,
            models: &[],
        }
    }

    /// The interval, in tables of these models alone.
    #[must_use]
    pub const fn only_for(self, models: &'static [&'static str]) -> Self {
        Self { models, ..self }
    }
}

/// A curve-fitted quantity: a section of the table whose keys are monomials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Its section.
    pub section: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// The variables that its monomials may have.
    pub variables: &'static [FitVariable],
    /// Those in which it is of degree one at most, together.
    pub affine: &'static [&'static str],
    /// The models whose tables have it; empty if all have it.
    pub models: &'static [&'static str],
}

impl Fit {
    /// From its fields.
    pub const fn new(
        section: &'static str,
        unit: &'static str,
        doc: &'static str,
        variables: &'static [FitVariable],
        affine: &'static [&'static str],
    ) -> Self {
        Self {
            section,
            unit,
            doc,
            variables,
            affine,
            models: &[],
        }
    }

    /// The quantity, in tables of these models alone.
    #[must_use]
    pub const fn only_for(self, models: &'static [&'static str]) -> Self {
        Self { models, ..self }
    }
}

/// A variable of the monomials of a [`Fit`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FitVariable {
    /// Its name.
    pub name: &'static str,
    /// Its unit, angles in rad.
    pub unit: &'static str,
    /// The entry of the validity box that bounds it; none bounds a derived variable.
    pub interval: Option<&'static str>,
}

impl FitVariable {
    /// A variable that an entry of the validity box bounds.
    pub const fn new(name: &'static str, unit: &'static str, interval: &'static str) -> Self {
        Self {
            name,
            unit,
            interval: Some(interval),
        }
    }

    /// A derived variable, such as the Mach number, which nothing bounds.
    pub const fn unbounded(name: &'static str, unit: &'static str) -> Self {
        Self {
            name,
            unit,
            interval: None,
        }
    }
}

/// What the numbers of a table must obey: a polynomial of parameters that has a sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// What kind of rule it is, e.g. `positive`.
    pub name: &'static str,
    /// The rule as a sentence.
    pub reason: &'static str,
    /// Which sign the polynomial must have.
    pub must: Sign,
    /// Terms of the polynomial. A fault is one of the first parameter of the first term.
    pub terms: &'static [Term],
}

impl Rule {
    /// From its fields.
    pub const fn new(
        name: &'static str,
        reason: &'static str,
        must: Sign,
        terms: &'static [Term],
    ) -> Self {
        Self {
            name,
            reason,
            must,
            terms,
        }
    }

    /// Whether these parameters obey it. A value that is not a number obeys nothing.
    pub fn holds<P: Vector<f64>>(&self, parameters: &P) -> bool {
        self.holds_for(|name| {
            let value = P::index_of(name).and_then(|index| parameters.get(index));
            value.unwrap_or(f64::NAN)
        })
    }

    /// Whether parameters obey it whose values by name are `value`.
    pub fn holds_for(&self, value: impl Fn(&str) -> f64) -> bool {
        let value: f64 = self.terms.iter().map(|term| term.value(&value)).sum();
        match self.must {
            Sign::Positive => value > 0.0,
            Sign::NotNegative => value >= 0.0,
            Sign::NotZero => value.abs() > 0.0,
        }
    }
}

/// A sign that a number must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Above 0.
    Positive,
    /// 0 or above.
    NotNegative,
    /// Anything but 0.
    NotZero,
}

/// A factor times parameters; a power repeats its parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// The factor.
    pub factor: f64,
    /// Names of the parameters.
    pub parameters: &'static [&'static str],
}

impl Term {
    /// From its fields.
    pub const fn new(factor: f64, parameters: &'static [&'static str]) -> Self {
        Self { factor, parameters }
    }

    fn value(&self, value: &impl Fn(&str) -> f64) -> f64 {
        let values = self.parameters.iter().map(|name| value(name));
        values.fold(self.factor, |product, value| product * value)
    }
}

/// A set of parameters with a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSet<P, Q> {
    /// Its name.
    pub name: &'static str,
    /// The parameters.
    pub parameters: P,
    /// Where each comes from: a vector of [`Provenance`].
    pub provenance: Q,
}

impl<P, Q> ParameterSet<P, Q> {
    /// From its fields.
    pub const fn new(name: &'static str, parameters: P, provenance: Q) -> Self {
        Self {
            name,
            parameters,
            provenance,
        }
    }
}

impl<P, Q: Vector<Provenance>> ParameterSet<P, Q> {
    /// Relative uncertainties of the parameters.
    pub fn uncertainty(&self) -> P
    where
        P: Vector<f64>,
    {
        P::from_fn(|index| {
            let entry = self.provenance.get(index);
            entry.map_or(0.0, |entry| entry.uncertainty)
        })
    }
}
