//! Sine and cosine of one angle, computed together.

use super::{Scope, Statement, Value};
use crate::dag::{Call, Id, Node};
use crate::passes::Pass;
use crate::print::reference;

impl Scope<'_> {
    /// The sine, the cosine and their angle, where a node is one of the two and the body needs the other as well.
    pub(super) fn sin_cos(&self, id: Id) -> Option<(Id, Id, Id)> {
        let Node::Call(call, argument) = *self.dag.node(id) else {
            return None;
        };
        let twin = match call {
            Call::Sin => Call::Cos,
            Call::Cos => Call::Sin,
            Call::Exp | Call::Sqrt => return None,
        };
        let twin = self.dag.find_call(twin, argument)?;
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
    pub(super) fn bind_pair(&mut self, sin: Id, cos: Id, argument: Id) {
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
}
