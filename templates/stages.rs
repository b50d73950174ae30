//! {{ about }}

use super::{ {{- imports.join(", ") -}} };
use ahv_core::Real;

{%- for stage in stages %}

{{ stage.record }}
{%- for part in stage.parts %}

/// Fills a part of [`{{ stage.kind.type_name }}`].
{% if stage.is_inline %}#[inline(always)]
{% endif -%}
fn {{ part.name }}<R: Real>({{ part.arguments }}) {
{%- for statement in part.statements %}
    {{ statement }}
{%- endfor %}
}
{%- endfor %}

{%- for line in stage.docs %}
///{% if !line.is_empty() %} {{ line }}{% endif %}
{%- endfor %}
{% if stage.is_inline %}#[inline(always)]
{% endif -%}
pub fn {{ stage.kind.function }}<R: Real>({{ stage.arguments }}) -> {{ stage.kind.type_name }}<R> {
    let mut {{ stage.kind.argument }} = {{ stage.kind.type_name }}::{{ stage.start }};
{%- for part in stage.parts %}
    {{ part.call }}
{%- endfor %}
{%- for statement in stage.statements %}
    {{ statement }}
{%- endfor %}
    {{ stage.kind.argument }}
}
{%- endfor %}
