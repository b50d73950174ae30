//! Sine and cosine of one angle, computed together.

use super::scope::Scope;
use super::tree::Statement;
use crate::call::Call;
use crate::graph::passes::Pass;
use crate::graph::{Id, Node};

impl Scope<'_> {
    /// The sine, the cosine and their angle, where a node is one of the two and the body needs the other as well.
    pub(super) fn sin_cos(&self, id: Id) -> Option<(Id, Id, Id)> {
        let Node::Call(call, arguments) = self.dag.node(id) else {
            return None;
        };
        let &[argument] = arguments.as_slice() else {
            return None;
        };
        let twin = match call {
            Call::Sin => Call::Cos,
            Call::Cos => Call::Sin,
            _ => return None,
        };
        let twin = self.dag.find_call(twin, &[argument])?;
        let is_open = self.uses.contains_key(&twin) && !self.bound.contains_key(&twin);
        if !is_open || !self.dag.has(Pass::SinCos) {
            return None;
        }
        Some(match call {
            Call::Sin => (id, twin, argument),
            _ => (twin, id, argument),
        })
    }

    /// Binds both in one statement.
    pub(super) fn bind_pair(&mut self, sin: Id, cos: Id, angle: Id) {
        let angle = self.reference(angle);
        let (sin, cos) = (self.take(sin), self.take(cos));
        self.statements.push(Statement::SinCos { sin, cos, angle });
    }
}
