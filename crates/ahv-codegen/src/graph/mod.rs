//! Expressions of a model as one graph, sums and products in a normal form.
//!
//! The normal form is n-ary: a sum of numeric multiples, a product of powers. A division is a product with a
//! reciprocal. Named quantities stay whole. The rules that rewrite beyond that form are [`Pass`]es, each in a module
//! of its own.

pub(crate) mod decay;
mod estrin;
mod named_products;
pub(crate) mod passes;
mod powers;
mod regrouping;

use std::collections::HashMap;

use crate::EmitError;
use crate::call::Call;
use crate::ir;

use passes::{Pass, Passes};

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

#[derive(Clone, Debug)]
pub(crate) enum Node {
    Number(f64),
    Leaf(Kind, String),
    /// Sum of multiples; the constant part is a multiple of the number one.
    Sum(Vec<Term>),
    /// Number times factors, each of them neither a number nor a nameless product.
    Product(f64, Vec<Id>),
    /// Whole power; the exponent is neither 0 nor 1.
    Power(Id, i32),
    Call(Call, Vec<Id>),
}

#[derive(Clone, PartialEq, Eq, Hash)]
enum Key {
    Number(u64),
    Leaf(Kind, String),
    Sum(Vec<(u64, Id)>),
    Product(u64, Vec<Id>),
    Power(Id, i32),
    Call(Call, Vec<Id>),
}

/// A power that stands as a factor.
type Factor = (Id, i32);
/// A numeric multiple that stands as an addend.
type Term = (f64, Id);

#[derive(Clone)]
pub(crate) struct Dag {
    nodes: Vec<Node>,
    index: HashMap<Key, Id>,
    /// The quantities that a node is, by position in the model: those of different functions may be equal.
    names: Vec<Vec<usize>>,
    parametric: Vec<bool>,
    /// Named products with their factors, by the first of these, to be found again inside larger ones.
    named_products: HashMap<Factor, Vec<(Id, Vec<Factor>)>>,
    /// What each power is the product of.
    steps: HashMap<Id, Vec<Id>>,
    passes: Passes,
    symbols: HashMap<String, Id>,
    one: Id,
}

impl Dag {
    /// The graph of all quantities of a model.
    pub(crate) fn new(model: &ir::Model, passes: &Passes) -> Result<Self, EmitError> {
        let mut dag = Self {
            nodes: Vec::new(),
            index: HashMap::new(),
            names: Vec::new(),
            parametric: Vec::new(),
            named_products: HashMap::new(),
            steps: HashMap::new(),
            passes: passes.clone(),
            symbols: HashMap::new(),
            one: 0,
        };
        dag.one = dag.number(1.0);
        for (position, quantity) in model.quantities.iter().enumerate() {
            let id = dag.build(&quantity.expr, &quantity.name)?;
            let nameable = !matches!(dag.nodes[id], Node::Number(_) | Node::Leaf(..));
            if nameable {
                if dag.names[id].is_empty() {
                    dag.note_named_product(id);
                }
                dag.names[id].push(position);
            }
            dag.symbols.insert(quantity.name.clone(), id);
        }
        Ok(dag)
    }

    /// The same graph where other passes write the code; those that build the graph are taken already.
    pub(crate) fn written_with(&self, passes: &Passes) -> Self {
        Self {
            passes: passes.clone(),
            ..self.clone()
        }
    }

    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id]
    }

    /// The quantities that a node is, by position in the model; it stays whole if there are any.
    pub(crate) fn quantities(&self, id: Id) -> &[usize] {
        &self.names[id]
    }

    /// Whether a node depends on parameters alone.
    pub(crate) fn is_parametric(&self, id: Id) -> bool {
        self.parametric[id]
    }

    /// Whether a pass is taken.
    pub(crate) fn has(&self, pass: Pass) -> bool {
        self.passes.has(pass)
    }

    pub(crate) fn is_one(&self, id: Id) -> bool {
        id == self.one
    }

    /// The node of a call on arguments, if the graph has it.
    pub(crate) fn find_call(&self, call: Call, arguments: &[Id]) -> Option<Id> {
        self.index
            .get(&Key::Call(call, arguments.to_vec()))
            .copied()
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
            Node::Power(..) => self.steps_of_power(id),
            Node::Call(_, arguments) => arguments,
        }
    }

    /// Adds the entries of a function to the graph.
    pub(crate) fn roots(&mut self, function: &ir::Function) -> Result<Vec<Id>, EmitError> {
        let entries = function.outputs.iter().flat_map(|output| &output.entries);
        entries
            .map(|entry| self.build(&entry.expr, &function.name))
            .collect()
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
            (name, ids) => self.call(Call::of(name, ids.len())?, ids),
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
        let leaf = self.intern(
            Key::Leaf(kind, field.to_owned()),
            Node::Leaf(kind, field.to_owned()),
        );
        self.symbols.insert(name.to_owned(), leaf);
        Some(leaf)
    }

    fn intern(&mut self, key: Key, node: Node) -> Id {
        // A number and a leaf are names, not values.
        let is_name = matches!(node, Node::Number(_) | Node::Leaf(..));
        if let Some(&id) = self.index.get(&key)
            && (is_name || self.has(Pass::HashConsing))
        {
            return id;
        }
        let parametric = match &node {
            Node::Number(_) => true,
            Node::Leaf(kind, _) => *kind == Kind::Parameter,
            Node::Sum(terms) => terms.iter().all(|&(_, id)| self.parametric[id]),
            Node::Product(_, factors) => factors.iter().all(|&id| self.parametric[id]),
            Node::Power(id, _) => self.parametric[*id],
            Node::Call(_, ids) => ids.iter().all(|&id| self.parametric[id]),
        };
        let id = self.nodes.len();
        self.nodes.push(node);
        self.names.push(Vec::new());
        self.parametric.push(parametric);
        self.index.insert(key, id);
        id
    }

    fn number(&mut self, value: f64) -> Id {
        self.intern(Key::Number(value.to_bits()), Node::Number(value))
    }

    fn call(&mut self, call: Call, arguments: &[Id]) -> Id {
        let arguments = arguments.to_vec();
        self.intern(
            Key::Call(call, arguments.clone()),
            Node::Call(call, arguments),
        )
    }

    /// The numeric multiple and the powers that a factor consists of; named quantities stay whole.
    fn factors_of(&self, id: Id, exponent: i32, found: &mut Vec<Factor>) -> f64 {
        if self.names[id].is_empty() {
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

    /// A number times some nodes.
    pub(crate) fn product(&mut self, coefficient: f64, ids: &[Id]) -> Id {
        let mut factors = Vec::new();
        let coefficient = ids.iter().fold(coefficient, |c, &id| {
            c * self.factors_of(id, 1, &mut factors)
        });
        factors.retain(|&(_, exponent)| exponent != 0);
        if coefficient == 0.0 {
            return self.number(0.0);
        }
        self.reuse_named_products(&mut factors);
        self.join_parameter_factors(coefficient, &factors)
            .unwrap_or_else(|| self.flat_product(coefficient, &factors))
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

    fn sum(&mut self, terms: Vec<Term>) -> Id {
        let flat = self.flattened(terms);
        self.estrin(&flat)
            .unwrap_or_else(|| self.regrouped_sum(flat))
    }

    /// A sum by the rules of regrouping alone.
    fn regrouped_sum(&mut self, terms: Vec<Term>) -> Id {
        let flat = self.flattened(terms);
        self.take_common_factor(&flat)
            .or_else(|| self.join_parameter_addends(&flat))
            .unwrap_or_else(|| self.flat_sum(flat))
    }

    /// The addends of the sums among the terms, equal ones together.
    fn flattened(&mut self, terms: Vec<Term>) -> Vec<Term> {
        let mut flat = Vec::new();
        for (coefficient, id) in terms {
            self.add_term(coefficient, id, &mut flat);
        }
        flat.retain(|&(coefficient, _)| coefficient != 0.0);
        flat
    }

    fn add_term(&mut self, coefficient: f64, id: Id, flat: &mut Vec<Term>) {
        if self.names[id].is_empty() {
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

    fn flat_sum(&mut self, terms: Vec<Term>) -> Id {
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
}

#[cfg(test)]
mod tests;
