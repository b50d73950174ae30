//! Estrin's scheme: the addends of a long polynomial are taken in pairs, the pairs in pairs, and so on. It needs fewer
//! powers than the polynomial as it stands in the table, and its parts do not wait for each other.

use std::collections::{BTreeMap, BTreeSet};

use super::{Dag, Id, Term};
use crate::graph::passes::Pass;

/// A polynomial is long with so many powers of one variable. Below that the powers stand in other polynomials too, and
/// it is read, and compared, as the table lists it.
const LONG: usize = 4;

impl Dag {
    /// The sum with the longest polynomial in it by Estrin's scheme; none where none is long.
    pub(super) fn estrin(&mut self, terms: &[Term]) -> Option<Id> {
        if !self.has(Pass::Estrin) {
            return None;
        }
        let base = self.long_base(terms)?;
        let mut coefficients: BTreeMap<i32, Vec<Term>> = BTreeMap::new();
        let mut others = Vec::new();
        for &(number, id) in terms {
            match self.degree(id, base) {
                Some(degree) => {
                    let power = self.power(base, -degree);
                    let coefficient = self.product(1.0, &[id, power]);
                    coefficients
                        .entry(degree)
                        .or_default()
                        .push((number, coefficient));
                }
                None => others.push((number, id)),
            }
        }
        let mut sums = BTreeMap::new();
        for (degree, terms) in coefficients {
            sums.insert(degree, self.regrouped_sum(terms));
        }
        let polynomial = self.pairs(base, sums);
        others.insert(0, (1.0, polynomial));
        Some(self.regrouped_sum(others))
    }

    /// The first variable in which a sum is a long polynomial.
    fn long_base(&self, terms: &[Term]) -> Option<Id> {
        let mut powers: Vec<(Id, BTreeSet<i32>)> = Vec::new();
        for (base, degree) in terms.iter().filter_map(|&(_, id)| self.monomial(id)) {
            match powers.iter_mut().find(|(known, _)| *known == base) {
                Some((_, degrees)) => drop(degrees.insert(degree)),
                None => powers.push((base, BTreeSet::from([degree]))),
            }
        }
        let long = powers
            .into_iter()
            .find(|(_, degrees)| degrees.len() >= LONG);
        long.map(|(base, _)| base)
    }

    /// The positive power that a node is, apart from what depends on parameters alone.
    fn monomial(&self, id: Id) -> Option<(Id, i32)> {
        let mut factors = Vec::new();
        self.factors_of(id, 1, &mut factors);
        factors.retain(|&(base, _)| !self.parametric[base]);
        match factors.as_slice() {
            &[(base, degree)] if degree > 0 => Some((base, degree)),
            _ => None,
        }
    }

    /// The degree of an addend of a polynomial in `base`; none where it is not one.
    fn degree(&self, id: Id, base: Id) -> Option<i32> {
        if self.parametric[id] {
            return Some(0);
        }
        let (own, degree) = self.monomial(id)?;
        (own == base).then_some(degree)
    }

    /// c₀ + c₁x + c₂x² + … as (c₀ + c₁x) + (c₂ + c₃x)x² + …, then the same in x², until one is left.
    fn pairs(&mut self, base: Id, mut coefficients: BTreeMap<i32, Id>) -> Id {
        let mut step = 1;
        while coefficients.keys().any(|&degree| degree > 0) {
            let power = self.power(base, step);
            let mut pairs: BTreeMap<i32, Vec<Term>> = BTreeMap::new();
            for (degree, coefficient) in coefficients {
                let addend = if degree % 2 == 0 {
                    coefficient
                } else {
                    self.product(1.0, &[coefficient, power])
                };
                pairs.entry(degree / 2).or_default().push((1.0, addend));
            }
            coefficients = BTreeMap::new();
            for (degree, pair) in pairs {
                coefficients.insert(degree, self.regrouped_sum(pair));
            }
            step *= 2;
        }
        coefficients.into_values().next().unwrap_or(self.one)
    }
}
