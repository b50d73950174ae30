//! Statements and expressions between graph and text: what the printer of each language prints as it stands.

use std::collections::BTreeSet;

use crate::call::Call;
use crate::graph::Kind;

/// An expression. Sums and products are evaluated from left to right, so that every language has the same bits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expr {
    Number(f64),
    /// A component of an argument: of the state, of the input, of what is prepared or computed once.
    Component(Source, String),
    /// A value that a statement before names.
    Name(String),
    Negative(Box<Expr>),
    /// Addends, each added or subtracted.
    Sum(Vec<(Sign, Expr)>),
    /// Factors, each multiplied by or divided by; the first is no divisor.
    Product(Vec<(Operation, Expr)>),
    Reciprocal(Box<Expr>),
    Call(Call, Vec<Expr>),
}

/// Where a component stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// In an argument of the model's functions; prepared values stand for the parameters.
    Argument(Kind),
    /// In what is computed once for several functions.
    Stage(&'static StageKind),
    /// In the function's own result; the component is the whole path.
    Result,
}

/// What a stage is called, and whose values it holds.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct StageKind {
    /// The function whose values they are.
    pub(super) of: &'static str,
    /// The function that computes them.
    pub(crate) function: &'static str,
    /// The struct.
    pub(crate) type_name: &'static str,
    /// The struct as an argument.
    pub(crate) argument: &'static str,
    pub(crate) doc: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sign {
    Plus,
    Minus,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operation {
    Times,
    Over,
}

/// How strongly an expression holds together: what is weaker than its place asks for stands in parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Binding {
    Sum,
    Product,
    Atom,
}

/// A statement of a function body.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Statement {
    /// A heading.
    Section(String),
    /// A value gets a name; with a unit where there is one to tell.
    Let {
        name: String,
        value: Expr,
        unit: String,
    },
    /// A field of a struct gets its value.
    Set {
        source: Source,
        field: String,
        value: Expr,
        unit: String,
    },
    /// Sine and cosine of one angle get their names, or are set.
    SinCos { sin: Expr, cos: Expr, angle: Expr },
}

/// What a function does: its statements, then its results in the order of its entries.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Body {
    pub(crate) statements: Vec<Statement>,
    pub(crate) results: Vec<Expr>,
    /// Names that only say whose part a value is, each with the reason.
    pub(crate) numbered: Vec<(String, String)>,
}

impl Expr {
    pub(crate) fn binding(&self) -> Binding {
        match self {
            Self::Sum(_) => Binding::Sum,
            Self::Product(_) | Self::Negative(_) => Binding::Product,
            _ => Binding::Atom,
        }
    }

    /// Calls `see` with this expression and all of its parts.
    pub(crate) fn walk<'a>(&'a self, see: &mut impl FnMut(&'a Self)) {
        see(self);
        match self {
            Self::Number(_) | Self::Component(..) | Self::Name(_) => {}
            Self::Negative(part) | Self::Reciprocal(part) => part.walk(see),
            Self::Call(_, arguments) => arguments.iter().for_each(|part| part.walk(see)),
            Self::Sum(addends) => addends.iter().for_each(|(_, part)| part.walk(see)),
            Self::Product(factors) => factors.iter().for_each(|(_, part)| part.walk(see)),
        }
    }
}

impl Statement {
    /// The value that is computed; none for a heading.
    fn value(&self) -> Option<&Expr> {
        match self {
            Self::Section(_) => None,
            Self::Let { value, .. } | Self::Set { value, .. } => Some(value),
            Self::SinCos { angle, .. } => Some(angle),
        }
    }
}

impl Body {
    /// The same without its heading where it has one alone: the description of the function says as much.
    pub(super) fn untitled(mut self) -> Self {
        let is_heading = |it: &Statement| matches!(it, Statement::Section(_));
        if self.statements.iter().filter(|it| is_heading(it)).count() == 1 {
            self.statements.retain(|it| !is_heading(it));
        }
        self
    }

    /// Calls `see` with every expression and its parts.
    pub(crate) fn walk<'a>(&'a self, see: &mut impl FnMut(&'a Expr)) {
        let values = self.statements.iter().filter_map(Statement::value);
        values.chain(&self.results).for_each(|it| it.walk(see));
    }

    /// Whether the function refers to a component that stands there.
    pub(crate) fn uses(&self, source: Source) -> bool {
        let mut found = false;
        self.walk(&mut |expr| found |= matches!(expr, Expr::Component(it, _) if *it == source));
        found
    }

    /// Arguments that are scalars of their own, such as a time.
    pub(crate) fn scalars(&self) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        self.walk(&mut |expr| {
            if let Expr::Component(Source::Argument(Kind::Argument), name) = expr {
                found.insert(name.clone());
            }
        });
        found
    }

    /// A function that ends in `let y = …; y` ends in the expression itself.
    pub(crate) fn return_last(&mut self) {
        if let (Some(Statement::Let { name, value, .. }), [result]) =
            (self.statements.last(), self.results.as_mut_slice())
            && matches!(result, Expr::Name(it) if it == name)
        {
            result.clone_from(value);
            self.statements.pop();
        }
    }
}
