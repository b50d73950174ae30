//! The audit of generated models: their functions at random points, against the expressions at 50 digits.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde::Deserialize;

use crate::derive;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::project::Project;
use crate::surroundings::Surroundings;
use crate::tables::Tables;
use crate::{interrupt, python};

/// The largest error that passes, in units of 2⁻⁵²·K.
const BAR: f64 = 8.0;

/// Numbers by their labels: `state.alpha`, `drift.alpha`, `jacobians.state.alpha.velocity`.
pub type Values = BTreeMap<String, f64>;

/// What evaluates the compiled functions of a model at a point, by their labels; `None` for a model that is not compiled
/// into the program. An entry that is not in the result is not compared.
pub type Evaluate<'a> = &'a dyn Fn(&str, &Values) -> Option<Values>;

/// The worst error of a function and its entry; `None` for an error that is not finite.
type Worst = (Option<f64>, String);

/// What Python found of a model.
#[derive(Deserialize)]
struct Verified {
    casadi: BTreeMap<String, Worst>,
    differences: BTreeMap<String, Worst>,
}

/// The audit of all models of a project.
pub(crate) struct Audited {
    text: String,
    pub(crate) is_within: bool,
}

impl Audited {
    /// What people read.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }
}

/// Audits the models of a project at so many points each.
///
/// # Errors
/// Bad tables, no usable Python, a signal.
pub(crate) fn audit(
    points: u32,
    surroundings: &Surroundings,
    project: &Project,
    evaluate: Evaluate<'_>,
) -> Result<Audited, Failure> {
    let tables = Tables::load(project)?;
    let python = python::for_generation(surroundings)?;
    let folder = tempfile::tempdir()
        .map_err(|error| Failure::new(format!("cannot make a temporary folder: {error}")))?;
    let output = {
        let _progress = Progress::quiet("auditing the models");
        let mut command = python.command();
        command.args(["verify", "--points", &points.to_string(), "--out"]);
        command.arg(folder.path());
        command.args(tables.sources.iter().map(|source| &source.path));
        interrupt::output(&mut command, |error| {
            Failure::new(format!("cannot run Python: {error}"))
        })?
    };
    if !output.status.success() {
        return Err(derive::failure(&output, &tables));
    }
    let verified: BTreeMap<String, Verified> = serde_json::from_slice(&output.stdout)
        .map_err(|error| Failure::new(format!("the audit cannot be read: {error}")))?;
    let mut report = Report::new(points);
    for (model, found) in &verified {
        let vectors = Vectors::read(&folder.path().join(format!("{model}.txt")))?;
        report.model(model, found, vectors.compare(model, evaluate)?);
    }
    Ok(report.end())
}

/// What is printed.
struct Report {
    text: String,
    is_within: bool,
}

impl Report {
    fn new(points: u32) -> Self {
        let text = format!(
            "audit at {points} points a model, largest error in units of 2^-52 K against 50 digits; at most {BAR} passes\n"
        );
        Self {
            text,
            is_within: true,
        }
    }

    /// The lines of a model: one a function.
    fn model(&mut self, name: &str, found: &Verified, emitted: Option<BTreeMap<String, Worst>>) {
        let functions: BTreeSet<&String> = found
            .casadi
            .keys()
            .chain(emitted.iter().flatten().map(|(it, _)| it))
            .collect();
        let _ = writeln!(
            self.text,
            "{name:<28}{:>10}{:>10}{:>13}",
            "compiled", "CasADi", "differences"
        );
        for function in functions {
            let of = |worst: &BTreeMap<String, Worst>| worst.get(function).cloned();
            let columns = [
                emitted.as_ref().and_then(of),
                of(&found.casadi),
                of(&found.differences),
            ];
            let [a, b, c] = columns.clone().map(|column| shown(column.as_ref()));
            let _ = writeln!(self.text, "  {function:<26}{a:>10}{b:>10}{c:>13}");
            for (error, entry) in columns.into_iter().flatten() {
                if !error.is_some_and(|error| error <= BAR) {
                    self.is_within = false;
                    let _ = writeln!(self.text, "    over the bar: {entry}");
                }
            }
        }
        if emitted.is_none() {
            let _ = writeln!(
                self.text,
                "  {name} is not compiled into this program, and its Rust was not run: audit with the program of its package"
            );
        }
    }

    fn end(self) -> Audited {
        Audited {
            text: self.text,
            is_within: self.is_within,
        }
    }
}

fn shown(worst: Option<&Worst>) -> String {
    match worst {
        None => "-".to_owned(),
        Some((None, _)) => "inf".to_owned(),
        Some((Some(error), _)) => format!("{error:.2}"),
    }
}

/// A value that a double cannot hold, and the measure of its sums.
struct Reference {
    high: f64,
    low: f64,
    measure: f64,
}

/// Points, and the values of all functions there.
struct Vectors {
    inputs: Vec<String>,
    labels: Vec<String>,
    rows: Vec<(Vec<f64>, Vec<Reference>)>,
}

impl Vectors {
    fn read(path: &Path) -> Result<Self, Failure> {
        let text = fs::read_to_string(path).map_err(Failure::file("read", path))?;
        let broken = || Failure::new("the audit's points cannot be read");
        let mut lines = text.lines().skip(1);
        let names = |text: &str| text.split(',').map(str::to_owned).collect();
        let (inputs, labels) = lines
            .next()
            .and_then(|it| it.split_once('|'))
            .ok_or_else(broken)?;
        let rows: Option<Vec<_>> = lines.map(row).collect();
        Ok(Self {
            inputs: names(inputs),
            labels: names(labels),
            rows: rows.ok_or_else(broken)?,
        })
    }

    /// The worst of each function that is compiled; `None` where the model is not.
    fn compare(
        &self,
        model: &str,
        evaluate: Evaluate<'_>,
    ) -> Result<Option<BTreeMap<String, Worst>>, Failure> {
        let mut worst = BTreeMap::new();
        for (inputs, references) in &self.rows {
            let point = self.inputs.iter().cloned().zip(inputs.iter().copied());
            let Some(values) = evaluate(model, &point.collect()) else {
                return Ok(None);
            };
            let known: BTreeMap<&String, &Reference> = self.labels.iter().zip(references).collect();
            for (label, &value) in &values {
                // What the model says is zero all over has no reference.
                let error = known.get(label).map_or_else(
                    || if value == 0.0 { 0.0 } else { f64::INFINITY },
                    |reference| error(value, reference),
                );
                let function = label.split('.').next().unwrap_or(label);
                let of_function = worst
                    .entry(function.to_owned())
                    .or_insert_with(|| (Some(0.0), label.clone()));
                if of_function
                    .0
                    .is_some_and(|known| error > known || error.is_nan())
                {
                    *of_function = (Some(error).filter(|error| error.is_finite()), label.clone());
                }
            }
        }
        Ok(Some(worst))
    }
}

fn row(line: &str) -> Option<(Vec<f64>, Vec<Reference>)> {
    let (inputs, outputs) = line.split_once('|')?;
    let inputs = inputs.split(',').map(|text| text.parse().ok());
    let references = outputs.split(',').map(|text| {
        let mut parts = text.split(';').map(|part| part.parse().ok());
        let mut part = || parts.next().flatten();
        Some(Reference {
            high: part()?,
            low: part()?,
            measure: part()?,
        })
    });
    Some((
        inputs.collect::<Option<_>>()?,
        references.collect::<Option<_>>()?,
    ))
}

/// The error of a value in units of 2⁻⁵²·K; none outside the domain of a function, where the reference is NaN.
fn error(value: f64, reference: &Reference) -> f64 {
    if reference.high.is_nan() {
        return 0.0;
    }
    let difference = ((value - reference.high) - reference.low).abs();
    if difference == 0.0 {
        0.0
    } else if reference.measure == 0.0 {
        f64::INFINITY
    } else {
        difference / (f64::EPSILON * reference.measure)
    }
}

#[cfg(test)]
mod tests {
    use super::{Reference, Values, Vectors, error, row};

    const LINE: &str = "2.0,3.0|4.0;0.0;4.0,1.0;0.0;0.0";

    fn vectors() -> Vectors {
        Vectors {
            inputs: vec!["state.a".to_owned(), "input.b".to_owned()],
            labels: vec!["drift.a".to_owned(), "outputs.c".to_owned()],
            rows: vec![row(LINE).expect("a line")],
        }
    }

    fn worst(values: &[(&str, f64)]) -> Option<Vec<(String, Option<f64>)>> {
        let values: Values = values
            .iter()
            .map(|(name, value)| ((*name).to_owned(), *value))
            .collect();
        let found = vectors().compare("m", &|_, point| {
            assert_eq!((point["state.a"], point["input.b"]), (2.0, 3.0));
            (!values.is_empty()).then(|| values.clone())
        });
        let found = found.expect("points that can be read")?;
        Some(
            found
                .into_iter()
                .map(|(name, (error, _))| (name, error))
                .collect(),
        )
    }

    #[test]
    fn each_function_has_its_worst_error() {
        let ulp = 4.0 * (1.0 + f64::EPSILON);
        assert_eq!(
            worst(&[("drift.a", ulp), ("drift.b", 0.0), ("outputs.c", 1.0)]),
            Some(vec![
                ("drift".to_owned(), Some(1.0)),
                ("outputs".to_owned(), Some(0.0))
            ])
        );
    }

    #[test]
    fn what_is_not_zero_without_a_reference_and_what_is_no_number_is_over_every_bar() {
        assert_eq!(
            worst(&[("drift.b", 1e-300)]),
            Some(vec![("drift".to_owned(), None)])
        );
        assert_eq!(
            worst(&[("drift.a", f64::NAN)]),
            Some(vec![("drift".to_owned(), None)])
        );
        assert_eq!(
            worst(&[("outputs.c", 1.5)]),
            Some(vec![("outputs".to_owned(), None)])
        );
    }

    #[test]
    fn a_model_that_is_not_compiled_is_not_compared() {
        assert_eq!(worst(&[]), None);
    }

    #[test]
    fn the_rest_of_a_value_counts() {
        let reference = Reference {
            high: 1.0,
            low: f64::EPSILON / 4.0,
            measure: 1.0,
        };
        assert_eq!(error(1.0, &reference), 0.25);
    }

    #[test]
    fn a_broken_line_is_no_row() {
        assert!(
            row("1.0,2.0").is_none()
                && row("1.0|2.0;x;1.0").is_none()
                && row("1.0|2.0;1.0").is_none()
        );
    }
}
