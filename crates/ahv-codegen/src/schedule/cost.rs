//! The operations of a function as emitted.

use std::collections::BTreeMap;

use super::tree::{Body, Expr, Operation, Statement};
use crate::call::Call;

/// Operations by kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cost {
    pub(crate) additions: usize,
    pub(crate) multiplications: usize,
    pub(crate) divisions: usize,
    pub(crate) sin_cos: usize,
    /// Calls of the other functions, by their names.
    pub(crate) calls: BTreeMap<&'static str, usize>,
}

impl Cost {
    /// Counts the operation of an expression, that of its parts not.
    fn add(&mut self, expr: &Expr) {
        match expr {
            Expr::Number(_) | Expr::Component(..) | Expr::Name(_) | Expr::Negative(_) => {}
            Expr::Sum(addends) => self.additions += addends.len() - 1,
            Expr::Product(factors) => {
                let over = factors.iter().filter(|(it, _)| *it == Operation::Over);
                let over = over.count();
                self.divisions += over;
                self.multiplications += factors.len() - over - 1;
            }
            Expr::Reciprocal(_) => self.divisions += 1,
            Expr::Call(Call::Sin | Call::Cos, _) => self.sin_cos += 1,
            Expr::Call(call, _) => *self.calls.entry(call.name()).or_default() += 1,
        }
    }

    /// All operations, each counted as one.
    pub(crate) fn total(&self) -> usize {
        self.counted().iter().map(|(count, _)| count).sum()
    }

    fn counted(&self) -> Vec<(usize, &'static str)> {
        let mut counted = vec![
            (self.additions, "addition"),
            (self.multiplications, "multiplication"),
            (self.divisions, "division"),
            (self.sin_cos, "sin_cos"),
        ];
        counted.extend(self.calls.iter().map(|(&word, &count)| (count, word)));
        counted
    }

    /// One line: `71 operations: 30 additions, 35 multiplications, 1 division, …`.
    pub(crate) fn describe(&self) -> String {
        let (parts, total) = (self.counted(), self.total());
        let listed: Vec<String> = parts
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|&(count, word)| {
                let plural = if count > 1 && word.ends_with("ion") {
                    "s"
                } else {
                    ""
                };
                format!("{count} {word}{plural}")
            })
            .collect();
        match total {
            0 => "no operations".to_owned(),
            1 => format!("1 operation: {}", listed.join(", ")),
            _ => format!("{total} operations: {}", listed.join(", ")),
        }
    }
}

impl std::ops::AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.additions += other.additions;
        self.multiplications += other.multiplications;
        self.divisions += other.divisions;
        self.sin_cos += other.sin_cos;
        for (word, count) in other.calls {
            *self.calls.entry(word).or_default() += count;
        }
    }
}

impl Body {
    /// The operations.
    pub(crate) fn cost(&self) -> Cost {
        let mut cost = Cost::default();
        self.walk(&mut |expr| cost.add(expr));
        let pairs = self.statements.iter();
        cost.sin_cos += pairs
            .filter(|it| matches!(it, Statement::SinCos { .. }))
            .count();
        cost
    }
}
