//! What {{ label }} says of itself.

use super::*;
use ahv_core::{Equation, GeneratedModel, ModeOfMotion, ParameterSetOf, Real, Sought, Table, TrimProblem};

impl GeneratedModel for Model<f64> {
    const NAME: &'static str = "{{ model.name }}";
    const TITLE: &'static str = {{ model.title|text }};
    const NOTE: Option<&'static str> = {{ model.note|optional }};
    const TABLE: &'static Table = &TABLE;
    const SETS: &'static [ParameterSetOf<Self>] = &SETS;
    const STATE_BOUNDS: Self::StateOf<ahv_core::Bounds> = STATE_BOUNDS;
    const INPUT_BOUNDS: Self::InputOf<ahv_core::Bounds> = INPUT_BOUNDS;
    const TRIM: TrimProblem = TrimProblem {
        given: &[
{%- for it in model.trim.given %}
            ahv_core::Given::new("{{ it.name }}", {{ it.default|number }}, {{ bound(it.above, "f64::NEG_INFINITY") }}, {{ bound(it.below, "f64::INFINITY") }}),
{%- endfor %}
        ],
        sought: &[
{%- for it in model.trim.sought %}
            Sought::new("{{ it.name }}", {{ it.start|number }}, {{ it.scale|number }}),
{%- endfor %}
        ],
        equations: &[
{%- for it in model.trim.equations %}
            Equation::new("{{ it.name }}", {{ it.weight|number }}, {{ like(it) }}),
{%- endfor %}
        ],
        moving: &{{ model.trim.moving|texts }},
        shown: &{{ model.trim.shown|texts }},
    };
    const MODES: &'static [ModeOfMotion] = &[
{%- for mode in model.modes %}
        ModeOfMotion::new({{ mode.name|text }}, &{{ mode.states|texts }}, {{ mode.slowest|optional }}),
{%- endfor %}
    ];
    const DEFAULT_INPUTS: &'static [&'static str] = &{{ model.defaults.inputs|texts }};
    const DEFAULT_OUTPUTS: &'static [&'static str] = &{{ model.defaults.outputs|texts }};
    const DEVIATIONS: &'static [(&'static str, f64)] = &[
{%- for (name, deviation) in deviations() %}
        ("{{ name }}", {{ deviation|number }}),
{%- endfor %}
    ];
{%- if has_boundaries %}
    const BOUNDARIES: &'static [&'static str] = <Boundaries<f64> as ahv_core::Vector<f64>>::NAMES;
{%- endif %}

    type ParametersOf<T: ahv_core::Component> = Parameters<T>;
    type StateOf<T: ahv_core::Component> = State<T>;
    type InputOf<T: ahv_core::Component> = Input<T>;
    type NoiseOf<T: ahv_core::Component> = Noise<T>;
    type OutputsOf<T: ahv_core::Component> = Outputs<T>;
    type With<R: Real> = Model<R>;

    fn coloured<V: ahv_core::CountVisitor>({% if coloured == 0 %}_{% else %}visitor{% endif %}: V) -> Option<V::Output> {
{%- if coloured == 0 %}
        None
{%- else %}
        Some(visitor.visit::<{{ coloured }}>())
{%- endif %}
    }
{%- if has_boundaries %}

    fn boundary(&self, index: usize, x: &State<f64>, u: &Input<f64>) -> f64 {
        ahv_core::Vector::get(&boundaries(x, u, &self.prepared), index).unwrap_or(f64::NAN)
    }
{%- endif %}

    fn parameter_jacobian(&self, x: &State<f64>, u: &Input<f64>) -> ParameterJacobian<f64> {
        parameter_jacobian(x, u, &self.prepared)
    }

    fn outputs<R: Real>(model: &Model<R>, x: &State<R>, u: &Input<R>) -> Outputs<R> {
        outputs(x, u, &model.prepared)
    }

    ahv_core::model_functions!();
}
