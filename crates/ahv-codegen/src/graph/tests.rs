//! The normal form keeps values, and has the shape that the emitter relies on.

use super::{Dag, Id, Node};
use crate::graph::passes::Passes;
use crate::testing::{
    Draw, LEAVES, NAMES, choices_of_passes, expr, model, quantity, value_of_expr, value_of_node,
};

#[test]
fn the_graph_keeps_values_whatever_passes_are_taken() {
    for passes in choices_of_passes() {
        let mut draw = Draw(7);
        let mut compared = 0;
        for _ in 0..400 {
            let (inner, text) = (draw.tree(3, &LEAVES), draw.tree(4, &NAMES));
            let tree = expr(&text);
            // A named quantity inside: its name must not change what the rest is worth.
            let named = quantity("q", &inner);
            let mut dag = Dag::new(&model(&named), &passes).unwrap();
            let id = dag.build(&tree, "test").unwrap();
            for _ in 0..3 {
                let mut at = draw.point();
                at.insert("q".to_owned(), value_of_expr(&expr(&inner), &at));
                let (expected, found) = (value_of_expr(&tree, &at), value_of_node(&dag, id, &at));
                if expected.is_finite() && expected.abs() < 1e6 {
                    compared += 1;
                    assert!(
                        (expected - found).abs() <= 1e-9 * (1.0 + expected.abs()),
                        "{text}: {expected} became {found} at {at:?} with {passes:?}"
                    );
                }
            }
        }
        assert!(compared > 600, "only {compared} comparisons");
    }
}

fn built(quantities: &[String], text: &str) -> (Dag, Id) {
    let mut dag = Dag::new(&model(&quantities.join(",")), &Passes::default()).unwrap();
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
    assert!(factors.iter().any(|&f| dag.quantities(f) == [0]));
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
    let mut dag = Dag::new(&model(""), &Passes::default()).unwrap();
    for (text, part) in [
        (r#""nowhere""#, "unknown name `nowhere`"),
        (r#"["tanh", "x.a", "x.b"]"#, "`tanh` with 2 arguments"),
        (r#"[1, 2]"#, "without an operator"),
    ] {
        let message = dag.build(&expr(text), "lift").unwrap_err().to_string();
        assert!(
            message.contains("`lift`") && message.contains(part),
            "{message}"
        );
    }
}
