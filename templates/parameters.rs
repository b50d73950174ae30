//! Parameters of the table, and the box in which its curve fits are meant to be used.

use ahv_core::Bounds;

{{ parameters }}

/// The box in which the curve fits are meant to be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
{%- for v in validity %}
    /// {{ v.described() }}
    pub {{ v.name }}: Bounds,
{%- endfor %}
}
