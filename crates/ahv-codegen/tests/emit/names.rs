//! Names of values in the code.

use std::collections::{BTreeMap, BTreeSet};

use ahv_codegen::numbered;
use serde_json::Value;

use crate::{PACKAGE, TABLES, irs, table};

/// Names in an expression of the IR; the first item of a list is an operation.
fn names_in(expr: &Value, found: &mut Vec<String>) {
    match expr {
        Value::String(name) => found.push(name.clone()),
        Value::Array(items) => items.iter().skip(1).for_each(|it| names_in(it, found)),
        _ => {}
    }
}

/// Quantities that the derivation of a function goes through.
fn derivation(quantities: &BTreeMap<String, Value>, function: &Value) -> BTreeSet<String> {
    let mut open = Vec::new();
    for output in function["outputs"].as_array().unwrap() {
        for entry in output["entries"].as_array().unwrap() {
            names_in(&entry["expr"], &mut open);
        }
    }
    let mut found = BTreeSet::new();
    while let Some(name) = open.pop() {
        if let Some(expr) = quantities.get(&name)
            && found.insert(name)
        {
            names_in(expr, &mut open);
        }
    }
    found
}

/// What computes what several functions need, by the function whose values they are.
const STAGES: [(&str, &str); 6] = [
    ("intermediates", "drift"),
    ("slopes", "jacobians"),
    ("noise_terms", "diffusion"),
    ("noise_slopes", "noise_derivatives"),
    ("curvatures", "hessian"),
    ("sensitivities", "parameter_jacobian"),
];

/// Each emitted function with the function of the IR whose derivation it is, and the names of the values that it computes.
fn computed(code: &str) -> Vec<(String, Vec<&str>)> {
    let mut found: Vec<(String, Vec<&str>)> = Vec::new();
    for line in code.lines() {
        let head = line.strip_prefix("pub ").unwrap_or(line);
        if let Some(head) = head.strip_prefix("fn ") {
            let name = head.split('<').next().unwrap_or_default();
            let name = name.split("_by_").next().unwrap_or_default();
            let name = name.split("_part_").next().unwrap_or_default();
            let name = name.trim_end_matches("_from").trim_end_matches("_values");
            let stage = STAGES.iter().find(|(stage, _)| *stage == name);
            let name = stage.map_or(name, |(_, function)| function);
            found.push((name.to_owned(), Vec::new()));
        }
        let Some((_, names)) = found.last_mut() else {
            continue;
        };
        let Some((left, _)) = line.split_once(" =") else {
            continue;
        };
        let left = left.trim().trim_start_matches("let ");
        // An entry, `jacobian.gamma.alpha`, has the names of its row and column.
        let values = left.split([',', '(', ')', ' ']);
        let values = values.filter(|it| it.matches('.').count() < 2);
        names.extend(values.map(|it| it.rsplit('.').next().unwrap_or(it)));
    }
    found
}

/// A quantity's name stands only where it is part of the derivation; equal values elsewhere are named from what they are, and
/// of that kind are the names of sines, cosines and the like.
#[test]
fn names_are_those_of_the_functions_own_derivation() {
    let mut checked = 0;
    for table in TABLES {
        let ir: Value = serde_json::from_str(&irs()[table]).unwrap();
        for model in ir["models"].as_array().unwrap() {
            let text = |it: &Value, key: &str| it[key].as_str().unwrap().to_owned();
            let quantities = model["quantities"].as_array().unwrap().iter();
            let quantities = quantities.map(|it| (text(it, "name"), it["expr"].clone()));
            let quantities: BTreeMap<String, Value> = quantities.collect();
            let functions = model["functions"].as_array().unwrap().iter();
            let homes = functions.map(|it| (text(it, "name"), derivation(&quantities, it)));
            let homes: BTreeMap<String, BTreeSet<String>> = homes.collect();
            let folder = format!("src/{}/", text(model, "name"));
            for (file, code) in PACKAGE.iter().filter(|(path, _)| path.starts_with(&folder)) {
                for (function, names) in computed(code) {
                    let Some(home) = homes.get(&function) else {
                        continue;
                    };
                    for value in names {
                        let is_call = ["sin_", "cos_", "exp_", "sqrt_"];
                        let is_call = is_call.iter().any(|call| value.starts_with(call));
                        let foreign = quantities.contains_key(value) && !home.contains(value);
                        assert!(is_call || !foreign, "{file}: {value} in {function}");
                        checked += usize::from(home.contains(value));
                    }
                }
            }
        }
    }
    assert!(checked > 2000, "{checked}");
}

/// A numbered name tells a reviewer nothing: there are few, and each has a reason.
#[test]
fn few_values_are_numbered_and_each_has_a_reason() {
    let listed = numbered(&TABLES.map(table), &irs()).unwrap();
    let is_numbered = |word: &&str| word.contains("_term_") || word.contains("_constant_");
    let sources = PACKAGE.iter().filter(|(path, _)| path.starts_with("src/"));
    let mut emitted = BTreeSet::new();
    for (path, text) in sources {
        let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        for word in words.filter(is_numbered) {
            let model = path.split('/').nth(1).unwrap_or_default();
            emitted.insert((model.to_owned(), word.to_owned()));
        }
    }
    let known = |(model, name): &(String, String)| {
        let mut listed = listed.iter();
        listed.any(|it| it.model == *model && it.name == *name && !it.reason.is_empty())
    };
    assert!(emitted.iter().all(known), "{emitted:?}");
    assert!(emitted.len() < 20, "{emitted:?}");
}
