//! Named products inside larger ones.

use std::cmp::Reverse;

use super::{Dag, Factor, Id, Node};
use crate::graph::passes::Pass;

impl Dag {
    /// Remembers a quantity that is a product of several powers, without a number, before it has its name.
    pub(super) fn note_named_product(&mut self, id: Id) {
        let mut factors = Vec::new();
        let is_product = matches!(self.nodes[id], Node::Product(..));
        if is_product && self.factors_of(id, 1, &mut factors) == 1.0 {
            let first = factors[0];
            self.named_products
                .entry(first)
                .or_default()
                .push((id, factors));
        }
    }

    /// Replaces factors by the named products that they make up, the latest first.
    pub(super) fn reuse_named_products(&self, factors: &mut Vec<Factor>) {
        if !self.has(Pass::NamedProducts) {
            return;
        }
        let beginnings = factors
            .iter()
            .filter_map(|first| self.named_products.get(first));
        let mut candidates: Vec<&(Id, Vec<Factor>)> = beginnings.flatten().collect();
        candidates.sort_unstable_by_key(|&&(named, _)| Reverse(named));
        for (named, inner) in candidates {
            if !inner.iter().all(|part| factors.contains(part)) {
                continue;
            }
            let first = factors.iter().position(|part| inner.contains(part));
            factors.insert(first.unwrap_or(0), (*named, 1));
            factors.retain(|part| !inner.contains(part));
        }
    }
}
