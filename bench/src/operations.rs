//! Operations of the generated functions, as their headers have them, beside CasADi's.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use crate::candidates::Peers;
use crate::commands;
use crate::subject::SUBJECTS;

/// Operations of a function.
#[derive(Serialize)]
pub(crate) struct Operations {
    pub(crate) model: String,
    pub(crate) function: String,
    /// As emitted; what depends on parameters alone is done once, in `prepare`.
    pub(crate) ahv: u64,
    pub(crate) ahv_divisions: u64,
    /// CasADi's instructions without inputs, outputs and constants.
    pub(crate) casadi: u64,
    /// The same by the rules of the generated headers: a negation is free, and the sine and the cosine
    /// of one angle count as one.
    pub(crate) casadi_counted_alike: u64,
    pub(crate) casadi_divisions: u64,
    /// As the header of wrenfold's function says; of the timed functions.
    pub(crate) wrenfold: Option<u64>,
}

/// Every function of every model, and the timed calls that take several functions.
pub(crate) fn compare(root: &Path, peers: &Peers) -> Result<Vec<Operations>, String> {
    let mut found = Vec::new();
    for subject in &SUBJECTS {
        let own = headers(root, subject.model.name())?;
        let counts: Option<Vec<_>> = subject.functions.iter().map(|it| own.get(*it)).collect();
        let counts = counts.ok_or_else(|| missing(subject.model.name(), subject.symbol))?;
        let sum = counts.iter().fold(Count::default(), |sum, it| Count {
            operations: sum.operations + it.operations,
            divisions: sum.divisions + it.divisions,
            ..sum
        });
        found.push(Operations {
            wrenfold: peers.wrenfold["kernels"][subject.symbol]["operations"].as_u64(),
            ..row(
                subject.model.name(),
                &subject.functions.join(" + "),
                sum,
                &peers.casadi["kernels"][subject.symbol]["operations"],
            )
        });
    }
    let models = peers.casadi["counts"].as_object().into_iter().flatten();
    for (model, functions) in models {
        let own = headers(root, model)?;
        for (name, counts) in functions.as_object().into_iter().flatten() {
            let count = own.get(name);
            let count = count.copied().ok_or_else(|| missing(model, name))?;
            found.push(row(model, name, count, counts));
        }
    }
    let mut known = std::collections::BTreeSet::new();
    found.retain(|it| known.insert((it.model.clone(), it.function.clone())));
    Ok(found)
}

fn missing(model: &str, function: &str) -> String {
    format!("error: generated/src/{model} does not say the operations of {function}")
}

fn row(model: &str, function: &str, own: Count, casadi: &Value) -> Operations {
    let kind = |name: &str| casadi[name].as_u64().unwrap_or_default();
    let kinds = casadi.as_object().into_iter().flatten();
    let all: u64 = kinds.filter_map(|(_, count)| count.as_u64()).sum();
    Operations {
        model: model.to_owned(),
        function: function.to_owned(),
        ahv: own.operations,
        ahv_divisions: own.divisions,
        casadi: all,
        casadi_counted_alike: all - kind("negations") - kind("sin").min(kind("cos")),
        casadi_divisions: kind("divisions"),
        wrenfold: None,
    }
}

/// The operations of a function by their kinds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Count {
    operations: u64,
    pub(crate) additions: u64,
    pub(crate) multiplications: u64,
    pub(crate) divisions: u64,
    pub(crate) sin_cos: u64,
    pub(crate) exp: u64,
}

/// The operations of a generated function.
///
/// # Errors
/// A function whose header does not say them.
pub(crate) fn of(root: &Path, model: &str, function: &str) -> Result<Count, String> {
    let count = headers(root, model)?.get(function).copied();
    count.ok_or_else(|| missing(model, function))
}

/// What the headers of a model's functions say, by the function's name.
fn headers(root: &Path, model: &str) -> Result<BTreeMap<String, Count>, String> {
    let mut found = BTreeMap::new();
    for path in commands::files(&root.join("generated/src").join(model))? {
        found.extend(counts(&commands::read(&path)?));
    }
    Ok(found)
}

/// Pairs each `/// 141 operations: 58 additions, …` with the function below it.
///
/// A matrix is computed in its compressed form, whose count stands for both.
fn counts(text: &str) -> Vec<(String, Count)> {
    let mut found = Vec::new();
    let mut last = None;
    for line in text.lines() {
        if let Some(count) = line.strip_prefix("/// ").and_then(header) {
            last = Some(count);
        } else if let Some(rest) = line.strip_prefix("pub fn ") {
            let name = rest.split(['<', '(']).next().unwrap_or_default();
            let name = name.strip_suffix("_values").unwrap_or(name);
            found.extend(last.take().map(|count| (name.to_owned(), count)));
        }
    }
    found
}

fn header(line: &str) -> Option<Count> {
    if line == "No operations." {
        return Some(Count::default());
    }
    let (total, kinds) = line.split_once(": ")?;
    let operations = total
        .strip_suffix("operations")
        .or(total.strip_suffix("operation"))?;
    let of = |kind: &str| {
        let mut kinds = kinds.trim_end_matches('.').split(", ");
        let count = kinds.find_map(|it| {
            let (count, name) = it.split_once(' ')?;
            name.starts_with(kind).then(|| count.parse().ok())?
        });
        count.unwrap_or_default()
    };
    Some(Count {
        operations: operations.trim().parse().ok()?,
        additions: of("addition"),
        multiplications: of("multiplication"),
        divisions: of("division"),
        sin_cos: of("sin_cos"),
        exp: of("exp"),
    })
}

#[cfg(test)]
mod tests {
    use super::{Count, counts};

    #[test]
    fn headers_belong_to_the_function_below() {
        let text = "/// Drift, eq. (1).\n///\n/// 141 operations: 140 additions, 1 division.\n#[inline]\n\
                    pub fn drift_values<R: Real>(x: &State<R>) {}\n/// Dense.\npub fn drift<R: Real>(x: &State<R>) {}\n\
                    /// No operations.\npub fn none(x: f64) {}\n";
        let drift = Count {
            operations: 141,
            additions: 140,
            divisions: 1,
            ..Count::default()
        };
        let expected = [
            ("drift".to_owned(), drift),
            ("none".to_owned(), Count::default()),
        ];
        assert_eq!(counts(text), expected);
    }
}
