//! The statements of a function: which values get a name, in which order they stand.

use std::collections::{BTreeSet, HashMap, HashSet};

use crate::dag::{Call, Dag, Id, Kind, Node};
use crate::format::{ADDENDS, SECTION, TRAILING};
use crate::ir;
use crate::names::describe;
use crate::print::{Cost, definition, reference};

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

/// A value of `Prepared`: it depends on parameters alone.
#[derive(Debug)]
pub(crate) struct Field {
    pub(crate) id: Id,
    pub(crate) name: String,
}

/// The fields of `Prepared`, gathered over all functions of a model.
#[derive(Default)]
pub(crate) struct Prepared {
    pub(crate) fields: Vec<Field>,
    names: HashMap<Id, String>,
}

impl Prepared {
    /// Gathers what the functions of a model need of its parameters.
    pub(crate) fn gather(dag: &mut Dag, model: &ir::Model, roots: &[(String, Vec<Id>)]) -> Self {
        let mut found = Self::default();
        let mut seen = HashSet::new();
        for (owner, ids) in roots {
            for &id in ids {
                found.visit(dag, model, id, owner, &mut seen);
            }
        }
        found
    }

    /// The field that holds a node.
    pub(crate) fn field(&self, id: Id) -> Option<&str> {
        self.names.get(&id).map(String::as_str)
    }

    fn visit(
        &mut self,
        dag: &mut Dag,
        model: &ir::Model,
        id: Id,
        owner: &str,
        seen: &mut HashSet<Id>,
    ) {
        if !seen.insert(id) || matches!(dag.node(id), Node::Number(_)) {
            return;
        }
        if dag.is_parametric(id) {
            let name = self.unique_name(dag, model, id, owner);
            self.names.insert(id, name.clone());
            self.fields.push(Field { id, name });
            return;
        }
        let owner = dag
            .name(id)
            .map_or(owner, |position| &model.quantities[position].name);
        for operand in dag.operands(id) {
            self.visit(dag, model, operand, owner, seen);
        }
    }

    fn unique_name(&self, dag: &Dag, model: &ir::Model, id: Id, owner: &str) -> String {
        let taken = |name: &str| self.fields.iter().any(|f| f.name == name);
        match describe(dag, model, id) {
            Some(name) if !taken(&name) => name,
            _ => (1..)
                .map(|k| format!("{owner}_constant_{k}"))
                .find(|name| !taken(name))
                .unwrap_or_default(),
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
    taken: HashSet<String>,
    uses: HashMap<Id, usize>,
    visited: HashSet<Id>,
    statements: Vec<Statement>,
    section: String,
    owner: String,
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
            taken: HashSet::new(),
            uses: HashMap::new(),
            visited: HashSet::new(),
            statements: Vec::new(),
            section: String::new(),
            owner: String::new(),
        }
    }

    /// The name of a node, where it has one in this scope.
    pub(crate) fn known(&mut self, id: Id) -> Option<String> {
        if let Some(name) = self.bound.get(&id) {
            return Some(name.clone());
        }
        let field = self.prepared?.names.get(&id)?;
        self.used.insert(Kind::Parameter);
        Some(format!("p.{field}"))
    }

    /// Whether a node is a quantity that an equation defines; derivatives have none.
    pub(crate) fn is_defined(&self, id: Id) -> bool {
        let name = self.dag.name(id);
        name.is_some_and(|position| !self.model.quantities[position].equation.is_empty())
    }

    /// Binds everything that the roots need and returns the statements.
    pub(crate) fn write(&mut self, owner: &str, roots: &[Id]) -> Vec<Statement> {
        let mut counted = HashSet::new();
        for &root in roots {
            self.count(root, &mut counted);
        }
        let mut needed: Vec<(usize, Id)> = counted
            .iter()
            .filter_map(|&id| Some((self.dag.name(id)?, id)))
            .collect();
        needed.sort_unstable();
        for (position, id) in needed {
            if self.visited.contains(&id) {
                continue;
            }
            let quantity = &self.model.quantities[position];
            self.owner.clone_from(&quantity.name);
            self.enter(&quantity.section, &quantity.equation);
            self.visit(id);
        }
        self.owner = owner.to_owned();
        for &root in roots {
            self.visit(root);
        }
        std::mem::take(&mut self.statements)
    }

    fn is_frontier(&self, id: Id) -> bool {
        match self.dag.node(id) {
            Node::Number(_) | Node::Leaf(..) => true,
            _ => self.prepared.is_some() && self.dag.is_parametric(id),
        }
    }

    fn count(&mut self, id: Id, counted: &mut HashSet<Id>) {
        *self.uses.entry(id).or_default() += 1;
        if self.is_frontier(id) || !counted.insert(id) {
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
        let shared = self.uses.get(&id).is_some_and(|&uses| uses > 1);
        let costly = matches!(self.dag.node(id), Node::Call(..) | Node::Power(..));
        if self.dag.name(id).is_some() || shared || costly {
            self.bind(id);
        }
    }

    fn bind(&mut self, id: Id) {
        if self.bound.contains_key(&id) {
            return;
        }
        if let Node::Call(call @ (Call::Sin | Call::Cos), argument) = *self.dag.node(id) {
            let other = if call == Call::Sin {
                Call::Cos
            } else {
                Call::Sin
            };
            if let Some(twin) = self
                .dag
                .find_call(other, argument)
                .filter(|t| self.uses.contains_key(t))
            {
                let (sin, cos) = if call == Call::Sin {
                    (id, twin)
                } else {
                    (twin, id)
                };
                return self.bind_pair(sin, cos, argument);
            }
        }
        let value = definition(self, id);
        let unit = self
            .dag
            .name(id)
            .map(|position| self.model.quantities[position].unit.clone());
        let name = self.take_name(id);
        self.statements.push(Statement::Let {
            name,
            value,
            unit: unit.unwrap_or_default(),
        });
    }

    fn bind_pair(&mut self, sin: Id, cos: Id, argument: Id) {
        let argument = reference(self, argument);
        self.cost.sin_cos += 1;
        let (sin, cos) = (self.take_name(sin), self.take_name(cos));
        self.statements.push(Statement::Let {
            name: format!("({sin}, {cos})"),
            value: Value::Plain(if argument.contains(' ') {
                format!("({argument}).sin_cos()")
            } else {
                format!("{argument}.sin_cos()")
            }),
            unit: String::new(),
        });
    }

    fn take_name(&mut self, id: Id) -> String {
        let described =
            describe(self.dag, self.model, id).filter(|name| !self.taken.contains(name));
        let name = described.unwrap_or_else(|| {
            (1..)
                .map(|k| format!("{}_term_{k}", self.owner))
                .find(|name| !self.taken.contains(name))
                .unwrap_or_default()
        });
        self.taken.insert(name.clone());
        self.bound.insert(id, name.clone());
        name
    }
}
