//! Names for values that the derivation did not name, told from what they are.

use std::collections::{HashMap, HashSet};

use crate::graph::{Dag, Id, Kind, Node};
use crate::ir;

/// Longer names are not read; such a value is numbered under the quantity that it belongs to.
const LONGEST: usize = 80;

/// What the nodes of a graph are called in a function.
pub(crate) struct Names<'a> {
    pub(crate) dag: &'a Dag,
    pub(crate) model: &'a ir::Model,
    /// Positions of the quantities that the function's own derivation goes through; `None` for all. A name of another
    /// function's derivation would tell a reader of something that is not there.
    pub(crate) home: Option<&'a HashSet<usize>>,
    /// What nodes are called already.
    pub(crate) known: &'a HashMap<Id, String>,
}

impl Names<'_> {
    /// The quantity that a node is here, by position in the model.
    ///
    /// Its name may be of another function's derivation where it is what the value would be called anyway: a derivation that
    /// has the cosine as the derivative of the sine has it as the cosine too.
    pub(crate) fn quantity(&self, id: Id) -> Option<usize> {
        let at_home = |position: &usize| self.home.is_none_or(|home| home.contains(position));
        let called = |position: &usize| {
            self.spell_call(id)
                .is_some_and(|name| name == self.model.quantities[*position].name)
        };
        let mut quantities = self.dag.quantities(id).iter().copied();
        quantities.find(|position| at_home(position) || called(position))
    }

    /// A name that describes a node, or `None` where it would be too long.
    pub(crate) fn describe(&self, id: Id) -> Option<String> {
        let name = self.spell(id)?;
        (self.quantity(id).is_some() || name.len() <= LONGEST).then_some(name)
    }

    /// A name for what is left of the value `whole`, called `owner`, without its other factors: "lift_over_s".
    pub(crate) fn describe_share(&self, id: Id, owner: &str, whole: Id) -> Option<String> {
        let Node::Product(coefficient, factors) = self.dag.node(whole) else {
            return None;
        };
        let others = factors.iter().copied().filter(|&it| it != id);
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for other in others {
            match *self.dag.node(other) {
                // To leave a reciprocal out is to multiply.
                Node::Power(base, -1) if self.quantity(other).is_none() => {
                    above.push(self.spell(base)?);
                }
                _ => below.push(self.spell(other)?),
            }
        }
        let all = || above.iter().chain(&below);
        let is_part = above.len() + below.len() == factors.len() - 1 && factors.len() > 1;
        let is_plain = !all().any(|it| is_sum(it) || is_derivative(it) || it.contains("over_"));
        if coefficient.abs() != 1.0 || !is_part || !is_plain {
            return None;
        }
        let sign = if *coefficient < 0.0 { "minus_" } else { "" };
        let mut name = format!("{sign}{owner}");
        if !above.is_empty() {
            name += &format!("_times_{}", above.join("_"));
        }
        if !below.is_empty() {
            name += &format!("_over_{}", below.join("_"));
        }
        (name.len() <= LONGEST).then_some(name)
    }

    /// Why a node has no name that describes it, as a sentence.
    pub(crate) fn reason(&self, id: Id) -> String {
        match self.spell(id) {
            Some(name) if name.len() > LONGEST => {
                format!("its description has {} letters: {name}", name.len())
            }
            Some(name) => format!("another value is called {name}"),
            None => "a product of sums, or a number without a word, has no description".to_owned(),
        }
    }

    fn spell(&self, id: Id) -> Option<String> {
        if let Some(position) = self.quantity(id) {
            return Some(self.model.quantities[position].name.clone());
        }
        if let Node::Leaf(_, name) = self.dag.node(id)
            && self.model.quantities.iter().any(|it| it.name == *name)
        {
            // A quantity of the same name is something else.
            return Some(format!("table_{name}"));
        }
        let known = self.known.get(&id);
        if let Some(name) = known.filter(|name| !is_numbered(name)) {
            return Some(name.clone());
        }
        Some(match self.dag.node(id) {
            Node::Number(_) => return None,
            Node::Leaf(Kind::Noise, name) => format!("d{name}"),
            Node::Leaf(_, name) => name.clone(),
            Node::Power(base, exponent) => {
                let text = self.spell(*base)?;
                match (exponent, self.is_open(*base)) {
                    (-1, false) => format!("inv_{text}"),
                    (-1, true) => format!("inv_of_{text}"),
                    (k, true) if *k < 0 => format!("inv_power_{}_of_{text}", -k),
                    (k, true) => format!("power_{k}_of_{text}"),
                    (k, false) if *k < 0 => format!("inv_{text}_{}", -k),
                    (k, false) => format!("{text}_{k}"),
                }
            }
            Node::Call(..) => self.spell_call(id)?,
            Node::Product(coefficient, factors) => self.spell_product(*coefficient, factors)?,
            Node::Sum(terms) => self.spell_sum(terms)?,
        })
    }

    fn spell_call(&self, id: Id) -> Option<String> {
        let Node::Call(call, arguments) = self.dag.node(id) else {
            return None;
        };
        let function = call.name();
        let texts = arguments.iter().map(|&it| match self.dag.node(it) {
            Node::Number(value) => number_word(*value).map(str::to_owned),
            _ => self.spell(it),
        });
        let text = texts.collect::<Option<Vec<_>>>()?.join("_and_");
        let name = format!("{function}_{text}");
        // A quantity of that name is something else.
        let own = self.dag.quantities(id);
        let mut quantities = self.model.quantities.iter().zip(0..);
        let is_taken = quantities.any(|(it, place)| it.name == name && !own.contains(&place));
        if is_taken || arguments.iter().any(|&it| self.is_open(it)) {
            return Some(format!("{function}_of_{text}"));
        }
        Some(name)
    }

    /// Whether what follows a node's name would read as a part of it: of its last addend, or of what it is differentiated by.
    fn is_open(&self, id: Id) -> bool {
        self.spell(id)
            .is_some_and(|name| is_sum(&name) || is_derivative(&name))
    }

    /// Whether a node is spelled as a sum: what stands beside it must not read as a part of its last addend.
    fn is_open_sum(&self, id: Id) -> bool {
        self.spell(id).is_some_and(|name| is_sum(&name))
    }

    /// A sum whose addends differ in an index alone, 1, 2, 3 and so on, as "sum_of_c_t_eta_times_chi".
    fn spell_indexed_sum(&self, terms: &[(f64, Id)]) -> Option<String> {
        let addends = terms.iter().map(|&(coefficient, id)| {
            let name = self.spell(id).filter(|_| coefficient == 1.0)?;
            Some(name.split('_').map(str::to_owned).collect())
        });
        let addends: Vec<Vec<String>> = addends.collect::<Option<_>>()?;
        let first = addends.first().filter(|_| addends.len() > 1)?;
        let mut words = vec!["sum_of"];
        for (position, word) in first.iter().enumerate() {
            let others: Vec<&String> = addends.iter().filter_map(|it| it.get(position)).collect();
            let is_index = others.iter().zip(1..).all(|(it, k)| **it == k.to_string());
            if others.iter().all(|it| *it == word) {
                words.push(word);
            } else if !is_index || others.len() != addends.len() {
                return None;
            }
        }
        let same = addends.iter().all(|it| it.len() == first.len());
        same.then(|| words.join("_"))
    }

    fn spell_sum(&self, terms: &[(f64, Id)]) -> Option<String> {
        if let Some(name) = self.spell_indexed_sum(terms) {
            return Some(name);
        }
        let mut text = String::new();
        for (position, &(coefficient, id)) in terms.iter().enumerate() {
            text += match (position, coefficient < 0.0) {
                (0, false) => "",
                (0, true) => "minus_",
                (_, false) => "_plus_",
                (_, true) => "_minus_",
            };
            if coefficient.abs() != 1.0 {
                text += &format!("{}_", number_word(coefficient.abs())?);
            }
            text += &if self.dag.is_one(id) {
                "one".to_owned()
            } else {
                self.spell(id)?
            };
        }
        Some(text)
    }

    fn spell_product(&self, coefficient: f64, factors: &[Id]) -> Option<String> {
        let (mut sums, mut above, mut below) = (Vec::new(), Vec::new(), Vec::new());
        let mut number = Vec::new();
        if coefficient < 0.0 {
            number.push("minus");
        }
        if coefficient.abs() != 1.0 {
            number.push(number_word(coefficient.abs())?);
        }
        for &factor in factors {
            match self.dag.node(factor) {
                Node::Power(base, -1) if self.quantity(factor).is_none() => {
                    match self.known.get(&factor).filter(|name| !is_numbered(name)) {
                        Some(name) if self.is_open_sum(*base) => above.push(name.clone()),
                        None if self.is_open_sum(*base) => return None,
                        _ => below.push(self.spell(*base)?),
                    }
                }
                _ if self.is_open_sum(factor) => sums.push(self.spell(factor)?),
                _ => above.push(self.spell(factor)?),
            }
        }
        let open = above.iter().any(|name| is_derivative(name));
        let above = above.join(if open { "_times_" } else { "_" });
        let below = below.join("_");
        number.extend(Some(&*above).filter(|it| !it.is_empty()));
        let above = number.join("_");
        let product = match (above.is_empty(), below.is_empty()) {
            (_, true) => above,
            (true, false) => format!("inv_{below}"),
            (false, false) if open => format!("{above}_times_inv_{below}"),
            (false, false) => format!("{above}_over_{below}"),
        };
        // Of two sums one would read as a part of the other, and a sign as one of an addend.
        match sums.as_slice() {
            [] => Some(product),
            _ if coefficient < 0.0 => None,
            [sum] if sum.contains("_times_") => Some(format!("{sum}_{product}")),
            [sum] => Some(format!("{sum}_times_{product}")),
            _ => None,
        }
    }
}

fn is_sum(name: &str) -> bool {
    name.contains("_plus_") || name.contains("_minus_") || name.starts_with("sum_of_")
}

fn is_derivative(name: &str) -> bool {
    name.contains("_d_")
}

/// Whether a name only says whose part a value is.
pub(super) fn is_numbered(name: &str) -> bool {
    name.contains("_term_") || name.contains("_constant_")
}

fn number_word(value: f64) -> Option<&'static str> {
    Some(match value {
        0.0 => "zero",
        0.25 => "quarter",
        0.5 => "half",
        1.0 => "one",
        2.0 => "two",
        3.0 => "three",
        4.0 => "four",
        5.0 => "five",
        6.0 => "six",
        _ if (value * value - 0.5).abs() < 1e-15 => "root_half",
        _ => return None,
    })
}
