//! What is emitted computes the same values whatever passes are taken, and each pass saves what it says.
//!
//! The emitted text is evaluated as Rust means it, by a small interpreter of its syntax tree.

use super::print::{expression, statement};
use crate::graph::Dag;
use crate::graph::passes::{Pass, Passes};
use crate::schedule::given::Given;
use crate::schedule::tree::{Body, Statement};
use crate::schedule::{Cost, Prepared, body};
use crate::testing::{
    Draw, LEAVES, NAMES, Point, choices_of_passes, expr, model, quantity, value_of_call,
    value_of_expr,
};

/// A function as it is emitted, with what `prepare` does for it.
struct Emitted {
    /// Statements of `prepare`, and the fields with their values.
    prepare: (Vec<String>, Vec<(String, String)>),
    statements: Vec<String>,
    results: Vec<String>,
    cost: Cost,
    cost_of_prepare: Cost,
}

/// Statements and results as Rust; comments and units of no account.
fn printed(body: &Body) -> (Vec<String>, Vec<String>) {
    let statements = body.statements.iter().filter_map(|it| match it {
        Statement::Section(_) | Statement::Set { .. } => None,
        Statement::Let { name, value, .. } => Some(format!("let {name} = {};", expression(value))),
        Statement::SinCos { .. } => Some(statement(it)),
    });
    let results = body.results.iter().map(expression);
    (statements.collect(), results.collect())
}

fn given(prepared: Option<&Prepared>) -> Given<'_> {
    Given {
        prepared: prepared.map(Prepared::names),
        stages: &[],
    }
}

fn emitted(quantities: &str, roots: &[&str], passes: &Passes) -> Emitted {
    let model = model(quantities);
    let mut dag = Dag::new(&model, passes).unwrap();
    let ids: Vec<_> = roots
        .iter()
        .map(|root| dag.build(&expr(root), "test").unwrap())
        .collect();
    let prepared = Prepared::gather(&mut dag, &model, &[("test", &ids)], &[]);
    let fields: Vec<_> = prepared.fields.iter().map(|field| field.id).collect();
    let prepare = body(&mut dag, &model, given(None), "prepared", &fields);
    let function = body(&mut dag, &model, given(Some(&prepared)), "test", &ids);
    let (statements_of_prepare, values) = printed(&prepare);
    let names = prepared.fields.iter().map(|field| field.name.clone());
    let (statements, results) = printed(&function);
    Emitted {
        prepare: (statements_of_prepare, names.zip(values).collect()),
        statements,
        results,
        cost: function.cost(),
        cost_of_prepare: prepare.cost(),
    }
}

impl Emitted {
    /// The values of the results at a point.
    fn values(&self, at: &Point) -> Vec<f64> {
        let (statements, fields) = &self.prepare;
        let parameters = run(statements, at);
        let field = |(name, value): &(String, String)| {
            (format!("p.{name}"), value_of_text(value, &parameters))
        };
        // The function sees prepared values in the place of the parameters.
        let mut scope: Point = at
            .iter()
            .filter(|(name, _)| !name.starts_with("p."))
            .map(|(name, value)| (name.clone(), *value))
            .collect();
        scope.extend(fields.iter().map(field));
        let scope = run(&self.statements, &scope);
        self.results
            .iter()
            .map(|text| value_of_text(text, &scope))
            .collect()
    }
}

/// The names that are known after some `let`s.
fn run(statements: &[String], at: &Point) -> Point {
    let mut scope = at.clone();
    for text in statements {
        let syn::Stmt::Local(local) = syn::parse_str(text).unwrap() else {
            panic!("{text}")
        };
        let value = &local.init.as_ref().unwrap().expr;
        match &local.pat {
            syn::Pat::Ident(name) => {
                let value = value_of_rust(value, &scope);
                assert!(
                    scope.insert(name.ident.to_string(), value).is_none(),
                    "{text}"
                );
            }
            syn::Pat::Tuple(pair) => {
                let syn::Expr::MethodCall(call) = &**value else {
                    panic!("{text}")
                };
                assert_eq!(call.method, "sin_cos");
                let angle = value_of_rust(&call.receiver, &scope);
                for (pattern, value) in pair.elems.iter().zip([angle.sin(), angle.cos()]) {
                    let syn::Pat::Ident(name) = pattern else {
                        panic!("{text}")
                    };
                    assert!(
                        scope.insert(name.ident.to_string(), value).is_none(),
                        "{text}"
                    );
                }
            }
            _ => panic!("{text}"),
        }
    }
    scope
}

fn value_of_text(text: &str, scope: &Point) -> f64 {
    value_of_rust(&syn::parse_str(text).unwrap(), scope)
}

/// What an expression of the emitted code is worth.
fn value_of_rust(expr: &syn::Expr, scope: &Point) -> f64 {
    let value = |expr: &syn::Expr| value_of_rust(expr, scope);
    match expr {
        syn::Expr::Paren(inner) => value(&inner.expr),
        syn::Expr::Unary(negation) => -value(&negation.expr),
        syn::Expr::Binary(binary) => {
            let (a, b) = (value(&binary.left), value(&binary.right));
            match binary.op {
                syn::BinOp::Add(_) => a + b,
                syn::BinOp::Sub(_) => a - b,
                syn::BinOp::Mul(_) => a * b,
                syn::BinOp::Div(_) => a / b,
                _ => panic!("an operator"),
            }
        }
        syn::Expr::MethodCall(call) => {
            let receiver = value(&call.receiver);
            match call.method.to_string().as_str() {
                "recip" => receiver.recip(),
                name => {
                    let others = call.args.iter().map(value);
                    let arguments: Vec<f64> = std::iter::once(receiver).chain(others).collect();
                    value_of_call(name, &arguments)
                }
            }
        }
        syn::Expr::Field(field) => {
            let (syn::Expr::Path(base), syn::Member::Named(name)) = (&*field.base, &field.member)
            else {
                panic!("a field")
            };
            let name = format!("{}.{name}", base.path.get_ident().unwrap());
            *scope
                .get(&name)
                .unwrap_or_else(|| panic!("{name} is not known"))
        }
        // `R::from_f64(…)`
        syn::Expr::Call(call) => value(call.args.first().unwrap()),
        syn::Expr::Lit(syn::ExprLit {
            lit: syn::Lit::Float(number),
            ..
        }) => number.base10_parse().unwrap(),
        syn::Expr::Path(path) => match path
            .path
            .segments
            .last()
            .unwrap()
            .ident
            .to_string()
            .as_str()
        {
            "ZERO" => 0.0,
            "HALF" => 0.5,
            "ONE" => 1.0,
            "TWO" => 2.0,
            name => scope[name],
        },
        _ => panic!("an expression that is not emitted"),
    }
}

#[test]
fn what_is_emitted_keeps_values_whatever_passes_are_taken() {
    for passes in choices_of_passes() {
        let mut draw = Draw(11);
        let mut compared = 0;
        for _ in 0..200 {
            let named = draw.tree(3, &LEAVES);
            let roots = [draw.tree(4, &NAMES), draw.tree(3, &NAMES)];
            let code = emitted(
                &quantity("q", &named),
                &roots.each_ref().map(String::as_str),
                &passes,
            );
            for _ in 0..2 {
                let mut at = draw.point();
                let found = code.values(&at);
                at.insert("q".to_owned(), value_of_expr(&expr(&named), &at));
                for (root, found) in roots.iter().zip(found) {
                    let expected = value_of_expr(&expr(root), &at);
                    if expected.is_finite() && expected.abs() < 1e6 {
                        compared += 1;
                        assert!(
                            (expected - found).abs() <= 1e-9 * (1.0 + expected.abs()),
                            "{root} with q = {named}: {expected} became {found} at {at:?} with {passes:?}\n{:#?}",
                            code.statements
                        );
                    }
                }
            }
        }
        assert!(compared > 500, "only {compared} comparisons");
    }
}

/// The code of some expressions with all passes, and with all but one.
fn with_and_without(pass: Pass, quantities: &[String], roots: &[&str]) -> (Emitted, Emitted) {
    let quantities = quantities.join(",");
    let code = |passes: &Passes| emitted(&quantities, roots, passes);
    (code(&Passes::default()), code(&Passes::without(&[pass])))
}

#[test]
fn hash_consing_computes_equal_expressions_once() {
    let twice = r#"["sin", ["*", "x.a", ["+", "x.b", "u.c"]]]"#;
    let (with, without) = with_and_without(Pass::HashConsing, &[], &[twice, twice]);
    assert_eq!((with.cost.total(), without.cost.total()), (3, 6));
}

#[test]
fn hoisting_leaves_parameters_to_prepare() {
    let (with, without) = with_and_without(
        Pass::Hoisting,
        &[],
        &[r#"["*", "x.a", ["/", "p.d", ["*", "p.e", "p.e"]]]"#],
    );
    assert_eq!((with.cost.total(), with.cost_of_prepare.total()), (1, 3));
    assert_eq!(
        (without.cost.total(), without.cost_of_prepare.total()),
        (4, 0)
    );
}

#[test]
fn a_parameter_with_the_name_of_a_quantity_is_told_from_it() {
    let quantities = quantity("d", r#"["+", "x.a", "p.d"]"#);
    let roots = [r#"["*", 2.0, "p.d"]"#, r#"["*", "d", "d", "d", "p.d"]"#];
    let emitted = emitted(&quantities, &roots, &Passes::default());
    let names: Vec<_> = emitted.prepare.1.iter().map(|it| it.0.as_str()).collect();
    assert!(names.contains(&"two_table_d"), "{names:?}");
    let ours = emitted.statements.join("\n");
    assert!(
        ours.contains("let d = ") && !ours.contains("two_d"),
        "{ours}"
    );
}

#[test]
fn regrouping_of_sums_shares_factors_and_joins_parameters() {
    let sine = quantity("q", r#"["sin", "x.a"]"#);
    let root = r#"["+", ["*", "p.d", "q"], ["*", "x.b", "q"], ["*", "u.c", "q"], "p.e", "p.f"]"#;
    let (with, without) = with_and_without(Pass::RegroupingSums, &[sine], &[root]);
    assert_eq!((with.cost.total(), without.cost.total()), (1 + 4, 1 + 7));
}

#[test]
fn regrouping_of_products_joins_parameters() {
    let root = r#"["*", "p.d", "x.a", "p.e", "x.b", "p.f"]"#;
    let (with, without) = with_and_without(Pass::RegroupingProducts, &[], &[root]);
    assert_eq!(
        (with.cost.multiplications, without.cost.multiplications),
        (2, 4)
    );
}

#[test]
fn a_named_product_stands_in_a_larger_one() {
    let named = quantity("q", r#"["*", "x.a", "x.b", "p.d"]"#);
    let roots = ["\"q\"", r#"["*", "p.d", "x.b", "u.c", "x.a"]"#];
    let (with, without) = with_and_without(Pass::NamedProducts, &[named], &roots);
    assert_eq!(
        (with.cost.multiplications, without.cost.multiplications),
        (3, 5)
    );
}

#[test]
fn divisions_share_a_reciprocal() {
    let roots = [r#"["/", "x.b", "x.a"]"#, r#"["/", ["sin", "u.c"], "x.a"]"#];
    let (with, without) = with_and_without(Pass::SharedReciprocals, &[], &roots);
    assert_eq!((with.cost.divisions, without.cost.divisions), (1, 2));
    assert_eq!(without.results, ["x.b / x.a", "sin_c / x.a"]);
}

#[test]
fn powers_are_computed_from_each_other() {
    let roots = [
        r#"["pow", "x.a", 2]"#,
        r#"["pow", "x.a", 3]"#,
        r#"["pow", "x.a", 5]"#,
    ];
    let (with, without) = with_and_without(Pass::SharedPowers, &[], &roots);
    assert_eq!(
        (with.cost.multiplications, without.cost.multiplications),
        (4, 1 + 2 + 4)
    );
    assert_eq!(without.results[1], "x.a * x.a * x.a");
}

#[test]
fn sine_and_cosine_of_an_angle_are_one_call() {
    let roots = [r#"["sin", "x.a"]"#, r#"["cos", "x.a"]"#];
    let (with, without) = with_and_without(Pass::SinCos, &[], &roots);
    assert_eq!((with.cost.sin_cos, without.cost.sin_cos), (1, 2));
    assert_eq!(with.statements, ["let (sin_a, cos_a) = x.a.sin_cos();"]);
}

/// c₀ + c₁a + … + cₙaⁿ and a term in another variable.
fn polynomial(degree: u32) -> String {
    let addends = (0..=degree).map(|k| format!(r#"["*", "p.c_{k}", ["pow", "x.a", {k}]]"#));
    let addends: Vec<String> = addends.collect();
    format!(r#"["+", {}, ["*", "p.d", "x.b"]]"#, addends.join(", "))
}

#[test]
fn a_long_polynomial_is_summed_in_pairs() {
    let root = polynomial(7);
    let (with, without) = with_and_without(Pass::Estrin, &[], &[&root]);
    // Two powers in the place of six.
    assert_eq!(
        (with.cost.total(), without.cost.total()),
        (2 + 8 + 8, 6 + 8 + 8)
    );
    assert_eq!(
        with.statements,
        ["let a_2 = x.a * x.a;", "let a_4 = a_2 * a_2;"]
    );
    assert!(
        with.results[0].contains("(p.c_2 + p.c_3 * x.a) * a_2")
            && with.results[0]
                .contains("(p.c_4 + p.c_5 * x.a + (p.c_6 + p.c_7 * x.a) * a_2) * a_4"),
        "{}",
        with.results[0]
    );
}

#[test]
fn a_short_polynomial_stands_as_in_the_table() {
    let root = polynomial(3);
    let (with, without) = with_and_without(Pass::Estrin, &[], &[&root]);
    assert_eq!(with.results, without.results);
    assert_eq!(
        with.statements,
        ["let a_2 = x.a * x.a;", "let a_3 = x.a * a_2;"]
    );
}
