//! Prints nodes as Rust expressions and counts their operations.

use crate::body::{Scope, Value};
use crate::dag::{Call, Id, Kind, Node};

/// Operations of a function as emitted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cost {
    pub(crate) additions: usize,
    pub(crate) multiplications: usize,
    pub(crate) divisions: usize,
    pub(crate) sin_cos: usize,
    pub(crate) exp: usize,
    pub(crate) sqrt: usize,
}

impl Cost {
    /// All operations, each counted as one.
    pub(crate) fn total(&self) -> usize {
        self.counted().iter().map(|(count, _)| count).sum()
    }

    fn counted(&self) -> [(usize, &'static str); 6] {
        [
            (self.additions, "addition"),
            (self.multiplications, "multiplication"),
            (self.divisions, "division"),
            (self.sin_cos, "sin_cos"),
            (self.exp, "exp"),
            (self.sqrt, "sqrt"),
        ]
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

/// A sum of this many addends is written one a line, so that a new one is one line of a diff.
const LISTED: usize = 3;
/// Longer addends are left to the formatter: one must stay on its line, indented.
const WIDEST: usize = 108;

#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Atom,
}

/// The expression that stands for a node in a scope: its name where it has one.
pub(crate) fn reference(scope: &mut Scope<'_>, id: Id) -> String {
    expression(scope, id).0
}

/// The definition of a node, whether or not it has a name.
pub(crate) fn definition(scope: &mut Scope<'_>, id: Id) -> Value {
    if let Node::Sum(terms) = scope.dag.node(id).clone() {
        let addends = spell_sum(scope, terms, scope.is_defined(id));
        if addends.len() >= LISTED && addends.iter().all(|a| a.chars().count() <= WIDEST) {
            return Value::Addends(addends);
        }
        return Value::Plain(addends.join(" "));
    }
    Value::Plain(spell(scope, id).0)
}

/// A number as a constant of the scalar.
pub(crate) fn literal(value: f64) -> String {
    match value {
        0.0 => "R::ZERO".to_owned(),
        1.0 => "R::ONE".to_owned(),
        2.0 => "R::TWO".to_owned(),
        0.5 => "R::HALF".to_owned(),
        _ => format!("R::from_f64({value:?})"),
    }
}

fn expression(scope: &mut Scope<'_>, id: Id) -> (String, Binding) {
    match scope.known(id) {
        Some(name) => (name, Binding::Atom),
        None => spell(scope, id),
    }
}

fn atom(scope: &mut Scope<'_>, id: Id) -> String {
    enclosed(scope, id, Binding::Atom)
}

fn enclosed(scope: &mut Scope<'_>, id: Id, least: Binding) -> String {
    let (text, binding) = expression(scope, id);
    if binding < least {
        format!("({text})")
    } else {
        text
    }
}

fn spell(scope: &mut Scope<'_>, id: Id) -> (String, Binding) {
    match scope.dag.node(id).clone() {
        Node::Number(value) => (literal(value), Binding::Atom),
        Node::Leaf(kind, name) => {
            scope.used.insert(kind);
            let argument = match kind {
                Kind::State => "x",
                Kind::Input => "u",
                Kind::Noise => "dw",
                Kind::Parameter => "p",
                Kind::Argument => {
                    scope.arguments.insert(name.clone());
                    return (name, Binding::Atom);
                }
            };
            (format!("{argument}.{name}"), Binding::Atom)
        }
        Node::Sum(terms) => (spell_sum(scope, terms, false).join(" "), Binding::Sum),
        Node::Product(coefficient, factors) => spell_product(scope, coefficient, &factors),
        Node::Power(base, -1) => {
            scope.cost.divisions += 1;
            (format!("{}.recip()", atom(scope, base)), Binding::Atom)
        }
        Node::Power(..) => {
            let steps = scope.dag.steps_of_power(id);
            scope.cost.multiplications += steps.len() - 1;
            let steps: Vec<String> = steps.into_iter().map(|step| atom(scope, step)).collect();
            (steps.join(" * "), Binding::Product)
        }
        Node::Call(call, argument) => {
            let function = match call {
                Call::Sin => "sin",
                Call::Cos => "cos",
                Call::Exp => "exp",
                Call::Sqrt => "sqrt",
            };
            match call {
                Call::Sin | Call::Cos => scope.cost.sin_cos += 1,
                Call::Exp => scope.cost.exp += 1,
                Call::Sqrt => scope.cost.sqrt += 1,
            }
            (
                format!("{}.{function}()", atom(scope, argument)),
                Binding::Atom,
            )
        }
    }
}

fn spell_sum(
    scope: &mut Scope<'_>,
    mut terms: Vec<(f64, Id)>,
    constant_first: bool,
) -> Vec<String> {
    // A sum reads best from a positive addend, a polynomial from its constant: a new monomial is then a line of its
    // own wherever it stands. Addition in another order is the same work.
    let positive = |&(coefficient, _): &(f64, Id)| coefficient > 0.0;
    let constant = terms
        .iter()
        .position(|term| constant_first && positive(term) && scope.dag.is_parametric(term.1));
    let positive = terms.iter().position(positive);
    if let Some(first) = constant.or(positive) {
        let lead = terms.remove(first);
        terms.insert(0, lead);
    }
    scope.cost.additions += terms.len() - 1;
    let mut addends = Vec::with_capacity(terms.len());
    for (position, (coefficient, id)) in terms.into_iter().enumerate() {
        let sign = match (position, coefficient < 0.0) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => "+ ",
            (_, true) => "- ",
        };
        let size = coefficient.abs();
        let addend = if scope.dag.is_one(id) {
            literal(size)
        } else if size == 1.0 {
            enclosed(scope, id, Binding::Product)
        } else {
            scope.cost.multiplications += 1;
            format!(
                "{} * {}",
                literal(size),
                enclosed(scope, id, Binding::Product)
            )
        };
        addends.push(format!("{sign}{addend}"));
    }
    addends
}

fn spell_product(scope: &mut Scope<'_>, coefficient: f64, factors: &[Id]) -> (String, Binding) {
    // A reciprocal that is not shared is a division where it stands, unless there is nothing else to divide.
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for &id in factors {
        let is_open = scope.known(id).is_none() && scope.dag.is_written_anew(id);
        match *scope.dag.node(id) {
            Node::Power(base, -1) if is_open => below.push((id, base)),
            _ => above.push(id),
        }
    }
    if above.is_empty() && coefficient.abs() == 1.0 {
        above.push(below.remove(0).0);
    }
    let mut parts: Vec<String> = above
        .into_iter()
        .map(|f| enclosed(scope, f, Binding::Product))
        .collect();
    if coefficient.abs() != 1.0 {
        parts.insert(0, literal(coefficient));
    } else if coefficient < 0.0 {
        parts[0].insert(0, '-');
    }
    scope.cost.multiplications += parts.len() - 1;
    scope.cost.divisions += below.len();
    let mut text = parts.join(" * ");
    for (_, base) in below {
        text += &format!(" / {}", atom(scope, base));
    }
    (text, Binding::Product)
}
