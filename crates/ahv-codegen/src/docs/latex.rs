//! Expressions of the IR as LaTeX: fractions, powers, sums and products of many terms, and no parentheses to spare.

use std::cell::Cell;
use std::collections::{BTreeMap, HashMap};

use super::symbol;
use super::tree::{Tex, negated, power, product, sum};
use crate::call::Call;
use crate::ir::{Basis, Document, Expr, Model, Quantity};

/// Nodes of an expression that is written out; a longer one is not for a reader.
const LONGEST: usize = 3000;

/// Prints the expressions of one model.
pub(super) struct Printer<'a> {
    model: &'a Model,
    /// Symbols of states, inputs, Wiener increments, arguments and parameters, by name with prefix.
    leaves: HashMap<String, &'a str>,
    quantities: HashMap<&'a str, &'a Quantity>,
    variables: HashMap<&'a str, &'a str>,
}

/// How far names are resolved.
#[derive(Clone, Copy)]
pub(super) struct Style<'a> {
    /// How deep derivatives that have names in the code are written out.
    pub(super) derivatives: usize,
    /// Coefficients by leaf name (`p.c_l_alpha`) that are shown as numbers.
    pub(super) numbers: Option<&'a BTreeMap<String, f64>>,
}

impl Style<'_> {
    /// Names as they stand.
    pub(super) const NAMED: Self = Self::expanded(0);

    /// Derivatives written out to a depth.
    pub(super) const fn expanded(derivatives: usize) -> Self {
        Self {
            derivatives,
            numbers: None,
        }
    }
}

/// Whether a quantity is a derivative that the derivation named, not one of the paper's.
pub(super) fn is_derivative(quantity: &Quantity) -> bool {
    quantity.equation.is_empty()
}

/// Whether a quantity has a name rather than a formula for its symbol; a formula is written out where it is used.
pub(super) fn has_name(quantity: &Quantity) -> bool {
    !symbol::shape(&quantity.symbol).is_formula()
}

impl<'a> Printer<'a> {
    pub(super) fn new(model: &'a Model, document: &'a Document) -> Self {
        let mut leaves = HashMap::new();
        let mut variables = HashMap::new();
        for (basis, members) in &model.bases {
            let prefix = match basis {
                Basis::State => "x",
                Basis::Input => "u",
                Basis::Noise => "w",
                Basis::Parameter => "p",
                Basis::Argument | Basis::Boundary | Basis::Mode | Basis::Output => "t",
            };
            for variable in members {
                leaves.insert(
                    format!("{prefix}.{}", variable.name),
                    variable.symbol.as_str(),
                );
                variables.insert(variable.name.as_str(), variable.symbol.as_str());
            }
        }
        for parameter in &document.parameters {
            leaves.insert(format!("p.{}", parameter.name), parameter.symbol.as_str());
        }
        let quantities = model
            .quantities
            .iter()
            .map(|q| (q.name.as_str(), q))
            .collect();
        Self {
            model,
            leaves,
            quantities,
            variables,
        }
    }

    /// The model that is printed.
    pub(super) fn model(&self) -> &'a Model {
        self.model
    }

    /// The symbol of a state, input, Wiener process or mode by its name.
    pub(super) fn variable(&self, name: &str) -> String {
        let symbol = self.variables.get(name).copied().filter(|s| !s.is_empty());
        symbol.map_or_else(|| upright(name), str::to_owned)
    }

    /// The quantity of a name.
    pub(super) fn quantity(&self, name: &str) -> Option<&'a Quantity> {
        self.quantities.get(name).copied()
    }

    /// An expression, unless it is too long for a reader.
    pub(super) fn expression(&self, expr: &Expr, style: Style<'_>) -> Option<Tex> {
        self.expression_within(LONGEST, expr, style)
    }

    /// An expression of no more nodes than given.
    pub(super) fn expression_within(
        &self,
        nodes: usize,
        expr: &Expr,
        style: Style<'_>,
    ) -> Option<Tex> {
        self.tex(expr, style, &Cell::new(nodes.min(LONGEST)))
    }

    fn tex(&self, expr: &Expr, style: Style<'_>, left: &Cell<usize>) -> Option<Tex> {
        left.set(left.get().checked_sub(1)?);
        match expr {
            Expr::Number(value) => Some(Tex::Number(*value)),
            Expr::Name(name) => self.name(name, style, left),
            Expr::Apply(parts) => {
                let (Some(Expr::Name(operator)), arguments) = (parts.first(), parts.get(1..)?)
                else {
                    return None;
                };
                self.apply(operator, arguments, style, left)
            }
        }
    }

    fn name(&self, name: &str, style: Style<'_>, left: &Cell<usize>) -> Option<Tex> {
        if let Some(&value) = style.numbers.and_then(|numbers| numbers.get(name)) {
            return Some(Tex::Value(value));
        }
        if let Some((_, bare)) = name.split_once('.') {
            let symbol = self.leaves.get(name).copied().filter(|s| !s.is_empty());
            return Some(Tex::Symbol(
                symbol.map_or_else(|| upright(bare), str::to_owned),
            ));
        }
        let quantity = self.quantity(name)?;
        let derivative = is_derivative(quantity);
        if derivative && style.derivatives > 0 {
            let derivatives = style.derivatives - 1;
            return self.tex(
                &quantity.expr,
                Style {
                    derivatives,
                    ..style
                },
                left,
            );
        }
        // A root says what it is.
        let spelt = quantity.symbol.starts_with("\\sqrt");
        if !derivative && !spelt && !has_name(quantity) {
            return self.tex(&quantity.expr, style, left);
        }
        Some(Tex::Symbol(self.symbol(quantity)))
    }

    /// The symbol of a quantity; what a derivative is of stands in parentheses where it is a formula.
    pub(super) fn symbol(&self, quantity: &Quantity) -> String {
        let latex = &quantity.symbol;
        let parts = latex.strip_prefix("\\frac{\\partial").and_then(|rest| {
            let (above, below) = rest.split_once("}{\\partial")?;
            Some((above, below.strip_suffix('}')?))
        });
        let Some((above, below)) = parts else {
            return latex.clone();
        };
        let (order, of) = match above.strip_prefix("^2") {
            Some(of) => ("^2", of.trim()),
            None => ("", above.trim()),
        };
        let of = if symbol::shape(of).is_formula() {
            format!("\\left( {of} \\right)")
        } else {
            of.to_owned()
        };
        let below = below.trim();
        let below = match below.split_once("\\,\\partial") {
            Some((first, second)) if first.trim() == second.trim() => format!("{}^2", first.trim()),
            _ => below.to_owned(),
        };
        format!("\\frac{{\\partial{order} {of}}}{{\\partial {below}}}")
    }

    fn apply(
        &self,
        operator: &str,
        arguments: &[Expr],
        style: Style<'_>,
        left: &Cell<usize>,
    ) -> Option<Tex> {
        if let ("pow", [base, Expr::Number(exponent)]) = (operator, arguments) {
            return Some(power(self.tex(base, style, left)?, *exponent as i32));
        }
        let parts: Option<Vec<Tex>> = arguments.iter().map(|a| self.tex(a, style, left)).collect();
        let mut parts = parts?;
        Some(match (operator, parts.len()) {
            ("+", _) => sum(parts),
            ("*", _) => product(parts),
            ("-", 2) => {
                let last = negated(parts.pop()?);
                parts.push(last);
                sum(parts)
            }
            ("/", 2) => {
                let below = power(parts.pop()?, -1);
                parts.push(below);
                product(parts)
            }
            ("neg", 1) => negated(parts.pop()?),
            (name, count) => Tex::Call(Call::of(name, count)?, parts),
        })
    }
}

/// A name without a symbol, as upright text.
fn upright(name: &str) -> String {
    format!("\\mathrm{{{}}}", name.replace('_', "\\_"))
}
