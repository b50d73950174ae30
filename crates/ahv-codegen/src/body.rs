//! The statements of a function: which values get a name, in which order they stand.

mod sin_cos;

use std::collections::{BTreeSet, HashMap, HashSet};

use crate::dag::{Dag, Id, Kind, Node};
use crate::format::{ADDENDS, SECTION, TRAILING};
use crate::ir;
use crate::names::Names;
use crate::prepared::Prepared;
use crate::print::{Cost, definition};

/// A statement of a function body.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Statement {
    /// A heading.
    Section(String),
    /// `let name = value;` with a unit where there is one to tell.
    Let {
        name: String,
        value: Value,
        unit: String,
    },
}

impl Statement {
    /// The statement as source text; comments and listed sums travel as the formatter's markers.
    pub(crate) fn source(&self) -> String {
        match self {
            Self::Section(heading) => format!("{SECTION}({heading:?});"),
            Self::Let { name, value, unit } => {
                let value = value.source();
                // A pure number has no unit to tell.
                let trailing = match unit.as_str() {
                    "" | "1" => String::new(),
                    unit => format!(" {TRAILING}({unit:?});"),
                };
                format!("let {name} = {value};{trailing}")
            }
        }
    }
}

/// The right-hand side of a `let`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Value {
    /// An expression.
    Plain(String),
    /// The addends of a sum, signs included, to be written one a line as a table of coefficients is.
    Addends(Vec<String>),
}

impl Value {
    /// The value as source text, with the formatter's marker where it is listed.
    pub(crate) fn source(&self) -> String {
        match self {
            Self::Plain(text) => text.clone(),
            Self::Addends(addends) => format!("{ADDENDS}({:?})", addends.join("|")),
        }
    }

    /// The value as one expression.
    pub(crate) fn text(&self) -> String {
        match self {
            Self::Plain(text) => text.clone(),
            Self::Addends(addends) => addends.join(" "),
        }
    }
}

/// What is known while a body is written.
pub(crate) struct Scope<'a> {
    pub(crate) dag: &'a mut Dag,
    pub(crate) cost: Cost,
    /// Arguments that the body refers to.
    pub(crate) used: BTreeSet<Kind>,
    /// Those of them that are scalars of their own, such as a time.
    pub(crate) arguments: BTreeSet<String>,
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
    /// The scope of a function; without `prepared` it is that of `prepare` itself.
    pub(crate) fn new(
        dag: &'a mut Dag,
        model: &'a ir::Model,
        prepared: Option<&'a Prepared>,
    ) -> Self {
        Self {
            dag,
            cost: Cost::default(),
            used: BTreeSet::new(),
            arguments: BTreeSet::new(),
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

    /// The name of a node, where it has one in this scope.
    pub(crate) fn known(&mut self, id: Id) -> Option<String> {
        if let Some(name) = self.bound.get(&id) {
            return Some(name.clone());
        }
        let field = self.prepared?.field(id)?;
        self.used.insert(Kind::Parameter);
        Some(format!("p.{field}"))
    }

    /// Whether a node is a quantity that an equation defines; derivatives have none.
    pub(crate) fn is_defined(&self, id: Id) -> bool {
        let quantity = self.names().quantity(id);
        quantity.is_some_and(|position| !self.model.quantities[position].equation.is_empty())
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
    pub(crate) fn write(&mut self, owner: &str, roots: &[Id]) -> Vec<Statement> {
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
        if let Some((sin, cos, argument)) = self.sin_cos(id) {
            return self.bind_pair(sin, cos, argument);
        }
        let value = definition(self, id);
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

#[cfg(test)]
mod tests;
