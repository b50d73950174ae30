//! Parameters of the table, and the box in which its curve fits are meant to be used.

use ahv_core::Bounds;

/// One value for each parameter and coefficient of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Parameters<T> {
{%- for p in parameters %}
    /// {{ p.described() }}
    pub {{ p.name }}: T,
{%- endfor %}
}

impl<T> Parameters<T> {
    /// Names of the parameters.
    pub const NAMES: [&'static str; {{ parameters.len() }}] = [
        {%- for p in parameters %}"{{ p.name }}", {% endfor -%}
    ];
    /// Units of the parameters.
    pub const UNITS: [&'static str; {{ parameters.len() }}] = [
        {%- for p in parameters %}"{{ p.unit }}", {% endfor -%}
    ];

    /// The parameters in the order of the table.
    #[inline]
    pub fn to_array(self) -> [T; {{ parameters.len() }}] {
        [{% for p in parameters %}self.{{ p.name }}, {% endfor %}]
    }

    /// The parameters from an array in the order of the table.
    #[inline]
    pub fn from_array(values: [T; {{ parameters.len() }}]) -> Self {
        let [{% for p in parameters %}{{ p.name }}, {% endfor %}] = values;
        Self { {% for p in parameters %}{{ p.name }}, {% endfor %} }
    }
}

ahv_core::impl_vector!(Parameters, {{ parameters.len() }});

/// The box in which the curve fits are meant to be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
{%- for v in validity %}
    /// {{ v.described() }}
    pub {{ v.name }}: Bounds,
{%- endfor %}
}
