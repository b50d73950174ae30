//! {{ model.heading() }}.

{% for module in modules %}mod {{ module }};
{% endfor %}
{% for group in groups %}pub use {{ group }}::*;
{% endfor -%}
{%- if shared_parameters %}
pub use crate::{{ home }}::{ {{- shared.join(", ") -}} };
{%- else %}
{%- if has_choices %}
pub use choices::*;
{%- endif %}
pub use nominal::*;
pub use parameters::{Parameters, Validity};
pub use provenance::*;
pub use table::*;
{%- endif %}
pub use prepared::{Prepared, prepare};

use ahv_core::{Bounds, {% if model.noise.is_some() %}NoiseClass, {% endif %}Pattern, Real{% if model.noise.is_some() %}, Vector{% endif %}};

{%- for (v, definition) in vectors %}
{{ definition }}
{%- if let Some(bounds) = v.bounds %}
/// Where the curve fits are meant to be used.
pub const {{ bounds }}: {{ v.name }}<Bounds> = {{ v.name }} {
{%- for field in v.fields %}
    {{ field.name }}: VALIDITY.{{ field.validity.as_deref().unwrap_or_default() }},
{%- endfor %}
};
{%- endif %}
{%- endfor %}


#[cfg(feature = "nalgebra")]
ahv_core::impl_nalgebra!(State by State, {% for (v, _) in vectors[1..] %}{{ v.name }}{% if !loop.last %}, {% endif %}{% endfor %});

{%- if let [first, second, ..] = vectors[0].0.fields %}

/// ∂f/∂x: `jacobian.{{ first.name }}.{{ second.name }}` is the derivative of the first component's rate with respect to the second.
{%- else %}

/// ∂f/∂x.
{%- endif %}
pub type StateJacobian<T> = State<State<T>>;
/// ∂f/∂u, by rows of the state.
pub type InputJacobian<T> = State<Input<T>>;
/// ∂f/∂p, by rows of the state.
pub type ParameterJacobian<T> = State<Parameters<T>>;
/// ∂²f/∂x², by rows of the state.
pub type Hessian<T> = State<State<State<T>>>;
{%- if let Some(noise) = model.noise %}
/// G, by rows of the state.
pub type Diffusion<T> = State<Noise<T>>;
/// L^j b^k, by rows of the state, j and k.
pub type NoiseDerivatives<T> = State<Noise<Noise<T>>>;

/// How each column of the diffusion depends on the state.
pub const NOISE_CLASS: Noise<NoiseClass> = Noise {
{%- for column in noise.columns %}
    {{ column.name }}: NoiseClass::{{ column.class|fmt("{:?}") }},
{%- endfor %}
};
/// Whether two columns of the diffusion commute: L^j b^k = L^k b^j.
pub const NOISE_COMMUTES: Noise<Noise<bool>> = Noise {
{%- for j in noise.columns %}
    {{ j.name }}: Noise {
    {%- for k in noise.columns %}
        {{ k.name }}: {{ commute(j, k) }},
    {%- endfor %}
    },
{%- endfor %}
};
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

impl<R> Model<R> {
    /// The model with another scalar: `f` applied to every prepared value.
    #[inline(always)]
    pub fn map_ref<U>(&self, f: impl FnMut(&R) -> U) -> Model<U> {
        Model { prepared: self.prepared.map_ref(f) }
    }
}

impl<R: Real> ahv_core::Model for Model<R> {
    type Scalar = R;
    type State = State<R>;
    type Input = Input<R>;

    #[inline(always)]
    fn drift(&self, x: &State<R>, u: &Input<R>) -> State<R> {
        drift(x, u, &self.prepared)
    }
}

impl<R: Real> ahv_core::DifferentiableModel for Model<R> {
    type StateJacobian = StateJacobian<R>;
    type InputJacobian = InputJacobian<R>;

    const STATE_JACOBIAN_PATTERN: Pattern<2> = STATE_JACOBIAN_PATTERN;

    #[inline(always)]
    fn jacobians(&self, x: &State<R>, u: &Input<R>) -> (StateJacobian<R>, InputJacobian<R>) {
        jacobians(x, u, &self.prepared)
    }

    #[inline(always)]
    fn drift_and_jacobians(&self, x: &State<R>, u: &Input<R>) -> (State<R>, StateJacobian<R>, InputJacobian<R>) {
        drift_and_jacobians(x, u, &self.prepared)
    }
}
{%- if model.noise.is_some() %}

impl<R: Real> ahv_core::StochasticModel for Model<R> {
    type Noise = Noise<R>;

    #[inline(always)]
    fn noise_increment(&self, x: &State<R>, u: &Input<R>, dw: &Noise<R>) -> State<R> {
        noise_increment(x, u, &self.prepared, dw)
    }

    #[inline(always)]
    fn drift_and_noise_increment(&self, x: &State<R>, u: &Input<R>, dw: &Noise<R>) -> (State<R>, State<R>) {
        drift_and_noise_increment(x, u, &self.prepared, dw)
    }

    #[inline(always)]
    fn noise_class(channel: usize) -> NoiseClass {
        NOISE_CLASS.get(channel).unwrap_or(NoiseClass::General)
    }

    #[inline(always)]
    fn noise_commutes(first: usize, second: usize) -> bool {
        NOISE_COMMUTES.get(first).and_then(|row| row.get(second)).unwrap_or(false)
    }
}

impl<R: Real> ahv_core::ItoCorrected for Model<R> {
    #[inline(always)]
    fn ito_correction(&self, x: &State<R>, u: &Input<R>) -> State<R> {
        ito_correction(x, u, &self.prepared)
    }
}

impl<R: Real> ahv_core::DifferentiableNoise for Model<R> {
    #[inline(always)]
    fn iterated_increment(
        &self,
        x: &State<R>,
        u: &Input<R>,
        mut integral: impl FnMut(usize, usize) -> R,
    ) -> State<R> {
        let values = noise_derivatives_values(x, u, &self.prepared);
        let mut sum = State::splat(R::ZERO).to_array();
        for (value, &[row, j, k]) in values.to_array().into_iter().zip(NOISE_DERIVATIVES_PATTERN.at) {
            if let Some(component) = sum.get_mut(row) {
                *component = *component + value * integral(j, k);
            }
        }
        State::from_array(sum)
    }
}
{%- if is_additive() %}

impl<R: Real> ahv_core::AdditiveNoise for Model<R> {}
{%- endif %}
{%- if is_commutative() %}

impl<R: Real> ahv_core::CommutativeNoise for Model<R> {}
{%- endif %}
{%- else %}

/// There is no noise.
pub type Noise<T> = ahv_core::NoNoise<T>;

ahv_core::impl_no_noise!(Model, State, Input);
{%- endif %}

{%- if coloured.is_empty() %}

impl<R: Real> ahv_core::ColouredNoise for Model<R> {}
{%- else %}

impl<R: Real> ahv_core::ColouredNoise for Model<R> {
    #[inline(always)]
    fn decay(&self, state: usize) -> Option<R> {
        let mut decays = State::splat(None);
{%- for (state, rate) in coloured %}
        decays.{{ state }} = Some(self.prepared.{{ rate }});
{%- endfor %}
        decays.get(state).flatten()
    }
}
{%- endif %}
