//! The numbers of the table.

use super::{Parameters, Validity};
use ahv_core::Bounds;

/// Nominal values of the parameters.
pub const NOMINAL: Parameters<f64> = Parameters {
{%- for (name, value) in values %}
    {{ name }}: {{ value }},
{%- endfor %}
};

/// The box in which the curve fits are meant to be used.
pub const VALIDITY: Validity = Validity {
{%- for (name, min, max) in bounds %}
    {{ name }}: Bounds::new({{ min }}, {{ max }}),
{%- endfor %}
};
