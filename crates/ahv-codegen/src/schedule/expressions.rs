//! Expressions of nodes: how a value is computed, in the names that its scope has.

use super::scope::Scope;
use super::tree::{Expr, Operation, Sign, Source};
use crate::graph::{Id, Node};

impl Scope<'_> {
    /// The expression that stands for a node: its name where it has one.
    pub(super) fn reference(&mut self, id: Id) -> Expr {
        self.known(id).unwrap_or_else(|| self.written(id))
    }

    /// The definition of a node, whether or not it has a name.
    pub(super) fn definition(&mut self, id: Id) -> Expr {
        match self.dag.node(id).clone() {
            // A quantity that an equation defines is read as a table of coefficients is.
            Node::Sum(terms) => self.sum(terms, self.is_defined(id)),
            _ => self.written(id),
        }
    }

    fn written(&mut self, id: Id) -> Expr {
        match self.dag.node(id).clone() {
            Node::Number(value) => Expr::Number(value),
            Node::Leaf(kind, name) => Expr::Component(Source::Argument(kind), name),
            Node::Sum(terms) => self.sum(terms, false),
            Node::Product(coefficient, factors) => self.product(coefficient, &factors),
            Node::Power(base, -1) => Expr::Reciprocal(Box::new(self.reference(base))),
            Node::Power(..) => {
                let steps = self.dag.steps_of_power(id).into_iter();
                let steps = steps.map(|step| (Operation::Times, self.reference(step)));
                Expr::Product(steps.collect())
            }
            Node::Call(call, arguments) => {
                let arguments = arguments.into_iter();
                Expr::Call(call, arguments.map(|it| self.reference(it)).collect())
            }
        }
    }

    fn sum(&mut self, mut terms: Vec<(f64, Id)>, constant_first: bool) -> Expr {
        // A sum reads best from a positive addend, a polynomial from its constant: a new monomial is then a line of its
        // own wherever it stands. Addition in another order is the same work.
        let positive = |&(coefficient, _): &(f64, Id)| coefficient > 0.0;
        let constant = terms
            .iter()
            .position(|term| constant_first && positive(term) && self.dag.is_parametric(term.1));
        if let Some(first) = constant.or_else(|| terms.iter().position(positive)) {
            let lead = terms.remove(first);
            terms.insert(0, lead);
        }
        let addends = terms.into_iter().map(|(coefficient, id)| {
            let sign = if coefficient < 0.0 {
                Sign::Minus
            } else {
                Sign::Plus
            };
            let size = coefficient.abs();
            let addend = if self.dag.is_one(id) {
                Expr::Number(size)
            } else if size == 1.0 {
                self.reference(id)
            } else {
                let mut factors = vec![(Operation::Times, Expr::Number(size))];
                self.push_factor(id, &mut factors);
                Expr::Product(factors)
            };
            (sign, addend)
        });
        Expr::Sum(addends.collect())
    }

    fn product(&mut self, coefficient: f64, factors: &[Id]) -> Expr {
        // A reciprocal that is not shared is a division where it stands, unless there is nothing else to divide.
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for &id in factors {
            let is_open = self.known(id).is_none() && self.dag.is_written_anew(id);
            match *self.dag.node(id) {
                Node::Power(base, -1) if is_open => below.push((id, base)),
                _ => above.push(id),
            }
        }
        if above.is_empty() && coefficient.abs() == 1.0 {
            above.push(below.remove(0).0);
        }
        let mut parts = Vec::new();
        if coefficient.abs() != 1.0 {
            parts.push((Operation::Times, Expr::Number(coefficient)));
        }
        for id in above {
            self.push_factor(id, &mut parts);
        }
        if coefficient == -1.0 {
            let first = std::mem::replace(&mut parts[0].1, Expr::Number(0.0));
            parts[0].1 = Expr::Negative(Box::new(first));
        }
        for (_, base) in below {
            parts.push((Operation::Over, self.reference(base)));
        }
        match parts.as_slice() {
            [_] => parts.remove(0).1,
            _ => Expr::Product(parts),
        }
    }

    /// A factor; the factors of a nameless product stand among the others.
    fn push_factor(&mut self, id: Id, factors: &mut Vec<(Operation, Expr)>) {
        match self.reference(id) {
            Expr::Product(inner) => factors.extend(inner),
            other => factors.push((Operation::Times, other)),
        }
    }

    /// The name of a node, where it has one in this scope.
    fn known(&self, id: Id) -> Option<Expr> {
        if let Some(bound) = self.bound.get(&id) {
            return Some(bound.clone());
        }
        let (source, field) = self.given.find(id)?;
        Some(Expr::Component(source, field.to_owned()))
    }

    /// Whether a node is a quantity that an equation defines; derivatives have none.
    fn is_defined(&self, id: Id) -> bool {
        let quantity = self.names().quantity(id);
        quantity.is_some_and(|position| !self.model.quantities[position].equation.is_empty())
    }
}
