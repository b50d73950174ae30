//! What is known while a body is written: who needs which value, what is bound, and under which name.

use std::collections::{HashMap, HashSet};

use super::given::Given;
use super::names::{Names, is_numbered};
use super::tree::{Expr, Source, Statement};
use crate::graph::{Dag, Id, Node};
use crate::ir;

/// Arguments and results of emitted functions: no value may hide one.
const RESERVED: [&str; 13] = [
    "x", "u", "p", "dw", "c", "i", "s", "n", "m", "h", "q", "result", "entries",
];

/// The struct that a function fills: its values have their names there.
pub(super) struct Target<'a> {
    pub(super) source: Source,
    pub(super) names: &'a HashMap<Id, String>,
}

/// What is known while a body is written.
pub(super) struct Scope<'a> {
    pub(super) dag: &'a mut Dag,
    pub(super) model: &'a ir::Model,
    pub(super) given: Given<'a>,
    target: Option<Target<'a>>,
    /// Names that only say whose part a value is, each with the reason.
    pub(super) numbered: Vec<(String, String)>,
    pub(super) bound: HashMap<Id, Expr>,
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
        Self::filling(dag, model, given, None)
    }

    /// The scope of a function that fills a struct.
    pub(super) fn filling(
        dag: &'a mut Dag,
        model: &'a ir::Model,
        given: Given<'a>,
        target: Option<Target<'a>>,
    ) -> Self {
        Self {
            dag,
            model,
            given,
            target,
            numbered: Vec::new(),
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
        let names = self.bound_in_order.iter();
        let names = names.map(|id| (*id, self.spelled[id].clone()));
        names.filter(|(_, name)| !is_numbered(name)).collect()
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
        if self.target.is_some() && !self.section.is_empty() {
            self.enter("Further values", "");
        }
        for &root in roots {
            self.whole = Some(root).filter(|_| roots.len() == 1);
            self.visit(root);
            if self.target.is_some() {
                self.bind(root);
            }
        }
        // A heading of nothing is none.
        while matches!(self.statements.last(), Some(Statement::Section(_))) {
            self.statements.pop();
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
        let unit = unit.unwrap_or_default();
        let statement = match self.take(id) {
            Expr::Component(source, field) => Statement::Set {
                source,
                field,
                value,
                unit,
            },
            Expr::Name(name) => Statement::Let { name, value, unit },
            _ => return,
        };
        self.statements.push(statement);
    }

    /// Fills fields with the arguments that they are.
    pub(super) fn handed_on(&self, leaves: &[Id]) -> Vec<Statement> {
        let target = self.target.as_ref();
        let set = |leaf: &Id| {
            let (target, Node::Leaf(kind, name)) = (target?, self.dag.node(*leaf)) else {
                return None;
            };
            Some(Statement::Set {
                source: target.source,
                field: target.names.get(leaf)?.clone(),
                value: Expr::Component(Source::Argument(*kind), name.clone()),
                unit: String::new(),
            })
        };
        leaves.iter().filter_map(set).collect()
    }

    /// A node's name or field from here on.
    pub(super) fn take(&mut self, id: Id) -> Expr {
        let target = self.target.as_ref();
        let field = target.and_then(|it| Some((it.source, it.names.get(&id)?.clone())));
        let (expr, name) = match field {
            Some((source, name)) => (Expr::Component(source, name.clone()), name),
            None => {
                let name = self.new_name(id);
                (Expr::Name(name.clone()), name)
            }
        };
        self.bound.insert(id, expr.clone());
        self.bound_in_order.push(id);
        self.spelled.insert(id, name);
        expr
    }

    fn new_name(&mut self, id: Id) -> String {
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
        if is_numbered(&name) {
            let reason = self.names().reason(id);
            self.numbered.push((name.clone(), reason));
        }
        self.taken.insert(name.clone());
        name
    }
}
