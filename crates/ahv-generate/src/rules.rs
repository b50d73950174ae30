//! The numbers of tables that are not derived again, checked as the derivation checks them: by the rules in the IR.

use std::collections::BTreeMap;

use ahv_codegen::Table;
use ahv_codegen::ir::{Parameter, ParameterSet, Rule, Sign, Variable};
use serde::Deserialize;

use crate::failure::Failure;
use crate::tables::{Diagnostic, Tables};

/// Where parameters stand in a table, by their names.
type Paths<'a> = BTreeMap<&'a str, Vec<&'a str>>;

/// Of an IR, what its numbers must obey.
#[derive(Deserialize)]
struct Ruled {
    parameters: Vec<Parameter>,
    sets: Vec<ParameterSet>,
    validity: Vec<Variable>,
    rules: Vec<Rule>,
}

/// Checks the tables' numbers. That they are finite numbers is part of the structure that they have.
///
/// # Errors
/// All faults, as the derivation reports them; an IR that cannot be read.
pub(crate) fn check(tables: &Tables, irs: &BTreeMap<String, String>) -> Result<(), Failure> {
    let mut faults = Vec::new();
    for table in &tables.parsed {
        let text = irs.get(&table.name).map_or("", String::as_str);
        let ruled: Ruled = serde_json::from_str(text).map_err(|error| {
            Failure::new(format!(
                "the IR of table {:?} cannot be read: {error}",
                table.name
            ))
        })?;
        faults.extend(ruled.faults(table));
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(tables.faults(faults))
    }
}

impl Ruled {
    fn faults<'a>(&'a self, table: &Table) -> Vec<Diagnostic> {
        let mut faults = Vec::new();
        for variable in &self.validity {
            let end = |key| table.number(&["validity", &variable.name, key]);
            if let (Some(min), Some(max)) = (end("min"), end("max"))
                && min >= max
            {
                let path = ["validity", &variable.name, "min"];
                faults.push(Diagnostic::of_value(
                    "range",
                    table,
                    &path,
                    "`min` must be below `max`",
                ));
            }
        }
        let own = self.parameters.iter();
        let own: Paths<'_> = own
            .map(|it| (it.name.as_str(), vec![&*it.path.0, &*it.path.1]))
            .collect();
        let of_set = |set: &'a ParameterSet| -> Paths<'a> {
            let path = |path: &'a [String]| path.iter().map(String::as_str).collect();
            set.parameters
                .iter()
                .map(|it| (it.name.as_str(), path(&it.path)))
                .collect()
        };
        let sets: Vec<Paths<'_>> = self.sets.iter().map(of_set).collect();
        for rule in &self.rules {
            for paths in [&own].into_iter().chain(&sets) {
                faults.extend(broken(rule, &own, paths, table));
            }
        }
        faults
    }
}

/// The fault of a rule that a set breaks whose parameters stand at `paths`, where it says something of the rule.
fn broken(rule: &Rule, own: &Paths<'_>, paths: &Paths<'_>, table: &Table) -> Option<Diagnostic> {
    let value = |name: &str| {
        let path = paths.get(name).or_else(|| own.get(name))?;
        table.number(&[path, ["value"].as_slice()].concat())
    };
    let mut names = rule.terms.iter().flat_map(|(_, names)| names);
    let named = names.find_map(|name| paths.get(name.as_str()))?;
    let term = |(factor, names): &(f64, Vec<String>)| {
        names
            .iter()
            .try_fold(1.0, |product, name| Some(product * value(name)?))
            .map(|it| factor * it)
    };
    let sum = rule
        .terms
        .iter()
        .try_fold(0.0, |sum, it| Some(sum + term(it)?))?;
    let holds = match rule.must {
        Sign::Positive => sum > 0.0,
        Sign::NotNegative => sum >= 0.0,
        Sign::NotZero => sum.abs() > 0.0,
    };
    let path = [named, ["value"].as_slice()].concat();
    (!holds).then(|| Diagnostic::of_value(&rule.name, table, &path, &rule.reason))
}
