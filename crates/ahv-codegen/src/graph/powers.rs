//! Whole powers and reciprocals.

use super::{Dag, Id, Key, Node};
use crate::graph::passes::Pass;

impl Dag {
    /// A whole power of a node; powers of numbers, powers and products are worked out.
    pub(super) fn power(&mut self, base: Id, exponent: i32) -> Id {
        if exponent == 0 {
            return self.one;
        }
        if exponent == 1 {
            return base;
        }
        if self.names[base].is_empty() {
            match self.nodes[base].clone() {
                Node::Number(value) => return self.number(value.powi(exponent)),
                Node::Power(inner, k) => return self.power(inner, k * exponent),
                Node::Product(coefficient, factors) => {
                    let powers: Vec<Id> = factors
                        .into_iter()
                        .map(|f| self.power(f, exponent))
                        .collect();
                    return self.product(coefficient.powi(exponent), &powers);
                }
                _ => {}
            }
        }
        self.intern(Key::Power(base, exponent), Node::Power(base, exponent))
    }

    /// The nodes that a whole power other than a reciprocal is the product of: two lower powers, or as many of the
    /// base as the exponent says.
    pub(crate) fn steps_of_power(&mut self, id: Id) -> Vec<Id> {
        let Node::Power(base, exponent) = self.nodes[id] else {
            return Vec::new();
        };
        if let Some(steps) = self.steps.get(&id) {
            return steps.clone();
        }
        let steps = if self.has(Pass::SharedPowers) {
            let low = if exponent % 2 == 0 {
                exponent / 2
            } else {
                exponent - exponent.signum()
            };
            vec![self.power(base, exponent - low), self.power(base, low)]
        } else {
            let step = self.power(base, exponent.signum());
            vec![step; exponent.unsigned_abs() as usize]
        };
        self.steps.insert(id, steps.clone());
        steps
    }

    /// Whether a node is written anew wherever it is used: a power or reciprocal that is not shared.
    pub(crate) fn is_written_anew(&self, id: Id) -> bool {
        let pass = match self.nodes[id] {
            Node::Power(_, -1) => Pass::SharedReciprocals,
            Node::Power(..) => Pass::SharedPowers,
            _ => return false,
        };
        self.names[id].is_empty() && !self.has(pass)
    }
}
