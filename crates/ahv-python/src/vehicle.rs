//! A model in its condition: its names and numbers, and its functions at many points.

use ahv_analysis::erased::{AnyModel, ParameterValues};
use ahv_analysis::linearize::LinearSystem;
use ahv_analysis::poles;
use ahv_cli::embedded;
use ahv_cli::labels::Labels;
use ahv_cli::vehicle;
use ahv_core::Bounds;
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2};
use pyo3::prelude::*;

use crate::failure::{numeric, raised, request};
use crate::linear::{Nested, Pair, matrix, nested, pair};
use crate::rows::{Rows, fill};

/// The models that this module has: name and title.
#[pyfunction]
pub(crate) fn models() -> Vec<(&'static str, &'static str)> {
    let models = embedded::models();
    models.map(|model| (model.name(), model.title())).collect()
}

/// Names and units.
type Named = (Vec<&'static str>, Vec<&'static str>);
/// A pole with its mode and the share of the mode's states in it.
type Pole = (Pair, Option<&'static str>, f64);

/// A model in its condition. Vectors are in the order of their names, arrays have a row for each point.
#[pyclass(frozen)]
pub(crate) struct Vehicle {
    own: vehicle::Vehicle,
    #[pyo3(get)]
    notes: Vec<String>,
}

fn named(labels: Labels) -> Named {
    (labels.names.to_vec(), labels.units.to_vec())
}

fn ends(bounds: &[Bounds]) -> Vec<Pair> {
    bounds.iter().map(|it| (it.min, it.max)).collect()
}

/// What is computed at a point.
#[derive(Clone, Copy)]
enum Kind {
    Drift,
    /// ∂f/∂x and ∂f/∂u side by side.
    Jacobians,
    ByParameters,
    Diffusion,
    Outputs,
}

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "drift" => Self::Drift,
            "jacobians" => Self::Jacobians,
            "parameter_jacobian" => Self::ByParameters,
            "diffusion" => Self::Diffusion,
            "outputs" => Self::Outputs,
            _ => return None,
        })
    }

    /// Numbers of a point; of a matrix row by row.
    fn numbers(self, model: &dyn AnyModel) -> usize {
        let n = model.states().len();
        match self {
            Self::Drift => n,
            Self::Jacobians => n * (n + model.inputs().len()),
            Self::ByParameters => n * model.parameters().len(),
            Self::Diffusion => n * model.channels(),
            Self::Outputs => model.outputs().len(),
        }
    }

    fn write(self, model: &dyn AnyModel, [p, x, u]: [&[f64]; 3], out: &mut [f64]) {
        let matrices = match self {
            Self::Drift => return out.copy_from_slice(&model.drift(p, x, u)),
            Self::Outputs => return out.copy_from_slice(&model.output_values(p, x, u)),
            Self::Jacobians => Vec::from(model.jacobians(p, x, u)),
            Self::ByParameters => vec![model.parameter_jacobian(p, x, u)],
            Self::Diffusion => vec![model.diffusion(p, x, u)],
        };
        let rows = (0..x.len()).flat_map(|row| {
            let of = matrices.iter().map(move |matrix| matrix.row(row));
            of.flat_map(|row| row.iter().copied().collect::<Vec<f64>>())
        });
        for (place, number) in out.iter_mut().zip(rows) {
            *place = number;
        }
    }
}

#[pymethods]
impl Vehicle {
    /// By the words of the flags of a command line.
    #[new]
    fn new(py: Python<'_>, words: Vec<String>) -> PyResult<Self> {
        let made = py.detach(|| embedded::vehicle(words));
        let (own, notes) = made.map_err(|failure| raised(py, &failure))?;
        Ok(Self { own, notes })
    }

    #[getter]
    fn name(&self) -> &'static str {
        self.own.model.name()
    }

    #[getter]
    fn title(&self) -> &'static str {
        self.own.model.title()
    }

    #[getter]
    fn set(&self) -> &str {
        &self.own.set
    }

    /// Names of the sets that the model was generated with.
    #[getter]
    fn sets(&self) -> Vec<&'static str> {
        let sets = self.own.model.sets();
        sets.iter()
            .map(|ParameterValues { name, .. }| *name)
            .collect()
    }

    /// Choices, each with what is chosen and all that there is to choose.
    #[getter]
    fn choices(&self) -> Vec<(&'static str, Option<&'static str>, Vec<&'static str>)> {
        let table = self.own.model.table();
        let choices = self.own.choices.iter().map(|&(name, chosen)| {
            let own = table.choices.iter().find(|choice| choice.name == name);
            let options = own.map(|choice| choice.options.iter().map(|option| option.name));
            (name, chosen, options.into_iter().flatten().collect())
        });
        choices.collect()
    }

    #[getter]
    fn unit_system(&self) -> &'static str {
        self.own.units.name()
    }

    #[getter]
    fn states(&self) -> Named {
        named(self.own.states)
    }

    #[getter]
    fn inputs(&self) -> Named {
        named(self.own.inputs)
    }

    #[getter]
    fn outputs(&self) -> Named {
        named(self.own.outputs)
    }

    #[getter]
    fn increments(&self) -> Named {
        named(self.own.units.labels(self.own.model.increments()))
    }

    #[getter]
    fn parameters(&self) -> Named {
        named(self.own.units.labels(self.own.model.parameters()))
    }

    #[getter]
    fn parameter_values(&self) -> Vec<f64> {
        self.own.parameters.clone()
    }

    #[getter]
    fn uncertainty(&self) -> Vec<f64> {
        self.own.uncertainty.clone()
    }

    #[getter]
    fn state_bounds(&self) -> Vec<Pair> {
        ends(&self.own.state_bounds)
    }

    #[getter]
    fn input_bounds(&self) -> Vec<Pair> {
        ends(&self.own.input_bounds)
    }

    /// What is given of a steady state.
    #[getter]
    fn given(&self) -> Vec<&'static str> {
        let problem = self.own.model.trim_problem();
        problem.given.iter().map(|given| given.name).collect()
    }

    /// Writes a function of the model at every row of `x` into that row of `out`. `u` and `p` have a row for each, or one for
    /// all.
    fn evaluate(
        &self,
        py: Python<'_>,
        kind: &str,
        x: PyReadonlyArray2<'_, f64>,
        u: PyReadonlyArray2<'_, f64>,
        p: PyReadonlyArray2<'_, f64>,
        mut out: PyReadwriteArray2<'_, f64>,
    ) -> PyResult<()> {
        let model = self.own.model;
        let kind = Kind::of(kind).ok_or_else(|| request(py, &format!("there is no {kind}")))?;
        let (count, columns) = (out.as_array().nrows(), out.as_array().ncols());
        if columns != kind.numbers(model) {
            return Err(request(
                py,
                "out: it has not as many columns as there are results",
            ));
        }
        let x = Rows::new("x", &x, model.states().len(), count)?;
        let u = Rows::new("u", &u, model.inputs().len(), count)?;
        let p = Rows::new("p", &p, model.parameters().len(), count)?;
        // In lanes where one model is at all points.
        let lanes = matches!(kind, Kind::Drift) && p.is_single() && !(x.is_single() && count > 1);
        fill(py, &mut out, &[x, u, p], |first, out| {
            if lanes {
                let rows = out.len() / columns;
                return model.drifts(p.row(0), x.part(first, rows), u.part(first, rows), out);
            }
            for (point, out) in (first..).zip(out.chunks_exact_mut(columns)) {
                kind.write(model, [p.row(point), x.row(point), u.row(point)], out);
            }
        })
    }

    /// A, B, C, D about a point, and the names of inputs and outputs.
    #[allow(clippy::type_complexity, reason = "a tuple of Python")]
    fn linearize(
        &self,
        py: Python<'_>,
        x: PyReadonlyArray1<'_, f64>,
        u: PyReadonlyArray1<'_, f64>,
        inputs: Vec<String>,
        outputs: Vec<String>,
    ) -> PyResult<([Nested; 4], Vec<&'static str>, Vec<&'static str>)> {
        let (x, u): (Vec<f64>, Vec<f64>) = (
            x.as_array().iter().copied().collect(),
            u.as_array().iter().copied().collect(),
        );
        let system = self.own.linear((&x, &u), &inputs, &outputs);
        let system = system.map_err(|failure| raised(py, &failure))?;
        let matrices = [&system.a, &system.b, &system.c, &system.d].map(nested);
        Ok((matrices, system.inputs, system.outputs))
    }

    /// Poles of a matrix of the states, with the modes of the model.
    fn poles(&self, py: Python<'_>, a: PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Pole>> {
        let model = self.own.model;
        let system = LinearSystem {
            states: model.states().names.to_vec(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            a: matrix(&a),
            b: nalgebra::DMatrix::zeros(0, 0),
            c: nalgebra::DMatrix::zeros(0, 0),
            d: nalgebra::DMatrix::zeros(0, 0),
        };
        let found = py.detach(|| poles::poles(&system, model.modes()));
        let found = found.map_err(|error| numeric(py, error))?;
        let poles = found.iter();
        Ok(poles
            .map(|pole| (pair(&pole.value), pole.mode, pole.participation))
            .collect())
    }
}
