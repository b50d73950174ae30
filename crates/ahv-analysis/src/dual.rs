//! Exact derivatives of generated functions, by numbers that carry a slope.

use ahv_core::{Dual, GeneratedModel, Vector};

/// The derivatives of the outputs at (x, u) by the parameter number `parameter`, state and input held.
pub fn output_parameter_slopes<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    parameter: usize,
    x: &M::State,
    u: &M::Input,
) -> M::OutputsOf<f64> {
    let mut moved = M::map_parameters(parameters, |&it| Dual::constant(it));
    let seeded = moved.get(parameter).map(|it| Dual::variable(it.value));
    seeded.and_then(|it| moved.set(parameter, it));
    let x = M::map_state(x, |&it| Dual::constant(it));
    let u = M::map_input(u, |&it| Dual::constant(it));
    let outputs = M::outputs(&M::generic(&moved), &x, &u);
    Vector::from_fn(|index| outputs.get(index).map_or(0.0, |it: Dual| it.slope))
}

/// The derivatives of the outputs of `model` at (x, u) by each state, then by each input: a vector over the outputs each.
pub fn output_slopes<M: GeneratedModel>(
    model: &M,
    x: &M::State,
    u: &M::Input,
) -> Vec<M::OutputsOf<f64>> {
    let model = model.with_scalar::<Dual>();
    let states = <M::State as Vector<f64>>::LEN;
    let slopes = (0..states + <M::Input as Vector<f64>>::LEN).map(|variable| {
        let mut x = M::map_state(x, |&it| Dual::constant(it));
        let mut u = M::map_input(u, |&it| Dual::constant(it));
        let seeded = |it: Dual| Dual::variable(it.value);
        match variable.checked_sub(states) {
            None => x
                .get(variable)
                .map(seeded)
                .and_then(|it| x.set(variable, it)),
            Some(input) => u.get(input).map(seeded).and_then(|it| u.set(input, it)),
        };
        let outputs = M::outputs(&model, &x, &u);
        M::OutputsOf::<f64>::from_fn(|index| outputs.get(index).map_or(0.0, |it| it.slope))
    });
    slopes.collect()
}
