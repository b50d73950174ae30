//! The files of one model: its vectors, its prepared parameters and its functions.

use askama::Template;
use std::collections::BTreeMap;

use crate::EmitError;
use crate::body::{Prepared, Scope, Statement};
use crate::dag::{Dag, Id, Kind, Node};
use crate::emit::render;
use crate::ir::{self, Variable, capitalised, described};
use crate::print::{literal, reference};

#[derive(Template)]
#[template(path = "model.rs")]
struct ModelTemplate<'a> {
    model: &'a ir::Model,
    label: String,
    home: &'a str,
    shared_parameters: bool,
    modules: Vec<&'a str>,
    groups: Vec<&'a str>,
    vectors: Vec<Vector<'a>>,
    stochastic: bool,
}

struct Vector<'a> {
    name: &'static str,
    doc: &'static str,
    fields: &'a [Variable],
    /// Constant that bounds it, where the table does.
    bounds: Option<&'static str>,
}

#[derive(Template)]
#[template(path = "prepared.rs")]
struct PreparedTemplate {
    label: String,
    fields: Vec<PreparedField>,
    statements: Vec<Statement>,
    cost: String,
}

struct PreparedField {
    name: String,
    doc: String,
    value: String,
}

#[derive(Template)]
#[template(path = "functions.rs")]
struct FunctionsTemplate {
    label: String,
    /// Types of the parent module, in alphabetical order.
    imports: Vec<&'static str>,
    paper_names: bool,
    needs_vector: bool,
    functions: Vec<FunctionText>,
}

struct FunctionText {
    name: String,
    docs: Vec<String>,
    arguments: Vec<String>,
    result: String,
    statements: Vec<Statement>,
    zeros: Vec<(String, &'static str)>,
    outputs: Vec<(String, String)>,
}

impl FunctionText {
    /// Whether a blank line sets the result off from what it is made of.
    fn sets_result_off(&self) -> bool {
        matches!(self.statements.last(), Some(Statement::Let { .. }))
    }
}

/// Emits one model.
pub(crate) struct ModelEmitter<'a> {
    model: &'a ir::Model,
    document: &'a ir::Document,
    home: &'a str,
    dag: Dag,
    prepared: Prepared,
    roots: Vec<Vec<Id>>,
}

impl<'a> ModelEmitter<'a> {
    /// Reads the model's expressions; `home` is the module of the table's parameters.
    pub(crate) fn new(
        model: &'a ir::Model,
        home: &'a str,
        document: &'a ir::Document,
    ) -> Result<Self, EmitError> {
        let mut dag = Dag::new(model)?;
        let mut roots = Vec::new();
        for function in &model.functions {
            let entries = function.outputs.iter().flat_map(|output| &output.entries);
            let ids: Result<Vec<Id>, EmitError> = entries
                .map(|entry| dag.build(&entry.expr, &function.name))
                .collect();
            roots.push(ids?);
        }
        let named: Vec<(String, Vec<Id>)> = model
            .functions
            .iter()
            .zip(&roots)
            .map(|(function, ids)| (function.name.clone(), ids.clone()))
            .collect();
        let prepared = Prepared::gather(&mut dag, model, &named);
        Ok(Self {
            model,
            document,
            home,
            dag,
            prepared,
            roots,
        })
    }

    /// The text of each file, by its name without ending.
    pub(crate) fn files(mut self) -> Result<BTreeMap<String, String>, EmitError> {
        let mut files = BTreeMap::new();
        let mut groups: Vec<&str> = Vec::new();
        for function in &self.model.functions {
            if !groups.contains(&function.group.as_str()) {
                groups.push(&function.group);
            }
        }
        for &group in &groups {
            files.insert(group.to_owned(), self.functions(group)?);
        }
        files.insert("prepared".to_owned(), self.prepare());
        files.insert("mod".to_owned(), self.module(groups));
        Ok(files)
    }

    fn label(&self) -> String {
        self.model.name.to_uppercase()
    }

    fn basis(&self, name: &str) -> &'a [Variable] {
        self.model.bases.get(name).map_or(&[], Vec::as_slice)
    }

    fn module(&self, mut groups: Vec<&'a str>) -> String {
        groups.sort_unstable();
        let mut modules = groups.clone();
        modules.push("prepared");
        if self.home == self.model.name {
            modules.extend(["nominal", "parameters", "provenance"]);
        }
        modules.sort_unstable();
        let mut vectors = vec![
            Vector {
                name: "State",
                doc: "State",
                fields: self.basis("state"),
                bounds: Some("STATE_BOUNDS"),
            },
            Vector {
                name: "Input",
                doc: "Input",
                fields: self.basis("input"),
                bounds: Some("INPUT_BOUNDS"),
            },
        ];
        let stochastic = self.model.bases.contains_key("noise");
        if stochastic {
            vectors.push(Vector {
                name: "Noise",
                doc: "One value for each independent Wiener process",
                fields: self.basis("noise"),
                bounds: None,
            });
        }
        render(&ModelTemplate {
            model: self.model,
            label: self.label(),
            home: self.home,
            shared_parameters: self.home != self.model.name,
            modules,
            groups,
            vectors,
            stochastic,
        })
    }

    fn prepare(&mut self) -> String {
        let label = self.label();
        let computed: Vec<Id> = self
            .prepared
            .fields
            .iter()
            .map(|field| field.id)
            .filter(|&id| !matches!(self.dag.node(id), Node::Leaf(..)))
            .collect();
        let mut scope = Scope::new(&mut self.dag, self.model, None);
        let statements = scope.write("prepared", &computed);
        let mut fields = Vec::new();
        for field in &self.prepared.fields {
            let value = reference(&mut scope, field.id);
            let quantity = scope
                .dag
                .name(field.id)
                .map(|position| &self.model.quantities[position]);
            let doc = match (quantity, scope.dag.node(field.id)) {
                (Some(q), _) => described(&q.doc, &q.unit),
                (None, Node::Leaf(_, name)) => parameter_doc(self.document, name),
                (None, _) => format!("`{}`.", formula(&value, &statements)),
            };
            fields.push(PreparedField {
                name: field.name.clone(),
                doc,
                value,
            });
        }
        let cost = scope.cost.describe();
        render(&PreparedTemplate {
            label,
            fields,
            statements,
            cost,
        })
    }

    fn functions(&mut self, group: &str) -> Result<String, EmitError> {
        let mut functions = Vec::new();
        let mut imports = vec!["Input", "Prepared", "State"];
        for position in 0..self.model.functions.len() {
            let function = &self.model.functions[position];
            if function.group != group {
                continue;
            }
            let ids = self.roots[position].clone();
            let text = self.function(function, &ids)?;
            for alias in ["Diffusion", "InputJacobian", "Noise", "StateJacobian"] {
                let mentions = text.result.contains(alias)
                    || text.arguments.iter().any(|a| a.contains(alias))
                    || text.zeros.iter().any(|(_, of)| *of == alias)
                    || text
                        .outputs
                        .iter()
                        .any(|(_, value)| value.contains(&format!("{alias} {{")));
                if mentions && !imports.contains(&alias) {
                    imports.push(alias);
                }
            }
            functions.push(text);
        }
        imports.sort_unstable();
        Ok(render(&FunctionsTemplate {
            label: self.label(),
            imports,
            paper_names: functions
                .iter()
                .any(|f| f.name.chars().any(char::is_uppercase)),
            needs_vector: functions.iter().any(|f| !f.zeros.is_empty()),
            functions,
        }))
    }

    fn function(&mut self, function: &ir::Function, ids: &[Id]) -> Result<FunctionText, EmitError> {
        let model = self.model;
        let mut scope = Scope::new(&mut self.dag, model, Some(&self.prepared));
        let mut statements = scope.write(&function.name, ids);
        let mut zeros = Vec::new();
        let (mut outputs, mut results) = (Vec::new(), Vec::new());
        let mut remaining = ids.iter();
        for output in &function.outputs {
            let values: Vec<String> = remaining
                .by_ref()
                .take(output.entries.len())
                .map(|&id| reference(&mut scope, id))
                .collect();
            let shape = Shape::of(model, output)?;
            results.push(shape.result());
            outputs.push((
                output.name.clone(),
                shape.value(model, output, &values, &mut zeros),
            ));
        }
        if let [(_, result)] = outputs.as_mut_slice() {
            return_last(&mut statements, result);
        }
        let argument = |name: &str, kind: Kind, ty: &str| {
            let unused = if scope.used.contains(&kind) { "" } else { "_" };
            format!("{unused}{name}: &{ty}<R>")
        };
        let mut arguments = vec![
            argument("x", Kind::State, "State"),
            argument("u", Kind::Input, "Input"),
            argument("p", Kind::Parameter, "Prepared"),
        ];
        if scope.used.contains(&Kind::Noise) {
            arguments.push(argument("dw", Kind::Noise, "Noise"));
        }
        let unit = function.outputs.iter().find_map(|o| o.unit.as_deref());
        let summary = format!("{}, eq. {}.", function.doc, function.equation);
        let unit = unit.map_or_else(String::new, |u| format!(" Unit: {u}."));
        let mut docs = wrapped(&(summary + &unit));
        docs.push(String::new());
        docs.push(format!("{}.", capitalised(&scope.cost.describe())));
        Ok(FunctionText {
            name: function.name.clone(),
            docs,
            arguments,
            result: if results.len() == 1 {
                results.remove(0)
            } else {
                format!("({})", results.join(", "))
            },
            statements,
            zeros,
            outputs,
        })
    }
}

/// A text in lines of a comment's width.
fn wrapped(text: &str) -> Vec<String> {
    const WIDTH: usize = 110;
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].chars().count() + 1 + word.chars().count() > WIDTH
        {
            lines.push(word.to_owned());
        } else {
            if !lines[last].is_empty() {
                lines[last].push(' ');
            }
            lines[last] += word;
        }
    }
    lines
}

/// A function that ends in `let y = …; y` ends in the expression itself.
fn return_last(statements: &mut Vec<Statement>, result: &mut String) {
    if let Some(Statement::Let { name, value, .. }) = statements.last()
        && name == result
    {
        *result = value.source();
        statements.pop();
    }
}

/// The shape of an output.
enum Shape {
    Scalar,
    Array(usize),
    Vector,
    Matrix {
        column: &'static str,
        alias: &'static str,
    },
}

impl Shape {
    fn of(model: &ir::Model, output: &ir::Output) -> Result<Self, EmitError> {
        if let Some(basis) = output.basis.iter().find(|b| !model.bases.contains_key(*b)) {
            return Err(EmitError::Mismatch(format!(
                "model `{}` has no basis `{basis}`",
                model.name
            )));
        }
        let known = |at: &[String]| {
            at.len() == output.basis.len()
                && at.iter().zip(&output.basis).all(|(name, basis)| {
                    let variables = model.bases.get(basis);
                    variables.is_some_and(|all| all.iter().any(|v| v.name == *name))
                })
        };
        if let Some(entry) = output.entries.iter().find(|entry| !known(&entry.at)) {
            return Err(EmitError::Mismatch(format!(
                "model `{}` has an entry at {:?}, which its bases do not hold",
                model.name, entry.at
            )));
        }
        let basis: Vec<&str> = output.basis.iter().map(String::as_str).collect();
        Ok(match basis.as_slice() {
            [] => Self::Scalar,
            ["state"] => Self::Vector,
            ["mode"] => Self::Array(model.bases.get("mode").map_or(0, Vec::len)),
            ["state", "state"] => Self::Matrix {
                column: "State",
                alias: "StateJacobian",
            },
            ["state", "input"] => Self::Matrix {
                column: "Input",
                alias: "InputJacobian",
            },
            ["state", "noise"] => Self::Matrix {
                column: "Noise",
                alias: "Diffusion",
            },
            other => {
                return Err(EmitError::Mismatch(format!(
                    "model `{}` has an output over {other:?}, which the emitter has no form for",
                    model.name
                )));
            }
        })
    }

    fn result(&self) -> String {
        match self {
            Self::Scalar => "R".to_owned(),
            Self::Array(length) => format!("[R; {length}]"),
            Self::Vector => "State<R>".to_owned(),
            Self::Matrix { alias, .. } => format!("{alias}<R>"),
        }
    }

    fn value(
        &self,
        model: &ir::Model,
        output: &ir::Output,
        values: &[String],
        zeros: &mut Vec<(String, &'static str)>,
    ) -> String {
        let at = |names: &[&str]| {
            let position = output.entries.iter().position(|entry| entry.at == names);
            position.map(|k| values[k].clone())
        };
        let rows = output
            .basis
            .first()
            .and_then(|basis| model.bases.get(basis));
        let rows = rows.map_or(&[] as &[Variable], Vec::as_slice);
        match self {
            Self::Scalar => values.first().cloned().unwrap_or_else(|| literal(0.0)),
            Self::Array(_) => {
                let entries = rows
                    .iter()
                    .map(|row| at(&[&row.name]).unwrap_or_else(|| literal(0.0)));
                format!("[{}]", entries.collect::<Vec<_>>().join(", "))
            }
            Self::Vector => {
                let fields = rows.iter().map(|row| field(&row.name, at(&[&row.name])));
                format!("State {{ {} }}", fields.collect::<Vec<_>>().join(", "))
            }
            Self::Matrix { column, .. } => {
                let zero = format!("no_{}", column.to_lowercase());
                let columns = &model.bases[&output.basis[1]];
                let mut any_zero = false;
                let lines: Vec<String> = rows
                    .iter()
                    .map(|row| {
                        let present: Vec<String> = columns
                            .iter()
                            .filter_map(|c| Some(field(&c.name, Some(at(&[&row.name, &c.name])?))))
                            .collect();
                        any_zero |= present.len() < columns.len();
                        let value = match present.len() {
                            0 => zero.clone(),
                            n if n == columns.len() => {
                                format!("{column} {{ {} }}", present.join(", "))
                            }
                            _ => format!("{column} {{ {}, ..{zero} }}", present.join(", ")),
                        };
                        format!("{}: {value}", row.name)
                    })
                    .collect();
                if any_zero {
                    zeros.push((zero, column));
                }
                format!("State {{ {} }}", lines.join(", "))
            }
        }
    }
}

fn field(name: &str, value: Option<String>) -> String {
    match value {
        Some(value) if value == name => value,
        Some(value) => format!("{name}: {value}"),
        None => format!("{name}: {}", literal(0.0)),
    }
}

fn parameter_doc(document: &ir::Document, name: &str) -> String {
    let parameter = document.parameters.iter().find(|p| p.name == name);
    parameter.map_or_else(String::new, |p| described(&p.doc, &p.unit))
}

/// The formula of a prepared value for a reader: that of its `let` where it has one.
fn formula(value: &str, statements: &[Statement]) -> String {
    let bound = statements.iter().find_map(|statement| match statement {
        Statement::Let {
            name, value: bound, ..
        } if name == value => Some(bound.text()),
        _ => None,
    });
    let text = bound.unwrap_or_else(|| value.to_owned()).replace("p.", "");
    match text.strip_suffix(".recip()") {
        Some(below) => format!("1 / {below}"),
        None => text.replace("R::TWO", "2").replace("R::from_f64(3.0)", "3"),
    }
}
