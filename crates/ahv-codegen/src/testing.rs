//! Small models and random expressions, and what those are worth by direct evaluation.

use std::collections::HashMap;

use crate::graph::passes::{Pass, Passes};
use crate::graph::{Dag, Id, Kind, Node};
use crate::ir::{Expr, Model};

/// A point: the values of leaves by their name with prefix, and of quantities by their name.
pub(crate) type Point = HashMap<String, f64>;

/// The leaves of random expressions.
pub(crate) const LEAVES: [&str; 6] = ["x.a", "x.b", "u.c", "p.d", "p.e", "p.f"];
/// The same and a named quantity.
pub(crate) const NAMES: [&str; 7] = ["x.a", "x.b", "u.c", "p.d", "p.e", "p.f", "q"];

/// A model with these quantities.
pub(crate) fn model(quantities: &str) -> Model {
    model_with(quantities, "")
}

/// A model with these quantities and functions.
pub(crate) fn model_with(quantities: &str, functions: &str) -> Model {
    let json = format!(
        r#"{{"name": "m", "title": "", "equations": "", "bases": {{}}, "quantities": [{quantities}], "functions": [{functions}],
        "note": null, "trim": {{"given": [], "sought": [], "equations": [], "moving": [], "shown": []}}, "modes": [],
        "defaults": {{"inputs": [], "outputs": []}}, "deviations": {{}}}}"#
    );
    serde_json::from_str(&json).unwrap()
}

/// A quantity as JSON.
pub(crate) fn quantity(name: &str, expr: &str) -> String {
    format!(
        r#"{{"name": "{name}", "symbol": "", "unit": "1", "doc": "", "equation": "", "section": "", "expr": {expr}}}"#
    )
}

/// An expression from JSON.
pub(crate) fn expr(json: &str) -> Expr {
    serde_json::from_str(json).unwrap()
}

/// What an expression is worth at a point.
pub(crate) fn value_of_expr(expr: &Expr, at: &Point) -> f64 {
    match expr {
        Expr::Number(value) => *value,
        Expr::Name(name) => at[name],
        Expr::Apply(items) => {
            let Expr::Name(op) = &items[0] else {
                panic!("an operator")
            };
            let v: Vec<f64> = items[1..].iter().map(|e| value_of_expr(e, at)).collect();
            match op.as_str() {
                "+" => v.iter().sum(),
                "*" => v.iter().product(),
                "-" => v[0] - v[1],
                "/" => v[0] / v[1],
                "neg" => -v[0],
                "pow" => v[0].powi(v[1] as i32),
                name => value_of_call(name, &v),
            }
        }
    }
}

/// What a function of this name is worth.
pub(crate) fn value_of_call(name: &str, arguments: &[f64]) -> f64 {
    match *arguments {
        [a] => match name {
            "sin" => a.sin(),
            "cos" => a.cos(),
            "tan" => a.tan(),
            "asin" => a.asin(),
            "atan" => a.atan(),
            "exp" => a.exp(),
            "tanh" => a.tanh(),
            "ln" => a.ln(),
            "sqrt" => a.sqrt(),
            "abs" => a.abs(),
            _ => panic!("{name}"),
        },
        [a, b] => match name {
            "atan2" => a.atan2(b),
            "powr" => a.powf(b),
            "min" => a.min(b),
            "max" => a.max(b),
            _ => panic!("{name}"),
        },
        [a, b, c, d] if name == "select" => {
            if a < b {
                c
            } else {
                d
            }
        }
        _ => panic!("{name}"),
    }
}

/// What a node of the graph is worth at a point.
pub(crate) fn value_of_node(dag: &Dag, id: Id, at: &Point) -> f64 {
    let value = |id: &Id| value_of_node(dag, *id, at);
    match dag.node(id) {
        Node::Number(value) => *value,
        Node::Leaf(kind, name) => {
            let prefix = match kind {
                Kind::State => "x",
                Kind::Input => "u",
                Kind::Noise => "w",
                Kind::Parameter => "p",
                Kind::Argument => "t",
            };
            at[&format!("{prefix}.{name}")]
        }
        Node::Sum(terms) => terms.iter().map(|(c, t)| c * value(t)).sum(),
        Node::Product(c, factors) => c * factors.iter().map(value).product::<f64>(),
        Node::Power(base, exponent) => value(base).powi(*exponent),
        Node::Call(call, arguments) => {
            let arguments: Vec<f64> = arguments.iter().map(value).collect();
            value_of_call(call.name(), &arguments)
        }
    }
}

/// A small generator of numbers: the tests need no more.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }

    fn one_of<'a>(&mut self, items: &[&'a str]) -> &'a str {
        items[self.below(items.len() as u64) as usize]
    }

    /// An expression of these names as JSON.
    pub(crate) fn tree(&mut self, depth: u32, names: &[&str]) -> String {
        if depth == 0 || self.below(6) == 0 {
            return match self.below(4) {
                0 => self.one_of(&["0", "1", "2", "0.5", "-3"]).to_owned(),
                _ => format!("\"{}\"", self.one_of(names)),
            };
        }
        let mut part = || self.tree(depth - 1, names);
        let (a, b, c) = (part(), part(), part());
        match self.below(13) {
            0 => format!(r#"["+", {a}, {b}, {c}]"#),
            1 => format!(r#"["-", {a}, {b}]"#),
            2 | 3 => format!(r#"["*", {a}, {b}]"#),
            // A denominator that is away from zero.
            4 => format!(r#"["/", {a}, ["+", 2, ["*", {b}, {b}]]]"#),
            5 => format!(r#"["neg", {a}]"#),
            6 => format!(r#"["pow", {a}, {}]"#, 2 + self.below(3)),
            7 => format!(r#"["sin", {a}]"#),
            8 => format!(r#"["cos", {a}]"#),
            9 => format!(r#"["tanh", {a}]"#),
            10 => format!(r#"["max", {a}, {b}]"#),
            // Without a jump: another order of rounding would take the other branch.
            11 => format!(r#"["select", {a}, {b}, {a}, {b}]"#),
            _ => self.polynomial(names, &a),
        }
    }

    /// A polynomial of one variable, perhaps a long one, and something else.
    fn polynomial(&mut self, names: &[&str], rest: &str) -> String {
        let variable = self.one_of(names);
        let mut addends = vec![rest.to_owned()];
        for degree in 0..3 + self.below(6) {
            let coefficient = self.one_of(&["\"p.d\"", "\"p.e\"", "-0.5", "0"]);
            addends.push(format!(
                r#"["*", {coefficient}, ["pow", "{variable}", {degree}]]"#
            ));
        }
        format!(r#"["+", {}]"#, addends.join(", "))
    }

    /// A point of the leaves.
    pub(crate) fn point(&mut self) -> Point {
        LEAVES
            .iter()
            .map(|name| ((*name).to_owned(), self.below(4001) as f64 / 1000.0 - 2.0))
            .collect()
    }
}

/// All passes, none, and all but each.
pub(crate) fn choices_of_passes() -> Vec<Passes> {
    let singles = Pass::ALL.map(|pass| Passes::without(&[pass]));
    [Passes::default(), Passes::none()]
        .into_iter()
        .chain(singles)
        .collect()
}
