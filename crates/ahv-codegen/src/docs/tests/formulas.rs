//! Expressions as LaTeX.

use super::super::functions::paper_symbol;
use super::super::latex::{Printer, Style};
use super::super::lines::{equation, listed};
use super::super::symbol::{Shape, shape};
use super::super::typeset::signed;
use super::document;
use crate::ir::Expr;

fn printed(text: &str, depth: usize) -> String {
    let document = document();
    let printer = Printer::new(&document.models[0], &document);
    let expr: Expr = serde_json::from_str(text).expect("an expression");
    let tex = printer.expression(&expr, Style::expanded(depth));
    signed(&tex.expect("a formula"))
}

#[test]
fn operators_become_fractions_powers_and_sums() {
    for (expr, latex) in [
        (
            r#"["/", ["*", "x.speed", "u.push"], "p.m"]"#,
            r"\frac{V \phi}{m}",
        ),
        (
            r#"["*", ["*", 0.5, "p.m"], ["pow", "x.speed", 2]]"#,
            r"\tfrac{1}{2} m V^2",
        ),
        (r#"["*", "x.speed", ["pow", "x.speed", 2]]"#, "V^3"),
        (
            r#"["-", "x.speed", ["-", "u.push", "p.m"]]"#,
            r"V - \phi + m",
        ),
        (r#"["neg", ["+", "x.speed", "u.push"]]"#, r"-V - \phi"),
        (r#"["*", ["sin", "x.angle"], "x.speed"]"#, r"V \sin \alpha"),
        (r#"["pow", ["sin", "x.angle"], 2]"#, r"\sin^2 \alpha"),
        (
            r#"["pow", "p.c_l_angle", 2]"#,
            r"\left( C_L^{\alpha} \right)^2",
        ),
        (
            r#"["exp", ["/", ["neg", "x.speed"], "p.m"]]"#,
            r"\exp\left( -\frac{V}{m} \right)",
        ),
        (r#"["pow", ["exp", ["neg", "x.speed"]], 2]"#, r"e^{-2\, V}"),
        (r#"["pow", ["sqrt", ["+", 1, "p.m"]], 2]"#, "1 + m"),
        (
            r#"["*", "x.speed", ["+", 1, ["*", "p.m", ["+", 1, "u.push"]]]]"#,
            r"V \left[ 1 + m \left( 1 + \phi \right) \right]",
        ),
        (
            r#"["+", ["/", ["*", "u.push", "p.c_l_0"], "p.m"], ["/", ["*", "u.push", "x.angle"], "p.m"]]"#,
            r"\frac{\phi}{m} \left( C_L^{0} + \alpha \right)",
        ),
        (r#"["+", "x.speed", ["*", 2, "x.speed"]]"#, r"3\, V"),
        (
            r#"["/", "x.speed", 1.4142135623730951]"#,
            r"\frac{V}{\sqrt{2}}",
        ),
        (r#"["+", 0, 0]"#, "0"),
    ] {
        assert_eq!(printed(expr, 0), latex, "{expr}");
    }
}

#[test]
fn names_stand_and_formulas_are_written_out() {
    assert_eq!(printed(r#"["*", "c_l", "inverse"]"#, 0), r"\frac{C_L}{m V}");
    assert_eq!(
        printed(r#""d_c_l_d_angle""#, 0),
        r"\frac{\partial C_L}{\partial \alpha}"
    );
    assert_eq!(printed(r#""d_c_l_d_angle""#, 1), r"C_L^{\alpha}");
}

#[test]
fn long_equations_break_before_addends() {
    let document = document();
    let printer = Printer::new(&document.models[0], &document);
    let addend = r#"["*", "p.c_l_angle", "x.speed", "u.push", "p.m", ["sin", "x.angle"]]"#;
    let addends: Vec<String> = (2..14)
        .map(|n| addend.replace("\"p.m\"", &format!("[\"pow\", \"p.m\", {n}]")))
        .collect();
    let text = format!("[\"+\", {}]", addends.join(", "));
    let expr: Expr = serde_json::from_str(&text).expect("an expression");
    let tex = printer.expression(&expr, Style::NAMED).expect("a formula");
    let lines = equation("y", &tex, "27");
    assert_eq!(lines[0], r"\begin{aligned}");
    assert!(lines[1].starts_with("y ={}& "), "{lines:?}");
    assert_eq!(
        lines.last().map(String::as_str),
        Some(r"\end{aligned} \tag{27}")
    );
    // One addend a line, so that a change of one is a line of a diff.
    assert_eq!(lines.len(), 14);
    assert!(listed("y", &tex, "").len() == 14);
}

#[test]
fn symbols_are_told_apart() {
    for (latex, expected) in [
        ("V", Shape::Atom),
        (r"\bar q", Shape::Atom),
        ("g(h)", Shape::Atom),
        (r"C_L^{\alpha}", Shape::Labelled),
        (r"\omega_1^2", Shape::Power),
        (r"\sin\alpha", Shape::Function),
        (r"\bar q S", Shape::Product),
        (r"T\cos\alpha-D", Shape::Sum),
        ("1/(mV)", Shape::Quotient("1".into(), "mV".into())),
        (
            r"(\bar q S)/(mV)",
            Shape::Quotient(r"\bar q S".into(), "mV".into()),
        ),
        ("C_{a/b}/m", Shape::Quotient("C_{a/b}".into(), "m".into())),
    ] {
        assert_eq!(shape(latex), expected, "{latex}");
    }
}

#[test]
fn functions_have_the_papers_symbols() {
    for (name, latex) in [
        ("f_V", "f_{V}"),
        ("h_gamma", r"h_{\gamma}"),
        ("f_alpha_eta", r"f_{\alpha}^{\eta}"),
        ("delta_H_Q", r"\Delta H_{Q}"),
        ("L_f2_h", "L_f^2 h"),
        ("L_g_L_f_h", "L_g L_f h"),
    ] {
        assert_eq!(paper_symbol(name), latex);
    }
}

#[test]
fn functions_are_written_as_people_write_them() {
    for (expr, latex) in [
        (r#"["tan", "x.angle"]"#, r"\tan \alpha"),
        (r#"["asin", "x.angle"]"#, r"\arcsin \alpha"),
        (r#"["ln", ["+", 1, "p.m"]]"#, r"\ln\left( 1 + m \right)"),
        (
            r#"["atan2", "x.speed", ["neg", "p.m"]]"#,
            r"\operatorname{atan2}\left( V,\, -m \right)",
        ),
        (
            r#"["*", ["abs", ["-", "x.speed", 1]], "p.m"]"#,
            r"\left| V - 1 \right| m",
        ),
        (
            r#"["powr", ["+", 1, "p.m"], -0.3]"#,
            r"\left( 1 + m \right)^{-0.3}",
        ),
        (r#"["max", "x.speed", 0]"#, r"\max\left( V,\, 0 \right)"),
        (
            r#"["select", "u.push", 1, "x.speed", ["*", 2, "p.m"]]"#,
            r"\begin{cases} V & \phi < 1 \\ 2\, m & \text{else} \end{cases}",
        ),
    ] {
        assert_eq!(printed(expr, 0), latex, "{expr}");
    }
}
