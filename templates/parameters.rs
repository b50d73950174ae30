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

{{ implementation }}

/// The box in which the curve fits are meant to be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
{%- for v in validity %}
    /// {{ v.described() }}
    pub {{ v.name }}: Bounds,
{%- endfor %}
}
