//! What the programs answer beside what SciPy computes for the same vehicles, `tests/vectors/answers.json`.

use std::fs;

use serde_json::Value;

use super::commands::Own;
use crate::shell;

/// Made by `cargo xtask vectors`.
const FILE: &str = "tests/vectors/answers.json";
/// Of a number, relative to it.
const TOLERANCE: f64 = 1e-9;
/// Of a number that is 0 but for rounding, relative to the largest beside it.
const ROUNDING: f64 = 1e-15;
/// Of an eigenvalue, relative to the largest.
const OF_POLES: f64 = 1e-12;

/// The questions, with the answers of an implementation that shares nothing with the generator.
pub(super) struct Answers(Vec<Value>);

impl Answers {
    pub(super) fn load() -> Result<Self, String> {
        let path = shell::root().join(FILE);
        let text = fs::read_to_string(&path)
            .map_err(|error| format!("error: cannot read {FILE}: {error}"))?;
        serde_json::from_str(&text)
            .map(Self)
            .map_err(|error| format!("error: {FILE}: {error}"))
    }

    /// Asks a program all of its questions.
    ///
    /// # Errors
    /// It has none, or an answer differs.
    pub(super) fn compare(&self, program: &str, own: &Own) -> Result<(), String> {
        let mut asked = 0;
        for question in self.0.iter().filter(|it| it["program"] == program) {
            let arguments = question["arguments"].as_str().unwrap_or_default();
            let found = own.json(arguments)?;
            let expected = question["answers"].as_object();
            for (pointer, expected) in expected.into_iter().flatten() {
                let found = found.pointer(pointer).unwrap_or(&Value::Null);
                let same = match pointer.as_str() {
                    "/poles" => same_poles(found, expected),
                    _ => same(found, expected, 1.0),
                };
                if !same {
                    return Err(format!(
                        "error: {program} {arguments}: {pointer} is\n{found}\nand by SciPy\n{expected}"
                    ));
                }
                asked += 1;
            }
        }
        match asked {
            0 => Err(format!("error: {FILE} has no question for {program}")),
            _ => {
                println!("  {asked} answers as by SciPy");
                Ok(())
            }
        }
    }
}

/// Whether numbers, or lists of them of the same shape, agree. `size` is the largest number beside one.
fn same(found: &Value, expected: &Value, size: f64) -> bool {
    match (found, expected) {
        (Value::Array(found), Value::Array(expected)) => {
            let numbers = expected.iter().filter_map(Value::as_f64);
            let size = numbers.map(f64::abs).fold(size, f64::max);
            let mut pairs = found.iter().zip(expected);
            found.len() == expected.len() && pairs.all(|(found, it)| same(found, it, size))
        }
        _ => match (found.as_f64(), expected.as_f64()) {
            (Some(found), Some(expected)) => {
                (found - expected).abs() <= TOLERANCE * expected.abs() + ROUNDING * size
            }
            _ => false,
        },
    }
}

/// Whether two lists hold the same eigenvalues, in whatever order.
fn same_poles(found: &Value, expected: &Value) -> bool {
    let (Some(mut found), Some(expected)) = (complex(found), complex(expected)) else {
        return false;
    };
    let largest = expected.iter().map(|it| it.0.hypot(it.1));
    let largest = largest.fold(0.0, f64::max);
    found.len() == expected.len()
        && expected.iter().all(|pole| {
            let tolerance = TOLERANCE * pole.0.hypot(pole.1) + OF_POLES * largest;
            let is_near = |it: &(f64, f64)| (it.0 - pole.0).hypot(it.1 - pole.1) <= tolerance;
            let place = found.iter().position(is_near);
            place.map(|place| found.swap_remove(place)).is_some()
        })
}

fn complex(list: &Value) -> Option<Vec<(f64, f64)>> {
    let parts = |it: &Value| Some((it.get(0)?.as_f64()?, it.get(1)?.as_f64()?));
    list.as_array()?.iter().map(parts).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::{same, same_poles};

    #[test]
    fn numbers_agree_to_nine_digits() {
        let expected = json!([[1.0, 2e-5], [0.0, 300.0]]);
        for (found, agrees) in [
            (json!([[1.0, 2e-5], [0.0, 300.0]]), true),
            (json!([[1.000_000_000_9, 2e-5], [1e-14, 300.0]]), true),
            (json!([[1.000_000_002, 2e-5], [0.0, 300.0]]), false),
            (json!([[1.0, 2.000_000_1e-5], [0.0, 300.0]]), false),
            (json!([[1.0, 2e-5], [1e-11, 300.0]]), false),
            (json!([[1.0, 2e-5]]), false),
            (json!(null), false),
        ] {
            assert_eq!(same(&found, &expected, 1.0), agrees, "{found}");
        }
    }

    #[test]
    fn eigenvalues_have_no_order() {
        let expected = json!([[-1.0, 2.0], [-1.0, -2.0], [0.0, 0.0]]);
        let found = json!([[0.0, 1e-13], [-1.0, -2.0], [-1.0, 2.0]]);
        assert!(same_poles(&found, &expected));
        let twice = json!([[0.0, 0.0], [-1.0, -2.0], [-1.0, -2.0]]);
        assert!(!same_poles(&twice, &expected));
        assert!(!same_poles(&json!([[0.0, 0.0]]), &expected));
    }
}
