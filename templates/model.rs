//! {{ label }}: {{ model.title }}, eq. {{ model.equations }}.

{% for module in modules %}mod {{ module }};
{% endfor %}
{% for group in groups %}pub use {{ group }}::*;
{% endfor -%}
{%- if shared_parameters %}
pub use crate::{{ home }}::{NOMINAL, PROVENANCE, Parameters, VALIDITY, Validity};
{%- else %}
pub use nominal::{NOMINAL, VALIDITY};
pub use parameters::{Parameters, Validity};
pub use provenance::PROVENANCE;
{%- endif %}
pub use prepared::{Prepared, prepare};

use ahv_core::{Bounds, Real};

{%- for v in vectors %}
/// {{ v.doc }} of {{ label }}.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct {{ v.name }}<T> {
{%- for field in v.fields %}
    /// {{ field.described() }}
    pub {{ field.name }}: T,
{%- endfor %}
}

impl<T> {{ v.name }}<T> {
    /// Names of the components.
    pub const NAMES: [&'static str; {{ v.fields.len() }}] = [
        {%- for field in v.fields %}"{{ field.name }}", {% endfor -%}
    ];
    /// Units of the components.
    pub const UNITS: [&'static str; {{ v.fields.len() }}] = [
        {%- for field in v.fields %}"{{ field.unit }}", {% endfor -%}
    ];

    /// The components in order.
    #[inline]
    pub fn to_array(self) -> [T; {{ v.fields.len() }}] {
        [{% for field in v.fields %}self.{{ field.name }}, {% endfor %}]
    }

    /// A vector from its components in order.
    #[inline]
    pub fn from_array(values: [T; {{ v.fields.len() }}]) -> Self {
        let [{% for field in v.fields %}{{ field.name }}, {% endfor %}] = values;
        Self { {% for field in v.fields %}{{ field.name }}, {% endfor %} }
    }
}

ahv_core::impl_vector!({{ v.name }}, {{ v.fields.len() }});
#[cfg(feature = "nalgebra")]
ahv_core::impl_nalgebra!({{ v.name }}, {{ v.fields.len() }});
#[cfg(feature = "nalgebra")]
ahv_core::impl_nalgebra_matrix!(State, {{ vectors[0].fields.len() }}, {{ v.name }}, {{ v.fields.len() }});

{%- if let Some(bounds) = v.bounds %}
/// Where the curve fits are meant to be used.
pub const {{ bounds }}: {{ v.name }}<Bounds> = {{ v.name }} {
{%- for field in v.fields %}
    {{ field.name }}: VALIDITY.{{ field.validity.as_deref().unwrap_or_default() }},
{%- endfor %}
};
{%- endif %}
{%- endfor %}

/// ∂f/∂x: `jacobian.velocity.alpha` is the derivative of the velocity's rate with respect to the angle of attack.
pub type StateJacobian<T> = State<State<T>>;
/// ∂f/∂u, by rows of the state.
pub type InputJacobian<T> = State<Input<T>>;
{%- if stochastic %}
/// G, by rows of the state.
pub type Diffusion<T> = State<Noise<T>>;
{%- endif %}

/// {{ label }} with its parameters prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model<R> {
    /// What depends on parameters alone.
    pub prepared: Prepared<R>,
}

impl<R: Real> Model<R> {
    /// The model for these parameters.
    pub fn new(parameters: &Parameters<R>) -> Self {
        Self { prepared: prepare(parameters) }
    }
}

impl<R: Real> ahv_core::Model for Model<R> {
    type Scalar = R;
    type State = State<R>;
    type Input = Input<R>;

    #[inline]
    fn drift(&self, x: &State<R>, u: &Input<R>) -> State<R> {
        drift(x, u, &self.prepared)
    }
}

impl<R: Real> ahv_core::DifferentiableModel for Model<R> {
    type StateJacobian = StateJacobian<R>;
    type InputJacobian = InputJacobian<R>;

    #[inline]
    fn jacobians(&self, x: &State<R>, u: &Input<R>) -> (StateJacobian<R>, InputJacobian<R>) {
        jacobians(x, u, &self.prepared)
    }

    #[inline]
    fn drift_and_jacobians(&self, x: &State<R>, u: &Input<R>) -> (State<R>, StateJacobian<R>, InputJacobian<R>) {
        drift_and_jacobians(x, u, &self.prepared)
    }
}
{%- if stochastic %}

impl<R: Real> ahv_core::StochasticModel for Model<R> {
    type Noise = Noise<R>;

    #[inline]
    fn noise_increment(&self, x: &State<R>, u: &Input<R>, dw: &Noise<R>) -> State<R> {
        noise_increment(x, u, &self.prepared, dw)
    }
}
{%- endif %}
