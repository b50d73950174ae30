//! Expressions of a model as one graph, each value once, sums and products in a normal form.
//!
//! The normal form is n-ary: a sum of numeric multiples, a product of powers. A division is a product with a
//! reciprocal. What depends on parameters alone is kept together inside a product or sum, so that it can be
//! computed once; a factor that several addends share is taken out of the sum. Named quantities stay whole.

use std::collections::HashMap;

use crate::EmitError;
use crate::ir;

/// A node of the graph.
pub(crate) type Id = usize;

/// The arguments that an expression may refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Kind {
    State,
    Input,
    Noise,
    Parameter,
    /// Neither state nor input: a time, a lag, a frequency.
    Argument,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Call {
    Sin,
    Cos,
    Exp,
    Sqrt,
}

#[derive(Clone, Debug)]
pub(crate) enum Node {
    Number(f64),
    Leaf(Kind, String),
    /// Sum of multiples; the constant part is a multiple of the number one.
    Sum(Vec<(f64, Id)>),
    /// Number times factors, each of them neither a number nor a nameless product.
    Product(f64, Vec<Id>),
    /// Whole power; the exponent is neither 0 nor 1.
    Power(Id, i32),
    Call(Call, Id),
}

#[derive(PartialEq, Eq, Hash)]
enum Key {
    Number(u64),
    Leaf(Kind, String),
    Sum(Vec<(u64, Id)>),
    Product(u64, Vec<Id>),
    Power(Id, i32),
    Call(Call, Id),
}

/// A power that stands as a factor.
type Factor = (Id, i32);

pub(crate) struct Dag {
    nodes: Vec<Node>,
    index: HashMap<Key, Id>,
    /// The quantity that a node is, by position in the model.
    names: Vec<Option<usize>>,
    parametric: Vec<bool>,
    /// Named products, to be found again inside larger ones.
    named_products: Vec<Id>,
    symbols: HashMap<String, Id>,
    one: Id,
}

impl Dag {
    /// The graph of all quantities of a model.
    pub(crate) fn new(model: &ir::Model) -> Result<Self, EmitError> {
        let mut dag = Self {
            nodes: Vec::new(),
            index: HashMap::new(),
            names: Vec::new(),
            parametric: Vec::new(),
            named_products: Vec::new(),
            symbols: HashMap::new(),
            one: 0,
        };
        dag.one = dag.number(1.0);
        for (position, quantity) in model.quantities.iter().enumerate() {
            let id = dag.build(&quantity.expr, &quantity.name)?;
            let nameable = !matches!(dag.nodes[id], Node::Number(_) | Node::Leaf(..));
            if nameable && dag.names[id].is_none() {
                dag.names[id] = Some(position);
                if matches!(dag.nodes[id], Node::Product(..)) {
                    dag.named_products.push(id);
                }
            }
            dag.symbols.insert(quantity.name.clone(), id);
        }
        Ok(dag)
    }

    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id]
    }

    /// The quantity that a node is, by position in the model.
    pub(crate) fn name(&self, id: Id) -> Option<usize> {
        self.names[id]
    }

    /// Whether a node depends on parameters alone.
    pub(crate) fn is_parametric(&self, id: Id) -> bool {
        self.parametric[id]
    }

    pub(crate) fn is_one(&self, id: Id) -> bool {
        id == self.one
    }

    /// The node of a call on an argument, if the graph has it.
    pub(crate) fn find_call(&self, call: Call, argument: Id) -> Option<Id> {
        self.index.get(&Key::Call(call, argument)).copied()
    }

    /// The lower powers that a whole power is computed from.
    pub(crate) fn split_power(&mut self, base: Id, exponent: i32) -> (Id, Id) {
        let half = if exponent % 2 == 0 {
            exponent / 2
        } else {
            exponent - exponent.signum()
        };
        (self.power(base, half), self.power(base, exponent - half))
    }

    /// Operands of a node, in the order in which they are written.
    pub(crate) fn operands(&mut self, id: Id) -> Vec<Id> {
        match self.nodes[id].clone() {
            Node::Number(_) | Node::Leaf(..) => Vec::new(),
            Node::Sum(terms) => terms
                .into_iter()
                .map(|(_, t)| t)
                .filter(|&t| t != self.one)
                .collect(),
            Node::Product(_, factors) => factors,
            Node::Power(base, -1) => vec![base],
            Node::Power(base, exponent) => {
                let (low, high) = self.split_power(base, exponent);
                if low == high {
                    vec![low]
                } else {
                    vec![low, high]
                }
            }
            Node::Call(_, argument) => vec![argument],
        }
    }

    /// Adds an expression of `owner` to the graph.
    pub(crate) fn build(&mut self, expr: &ir::Expr, owner: &str) -> Result<Id, EmitError> {
        let fault = |what: &str| EmitError::Mismatch(format!("the IR of `{owner}` holds {what}"));
        match expr {
            ir::Expr::Number(value) => Ok(self.number(*value)),
            ir::Expr::Name(name) => self
                .symbol(name)
                .ok_or_else(|| fault(&format!("the unknown name `{name}`"))),
            ir::Expr::Apply(items) => {
                let Some((ir::Expr::Name(op), arguments)) = items.split_first() else {
                    return Err(fault("an operation without an operator"));
                };
                if let ("pow", [base, ir::Expr::Number(exponent)]) = (op.as_str(), arguments) {
                    if exponent.fract() != 0.0 || exponent.abs() > 99.0 {
                        return Err(fault(&format!("the exponent {exponent}")));
                    }
                    let base = self.build(base, owner)?;
                    return Ok(self.power(base, *exponent as i32));
                }
                let ids = arguments
                    .iter()
                    .map(|a| self.build(a, owner))
                    .collect::<Result<Vec<_>, _>>()?;
                self.apply(op, &ids).ok_or_else(|| {
                    fault(&format!(
                        "the operation `{op}` with {} arguments",
                        ids.len()
                    ))
                })
            }
        }
    }

    fn apply(&mut self, op: &str, arguments: &[Id]) -> Option<Id> {
        Some(match (op, arguments) {
            ("+", ids) if !ids.is_empty() => self.sum(ids.iter().map(|&id| (1.0, id)).collect()),
            ("-", &[a, b]) => self.sum(vec![(1.0, a), (-1.0, b)]),
            ("neg", &[a]) => self.product(-1.0, &[a]),
            ("*", ids) if !ids.is_empty() => self.product(1.0, ids),
            ("/", &[a, b]) => {
                let inverse = self.power(b, -1);
                self.product(1.0, &[a, inverse])
            }
            ("sin", &[a]) => self.call(Call::Sin, a),
            ("cos", &[a]) => self.call(Call::Cos, a),
            ("exp", &[a]) => self.call(Call::Exp, a),
            ("sqrt", &[a]) => self.call(Call::Sqrt, a),
            _ => return None,
        })
    }

    fn symbol(&mut self, name: &str) -> Option<Id> {
        if let Some(&id) = self.symbols.get(name) {
            return Some(id);
        }
        let (prefix, field) = name.split_once('.')?;
        let kind = match prefix {
            "x" => Kind::State,
            "u" => Kind::Input,
            "w" => Kind::Noise,
            "p" => Kind::Parameter,
            "t" => Kind::Argument,
            _ => return None,
        };
        Some(self.intern(
            Key::Leaf(kind, field.to_owned()),
            Node::Leaf(kind, field.to_owned()),
        ))
    }

    fn intern(&mut self, key: Key, node: Node) -> Id {
        if let Some(&id) = self.index.get(&key) {
            return id;
        }
        let parametric = match &node {
            Node::Number(_) => true,
            Node::Leaf(kind, _) => *kind == Kind::Parameter,
            Node::Sum(terms) => terms.iter().all(|&(_, id)| self.parametric[id]),
            Node::Product(_, factors) => factors.iter().all(|&id| self.parametric[id]),
            Node::Power(id, _) | Node::Call(_, id) => self.parametric[*id],
        };
        let id = self.nodes.len();
        self.nodes.push(node);
        self.names.push(None);
        self.parametric.push(parametric);
        self.index.insert(key, id);
        id
    }

    fn number(&mut self, value: f64) -> Id {
        self.intern(Key::Number(value.to_bits()), Node::Number(value))
    }

    fn call(&mut self, call: Call, argument: Id) -> Id {
        self.intern(Key::Call(call, argument), Node::Call(call, argument))
    }

    fn power(&mut self, base: Id, exponent: i32) -> Id {
        if exponent == 0 {
            return self.one;
        }
        if exponent == 1 {
            return base;
        }
        if self.names[base].is_none() {
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

    /// The numeric multiple and the powers that a factor consists of; named quantities stay whole.
    fn factors_of(&self, id: Id, exponent: i32, found: &mut Vec<Factor>) -> f64 {
        if self.names[id].is_none() {
            match &self.nodes[id] {
                Node::Number(value) => return value.powi(exponent),
                Node::Power(base, k) => return self.factors_of(*base, k * exponent, found),
                Node::Product(coefficient, factors) => {
                    return factors.iter().fold(coefficient.powi(exponent), |c, &f| {
                        c * self.factors_of(f, exponent, found)
                    });
                }
                _ => {}
            }
        }
        match found.iter_mut().find(|(base, _)| *base == id) {
            Some((_, k)) => *k += exponent,
            None => found.push((id, exponent)),
        }
        1.0
    }

    fn product(&mut self, coefficient: f64, ids: &[Id]) -> Id {
        let mut factors = Vec::new();
        let coefficient = ids.iter().fold(coefficient, |c, &id| {
            c * self.factors_of(id, 1, &mut factors)
        });
        factors.retain(|&(_, exponent)| exponent != 0);
        if coefficient == 0.0 {
            return self.number(0.0);
        }
        self.reuse_named(&mut factors);
        self.product_of(coefficient, factors)
    }

    /// Replaces factors by a named product that they make up.
    fn reuse_named(&self, factors: &mut Vec<Factor>) {
        for &named in self.named_products.iter().rev() {
            let Node::Product(coefficient, ids) = &self.nodes[named] else {
                continue;
            };
            let mut inner = Vec::new();
            let number = ids.iter().fold(*coefficient, |c, &id| {
                c * self.factors_of(id, 1, &mut inner)
            });
            let contained = inner.len() > 1 && inner.iter().all(|part| factors.contains(part));
            if number == 1.0 && contained {
                let first = factors
                    .iter()
                    .position(|part| inner.contains(part))
                    .unwrap_or(0);
                factors.insert(first, (named, 1));
                factors.retain(|part| !inner.contains(part));
            }
        }
    }

    fn product_of(&mut self, coefficient: f64, factors: Vec<Factor>) -> Id {
        let (fixed, free): (Vec<Factor>, Vec<Factor>) =
            factors.iter().partition(|(id, _)| self.parametric[*id]);
        if free.is_empty() || fixed.is_empty() {
            return self.flat_product(coefficient, &factors);
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
        self.intern_product(sign, ids)
    }

    fn flat_product(&mut self, coefficient: f64, factors: &[Factor]) -> Id {
        let ids: Vec<Id> = factors
            .iter()
            .map(|&(base, exponent)| self.power(base, exponent))
            .collect();
        match (ids.as_slice(), coefficient) {
            ([], _) => self.number(coefficient),
            (&[id], 1.0) => id,
            _ => self.intern_product(coefficient, ids),
        }
    }

    fn intern_product(&mut self, coefficient: f64, ids: Vec<Id>) -> Id {
        let mut key = ids.clone();
        key.sort_unstable();
        self.intern(
            Key::Product(coefficient.to_bits(), key),
            Node::Product(coefficient, ids),
        )
    }

    fn sum(&mut self, terms: Vec<(f64, Id)>) -> Id {
        let mut flat = Vec::new();
        for (coefficient, id) in terms {
            self.add_term(coefficient, id, &mut flat);
        }
        flat.retain(|&(coefficient, _)| coefficient != 0.0);
        if let Some(id) = self.take_common_factor(&flat) {
            return id;
        }
        let (fixed, free): (Vec<_>, Vec<_>) = flat.iter().partition(|(_, id)| self.parametric[*id]);
        if fixed.len() > 1 && !free.is_empty() {
            let constant = self.flat_sum(fixed);
            let mut terms = free;
            terms.push((1.0, constant));
            return self.flat_sum(terms);
        }
        self.flat_sum(flat)
    }

    fn add_term(&mut self, coefficient: f64, id: Id, flat: &mut Vec<(f64, Id)>) {
        if self.names[id].is_none() {
            match self.nodes[id].clone() {
                Node::Sum(inner) => {
                    for (c, part) in inner {
                        self.add_term(coefficient * c, part, flat);
                    }
                    return;
                }
                Node::Number(value) if id != self.one => {
                    return self.add_term(coefficient * value, self.one, flat);
                }
                Node::Product(c, factors) if c != 1.0 => {
                    let part = self.product(1.0, &factors);
                    return self.add_term(coefficient * c, part, flat);
                }
                _ => {}
            }
        }
        match flat.iter_mut().find(|(_, known)| *known == id) {
            Some((c, _)) => *c += coefficient,
            None => flat.push((coefficient, id)),
        }
    }

    fn flat_sum(&mut self, terms: Vec<(f64, Id)>) -> Id {
        match terms.as_slice() {
            [] => self.number(0.0),
            &[(1.0, id)] => id,
            &[(coefficient, id)] => self.product(coefficient, &[id]),
            _ => {
                let mut key: Vec<_> = terms.iter().map(|&(c, id)| (c.to_bits(), id)).collect();
                key.sort_unstable();
                self.intern(Key::Sum(key), Node::Sum(terms))
            }
        }
    }

    /// Takes the factor that most addends share out of a sum. States and inputs stay: a polynomial is
    /// read, and its powers shared, as it stands in the table.
    fn take_common_factor(&mut self, terms: &[(f64, Id)]) -> Option<Id> {
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

#[cfg(test)]
mod tests;
