//! The linear system about a state and an input.

use ahv_core::{DifferentiableModel, GeneratedModel, Shown, Vector};
use nalgebra::DMatrix;

use crate::dual::output_slopes;

/// dx/dt = A x + B u, y = C x + D u, for deviations from a state and an input.
///
/// Units are those of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearSystem {
    /// Names of the states.
    pub states: Vec<&'static str>,
    /// Names of the inputs.
    pub inputs: Vec<&'static str>,
    /// Names of the outputs.
    pub outputs: Vec<&'static str>,
    /// ∂f/∂x, states by states.
    pub a: DMatrix<f64>,
    /// ∂f/∂u, states by inputs.
    pub b: DMatrix<f64>,
    /// Outputs by states.
    pub c: DMatrix<f64>,
    /// Outputs by inputs.
    pub d: DMatrix<f64>,
}

/// Why a model cannot be linearised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearizeError {
    /// An input that the model does not have.
    #[error("the model has no input called {0}")]
    UnknownInput(String),
    /// An output that is neither a state nor another quantity of the model.
    #[error("the model has no state or output called {0}")]
    UnknownOutput(String),
    /// A derivative is infinite or NaN.
    #[error("the derivative of {row} by {column} is {}", Shown(*value))]
    NonFinite {
        /// Row of the drift.
        row: &'static str,
        /// State or input.
        column: &'static str,
        /// The value.
        value: f64,
    },
}

/// Linearises `model` at state `x` and input `u`, by its own Jacobians; outputs are states.
///
/// # Errors
///
/// [`LinearizeError`]
pub fn linearize<M>(
    model: &M,
    x: &M::State,
    u: &M::Input,
    inputs: &[&str],
    outputs: &[&str],
) -> Result<LinearSystem, LinearizeError>
where
    M: DifferentiableModel<Scalar = f64>,
{
    let states = M::State::NAMES;
    let inputs = indices::<M::Input>(inputs, LinearizeError::UnknownInput)?;
    let outputs = indices::<M::State>(outputs, LinearizeError::UnknownOutput)?;
    let (by_state, by_input) = model.jacobians(x, u);
    let n = M::State::LEN;
    let entry = |row, column| by_state.get(row).and_then(|it: M::State| it.get(column));
    let a = DMatrix::from_fn(n, n, |row, column| entry(row, column).unwrap_or(0.0));
    let entry = |row, column: usize| {
        let row = by_input.get(row)?;
        row.get(*inputs.get(column)?)
    };
    let b = DMatrix::from_fn(n, inputs.len(), |row, column| {
        entry(row, column).unwrap_or(0.0)
    });
    let named = |of: &[usize], names: &[&'static str]| -> Vec<&'static str> {
        of.iter()
            .filter_map(|&index| names.get(index).copied())
            .collect()
    };
    let system = LinearSystem {
        states: states.to_vec(),
        inputs: named(&inputs, M::Input::NAMES),
        outputs: named(&outputs, states),
        c: DMatrix::from_fn(outputs.len(), n, |row, column| {
            f64::from(u8::from(outputs.get(row) == Some(&column)))
        }),
        d: DMatrix::zeros(outputs.len(), inputs.len()),
        a,
        b,
    };
    system.check()?;
    Ok(system)
}

/// The linear system of a generated model, whose outputs may be states and other quantities.
///
/// # Errors
///
/// [`LinearizeError`]
pub fn with_outputs<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    x: &M::State,
    u: &M::Input,
    inputs: &[String],
    outputs: &[String],
) -> Result<LinearSystem, LinearizeError> {
    let model = M::with_parameters(parameters);
    let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
    let mut system = linearize(&model, x, u, &inputs, &[])?;
    let (n, m) = (system.states.len(), system.inputs.len());
    let slopes = output_slopes(&model, x, u);
    let slope = |output: usize, variable: usize| {
        let slopes: Option<&M::OutputsOf<f64>> = slopes.get(variable);
        slopes.and_then(|slopes| slopes.get(output)).unwrap_or(0.0)
    };
    let places = system
        .inputs
        .iter()
        .map(|name| M::Input::index_of(name).unwrap_or(0));
    let places: Vec<usize> = places.collect();
    (system.c, system.d) = (
        DMatrix::zeros(outputs.len(), n),
        DMatrix::zeros(outputs.len(), m),
    );
    for (row, name) in outputs.iter().enumerate() {
        let name = name.as_str();
        let (known, index) = if let Some(state) = M::State::index_of(name) {
            system.c[(row, state)] = 1.0;
            (M::State::NAMES, state)
        } else if let Some(output) = M::OutputsOf::<f64>::index_of(name) {
            for state in 0..n {
                system.c[(row, state)] = slope(output, state);
            }
            for (column, &input) in places.iter().enumerate() {
                system.d[(row, column)] = slope(output, n + input);
            }
            (M::OutputsOf::<f64>::NAMES, output)
        } else {
            return Err(LinearizeError::UnknownOutput(name.to_owned()));
        };
        system.outputs.extend(known.get(index));
    }
    system.check()?;
    Ok(system)
}

impl LinearSystem {
    fn check(&self) -> Result<(), LinearizeError> {
        let rows = [
            (&self.a, &self.b, &self.states),
            (&self.c, &self.d, &self.outputs),
        ];
        for (by_state, by_input, rows) in rows {
            for (matrix, columns) in [(by_state, &self.states), (by_input, &self.inputs)] {
                for (&column, values) in columns.iter().zip(matrix.column_iter()) {
                    let mut rows = rows.iter().zip(&values);
                    if let Some((&row, &value)) = rows.find(|(_, value)| !value.is_finite()) {
                        return Err(LinearizeError::NonFinite { row, column, value });
                    }
                }
            }
        }
        Ok(())
    }
}

fn indices<V: Vector<f64>>(
    names: &[&str],
    unknown: impl Fn(String) -> LinearizeError,
) -> Result<Vec<usize>, LinearizeError> {
    let index = |name: &&str| V::index_of(name).ok_or_else(|| unknown((*name).to_owned()));
    names.iter().map(index).collect()
}
