//! What depends on parameters alone meets inside sums and products, and common factors leave sums.

use super::{Dag, Factor, Id, Kind, Node, Term};
use crate::graph::passes::Pass;

impl Dag {
    /// A product whose factors that depend on parameters alone are one; none where it has only one kind of factors.
    pub(super) fn join_parameter_factors(
        &mut self,
        coefficient: f64,
        factors: &[Factor],
    ) -> Option<Id> {
        let (fixed, free): (Vec<Factor>, Vec<Factor>) =
            factors.iter().partition(|(id, _)| self.parametric[*id]);
        if free.is_empty() || fixed.is_empty() || !self.has(Pass::RegroupingProducts) {
            return None;
        }
        // A sign costs nothing where it stands; any other number joins the parameters.
        let (sign, rest) = if coefficient.abs() == 1.0 {
            (coefficient, 1.0)
        } else {
            (1.0, coefficient)
        };
        let constant = self.flat_product(rest, &fixed);
        let first = factors.iter().position(|f| fixed.contains(f)).unwrap_or(0);
        let mut ids = Vec::with_capacity(free.len() + 1);
        for &(base, exponent) in &free {
            ids.push(self.power(base, exponent));
        }
        ids.insert(first.min(ids.len()), constant);
        Some(self.intern_product(sign, ids))
    }

    /// A sum whose addends that depend on parameters alone are one; none where there is nothing to join.
    pub(super) fn join_parameter_addends(&mut self, terms: &[Term]) -> Option<Id> {
        let (fixed, mut joined): (Vec<Term>, Vec<Term>) =
            terms.iter().partition(|(_, id)| self.parametric[*id]);
        if fixed.len() < 2 || joined.is_empty() || !self.has(Pass::RegroupingSums) {
            return None;
        }
        joined.push((1.0, self.flat_sum(fixed)));
        Some(self.flat_sum(joined))
    }

    /// Takes the factor that most addends share out of a sum. States and inputs stay: a polynomial is
    /// read, and its powers shared, as it stands in the table.
    pub(super) fn take_common_factor(&mut self, terms: &[Term]) -> Option<Id> {
        if !self.has(Pass::RegroupingSums) {
            return None;
        }
        let mut parts: Vec<Vec<Factor>> = Vec::new();
        for &(_, id) in terms {
            let mut factors = Vec::new();
            self.factors_of(id, 1, &mut factors);
            parts.push(factors);
        }
        let shared = |factor: &Factor| parts.iter().filter(|p| p.contains(factor)).count();
        let plain = |&(id, exponent): &Factor| {
            exponent > 0
                && matches!(
                    self.nodes[id],
                    Node::Leaf(Kind::State | Kind::Input | Kind::Noise, _)
                )
        };
        let mut best: Option<(Factor, usize)> = None;
        for factor in parts
            .iter()
            .flatten()
            .filter(|f| !plain(f) && f.0 != self.one)
        {
            let count = shared(factor);
            if count > 1 && best.is_none_or(|(_, most)| count > most) {
                best = Some((*factor, count));
            }
        }
        let (factor, _) = best?;
        let (mut inside, mut outside) = (Vec::new(), Vec::new());
        for (&(coefficient, id), factors) in terms.iter().zip(&parts) {
            if factors.contains(&factor) {
                let inverse = self.power(factor.0, -factor.1);
                inside.push((coefficient, self.product(1.0, &[id, inverse])));
            } else {
                outside.push((coefficient, id));
            }
        }
        let inner = self.sum(inside);
        let taken = self.power(factor.0, factor.1);
        outside.insert(0, (1.0, self.product(1.0, &[taken, inner])));
        Some(if outside.len() == 1 {
            outside[0].1
        } else {
            self.sum(outside)
        })
    }
}
