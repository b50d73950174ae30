//! The files of one model: its vectors, its prepared parameters and its functions.

use askama::Template;
use std::collections::{BTreeMap, BTreeSet};

use crate::EmitError;
use crate::body::{Scope, Statement};
use crate::dag::{Dag, Id, Kind, Node};
use crate::decay;
use crate::emit::render;
use crate::filters;
use crate::home;
use crate::ir::{self, Basis, Variable, capitalised, described};
use crate::items::{FunctionText, Item, scatter};
use crate::passes::Passes;
use crate::prepared::Prepared;
use crate::print::reference;
use crate::shape::{Shape, Zeros};
use crate::wording::{
    arguments, formula, parameter_doc, return_last, summary, tuple, values_name, vector_impl,
    wrapped,
};

#[derive(Template)]
#[template(path = "model.rs")]
struct ModelTemplate<'a> {
    model: &'a ir::Model,
    label: String,
    home: &'a str,
    shared_parameters: bool,
    modules: Vec<&'a str>,
    groups: Vec<&'a str>,
    has_choices: bool,
    /// What the home of the table shares.
    shared: Vec<String>,
    /// Vectors, each with its implementation.
    vectors: Vec<(Vector<'a>, String)>,
    /// States that decay by themselves, each with its rate as a field of `Prepared`.
    coloured: Vec<(String, String)>,
}

impl ModelTemplate<'_> {
    /// Whether no column of the diffusion depends on the state.
    fn is_additive(&self) -> bool {
        let columns = self.model.noise.as_ref().map(|noise| &noise.columns);
        columns.is_some_and(|columns| {
            columns
                .iter()
                .all(|column| column.class == ir::NoiseClass::Constant)
        })
    }

    /// Whether every two columns of the diffusion commute.
    fn is_commutative(&self) -> bool {
        let columns = self.model.noise.as_ref().map(|noise| &noise.columns);
        columns.is_some_and(|all| all.iter().all(|j| all.iter().all(|k| self.commute(j, k))))
    }

    /// Whether two columns of the diffusion commute.
    fn commute(&self, j: &ir::NoiseColumn, k: &ir::NoiseColumn) -> bool {
        let pair = |(a, b): &(String, String)| {
            (*a == j.name && *b == k.name) || (*a == k.name && *b == j.name)
        };
        let noise = self.model.noise.as_ref();
        j.name == k.name || noise.is_some_and(|noise| noise.commuting.iter().any(pair))
    }
}

#[derive(Template)]
#[template(path = "description.rs")]
struct DescriptionTemplate<'a> {
    model: &'a ir::Model,
    label: String,
    /// States of coloured noise.
    coloured: usize,
}

impl DescriptionTemplate<'_> {
    /// Deviations that cost 1, in the order of states and inputs.
    fn deviations(&self) -> Vec<(&str, f64)> {
        let model = self.model;
        let vectors = [Basis::State, Basis::Input].map(|basis| model.bases.get(&basis));
        let variables = vectors.into_iter().flatten().flatten();
        let found = variables.filter_map(|v| Some((&*v.name, *model.deviations.get(&v.name)?)));
        found.collect()
    }

    fn bound(&self, bound: &Option<f64>, open: &str) -> String {
        bound.map_or_else(|| open.to_owned(), filters::literal)
    }

    fn like(&self, equation: &ir::Equation) -> String {
        let like = equation.like.as_ref();
        like.map_or_else(
            || "None".to_owned(),
            |(row, state)| format!("Some(({row:?}, {state:?}))"),
        )
    }
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
    docs: Vec<String>,
    value: String,
}

#[derive(Template)]
#[template(path = "functions.rs")]
struct FunctionsTemplate {
    label: String,
    units: &'static str,
    /// Types of the parent module, in alphabetical order.
    imports: Vec<&'static str>,
    paper_names: bool,
    needs_vector: bool,
    items: Vec<Item>,
}

impl FunctionsTemplate {
    fn has_patterns(&self) -> bool {
        self.items
            .iter()
            .any(|item| matches!(item, Item::Pattern(_)))
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
    /// States whose rate is minus a parameter times themselves, each with that parameter.
    decays: Vec<(String, Id)>,
    /// The parameters as a basis.
    parameters: Vec<Variable>,
    /// Operations of each function.
    pub(crate) costs: BTreeMap<String, String>,
}

impl<'a> ModelEmitter<'a> {
    /// Reads the model's expressions; `home` is the module of the table's parameters.
    pub(crate) fn new(
        model: &'a ir::Model,
        home: &'a str,
        document: &'a ir::Document,
        passes: &Passes,
    ) -> Result<Self, EmitError> {
        let mut dag = Dag::new(model, passes)?;
        let mut roots = Vec::new();
        for function in &model.functions {
            roots.push(dag.roots(function)?);
        }
        let named: Vec<(String, Vec<Id>)> = model
            .functions
            .iter()
            .zip(&roots)
            .map(|(function, ids)| (function.name.clone(), ids.clone()))
            .collect();
        let decays = decay::rates(model, &mut dag, &roots);
        let prepared = Prepared::gather(&mut dag, model, &named, &decays);
        let parameters = document.parameters.iter().map(|p| Variable {
            name: p.name.clone(),
            symbol: p.symbol.clone(),
            unit: p.unit.clone(),
            doc: p.doc.clone(),
            validity: None,
            models: Vec::new(),
        });
        Ok(Self {
            model,
            document,
            home,
            dag,
            prepared,
            roots,
            decays,
            parameters: parameters.collect(),
            costs: BTreeMap::new(),
        })
    }

    /// The text of each file, by its name without ending.
    pub(crate) fn files(&mut self) -> Result<BTreeMap<String, String>, EmitError> {
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
        files.insert("prepared".to_owned(), self.prepare()?);
        let description = DescriptionTemplate {
            model: self.model,
            label: self.label(),
            coloured: self.coloured().len(),
        };
        files.insert("description".to_owned(), render(&description)?);
        files.insert("mod".to_owned(), self.module(groups)?);
        Ok(files)
    }

    fn label(&self) -> String {
        self.model.name.to_uppercase()
    }

    fn basis(&self, basis: Basis) -> &'a [Variable] {
        self.model.bases.get(&basis).map_or(&[], Vec::as_slice)
    }

    fn module(&self, mut groups: Vec<&'a str>) -> Result<String, EmitError> {
        groups.sort_unstable();
        let mut modules = groups.clone();
        modules.extend(["description", "prepared"]);
        if self.home == self.model.name {
            modules.extend(["nominal", "parameters", "provenance", "table"]);
            if !self.document.choices.is_empty() {
                modules.push("choices");
            }
        }
        modules.sort_unstable();
        let mut vectors = vec![
            Vector {
                name: "State",
                doc: "State",
                fields: self.basis(Basis::State),
                bounds: Some("STATE_BOUNDS"),
            },
            Vector {
                name: "Input",
                doc: "Input",
                fields: self.basis(Basis::Input),
                bounds: Some("INPUT_BOUNDS"),
            },
        ];
        if self.model.noise.is_some() {
            vectors.push(Vector {
                name: "Noise",
                doc: "One value for each independent Wiener process",
                fields: self.basis(Basis::Noise),
                bounds: None,
            });
        }
        vectors.push(Vector {
            name: "Outputs",
            doc: "Quantities that people look at",
            fields: self.basis(Basis::Output),
            bounds: None,
        });
        let mut lists = Vec::new();
        for vector in &vectors {
            let fields = vector.fields.iter().map(|v| (&v.name, &v.unit));
            lists.push(vector_impl(vector.name, fields, &self.document.units)?);
        }
        render(&ModelTemplate {
            model: self.model,
            label: self.label(),
            home: self.home,
            shared_parameters: self.home != self.model.name,
            has_choices: !self.document.choices.is_empty(),
            shared: home::shared(self.document),
            modules,
            groups,
            vectors: vectors.into_iter().zip(lists).collect(),
            coloured: self.coloured(),
        })
    }

    /// States that decay by themselves, each with the field that holds its rate.
    fn coloured(&self) -> Vec<(String, String)> {
        let field = |(state, rate): &(String, Id)| {
            Some((state.clone(), self.prepared.field(*rate)?.to_owned()))
        };
        self.decays.iter().filter_map(field).collect()
    }

    fn prepare(&mut self) -> Result<String, EmitError> {
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
            let quantity = scope.dag.quantities(field.id).first();
            let quantity = quantity.map(|&position| &self.model.quantities[position]);
            let doc = match (quantity, scope.dag.node(field.id)) {
                (Some(q), _) => described(&q.doc, &q.unit),
                (None, Node::Leaf(_, name)) => parameter_doc(self.document, name),
                (None, _) => format!("`{}`.", formula(&value, &statements)),
            };
            fields.push(PreparedField {
                name: field.name.clone(),
                docs: wrapped(&doc),
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
        let mut items = Vec::new();
        // Functions of one group share the patterns of their results.
        let mut patterns = BTreeSet::new();
        let mut imports = vec!["Input", "Prepared", "State"];
        for position in 0..self.model.functions.len() {
            let function = &self.model.functions[position];
            if function.group != group {
                continue;
            }
            let parameters = std::mem::take(&mut self.parameters);
            let shapes = function
                .outputs
                .iter()
                .map(|o| Shape::of(self.model, &parameters, o));
            let shapes = shapes.collect::<Result<Vec<_>, _>>()?;
            for shape in &shapes {
                imports.extend(shape.vectors());
                imports.extend(shape.alias());
            }
            let ids = self.roots[position].clone();
            if function.compressed {
                for shape in &shapes {
                    if let Some(pattern) = shape.pattern()
                        && patterns.insert(pattern.name.clone())
                    {
                        items.push(Item::Pattern(pattern));
                        items.extend(scatter(shape).map(Item::Function));
                    }
                }
                items.push(Item::Function(self.function(function, &ids, &shapes, true)));
                items.push(Item::Function(self.dense(function, &shapes)));
            } else {
                items.push(Item::Function(
                    self.function(function, &ids, &shapes, false),
                ));
            }
            self.parameters = parameters;
        }
        let functions = || {
            items.iter().filter_map(|item| match item {
                Item::Function(function) => Some(function),
                Item::Pattern(_) => None,
            })
        };
        if functions().any(|f| f.arguments.iter().any(|a| a.contains("Noise<"))) {
            imports.push("Noise");
        }
        imports.sort_unstable();
        imports.dedup();
        render(&FunctionsTemplate {
            label: self.label(),
            units: self.document.units.in_words(),
            imports,
            paper_names: functions().any(|f| f.name.chars().any(char::is_uppercase)),
            needs_vector: functions().any(|f| !f.zeros.is_empty()),
            items,
        })
    }

    /// The function itself, or its compressed form.
    fn function(
        &mut self,
        function: &ir::Function,
        ids: &[Id],
        shapes: &[Shape<'_>],
        compressed: bool,
    ) -> FunctionText {
        let mut scope = Scope::new(&mut self.dag, self.model, Some(&self.prepared));
        let mut statements = scope.write(&function.name, ids);
        let mut zeros = Zeros::new();
        let (mut outputs, mut results) = (Vec::new(), Vec::new());
        let mut remaining = ids.iter();
        for (output, shape) in function.outputs.iter().zip(shapes) {
            let values: Vec<String> = remaining
                .by_ref()
                .take(output.entries.len())
                .map(|&id| reference(&mut scope, id))
                .collect();
            if compressed && shape.pattern().is_some() {
                results.push(format!("[R; {}]", values.len()));
                outputs.push((output.name.clone(), format!("[{}]", values.join(", "))));
            } else {
                results.push(shape.result());
                outputs.push((output.name.clone(), shape.dense(&values, &mut zeros)));
            }
        }
        if let [(_, result)] = outputs.as_mut_slice() {
            return_last(&mut statements, result);
        }
        let (used, scalars) = (scope.used.clone(), scope.arguments.clone());
        let cost = capitalised(&scope.cost.describe());
        self.costs.insert(function.name.clone(), cost.clone());
        let mut docs = summary(function);
        if compressed {
            docs.push(String::new());
            docs.push(
                "The structurally non-zero entries alone, in the order of the pattern.".to_owned(),
            );
        }
        docs.push(String::new());
        docs.push(format!("{cost}."));
        FunctionText {
            name: if compressed {
                values_name(function)
            } else {
                function.name.clone()
            },
            docs,
            arguments: arguments(|kind| used.contains(&kind), &scalars),
            result: tuple(&results),
            source: None,
            statements,
            zeros,
            outputs,
        }
    }

    /// The dense form of a compressed function.
    fn dense(&self, function: &ir::Function, shapes: &[Shape<'_>]) -> FunctionText {
        let results: Vec<String> = shapes.iter().map(Shape::result).collect();
        let call = format!("{}(x, u, p)", values_name(function));
        let named = function.outputs.iter().map(|output| output.name.clone());
        let values: Vec<String> = match shapes {
            [_] => vec![call.clone()],
            _ => named.collect(),
        };
        let source = (shapes.len() > 1).then(|| format!("let {} = {call};", tuple(&values)));
        let dense: Vec<String> = shapes
            .iter()
            .zip(&values)
            .map(|(shape, values)| shape.scattered(values).unwrap_or_else(|| values.clone()))
            .collect();
        FunctionText {
            name: function.name.clone(),
            docs: summary(function),
            arguments: arguments(|kind| kind != Kind::Noise, &BTreeSet::new()),
            result: tuple(&results),
            source,
            statements: Vec::new(),
            zeros: Zeros::new(),
            outputs: vec![(String::new(), tuple(&dense))],
        }
    }
}
