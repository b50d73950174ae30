//! The numbers of the table.

use super::provenance::*;
use super::{Parameters, Validity};
use ahv_core::{Bounds, ParameterSet, Provenance};

/// The unit system: `ft-slug-s-rad` or `si`.
pub const UNIT_SYSTEM: &str = "{{ system }}";

{%- if has_degrees %}
/// A degree in rad: what the table has per degree is written so here.
const DEGREE: f64 = core::f64::consts::PI / 180.0;
{%- endif %}

/// Values of the parameters in the table{% if !own_set.is_empty() %}, the set `{{ own_set }}`{% endif %}.
pub const NOMINAL: Parameters<f64> = Parameters {
{%- for (name, value) in values %}
    {{ name }}: {{ value }},
{%- endfor %}
};

{%- for set in sets %}
/// The set `{{ set.name }}`.
pub const {{ set.constant }}: Parameters<f64> = Parameters {
{%- for (name, value) in set.values %}
    {{ name }}: {{ value }},
{%- endfor %}
    ..NOMINAL
};
{%- endfor %}

/// Sets of parameters by name.
pub const SETS: [ParameterSet<Parameters<f64>, Parameters<Provenance>>; {{ sets.len() + 1 }}] = [
    ParameterSet::new("{{ own_set }}", NOMINAL, PROVENANCE),
{%- for set in sets %}
    ParameterSet::new("{{ set.name }}", {{ set.constant }}, {{ set.constant }}_PROVENANCE),
{%- endfor %}
];

/// The box in which the curve fits are meant to be used.
pub const VALIDITY: Validity = Validity {
{%- for (name, min, max) in bounds %}
    {{ name }}: Bounds::new({{ min }}, {{ max }}),
{%- endfor %}
};
