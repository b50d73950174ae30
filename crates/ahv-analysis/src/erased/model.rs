//! The interface, for each generated model.

use std::marker::PhantomData;

use ahv_core::{Bounds, GeneratedModel, ModeOfMotion, Table, TrimProblem, Vector};
use nalgebra::{DMatrix, DVector};

use super::adaptive::{self, Fly};
use super::rows;
use super::steppers::{self, Advance, DeterministicScheme, StepperError};
use super::{AnyModel, Components, ParameterValues, values, vector};
use crate::covariance::{CovarianceError, Flight, Spreading};
use crate::disperse::{self, Draws, Member, Nominal, Slopes, SolutionError};
use crate::dual::output_parameter_slopes;
use crate::linearize::{LinearSystem, LinearizeError, with_outputs};
use crate::monte_carlo::{Engine, Experiment, Feedback, MonteCarloError, Scheme, Unsteady};
use crate::ordered::Control;
use crate::trim::{SteadyState, Trim, TrimError, trim};
use crate::values::matrix;

/// The model `M` behind the interface.
pub(super) struct Erased<M>(PhantomData<fn() -> M>);

impl<M: GeneratedModel> Erased<M> {
    pub(super) const fn new() -> Self {
        Self(PhantomData)
    }
}

fn model<M: GeneratedModel>(p: &[f64]) -> M {
    M::with_parameters(&vector(p))
}

impl<M: GeneratedModel> AnyModel for Erased<M> {
    fn name(&self) -> &'static str {
        M::NAME
    }

    fn title(&self) -> &'static str {
        M::TITLE
    }

    fn note(&self) -> Option<&'static str> {
        M::NOTE
    }

    fn table(&self) -> &'static Table {
        M::TABLE
    }

    fn sets(&self) -> Vec<ParameterValues> {
        let sets = M::SETS.iter().map(|set| ParameterValues {
            name: set.name,
            parameters: values(&set.parameters),
            uncertainty: values(&set.uncertainty()),
        });
        sets.collect()
    }

    fn state_bounds(&self) -> Vec<Bounds> {
        values(&M::STATE_BOUNDS)
    }

    fn input_bounds(&self) -> Vec<Bounds> {
        values(&M::INPUT_BOUNDS)
    }

    fn trim_problem(&self) -> TrimProblem {
        M::TRIM
    }

    fn modes(&self) -> &'static [ModeOfMotion] {
        M::MODES
    }

    fn default_inputs(&self) -> &'static [&'static str] {
        if M::DEFAULT_INPUTS.is_empty() {
            return self.inputs().names;
        }
        M::DEFAULT_INPUTS
    }

    fn default_outputs(&self) -> &'static [&'static str] {
        if M::DEFAULT_OUTPUTS.is_empty() {
            return self.states().names;
        }
        M::DEFAULT_OUTPUTS
    }

    fn deviations(&self) -> &'static [(&'static str, f64)] {
        M::DEVIATIONS
    }

    fn parameters(&self) -> Components {
        Components::of::<f64, M::ParametersOf<f64>>()
    }

    fn states(&self) -> Components {
        Components::of::<f64, M::State>()
    }

    fn inputs(&self) -> Components {
        Components::of::<f64, M::Input>()
    }

    fn outputs(&self) -> Components {
        Components::of::<f64, M::OutputsOf<f64>>()
    }

    fn increments(&self) -> Components {
        Components::of::<f64, M::Noise>()
    }

    fn channels(&self) -> usize {
        <M::Noise as Vector<f64>>::LEN
    }

    fn coloured_states(&self) -> usize {
        M::coloured_states()
    }

    fn is_same(&self, p: &[f64], q: &[f64]) -> bool {
        model::<M>(p) == model::<M>(q)
    }

    fn fault(&self, p: &[f64], x: &[f64], u: &[f64]) -> Option<String> {
        let (model, x, u) = (model::<M>(p), vector(x), vector(u));
        let fault = model.fault(&x, &u);
        fault.map(|it| it.to_string())
    }

    fn drift(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64> {
        values(&model::<M>(p).drift(&vector(x), &vector(u)))
    }

    fn drifts(&self, p: &[f64], x: &[f64], u: &[f64], rates: &mut [f64]) {
        rows::drifts(&model::<M>(p), x, u, rates);
    }

    fn jacobians(&self, p: &[f64], x: &[f64], u: &[f64]) -> [DMatrix<f64>; 2] {
        let (by_state, by_input) = model::<M>(p).jacobians(&vector(x), &vector(u));
        [
            matrix::<M::State, _>(&by_state),
            matrix::<M::Input, _>(&by_input),
        ]
    }

    fn parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        let model = M::with_parameters(&vector(p));
        matrix::<M::ParametersOf<f64>, _>(&model.parameter_jacobian(&vector(x), &vector(u)))
    }

    fn diffusion(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        let (model, x, u) = (model::<M>(p), vector(x), vector(u));
        let columns = (0..self.channels()).map(|channel| {
            let unit = M::Noise::from_fn(|index| f64::from(u8::from(index == channel)));
            DVector::from_vec(values(&model.noise_increment(&x, &u, &unit)))
        });
        match columns.collect::<Vec<_>>() {
            columns if columns.is_empty() => DMatrix::zeros(self.states().len(), 0),
            columns => DMatrix::from_columns(&columns),
        }
    }

    fn output_values(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64> {
        let model = M::generic(&vector::<M::ParametersOf<f64>>(p));
        values(&M::outputs(&model, &vector(x), &vector(u)))
    }

    fn output_parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        let (parameters, x, u) = (vector(p), vector(x), vector(u));
        let columns = (0..p.len()).map(|parameter| {
            let slopes = output_parameter_slopes::<M>(&parameters, parameter, &x, &u);
            DVector::from_vec(values(&slopes))
        });
        DMatrix::from_columns(&columns.collect::<Vec<_>>())
    }

    fn trim(&self, p: &[f64], steady: &SteadyState) -> Result<Trim<Vec<f64>, Vec<f64>>, TrimError> {
        Ok(trim(&model::<M>(p), steady)?.erased())
    }

    fn linearize(
        &self,
        p: &[f64],
        (x, u): (&[f64], &[f64]),
        inputs: &[String],
        outputs: &[String],
    ) -> Result<LinearSystem, LinearizeError> {
        with_outputs::<M>(&vector(p), &vector(x), &vector(u), inputs, outputs)
    }

    fn covariance(
        &self,
        p: &[f64],
        flight: &Flight,
        times: &[f64],
    ) -> Result<Vec<Spreading>, CovarianceError> {
        flight.covariance(&model::<M>(p), times)
    }

    fn stationary(&self, p: &[f64], flight: &Flight) -> Result<DMatrix<f64>, CovarianceError> {
        flight.stationary(&model::<M>(p))
    }

    fn nominal(&self, p: &[f64], steady: SteadyState) -> Result<Nominal, SolutionError> {
        disperse::nominal::<M>(&vector(p), steady)
    }

    fn disperse(
        &self,
        draws: &Draws,
        nominal: &Nominal,
        members: u64,
        control: &Control,
    ) -> Vec<Member> {
        disperse::disperse::<M>(draws, nominal, members, control)
    }

    fn slopes(&self, draws: &Draws, nominal: &Nominal) -> Result<Slopes, SolutionError> {
        disperse::slopes::<M>(draws, nominal)
    }

    fn default_scheme(&self, p: &[f64]) -> Scheme {
        Scheme::default_for::<M>(p)
    }

    fn unsteady(&self, p: &[f64], feedback: &Feedback) -> Option<Unsteady> {
        feedback.unsteady(&model::<M>(p))
    }

    fn deterministic(
        &self,
        p: &[f64],
        stepper: DeterministicScheme,
    ) -> Result<Advance, StepperError> {
        stepper.advance(model::<M>(p))
    }

    fn adaptive(
        &self,
        p: &[f64],
        stepper: DeterministicScheme,
        tolerance: f64,
    ) -> Result<Fly, StepperError> {
        adaptive::fly(stepper, model::<M>(p), tolerance)
    }

    fn stochastic(&self, p: &[f64], scheme: Scheme, seed: u64) -> Result<Advance, StepperError> {
        steppers::stochastic(scheme, model::<M>(p), seed)
    }

    fn engine<'e>(&self, experiment: &'e Experiment) -> Result<Engine<'e>, MonteCarloError> {
        experiment.engine::<M>()
    }
}
