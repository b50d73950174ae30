//! The evaluator against direct arithmetic.

use super::*;
use crate::testing::{expr, model, quantity};

fn value(model: &Model, text: &str, leaf: impl Fn(&str) -> f64) -> f64 {
    let root = expr(text);
    let tape = Tape::compile(model, [&root]).expect("a tape");
    let values: Vec<f64> = tape.leaves().iter().map(|name| leaf(name)).collect();
    let mut outputs = Vec::new();
    tape.run(&values, &mut Vec::new(), &mut outputs);
    outputs[0]
}

#[test]
fn operators_are_those_of_f64() {
    let leaf = |name: &str| if name == "x.a" { 0.3 } else { -1.7 };
    let (a, b) = (0.3_f64, -1.7_f64);
    let m = model("");
    let cases = [
        (r#"["+", "x.a", "u.b", 2, 0.1]"#, a + b + 2.0 + 0.1),
        (r#"["*", "x.a", "u.b", 3]"#, a * b * 3.0),
        (r#"["-", "x.a", "u.b"]"#, a - b),
        (r#"["/", "x.a", "u.b"]"#, a / b),
        (r#"["neg", "x.a"]"#, -a),
        (r#"["pow", "u.b", 3]"#, b * b * b),
        (r#"["pow", "u.b", -2]"#, 1.0 / (b * b)),
        (r#"["pow", "u.b", 5]"#, (b * b) * (b * b) * b),
        (r#"["sin", "x.a"]"#, Real::sin(a)),
        (r#"["cos", "x.a"]"#, Real::cos(a)),
        (r#"["exp", "u.b"]"#, Real::exp(b)),
        (r#"["sqrt", "x.a"]"#, Real::sqrt(a)),
        (r#"["tan", "x.a"]"#, Real::tan(a)),
        (r#"["asin", "x.a"]"#, Real::asin(a)),
        (r#"["atan", "u.b"]"#, Real::atan(b)),
        (r#"["atan2", "x.a", "u.b"]"#, Real::atan2(a, b)),
        (r#"["tanh", "u.b"]"#, Real::tanh(b)),
        (r#"["ln", "x.a"]"#, Real::ln(a)),
        (r#"["powr", "x.a", "u.b"]"#, Real::powr(a, b)),
        (r#"["abs", "u.b"]"#, 1.7),
        (r#"["min", "x.a", "u.b"]"#, b),
        (r#"["max", "x.a", "u.b"]"#, a),
        (r#"["select", "u.b", "x.a", 3, 4]"#, 3.0),
        (r#"["select", "x.a", "u.b", 3, ["neg", "x.a"]]"#, -a),
    ];
    for (text, expected) in cases {
        assert_eq!(
            value(&m, text, leaf).to_bits(),
            expected.to_bits(),
            "{text}"
        );
    }
}

#[test]
fn quantities_are_computed_once_and_by_name() {
    let m = model(
        &[
            quantity("square", r#"["pow", "x.a", 2]"#),
            quantity("sum", r#"["+", "square", "square", "p.c"]"#),
        ]
        .join(","),
    );
    let root = expr(r#"["*", "sum", "square"]"#);
    let tape = Tape::compile(&m, [&root]).expect("a tape");
    // Two leaves, the square, two additions, the product.
    assert_eq!(tape.operations.len(), 6);
    let leaf = |name: &str| if name == "x.a" { 3.0 } else { 0.5 };
    assert_eq!(value(&m, r#"["*", "sum", "square"]"#, leaf), 18.5 * 9.0);
}

#[test]
fn fixed_leaves_become_constants() {
    let root = expr(r#"["+", ["*", ["sin", "p.c"], ["+", "p.c", 1]], "x.a"]"#);
    let tape = Tape::compile(&model(""), [&root]).expect("a tape");
    let fixed = tape.fixed(|leaf| leaf.starts_with("p.").then_some(0.25));
    assert_eq!(fixed.leaves(), ["x.a"]);
    let mut outputs = Vec::new();
    fixed.run(&[2.0], &mut Vec::new(), &mut outputs);
    assert_eq!(outputs, [Real::sin(0.25) * (0.25 + 1.0) + 2.0]);
}

#[test]
fn one_output_alone_keeps_the_leaves() {
    let roots = [expr(r#"["*", "x.a", "x.b"]"#), expr(r#"["sin", "x.b"]"#)];
    let tape = Tape::compile(&model(""), &roots).expect("a tape");
    let alone = tape.only(1);
    assert_eq!(alone.leaves(), tape.leaves());
    assert!(!alone.depends_on(0) && alone.depends_on(1));
    let mut outputs = Vec::new();
    alone.run(&[7.0, 0.5], &mut Vec::new(), &mut outputs);
    assert_eq!(outputs, [Real::sin(0.5)]);
}

#[test]
fn what_cannot_be_evaluated_is_named() {
    for (text, said) in [
        (r#"["cot", "x.a"]"#, "`cot`"),
        (r#""nobody""#, "`nobody`"),
        (r#"["/", 1]"#, "`/`"),
    ] {
        let root = expr(text);
        let error = Tape::compile(&model(""), [&root]).expect_err("a fault");
        assert!(error.to_string().contains(said), "{error}");
    }
}
