//! `ahv generate`: the command line and the act itself are those of `ahv-generate`.

use ahv_analysis::erased::AnyModel;
use ahv_generate::Values;
use nalgebra::DMatrix;

use crate::registry;

pub(crate) use ahv_generate::Args as Arguments;

/// Runs the command, which says for itself what it did or why it failed.
pub(crate) fn run(arguments: &Arguments) -> u8 {
    ahv_generate::run_with(arguments, &evaluate)
}

/// What the compiled functions of a model give at a point, for an audit; `None` if this program does not know the model.
fn evaluate(model: &str, point: &Values) -> Option<Values> {
    let model = registry::models().find(|known| known.name() == model)?;
    let part = |prefix: &str, names: &[&str]| -> Option<Vec<f64>> {
        let number = |name: &&str| point.get(&format!("{prefix}.{name}")).copied();
        names.iter().map(number).collect()
    };
    let (states, inputs) = (model.states().names, model.inputs().names);
    // A model of the same name with other variables is another model.
    let x = part("state", states)?;
    let u = part("input", inputs)?;
    let p = part("parameter", model.parameters().names)?;
    let mut values = Values::new();
    put(&mut values, "drift", states, &model.drift(&p, &x, &u));
    let shown = model.output_values(&p, &x, &u);
    put(&mut values, "outputs", model.outputs().names, &shown);
    let [by_state, by_input] = model.jacobians(&p, &x, &u);
    for (label, columns, matrix) in [
        ("jacobians.state", states, by_state),
        ("jacobians.input", inputs, by_input),
        (
            "parameter_jacobian",
            model.parameters().names,
            model.parameter_jacobian(&p, &x, &u),
        ),
        (
            "diffusion",
            model.increments().names,
            model.diffusion(&p, &x, &u),
        ),
    ] {
        put_matrix(&mut values, label, model, columns, &matrix);
    }
    Some(values)
}

fn put(values: &mut Values, label: &str, names: &[&str], numbers: &[f64]) {
    let named = names.iter().zip(numbers);
    values.extend(named.map(|(name, &number)| (format!("{label}.{name}"), number)));
}

/// A matrix whose rows are those of the drift.
fn put_matrix(
    values: &mut Values,
    label: &str,
    model: &dyn AnyModel,
    columns: &[&str],
    matrix: &DMatrix<f64>,
) {
    for (index, row) in model.states().names.iter().enumerate() {
        let numbers: Vec<f64> = matrix.row(index).iter().copied().collect();
        put(values, &format!("{label}.{row}"), columns, &numbers);
    }
}
