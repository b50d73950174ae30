//! Results that are entries of a struct: each is set where it is computed.

use std::collections::{BTreeMap, BTreeSet};

use crate::schedule::tree::{Body, Expr, Source, Statement};

/// The body with its results in their places, as far as they have one. A value that is a result has no name besides its place.
pub(super) fn placed(body: &Body, places: &[Option<String>]) -> Body {
    let named = body.statements.iter().filter_map(|it| match it {
        Statement::Let { name, .. } => Some(&**name),
        _ => None,
    });
    let named: BTreeSet<&str> = named.collect();
    let mut own: BTreeMap<&str, &str> = BTreeMap::new();
    for (place, result) in places.iter().zip(&body.results) {
        if let (Some(place), Expr::Name(name)) = (place, result)
            && named.contains(&**name)
        {
            own.entry(name).or_insert(place);
        }
    }
    let mut statements = body.statements.clone();
    for statement in &mut statements {
        place(statement, &own);
    }
    let is_heading = |it: &Statement| matches!(it, Statement::Section(_));
    if statements.iter().any(is_heading) {
        // What follows belongs to none.
        statements.push(Statement::Section(String::new()));
    }
    let mut results = Vec::new();
    for (place, result) in places.iter().zip(&body.results) {
        let value = renamed(result, &own);
        match place {
            None => results.push(value),
            Some(place) if is_at(&value, place) => {}
            Some(place) => statements.push(set(place.clone(), value, String::new())),
        }
    }
    while statements.last().is_some_and(is_heading) {
        statements.pop();
    }
    Body {
        statements,
        results,
        numbered: Vec::new(),
    }
}

fn set(field: String, value: Expr, unit: String) -> Statement {
    Statement::Set {
        source: Source::Result,
        field,
        value,
        unit,
    }
}

fn is_at(value: &Expr, place: &str) -> bool {
    matches!(value, Expr::Component(Source::Result, it) if it == place)
}

/// A statement whose value goes to its place, and takes others from theirs.
fn place(statement: &mut Statement, own: &BTreeMap<&str, &str>) {
    match statement {
        Statement::Section(_) => {}
        Statement::SinCos { angle, .. } => *angle = renamed(angle, own),
        Statement::Set { value, .. } => *value = renamed(value, own),
        Statement::Let { name, value, unit } => {
            let value = renamed(value, own);
            *statement = match own.get(&**name) {
                Some(place) => set((*place).to_owned(), value, std::mem::take(unit)),
                None => Statement::Let {
                    name: std::mem::take(name),
                    value,
                    unit: std::mem::take(unit),
                },
            };
        }
    }
}

/// The expression with values from their places.
fn renamed(expr: &Expr, own: &BTreeMap<&str, &str>) -> Expr {
    let boxed = |part: &Expr| Box::new(renamed(part, own));
    match expr {
        Expr::Number(_) | Expr::Component(..) => expr.clone(),
        Expr::Name(name) => own.get(&**name).map_or_else(
            || expr.clone(),
            |place| Expr::Component(Source::Result, (*place).to_owned()),
        ),
        Expr::Negative(part) => Expr::Negative(boxed(part)),
        Expr::Reciprocal(part) => Expr::Reciprocal(boxed(part)),
        Expr::Call(call, arguments) => {
            let arguments = arguments.iter();
            Expr::Call(*call, arguments.map(|it| renamed(it, own)).collect())
        }
        Expr::Sum(addends) => {
            let addends = addends.iter();
            Expr::Sum(
                addends
                    .map(|(sign, it)| (*sign, renamed(it, own)))
                    .collect(),
            )
        }
        Expr::Product(factors) => {
            let factors = factors.iter();
            Expr::Product(factors.map(|(how, it)| (*how, renamed(it, own))).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rust::print::statement;

    #[test]
    fn a_result_is_set_where_it_is_computed_and_read_from_there() {
        let name = |name: &str| Expr::Name(name.to_owned());
        let minus = |of: &str| Expr::Negative(Box::new(name(of)));
        let bind = |to: &str, value: Expr| Statement::Let {
            name: to.to_owned(),
            value,
            unit: String::new(),
        };
        let body = Body {
            statements: vec![
                Statement::Section("Rates".to_owned()),
                bind("a", minus("z")),
                bind("b", minus("a")),
            ],
            results: vec![name("a"), minus("a"), name("b"), name("a")],
            numbered: Vec::new(),
        };
        let places = ["r.u.v", "r.u.w", "r.v.v", "r.w.w"].map(|it| Some(it.to_owned()));
        let printed = placed(&body, &places).statements;
        let printed: Vec<String> = printed.iter().map(statement).collect();
        let expected = [
            "__section!(\"Rates\");",
            "r.u.v = -z;",
            "r.v.v = -r.u.v;",
            "__section!(\"\");",
            "r.u.w = -r.u.v;",
            "r.w.w = r.u.v;",
        ];
        assert_eq!(printed, expected);
        // A dense result stays a value.
        let places = [Some("r.u.v".to_owned()), None, None, None];
        let rest = placed(&body, &places).results;
        let rest: Vec<String> = rest.iter().map(crate::rust::print::expression).collect();
        assert_eq!(rest, ["-r.u.v", "b", "r.u.v"]);
    }
}
