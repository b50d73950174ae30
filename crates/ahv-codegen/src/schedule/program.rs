//! A model as it is emitted, in no language yet: what printers of each language start from.

use std::collections::BTreeMap;

use super::body;
use super::prepared::Prepared;
use super::tree::{Body, Expr};
use crate::EmitError;
use crate::graph::passes::Passes;
use crate::graph::{Dag, Id, Node, decay};
use crate::ir::{self, capitalised, described};
use crate::shape::Shape;
use crate::wording::parameter_doc;

/// A model with the bodies of its functions.
pub(crate) struct Program<'a> {
    pub(crate) model: &'a ir::Model,
    pub(crate) document: &'a ir::Document,
    /// The module in which the parameters of the table stand.
    pub(crate) home: &'a str,
    /// What computes [`Program::fields`].
    pub(crate) prepare: Body,
    /// What depends on parameters alone.
    pub(crate) fields: Vec<Field>,
    pub(crate) functions: Vec<Function<'a>>,
    /// States that decay by themselves, each with the field that holds its rate.
    pub(crate) coloured: Vec<(String, String)>,
}

/// A prepared value.
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) value: Expr,
    /// What it is, as a sentence; `None` where its formula says it.
    pub(crate) about: Option<String>,
}

/// A function with what it does.
pub(crate) struct Function<'a> {
    pub(crate) ir: &'a ir::Function,
    /// The shapes of its outputs.
    pub(crate) shapes: Vec<Shape<'a>>,
    /// Its results are the entries of the outputs in turn.
    pub(crate) body: Body,
}

impl<'a> Program<'a> {
    /// Reads a model's expressions and decides what is computed in which order under which name.
    ///
    /// # Errors
    /// [`EmitError::Mismatch`] where the IR holds what it cannot.
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
        let functions = model.functions.iter().zip(&roots);
        let named: Vec<(String, Vec<Id>)> = functions
            .map(|(function, ids)| (function.name.clone(), ids.clone()))
            .collect();
        let decays = decay::rates(model, &mut dag, &roots);
        let prepared = Prepared::gather(&mut dag, model, &named, &decays);
        let (prepare, fields) = prepare(&mut dag, model, document, &prepared);
        let mut functions = Vec::new();
        for (function, ids) in model.functions.iter().zip(&roots) {
            let shapes = function.outputs.iter();
            let shapes = shapes.map(|output| Shape::of(model, document, output));
            let shapes = shapes.collect::<Result<Vec<_>, _>>()?;
            let mut body = body(&mut dag, model, Some(&prepared), &function.name, ids);
            if matches!(shapes.as_slice(), [shape] if shape.axes.is_empty()) {
                body.return_last();
            }
            functions.push(Function {
                ir: function,
                shapes,
                body,
            });
        }
        let coloured = decays
            .iter()
            .filter_map(|(state, rate)| Some((state.clone(), prepared.field(*rate)?.to_owned())));
        Ok(Self {
            model,
            document,
            home,
            prepare,
            fields,
            functions,
            coloured: coloured.collect(),
        })
    }

    /// The model's name as people write it.
    pub(crate) fn label(&self) -> String {
        self.model.name.to_uppercase()
    }

    /// The operations of each function, in words.
    pub(crate) fn costs(&self) -> BTreeMap<String, String> {
        let functions = self.functions.iter();
        let cost = |it: &Function<'_>| capitalised(&it.body.cost().describe());
        functions.map(|it| (it.ir.name.clone(), cost(it))).collect()
    }

    /// The groups of the functions, in the order of the IR: each becomes a file, or a section of one.
    pub(crate) fn groups(&self) -> Vec<&'a str> {
        let mut groups: Vec<&str> = Vec::new();
        for function in &self.model.functions {
            if !groups.contains(&&*function.group) {
                groups.push(&function.group);
            }
        }
        groups
    }
}

/// The body of `prepare`, and the fields that it computes.
fn prepare(
    dag: &mut Dag,
    model: &ir::Model,
    document: &ir::Document,
    prepared: &Prepared,
) -> (Body, Vec<Field>) {
    let computed = prepared.fields.iter().map(|field| field.id);
    let computed = computed.filter(|&id| !matches!(dag.node(id), Node::Leaf(..)));
    let computed: Vec<Id> = computed.collect();
    let body = body(dag, model, None, "prepared", &computed);
    let mut fields = Vec::new();
    let mut results = body.results.iter();
    for field in &prepared.fields {
        let (value, leaf) = match dag.node(field.id) {
            Node::Leaf(kind, name) => (Some(Expr::Component(*kind, name.clone())), Some(name)),
            _ => (results.next().cloned(), None),
        };
        let quantity = dag.quantities(field.id).first();
        let about = quantity.map(|&position| {
            let quantity = &model.quantities[position];
            described(&quantity.doc, &quantity.unit)
        });
        let about = about.or_else(|| leaf.map(|name| parameter_doc(document, name)));
        fields.extend(value.map(|value| Field {
            name: field.name.clone(),
            value,
            about,
        }));
    }
    (body, fields)
}
