//! How trim and roots move with parameters, to first order.

use ahv_core::{GeneratedModel, Vector};
use nalgebra::{Complex, DMatrix};

use super::draws::Draws;
use super::quantity::{Kind, Quantity};
use super::{Nominal, SolutionError};
use crate::dual::output_parameter_slopes;
use crate::linearize::{LinearSystem, linearize};
use crate::sensitivity::RootVectors;
use crate::statistics::deviation_of;
use crate::trim::{ModelChange, Shift, Trim, response};
use crate::values::vector;

/// Step of the central differences, as a share of the parameter.
const STEP: f64 = 1e-5;

/// Slopes of the quantities by the parameters that vary.
#[derive(Clone, Debug, PartialEq)]
pub struct Slopes {
    /// Indices of the parameters.
    pub parameters: Vec<usize>,
    /// By quantity, then by parameter; `None` for a root that is not simple.
    pub by_quantity: Vec<Option<Vec<f64>>>,
}

/// What a parameter's uncertainty does to a quantity, to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// Index of the parameter.
    pub parameter: usize,
    /// Slope: unit of the quantity over that of the parameter.
    pub slope: f64,
    /// What a parameter that is larger in magnitude by a standard deviation adds to the quantity.
    pub effect: f64,
}

impl Slopes {
    /// What each parameter contributes to the quantity number `quantity`, the greatest first, without those that contribute
    /// nothing; empty for a root that is not simple.
    pub fn ranked(&self, quantity: usize, draws: &Draws) -> Vec<Contribution> {
        let slopes = self.by_quantity.get(quantity).and_then(Option::as_ref);
        let pairs = slopes
            .into_iter()
            .flat_map(|slopes| self.parameters.iter().zip(slopes));
        let mut contributions: Vec<Contribution> = pairs
            .map(|(&parameter, &slope)| Contribution {
                parameter,
                slope,
                effect: slope * draws.deviation(parameter),
            })
            .filter(|it| it.effect != 0.0)
            .collect();
        contributions.sort_by(|a, b| b.effect.abs().total_cmp(&a.effect.abs()));
        contributions
    }

    /// Standard deviation of the quantity number `quantity` to first order, correlations included.
    pub fn std(&self, quantity: usize, draws: &Draws) -> Option<f64> {
        self.by_quantity.get(quantity)?.as_ref()?;
        let effects = self.ranked(quantity, draws);
        let pairs = effects
            .iter()
            .flat_map(|a| effects.iter().map(move |b| (a, b)));
        let products =
            pairs.map(|(a, b)| a.effect * b.effect * draws.correlation(a.parameter, b.parameter));
        let variance: f64 = products.sum();
        Some(deviation_of(variance))
    }
}

/// A change per unit of a parameter, along which the trim moves too.
struct Change {
    outputs: Vec<f64>,
    a: DMatrix<f64>,
    b: DMatrix<f64>,
}

/// The slopes of `nominal`'s quantities by the parameters that `draws` vary.
///
/// # Errors
///
/// [`SolutionError`].
pub fn slopes<M: GeneratedModel>(
    draws: &Draws,
    nominal: &Nominal,
) -> Result<Slopes, SolutionError> {
    let parameters = draws.varied();
    let parameters_there: M::ParametersOf<f64> = vector(draws.nominal());
    let model = M::with_parameters(&parameters_there);
    let trim = typed::<M>(nominal);
    let jacobian = model.parameter_jacobian(&trim.state, &trim.input);
    let by = |parameter: usize| {
        let row = |row| {
            jacobian
                .get(row)
                .and_then(|it: M::ParametersOf<f64>| it.get(parameter))
        };
        M::State::from_fn(|index| row(index).unwrap_or(0.0))
    };
    let model_changes = parameters.iter().map(|&parameter| ModelChange {
        drift: by(parameter),
        outputs: output_parameter_slopes::<M>(
            &parameters_there,
            parameter,
            &trim.state,
            &trim.input,
        ),
    });
    let model_changes: Vec<_> = model_changes.collect();
    let Some(moves) = response(&model, &nominal.flight, &trim, &model_changes)? else {
        return Ok(Slopes {
            by_quantity: vec![None; nominal.quantities.len()],
            parameters,
        });
    };
    let changes = parameters
        .iter()
        .zip(&moves)
        .map(|(&parameter, by)| change::<M>(&parameters_there, nominal, parameter, by))
        .collect::<Result<Vec<_>, _>>()?;
    let slopes = |quantity: &Quantity| -> Option<Vec<f64>> {
        if quantity.kind == Kind::Trim {
            let slope = |(shift, change): (&Shift<M::State, M::Input>, &Change)| {
                let state = M::State::index_of(&quantity.name).and_then(|i| shift.state.get(i));
                let input = M::Input::index_of(&quantity.name).and_then(|i| shift.input.get(i));
                let output = M::OutputsOf::<f64>::index_of(&quantity.name);
                let output = output.and_then(|i| change.outputs.get(i).copied());
                state.or(input).or(output)
            };
            return moves.iter().zip(&changes).map(slope).collect();
        }
        let (vectors, bordered) = root_vectors(&nominal.solution.system, quantity, nominal)?;
        let slope = |change: &Change| {
            let matrix = if bordered {
                border(&change.a, &change.b, nominal.solution.system.c.map(|_| 0.0))
            } else {
                change.a.clone()
            };
            quantity.part_of(vectors.slope(&matrix))
        };
        Some(changes.iter().map(slope).collect())
    };
    Ok(Slopes {
        by_quantity: nominal.quantities.iter().map(slopes).collect(),
        parameters,
    })
}

/// The nominal trim.
fn typed<M: GeneratedModel>(nominal: &Nominal) -> Trim<M::State, M::Input> {
    let trim = &nominal.solution.trim;
    Trim {
        state: vector(&trim.state),
        input: vector(&trim.input),
        residuals: vector(&trim.residuals),
        residual_max: trim.residual_max,
        iterations: trim.iterations,
    }
}

/// Central differences by the parameter number `parameter`, the trim moving by `shift` per unit of it.
fn change<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    nominal: &Nominal,
    parameter: usize,
    shift: &Shift<M::State, M::Input>,
) -> Result<Change, SolutionError> {
    let value = parameters.get(parameter).unwrap_or(0.0);
    let trim = typed::<M>(nominal);
    let at = |step: f64| {
        let mut moved = *parameters;
        moved.set(parameter, value + step);
        let model = M::with_parameters(&moved);
        let x = trim.state.zip_with(shift.state, |x, by| x + by * step);
        let u = trim.input.zip_with(shift.input, |u, by| u + by * step);
        let system = linearize(&model, &x, &u, M::DEFAULT_INPUTS, M::DEFAULT_OUTPUTS)?;
        Ok::<_, SolutionError>((M::outputs(&M::generic(&moved), &x, &u), system))
    };
    let step = STEP * value.abs();
    let ((above, system_above), (below, system_below)) = (at(step)?, at(-step)?);
    let per_unit = 0.5 / step;
    Ok(Change {
        outputs: (0..M::OutputsOf::<f64>::LEN)
            .filter_map(|index| Some((above.get(index)? - below.get(index)?) * per_unit))
            .collect(),
        a: (system_above.a - system_below.a) * per_unit,
        b: (system_above.b - system_below.b) * per_unit,
    })
}

/// The null vectors of a quantity's root, and whether they are those of the system's pencil.
fn root_vectors(
    system: &LinearSystem,
    quantity: &Quantity,
    nominal: &Nominal,
) -> Option<(RootVectors, bool)> {
    let (n, outputs) = (system.a.nrows(), system.c.nrows());
    if quantity.kind == Kind::Pole {
        let pole = nominal.solution.poles.get(quantity.index())?.value;
        let mass = DMatrix::identity(n, n);
        return Some((RootVectors::new(&system.a, &mass, pole)?, false));
    }
    let zero: Complex<f64> = *nominal.solution.zeros.get(quantity.index())?;
    let pencil = border(&system.a, &system.b, system.c.clone());
    let mut mass = DMatrix::zeros(n + outputs, n + outputs);
    mass.fill_diagonal(1.0);
    for index in n..n + outputs {
        mass[(index, index)] = 0.0;
    }
    Some((RootVectors::new(&pencil, &mass, zero)?, true))
}

/// The matrix of blocks [a, b; c, 0].
fn border(a: &DMatrix<f64>, b: &DMatrix<f64>, c: DMatrix<f64>) -> DMatrix<f64> {
    let (n, inputs, outputs) = (a.nrows(), b.ncols(), c.nrows());
    let mut matrix = DMatrix::zeros(n + outputs, n + inputs);
    matrix.view_mut((0, 0), (n, n)).copy_from(a);
    matrix.view_mut((0, n), (n, inputs)).copy_from(b);
    matrix.view_mut((n, 0), (outputs, n)).copy_from(&c);
    matrix
}
