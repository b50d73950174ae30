//! The rules by which expressions become statements: each has a name, and can be left out to see what it does.

use std::collections::BTreeSet;
use std::str::FromStr;

/// A rule of rewriting. Without it the emitted code computes the same values, with more operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pass {
    /// Equal expressions are one value.
    HashConsing,
    /// What depends on parameters alone is computed in `prepare`.
    Hoisting,
    /// Addends that depend on parameters alone meet, and a factor that addends share is taken out.
    RegroupingSums,
    /// Factors that depend on parameters alone meet.
    RegroupingProducts,
    /// A product that contains a named quantity refers to it.
    NamedProducts,
    /// Divisions by one value share its reciprocal.
    SharedReciprocals,
    /// Powers of one value are computed from each other.
    SharedPowers,
    /// Sine and cosine of one angle are computed together.
    SinCos,
    /// A polynomial with four or more powers of one variable is summed by Estrin's scheme.
    Estrin,
}

impl Pass {
    /// All passes, in the order in which they act.
    pub const ALL: [Self; 9] = [
        Self::HashConsing,
        Self::Hoisting,
        Self::RegroupingSums,
        Self::RegroupingProducts,
        Self::NamedProducts,
        Self::SharedReciprocals,
        Self::SharedPowers,
        Self::SinCos,
        Self::Estrin,
    ];

    /// The name on the command line and in the documentation.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::HashConsing => "hash-consing",
            Self::Hoisting => "hoisting",
            Self::RegroupingSums => "regrouping-sums",
            Self::RegroupingProducts => "regrouping-products",
            Self::NamedProducts => "named-products",
            Self::SharedReciprocals => "shared-reciprocals",
            Self::SharedPowers => "shared-powers",
            Self::SinCos => "sin-cos",
            Self::Estrin => "estrin",
        }
    }

    /// Whether it acts when expressions are read into the graph, rather than when code is written from it.
    pub(crate) const fn builds_graph(self) -> bool {
        match self {
            Self::HashConsing
            | Self::RegroupingSums
            | Self::RegroupingProducts
            | Self::NamedProducts
            | Self::Estrin => true,
            Self::Hoisting | Self::SharedReciprocals | Self::SharedPowers | Self::SinCos => false,
        }
    }

    /// What it does, in a sentence.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::HashConsing => "Equal expressions are one value.",
            Self::Hoisting => "What depends on parameters alone is computed in `prepare`.",
            Self::RegroupingSums => {
                "Addends that depend on parameters alone meet; a factor that addends share is taken out, unless it is \
                 a state or input."
            }
            Self::RegroupingProducts => "Factors that depend on parameters alone meet.",
            Self::NamedProducts => "A product that contains a named quantity refers to it.",
            Self::SharedReciprocals => "Divisions by one value share its reciprocal.",
            Self::SharedPowers => "Powers of one value are computed from each other.",
            Self::SinCos => "Sine and cosine of one angle are computed together.",
            Self::Estrin => {
                "A polynomial with four or more powers of one variable is summed by Estrin's scheme."
            }
        }
    }
}

/// A name that no pass has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no pass `{0}`; there are {names}", names = Pass::ALL.map(Pass::name).join(", "))]
pub struct UnknownPass(String);

impl FromStr for Pass {
    type Err = UnknownPass;

    fn from_str(name: &str) -> Result<Self, UnknownPass> {
        let found = Self::ALL.into_iter().find(|pass| pass.name() == name);
        found.ok_or_else(|| UnknownPass(name.to_owned()))
    }
}

/// The passes that are taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Passes(BTreeSet<Pass>);

impl Default for Passes {
    /// All of them.
    fn default() -> Self {
        Self(BTreeSet::from(Pass::ALL))
    }
}

impl Passes {
    /// None of them.
    #[must_use]
    pub const fn none() -> Self {
        Self(BTreeSet::new())
    }

    /// All of them but those named.
    #[must_use]
    pub fn without(left_out: &[Pass]) -> Self {
        let taken = Pass::ALL
            .into_iter()
            .filter(|pass| !left_out.contains(pass));
        Self(taken.collect())
    }

    /// Whether a pass is taken.
    #[must_use]
    pub fn has(&self, pass: Pass) -> bool {
        self.0.contains(&pass)
    }

    /// The passes that are not taken, in the order in which they act.
    pub fn left_out(&self) -> impl Iterator<Item = Pass> {
        Pass::ALL.into_iter().filter(|&pass| !self.has(pass))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pass_is_found_by_its_name() {
        for pass in Pass::ALL {
            assert_eq!(pass.name().parse(), Ok(pass));
        }
    }

    #[test]
    fn an_unknown_name_is_answered_with_those_there_are() {
        let message = "horner".parse::<Pass>().unwrap_err().to_string();
        assert!(message.starts_with("there is no pass `horner`; there are hash-consing, hoisting"));
        assert!(message.ends_with("estrin"), "{message}");
    }

    #[test]
    fn a_pass_that_is_left_out_is_not_taken() {
        let passes = Passes::without(&[Pass::Estrin, Pass::SinCos]);
        assert!(passes.has(Pass::Hoisting) && !passes.has(Pass::Estrin));
        assert_eq!(
            passes.left_out().collect::<Vec<_>>(),
            [Pass::SinCos, Pass::Estrin]
        );
        assert_eq!(Passes::without(&Pass::ALL), Passes::none());
    }
}
