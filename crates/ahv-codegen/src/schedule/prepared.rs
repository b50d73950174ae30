//! The values that are computed from parameters once, in `prepare`.

use std::collections::{HashMap, HashSet};

use crate::graph::passes::Pass;
use crate::graph::{Dag, Id, Kind, Node};
use crate::ir;

use super::names::Names;

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
    /// Names that only say whose part a value is, each with the reason.
    pub(crate) numbered: Vec<(String, String)>,
    names: HashMap<Id, String>,
}

impl Prepared {
    /// Gathers what the functions of a model need of its parameters.
    ///
    /// `values` depend on parameters alone and are needed in any case, each by an owner.
    pub(crate) fn gather(
        dag: &mut Dag,
        model: &ir::Model,
        roots: &[(&str, &[Id])],
        values: &[(String, Id)],
    ) -> Self {
        let mut found = Self::default();
        let mut seen = HashSet::new();
        for (owner, ids) in roots {
            for &id in *ids {
                found.visit(dag, model, id, owner, &mut seen);
            }
        }
        for (owner, id) in values {
            if found.field(*id).is_none() {
                found.insert(dag, model, *id, owner);
            }
        }
        found
    }

    /// The fields by node.
    pub(crate) fn names(&self) -> &HashMap<Id, String> {
        &self.names
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
        let is_parameter = matches!(dag.node(id), Node::Leaf(Kind::Parameter, _));
        if is_parameter || (dag.is_parametric(id) && dag.has(Pass::Hoisting)) {
            return self.insert(dag, model, id, owner);
        }
        let owner = dag
            .quantities(id)
            .first()
            .map_or(owner, |&position| &model.quantities[position].name);
        for operand in dag.operands(id) {
            self.visit(dag, model, operand, owner, seen);
        }
    }

    fn insert(&mut self, dag: &Dag, model: &ir::Model, id: Id, owner: &str) {
        let name = self.unique_name(dag, model, id, owner);
        self.names.insert(id, name.clone());
        self.fields.push(Field { id, name });
    }

    fn unique_name(&mut self, dag: &Dag, model: &ir::Model, id: Id, owner: &str) -> String {
        let taken = |name: &str| self.fields.iter().any(|f| f.name == name);
        // A value of the model, whichever function needs it.
        let names = Names {
            dag,
            model,
            home: None,
            known: &self.names,
        };
        let own = match dag.node(id) {
            Node::Leaf(_, name) => Some(name.clone()),
            _ => None,
        };
        let mut free = [own, names.describe(id)].into_iter().flatten();
        if let Some(name) = free.find(|name| !taken(name)) {
            return name;
        }
        let numbers = (1..).map(|k| format!("{}_constant_{k}", owner.to_lowercase()));
        let mut free = numbers.filter(|name| !taken(name));
        let name = free.next().unwrap_or_default();
        let reason = names.reason(id);
        self.numbered.push((name.clone(), reason));
        name
    }
}
