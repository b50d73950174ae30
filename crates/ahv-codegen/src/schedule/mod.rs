//! From the graph to statements: which values get a name, in which order they stand.

mod cost;
pub(crate) mod effect;
mod expressions;
pub(crate) mod given;
mod names;
pub(crate) mod pieces;
mod prepared;
pub(crate) mod program;
mod scope;
mod sin_cos;
pub(crate) mod stages;
pub(crate) mod tree;

use crate::graph::{Dag, Id};
use crate::ir;

pub(crate) use cost::Cost;
pub(crate) use prepared::Prepared;

use given::Given;
use scope::Scope;
use tree::Body;

/// What a function of this name does that computes the roots; without anything given it is `prepare` itself.
pub(crate) fn body(
    dag: &mut Dag,
    model: &ir::Model,
    given: Given<'_>,
    owner: &str,
    roots: &[Id],
) -> Body {
    let mut scope = Scope::new(dag, model, given);
    let statements = scope.write(owner, roots);
    let results = roots.iter().map(|&id| scope.reference(id)).collect();
    Body {
        statements,
        results,
        numbered: scope.numbered,
    }
}
