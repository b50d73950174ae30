//! What {{ label }} computes from its parameters once.

use super::Parameters;
use ahv_core::Real;

/// Parameters as the functions of this model use them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prepared<R> {
{%- for field in fields %}
{%- for line in field.docs %}
    /// {{ line }}
{%- endfor %}
    pub {{ field.name }}: R,
{%- endfor %}
}

impl<R> Prepared<R> {
    /// Applies `f` to each field; the type of the fields may change.
    #[inline(always)]
    pub fn map_ref<U>(&self, mut f: impl FnMut(&R) -> U) -> Prepared<U> {
        Prepared {
{%- for field in fields %}
            {{ field.name }}: f(&self.{{ field.name }}),
{%- endfor %}
        }
    }
}

/// Computes everything that depends on parameters alone.
///
/// {{ cost }}.
pub fn prepare<R: Real>(p: &Parameters<R>) -> Prepared<R> {
{%- for statement in statements %}
    {{ statement }}
{%- endfor %}
    __section!("");
    Prepared {
{%- for field in fields %}
{%- if field.name == field.value %}
        {{ field.name }},
{%- else %}
        {{ field.name }}: {{ field.value }},
{%- endif %}
{%- endfor %}
    }
}
