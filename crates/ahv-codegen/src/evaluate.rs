//! The values of expressions: an IR compiled once to a list of operations, then run at many points.
//!
//! Elementary functions are those of `ahv-core`, so that a number has the same bits on every machine.

use ahv_core::Real;
use std::collections::{BTreeMap, HashMap};

use crate::EmitError;
use crate::call::{Call, MOST};
use crate::ir::{Expr, Model};

#[cfg(test)]
mod tests;

/// One operation on the values before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Operation {
    /// A leaf, by its position in [`Tape::leaves`].
    Leaf(usize),
    /// A constant, by its bits.
    Number(u64),
    Add(usize, usize),
    Subtract(usize, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    Negate(usize),
    /// A function; the places beyond its arguments are 0.
    Call(Call, [usize; MOST]),
}

/// Expressions of one model as a flat list of operations; what stands twice is computed once.
#[derive(Debug, Default)]
pub(crate) struct Tape {
    /// Leaves with their prefix (`x.alpha`, `p.m`), in the order in which [`Tape::run`] takes their values.
    leaves: Vec<String>,
    operations: Vec<Operation>,
    outputs: Vec<usize>,
}

impl Tape {
    /// Compiles expressions of a model.
    ///
    /// # Errors
    /// [`EmitError::Mismatch`] for an expression with a name that the model does not have or an unknown operator.
    pub(crate) fn compile<'a>(
        model: &Model,
        roots: impl IntoIterator<Item = &'a Expr>,
    ) -> Result<Self, EmitError> {
        let quantities = model.quantities.iter().map(|q| (q.name.as_str(), &q.expr));
        let mut compiler = Compiler {
            model: &model.name,
            quantities: quantities.collect(),
            known: HashMap::new(),
            index: HashMap::new(),
            leaf_index: BTreeMap::new(),
            tape: Self::default(),
        };
        for root in roots {
            let output = compiler.expression(root)?;
            compiler.tape.outputs.push(output);
        }
        Ok(compiler.tape)
    }

    /// The leaves that the expressions depend on, with their prefix.
    pub(crate) fn leaves(&self) -> &[String] {
        &self.leaves
    }

    /// The values of the outputs where the leaves have the given values, in the order of [`Tape::leaves`].
    ///
    /// `scratch` holds intermediate values; one vector serves many calls. With [`Lanes`](ahv_core::Lanes) many points
    /// are evaluated at once, each with the same bits as alone.
    pub(crate) fn run<T: Real>(&self, values: &[T], scratch: &mut Vec<T>, outputs: &mut Vec<T>) {
        scratch.clear();
        for &operation in &self.operations {
            let value = match operation {
                Operation::Leaf(position) => values[position],
                Operation::Number(bits) => T::from_f64(f64::from_bits(bits)),
                Operation::Add(a, b) => scratch[a] + scratch[b],
                Operation::Subtract(a, b) => scratch[a] - scratch[b],
                Operation::Multiply(a, b) => scratch[a] * scratch[b],
                Operation::Divide(a, b) => scratch[a] / scratch[b],
                Operation::Negate(a) => -scratch[a],
                Operation::Call(call, places) => call.value(places.map(|place| scratch[place])),
            };
            scratch.push(value);
        }
        outputs.clear();
        outputs.extend(self.outputs.iter().map(|&output| scratch[output]));
    }

    /// The same tape with the leaves that `value` knows replaced by their values, and what depends on them alone
    /// computed.
    pub(crate) fn fixed(&self, value: impl Fn(&str) -> Option<f64>) -> Self {
        let mut tape = Self::default();
        let mut moved = Vec::with_capacity(self.operations.len());
        for &operation in &self.operations {
            let operation = match operation {
                Operation::Leaf(position) => {
                    let leaf = &self.leaves[position];
                    value(leaf).map_or_else(
                        || {
                            tape.leaves.push(leaf.clone());
                            Operation::Leaf(tape.leaves.len() - 1)
                        },
                        |known| Operation::Number(known.to_bits()),
                    )
                }
                other => tape.folded(renumbered(other, &moved)),
            };
            moved.push(tape.operations.len());
            tape.operations.push(operation);
        }
        tape.outputs = self.outputs.iter().map(|&output| moved[output]).collect();
        tape
    }

    /// The tape of one output alone; its leaves are those of the whole.
    pub(crate) fn only(&self, output: usize) -> Self {
        let mut needed = vec![false; self.operations.len()];
        needed[self.outputs[output]] = true;
        for (position, &operation) in self.operations.iter().enumerate().rev() {
            if needed[position] {
                arguments(operation).for_each(|argument| needed[argument] = true);
            }
        }
        let mut moved = vec![0; self.operations.len()];
        let mut operations = Vec::new();
        for (position, &operation) in self.operations.iter().enumerate() {
            if needed[position] {
                moved[position] = operations.len();
                operations.push(renumbered(operation, &moved));
            }
        }
        Self {
            leaves: self.leaves.clone(),
            operations,
            outputs: vec![moved[self.outputs[output]]],
        }
    }

    /// Whether an output depends on a leaf, by its position.
    pub(crate) fn depends_on(&self, leaf: usize) -> bool {
        self.operations.contains(&Operation::Leaf(leaf))
    }

    /// The constant that an operation on constants gives, else the operation.
    fn folded(&self, operation: Operation) -> Operation {
        let constant = |position: usize| matches!(self.operations[position], Operation::Number(_));
        if !arguments(operation).all(constant) || matches!(operation, Operation::Number(_)) {
            return operation;
        }
        let alone = Self {
            leaves: Vec::new(),
            operations: arguments(operation)
                .map(|position| self.operations[position])
                .chain([renumbered_in_order(operation)])
                .collect(),
            outputs: Vec::new(),
        };
        let mut scratch = Vec::<f64>::new();
        alone.run(&[], &mut scratch, &mut Vec::new());
        let value = scratch.last().copied().unwrap_or(f64::NAN);
        Operation::Number(value.to_bits())
    }
}

fn arguments(operation: Operation) -> impl Iterator<Item = usize> {
    use Operation as O;
    let (places, count) = match operation {
        O::Leaf(_) | O::Number(_) => ([0; MOST], 0),
        O::Add(a, b) | O::Subtract(a, b) | O::Multiply(a, b) | O::Divide(a, b) => ([a, b, 0, 0], 2),
        O::Negate(a) => ([a, 0, 0, 0], 1),
        O::Call(call, places) => (places, call.arity()),
    };
    places.into_iter().take(count)
}

/// The operation with its arguments where they have moved to.
fn renumbered(operation: Operation, moved: &[usize]) -> Operation {
    with_arguments(operation, |position, _| moved[position])
}

/// The operation with its arguments numbered from 0.
fn renumbered_in_order(operation: Operation) -> Operation {
    with_arguments(operation, |_, order| order)
}

fn with_arguments(operation: Operation, new: impl Fn(usize, usize) -> usize) -> Operation {
    use Operation as O;
    match operation {
        O::Leaf(_) | O::Number(_) => operation,
        O::Add(a, b) => O::Add(new(a, 0), new(b, 1)),
        O::Subtract(a, b) => O::Subtract(new(a, 0), new(b, 1)),
        O::Multiply(a, b) => O::Multiply(new(a, 0), new(b, 1)),
        O::Divide(a, b) => O::Divide(new(a, 0), new(b, 1)),
        O::Negate(a) => O::Negate(new(a, 0)),
        O::Call(call, mut places) => {
            let own = places.iter_mut().zip(0..call.arity());
            own.for_each(|(place, order)| *place = new(*place, order));
            O::Call(call, places)
        }
    }
}

struct Compiler<'a> {
    model: &'a str,
    quantities: HashMap<&'a str, &'a Expr>,
    /// Where the value of a quantity stands.
    known: HashMap<String, usize>,
    index: HashMap<Operation, usize>,
    leaf_index: BTreeMap<String, usize>,
    tape: Tape,
}

impl Compiler<'_> {
    fn push(&mut self, operation: Operation) -> usize {
        let next = self.tape.operations.len();
        let position = *self.index.entry(operation).or_insert(next);
        if position == next {
            self.tape.operations.push(operation);
        }
        position
    }

    fn expression(&mut self, expr: &Expr) -> Result<usize, EmitError> {
        match expr {
            Expr::Number(value) => Ok(self.push(Operation::Number(value.to_bits()))),
            Expr::Name(name) => self.name(name),
            Expr::Apply(parts) => match parts.split_first() {
                Some((Expr::Name(operator), arguments)) => self.apply(operator, arguments),
                _ => Err(self.fault("an expression without an operator")),
            },
        }
    }

    fn name(&mut self, name: &str) -> Result<usize, EmitError> {
        if name.contains('.') {
            let next = self.tape.leaves.len();
            let position = *self.leaf_index.entry(name.to_owned()).or_insert(next);
            if position == next {
                self.tape.leaves.push(name.to_owned());
            }
            return Ok(self.push(Operation::Leaf(position)));
        }
        if let Some(&position) = self.known.get(name) {
            return Ok(position);
        }
        let Some(&expr) = self.quantities.get(name) else {
            return Err(self.fault(&format!("the unknown name `{name}`")));
        };
        let position = self.expression(expr)?;
        self.known.insert(name.to_owned(), position);
        Ok(position)
    }

    fn apply(&mut self, operator: &str, arguments: &[Expr]) -> Result<usize, EmitError> {
        if let ("pow", [base, Expr::Number(exponent)]) = (operator, arguments) {
            let base = self.expression(base)?;
            return Ok(self.power(base, *exponent as i32));
        }
        let values: Result<Vec<usize>, EmitError> =
            arguments.iter().map(|a| self.expression(a)).collect();
        let operation = match (operator, values?.as_slice()) {
            ("+", [first, rest @ ..]) => return Ok(self.chain(*first, rest, Operation::Add)),
            ("*", [first, rest @ ..]) => return Ok(self.chain(*first, rest, Operation::Multiply)),
            ("-", &[a, b]) => Operation::Subtract(a, b),
            ("/", &[a, b]) => Operation::Divide(a, b),
            ("neg", &[a]) => Operation::Negate(a),
            (name, values) => match Call::of(name, values.len()) {
                Some(call) => {
                    let mut places = [0; MOST];
                    places[..values.len()].copy_from_slice(values);
                    Operation::Call(call, places)
                }
                None => return Err(self.fault(&format!("the operator `{operator}`"))),
            },
        };
        Ok(self.push(operation))
    }

    fn chain(
        &mut self,
        first: usize,
        rest: &[usize],
        operation: fn(usize, usize) -> Operation,
    ) -> usize {
        let step = |sum: usize, &value: &usize| self.push(operation(sum, value));
        rest.iter().fold(first, step)
    }

    /// A whole power by squaring.
    fn power(&mut self, base: usize, exponent: i32) -> usize {
        let one = Operation::Number(1_f64.to_bits());
        if exponent < 0 {
            let below = self.power(base, -exponent);
            let above = self.push(one);
            return self.push(Operation::Divide(above, below));
        }
        match exponent {
            0 => self.push(one),
            1 => base,
            _ => {
                let half = self.power(base, exponent / 2);
                let square = self.push(Operation::Multiply(half, half));
                if exponent % 2 == 0 {
                    return square;
                }
                self.push(Operation::Multiply(square, base))
            }
        }
    }

    fn fault(&self, what: &str) -> EmitError {
        EmitError::Mismatch(format!(
            "the IR of model `{}` has {what}, which cannot be evaluated",
            self.model
        ))
    }
}
