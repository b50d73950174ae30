//! Models whose parameters are values at run time, with the derivatives by them.

use ahv_core::{DifferentiableModel, Vector};
use ahv_models::{com, com_rigid, dcom, sdcom, sdcom_gust, sdcom_printed};

/// A model that can be made from other parameters.
pub trait Parametric: DifferentiableModel<Scalar = f64> + Sized {
    /// Parameters of its table.
    type Parameters: Vector<f64>;
    /// ∂f/∂p: a vector over the rows of f; each row is a vector over the parameters.
    type ParameterJacobian: Vector<Self::Parameters>;

    /// The model for these parameters.
    fn with_parameters(parameters: &Self::Parameters) -> Self;

    /// ∂f/∂p at (x, u); the unit of an entry is that of its row per second, over that of its column.
    fn parameter_jacobian(&self, x: &Self::State, u: &Self::Input) -> Self::ParameterJacobian;

    /// Deflections η of the flexible modes at (x, u): states, or what follows the rigid body quasi-statically.
    fn deflections(&self, x: &Self::State, u: &Self::Input) -> Vec<f64>;

    /// Why no vehicle has these parameters; `None` if one may.
    fn contradiction(parameters: &Self::Parameters) -> Option<&'static str>;
}

/// Implements [`Parametric`] for generated models: the deflections, and what may contradict among parameters.
macro_rules! parametric {
    ($($module:ident: |$model:pat_param, $x:pat_param, $u:pat_param| $deflections:expr, $contradiction:expr;)+) => {
        $(impl Parametric for $module::Model<f64> {
            type Parameters = $module::Parameters<f64>;
            type ParameterJacobian = $module::ParameterJacobian<f64>;

            fn with_parameters(parameters: &Self::Parameters) -> Self {
                Self::new(parameters)
            }

            fn parameter_jacobian(&self, x: &Self::State, u: &Self::Input) -> Self::ParameterJacobian {
                $module::parameter_jacobian(x, u, &self.prepared)
            }

            fn deflections(&self, $x: &Self::State, $u: &Self::Input) -> Vec<f64> {
                let $model = &self.prepared;
                $deflections
            }

            fn contradiction(parameters: &Self::Parameters) -> Option<&'static str> {
                $contradiction(parameters)
            }
        })+
    };
}

parametric! {
    com: |_, x, _| vec![x.eta_1, x.eta_2], cantilevers;
    com_rigid: |_, _, _| Vec::new(), |_| None;
    dcom: |_, x, _| vec![x.eta_1, x.eta_2, x.eta_3], |_| None;
    sdcom: |p, x, u| vec![sdcom::eta_1(x, u, p), sdcom::eta_2(x, u, p), sdcom::eta_3(x, u, p)], |_| None;
    sdcom_printed: |p, x, u| vec![sdcom_printed::eta_1(x, u, p), sdcom_printed::eta_2(x, u, p), sdcom_printed::eta_3(x, u, p)],
        |_| None;
    sdcom_gust: |p, x, u| vec![sdcom_gust::eta_1(x, u, p), sdcom_gust::eta_2(x, u, p), sdcom_gust::eta_3(x, u, p)], |_| None;
}

/// The kinetic energy of the beams and the body that they are clamped to must be positive.
fn cantilevers(parameters: &com::Parameters<f64>) -> Option<&'static str> {
    let com::Parameters {
        i_yy, psi_1, psi_2, ..
    } = *parameters;
    (i_yy <= psi_1 * psi_1 + psi_2 * psi_2)
        .then_some("i_yy is not above psi_1^2 + psi_2^2: the mass matrix is not positive definite")
}
