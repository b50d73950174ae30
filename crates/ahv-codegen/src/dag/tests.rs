//! The normal form keeps values, and has the shape that the emitter relies on.

use std::collections::HashMap;

use super::{Call, Dag, Id, Kind, Node};
use crate::ir::{Expr, Model};

const LEAVES: [&str; 6] = ["x.a", "x.b", "u.c", "p.d", "p.e", "p.f"];

fn model(quantities: &str) -> Model {
    let json = format!(
        r#"{{"name": "m", "title": "", "equations": "", "bases": {{}}, "functions": [], "quantities": [{quantities}]}}"#
    );
    serde_json::from_str(&json).unwrap()
}

fn quantity(name: &str, expr: &str) -> String {
    format!(
        r#"{{"name": "{name}", "symbol": "", "unit": "1", "doc": "", "equation": "", "section": "", "expr": {expr}}}"#
    )
}

fn expr(json: &str) -> Expr {
    serde_json::from_str(json).unwrap()
}

fn leaf(name: &str, at: &HashMap<String, f64>) -> f64 {
    at[name]
}

fn value_of_expr(expr: &Expr, at: &HashMap<String, f64>) -> f64 {
    match expr {
        Expr::Number(value) => *value,
        Expr::Name(name) => leaf(name, at),
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
                "sin" => v[0].sin(),
                "cos" => v[0].cos(),
                "exp" => v[0].exp(),
                other => panic!("{other}"),
            }
        }
    }
}

fn value_of_node(dag: &Dag, id: Id, at: &HashMap<String, f64>) -> f64 {
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
            leaf(&format!("{prefix}.{name}"), at)
        }
        Node::Sum(terms) => terms.iter().map(|(c, t)| c * value(t)).sum(),
        Node::Product(c, factors) => c * factors.iter().map(value).product::<f64>(),
        Node::Power(base, exponent) => value(base).powi(*exponent),
        Node::Call(Call::Sin, a) => value(a).sin(),
        Node::Call(Call::Cos, a) => value(a).cos(),
        Node::Call(Call::Exp, a) => value(a).exp(),
        Node::Call(Call::Sqrt, a) => value(a).sqrt(),
    }
}

/// A small generator of numbers: the tests need no more.
struct Draw(u64);

impl Draw {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }

    fn tree(&mut self, depth: u32) -> String {
        if depth == 0 || self.below(6) == 0 {
            return match self.below(4) {
                0 => ["0", "1", "2", "0.5", "-3"][self.below(5) as usize].to_owned(),
                _ => format!("\"{}\"", LEAVES[self.below(6) as usize]),
            };
        }
        let mut part = || self.tree(depth - 1);
        let (a, b, c) = (part(), part(), part());
        match self.below(9) {
            0 => format!(r#"["+", {a}, {b}, {c}]"#),
            1 => format!(r#"["-", {a}, {b}]"#),
            2 | 3 => format!(r#"["*", {a}, {b}]"#),
            // A denominator that is away from zero.
            4 => format!(r#"["/", {a}, ["+", 2, ["*", {b}, {b}]]]"#),
            5 => format!(r#"["neg", {a}]"#),
            6 => format!(r#"["pow", {a}, {}]"#, 2 + self.below(3)),
            7 => format!(r#"["sin", {a}]"#),
            _ => format!(r#"["cos", {a}]"#),
        }
    }

    fn point(&mut self) -> HashMap<String, f64> {
        LEAVES
            .iter()
            .map(|name| ((*name).to_owned(), self.below(4000) as f64 / 1000.0 - 2.0))
            .collect()
    }
}

#[test]
fn the_normal_form_keeps_values() {
    let mut draw = Draw(7);
    let mut compared = 0;
    for _ in 0..2000 {
        let text = draw.tree(4);
        let tree = expr(&text);
        // A named quantity inside: its name must not change what the rest is worth.
        let named = quantity("q", &draw.tree(3));
        let mut dag = Dag::new(&model(&named)).unwrap();
        let id = dag.build(&tree, "test").unwrap();
        for _ in 0..3 {
            let at = draw.point();
            let (expected, found) = (value_of_expr(&tree, &at), value_of_node(&dag, id, &at));
            if expected.is_finite() && expected.abs() < 1e6 {
                compared += 1;
                assert!(
                    (expected - found).abs() <= 1e-9 * (1.0 + expected.abs()),
                    "{text}: {expected} became {found} at {at:?}"
                );
            }
        }
    }
    assert!(compared > 3000, "only {compared} comparisons");
}

fn built(quantities: &[String], text: &str) -> (Dag, Id) {
    let mut dag = Dag::new(&model(&quantities.join(","))).unwrap();
    let id = dag.build(&expr(text), "test").unwrap();
    (dag, id)
}

#[test]
fn equal_values_are_one_node() {
    let (mut dag, first) = built(&[], r#"["*", "x.a", ["+", "x.b", "p.d"]]"#);
    let second = dag
        .build(&expr(r#"["*", ["+", "p.d", "x.b"], "x.a"]"#), "test")
        .unwrap();
    assert_eq!(first, second);
}

#[test]
fn like_terms_meet() {
    // The derivative of a cube, as it comes from the product rule.
    let (mut dag, id) = built(
        &[],
        r#"["+", ["pow", "x.a", 2], ["*", "x.a", ["*", 2, "x.a"]]]"#,
    );
    let three = dag
        .build(&expr(r#"["*", 3, ["pow", "x.a", 2]]"#), "test")
        .unwrap();
    assert_eq!(id, three);
}

#[test]
fn divisions_share_a_reciprocal() {
    let (dag, id) = built(&[], r#"["+", ["/", "x.b", "x.a"], ["/", "u.c", "x.a"]]"#);
    let Node::Product(_, factors) = dag.node(id) else {
        panic!("{:?}", dag.node(id))
    };
    assert!(matches!(dag.node(factors[0]), Node::Power(_, -1)));
    assert!(matches!(dag.node(factors[1]), Node::Sum(terms) if terms.len() == 2));
}

#[test]
fn what_depends_on_parameters_stands_together() {
    let (dag, id) = built(&[], r#"["*", ["*", "p.d", "x.a"], ["/", "p.e", "p.f"]]"#);
    let Node::Product(_, factors) = dag.node(id) else {
        panic!("{:?}", dag.node(id))
    };
    let fixed: Vec<_> = factors.iter().filter(|&&f| dag.is_parametric(f)).collect();
    assert_eq!((factors.len(), fixed.len()), (2, 1));
}

#[test]
fn a_named_product_is_found_inside_a_larger_one() {
    let force = quantity("force", r#"["*", "x.a", "x.b"]"#);
    let (dag, id) = built(&[force], r#"["*", "x.a", ["*", "u.c", "x.b"]]"#);
    let Node::Product(_, factors) = dag.node(id) else {
        panic!("{:?}", dag.node(id))
    };
    assert!(factors.iter().any(|&f| dag.name(f) == Some(0)));
}

#[test]
fn polynomials_of_states_keep_their_terms() {
    let (dag, id) = built(
        &[],
        r#"["+", ["*", "p.d", ["pow", "x.a", 2]], ["*", "p.e", "x.a"]]"#,
    );
    assert!(matches!(dag.node(id), Node::Sum(terms) if terms.len() == 2));
}

#[test]
fn faults_of_an_ir_are_named() {
    let mut dag = Dag::new(&model("")).unwrap();
    for (text, part) in [
        (r#""nowhere""#, "unknown name `nowhere`"),
        (r#"["tanh", "x.a"]"#, "`tanh` with 1 arguments"),
        (r#"[1, 2]"#, "without an operator"),
    ] {
        let message = dag.build(&expr(text), "lift").unwrap_err().to_string();
        assert!(
            message.contains("`lift`") && message.contains(part),
            "{message}"
        );
    }
}
