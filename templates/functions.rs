//! Functions of {{ label }}. Units are {{ units }}.
{%- if paper_names %}
#![allow(non_snake_case)]
{%- endif %}
{%- if is_crowded %}
#![allow(clippy::too_many_arguments)]
{%- endif %}

use super::{ {{- imports.join(", ") -}} };
use ahv_core::{Real {%- if needs_vector %}, Vector{% endif -%} };

{%- for item in items %}
{%- match item %}
{%- when Item::Entries(definition) %}
{{ definition }}
{%- when Item::Function(f) %}
{%- for line in f.docs %}
///{% if !line.is_empty() %} {{ line }}{% endif %}
{%- endfor %}
#[inline(always)]
{% if f.is_public %}pub {% endif %}fn {{ f.name }}<R: Real>({{ f.arguments.join(", ") }}){% if !f.result.is_empty() %} -> {{ f.result }}{% endif %} {
{%- for statement in f.statements %}
    {{ statement }}
{%- endfor %}
{%- if f.outputs.len() > 1 || !(f.zeros.is_empty() || f.statements.is_empty()) %}
    __section!("Result");
{%- else if f.sets_result_off %}
    __section!("");
{%- endif %}
{%- for (name, of, component) in f.zeros %}
    let {{ name }} = {{ of }}::splat({{ component }});
{%- endfor %}
{%- if f.outputs.len() == 1 %}
    {{ f.outputs[0].1 }}
{%- else if f.outputs.len() > 1 %}
{%- for (name, value) in f.outputs %}
    let {{ name }} = {{ value }};
{%- endfor %}
    ({% for (name, _) in f.outputs %}{{ name }}{% if !loop.last %}, {% endif %}{% endfor %})
{%- endif %}
}
{%- endmatch %}
{%- endfor %}
