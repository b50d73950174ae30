//! From the graph to statements: which values get a name, in which order they stand.

mod cost;
pub(crate) mod effect;
mod expressions;
mod names;
mod prepared;
pub(crate) mod program;
mod sin_cos;
pub(crate) mod tree;

use std::collections::{HashMap, HashSet};

use crate::graph::{Dag, Id, Node};
use crate::ir;

pub(crate) use cost::Cost;
pub(crate) use prepared::Prepared;

use names::Names;
use tree::{Body, Statement};

/// What a function of this name does that computes the roots; without `prepared` it is `prepare` itself.
pub(crate) fn body(
    dag: &mut Dag,
    model: &ir::Model,
    prepared: Option<&Prepared>,
    owner: &str,
    roots: &[Id],
) -> Body {
    let mut scope = Scope::new(dag, model, prepared);
    let statements = scope.write(owner, roots);
    let results = roots.iter().map(|&id| scope.reference(id)).collect();
    Body {
        statements,
        results,
    }
}

/// What is known while a body is written.
struct Scope<'a> {
    dag: &'a mut Dag,
    model: &'a ir::Model,
    prepared: Option<&'a Prepared>,
    bound: HashMap<Id, String>,
    /// What nodes are called in names: the fields of `Prepared`, and what is bound.
    spelled: HashMap<Id, String>,
    taken: HashSet<String>,
    uses: HashMap<Id, usize>,
    visited: HashSet<Id>,
    statements: Vec<Statement>,
    section: String,
    owner: String,
    /// The value that is written, the owner's.
    whole: Option<Id>,
    /// Positions of the quantities that the derivation of the function goes through; `None` for all.
    home: Option<HashSet<usize>>,
}

impl<'a> Scope<'a> {
    fn new(dag: &'a mut Dag, model: &'a ir::Model, prepared: Option<&'a Prepared>) -> Self {
        Self {
            dag,
            model,
            prepared,
            bound: HashMap::new(),
            spelled: prepared.map_or_else(HashMap::new, |it| it.names().clone()),
            taken: HashSet::new(),
            uses: HashMap::new(),
            visited: HashSet::new(),
            statements: Vec::new(),
            section: String::new(),
            owner: String::new(),
            whole: None,
            home: None,
        }
    }

    fn names(&self) -> Names<'_> {
        Names {
            dag: self.dag,
            model: self.model,
            home: self.home.as_ref(),
            known: &self.spelled,
        }
    }

    /// Binds everything that the roots need and returns the statements.
    fn write(&mut self, owner: &str, roots: &[Id]) -> Vec<Statement> {
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
            _ => self
                .prepared
                .is_some_and(|prepared| prepared.field(id).is_some()),
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

    fn take_name(&mut self, id: Id) -> String {
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
        self.spelled.insert(id, name.clone());
        name
    }
}
