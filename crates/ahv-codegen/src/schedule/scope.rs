//! What is known while a body is written: who needs which value, what is bound, and under which name.

use std::collections::{HashMap, HashSet};

use super::names::{Names, is_numbered};
use super::stages::Given;
use super::tree::Statement;
use crate::graph::{Dag, Id, Node};
use crate::ir;

/// Arguments of emitted functions: no value may hide one.
const RESERVED: [&str; 7] = ["x", "u", "p", "dw", "i", "s", "n"];

/// What is known while a body is written.
pub(super) struct Scope<'a> {
    pub(super) dag: &'a mut Dag,
    pub(super) model: &'a ir::Model,
    pub(super) given: Given<'a>,
    pub(super) bound: HashMap<Id, String>,
    bound_in_order: Vec<Id>,
    /// What nodes are called in names: what is given, and what is bound.
    spelled: HashMap<Id, String>,
    taken: HashSet<String>,
    pub(super) uses: HashMap<Id, usize>,
    visited: HashSet<Id>,
    pub(super) statements: Vec<Statement>,
    section: String,
    owner: String,
    /// The value that is written, the owner's.
    whole: Option<Id>,
    /// Positions of the quantities that the derivation of the function goes through; `None` for all.
    home: Option<HashSet<usize>>,
}

impl<'a> Scope<'a> {
    pub(super) fn new(dag: &'a mut Dag, model: &'a ir::Model, given: Given<'a>) -> Self {
        Self {
            dag,
            model,
            given,
            bound: HashMap::new(),
            bound_in_order: Vec::new(),
            spelled: given.names(),
            taken: RESERVED.map(str::to_owned).into(),
            uses: HashMap::new(),
            visited: HashSet::new(),
            statements: Vec::new(),
            section: String::new(),
            owner: String::new(),
            whole: None,
            home: None,
        }
    }

    pub(super) fn names(&self) -> Names<'_> {
        Names {
            dag: self.dag,
            model: self.model,
            home: self.home.as_ref(),
            known: &self.spelled,
        }
    }

    /// The values that are bound and whose names describe them, in the order in which they are.
    pub(super) fn described(&self) -> Vec<(Id, String)> {
        let mut order = self.bound_in_order.clone();
        order.retain(|id| !is_numbered(&self.bound[id]));
        order
            .into_iter()
            .map(|id| (id, self.bound[&id].clone()))
            .collect()
    }

    /// Binds everything that the roots need and returns the statements.
    pub(super) fn write(&mut self, owner: &str, roots: &[Id]) -> Vec<Statement> {
        let functions = &mut self.model.functions.iter();
        let function = functions.find(|function| function.name == owner);
        self.home = function.map(|function| self.model.derivation(function));
        let mut counted = HashSet::new();
        for &root in roots {
            self.count(root, &mut counted);
        }
        let mut needed: Vec<(usize, Id)> = counted
            .iter()
            .filter_map(|&id| Some((self.names().quantity(id)?, id)))
            .collect();
        needed.sort_unstable();
        for (position, id) in needed {
            if self.visited.contains(&id) {
                continue;
            }
            let quantity = &self.model.quantities[position];
            self.owner.clone_from(&quantity.name);
            self.whole = Some(id);
            self.enter(&quantity.section, &quantity.equation);
            self.visit(id);
        }
        self.owner = owner.to_owned();
        for &root in roots {
            self.whole = Some(root).filter(|_| roots.len() == 1);
            self.visit(root);
        }
        std::mem::take(&mut self.statements)
    }

    fn is_frontier(&self, id: Id) -> bool {
        match self.dag.node(id) {
            Node::Number(_) | Node::Leaf(..) => true,
            _ => self.given.find(id).is_some(),
        }
    }

    fn count(&mut self, id: Id, counted: &mut HashSet<Id>) {
        *self.uses.entry(id).or_default() += 1;
        if self.is_frontier(id) || !(counted.insert(id) || self.dag.is_written_anew(id)) {
            return;
        }
        for operand in self.dag.operands(id) {
            self.count(operand, counted);
        }
    }

    fn enter(&mut self, section: &str, equation: &str) {
        if section != self.section {
            section.clone_into(&mut self.section);
            let heading = if equation.is_empty() {
                section.to_owned()
            } else {
                format!("{section}, {equation}")
            };
            self.statements.push(Statement::Section(heading));
        }
    }

    fn visit(&mut self, id: Id) {
        if self.is_frontier(id) || !self.visited.insert(id) {
            return;
        }
        for operand in self.dag.operands(id) {
            self.visit(operand);
        }
        if self.dag.is_written_anew(id) {
            return;
        }
        let shared = self.uses.get(&id).is_some_and(|&uses| uses > 1);
        let costly = matches!(self.dag.node(id), Node::Call(..) | Node::Power(..));
        if !self.dag.quantities(id).is_empty() || shared || costly {
            self.bind(id);
        }
    }

    fn bind(&mut self, id: Id) {
        if self.bound.contains_key(&id) {
            return;
        }
        if let Some((sin, cos, angle)) = self.sin_cos(id) {
            return self.bind_pair(sin, cos, angle);
        }
        let value = self.definition(id);
        let unit = self
            .names()
            .quantity(id)
            .map(|position| self.model.quantities[position].unit.clone());
        let name = self.take_name(id);
        self.statements.push(Statement::Let {
            name,
            value,
            unit: unit.unwrap_or_default(),
        });
    }

    pub(super) fn take_name(&mut self, id: Id) -> String {
        let described = self.names().describe(id);
        let share = || self.names().describe_share(id, &self.owner, self.whole?);
        let described = described.or_else(share);
        let described = described.filter(|name| !self.taken.contains(name));
        let name = described.unwrap_or_else(|| {
            (1..)
                .map(|k| format!("{}_term_{k}", self.owner))
                .find(|name| !self.taken.contains(name))
                .unwrap_or_default()
        });
        self.taken.insert(name.clone());
        self.bound.insert(id, name.clone());
        self.bound_in_order.push(id);
        self.spelled.insert(id, name.clone());
        name
    }
}
