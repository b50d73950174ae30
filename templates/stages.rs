//! What functions of {{ label }} share. Units are {{ units }}.

use super::{ {{- imports.join(", ") -}} };
use ahv_core::Real;

{%- for stage in stages %}

/// {{ stage.kind.doc }}.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct {{ stage.kind.type_name }}<R> {
{%- for field in stage.fields %}
{%- for line in field.docs %}
    /// {{ line }}
{%- endfor %}
    pub {{ field.name }}: R,
{%- endfor %}
}

/// Computes [`{{ stage.kind.type_name }}`].
#[inline(always)]
pub fn {{ stage.kind.function }}<R: Real>({{ stage.arguments.join(", ") }}) -> {{ stage.kind.type_name }}<R> {
{%- for statement in stage.statements %}
    {{ statement }}
{%- endfor %}
    __section!("");
    {{ stage.kind.type_name }} {
{%- for field in stage.fields %}
{%- if field.name == field.value %}
        {{ field.name }},
{%- else %}
        {{ field.name }}: {{ field.value }},
{%- endif %}
{%- endfor %}
    }
}
{%- endfor %}
