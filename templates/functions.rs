//! Functions of {{ label }}. Units are foot, slug, second and radian.
{%- if paper_names %}
#![allow(non_snake_case)]
{%- endif %}

use super::{ {{- imports.join(", ") -}} };
use ahv_core::{Real{% if needs_vector %}, Vector{% endif %}};

{%- for f in functions %}
{%- for line in f.docs %}
///{% if !line.is_empty() %} {{ line }}{% endif %}
{%- endfor %}
#[inline]
pub fn {{ f.name }}<R: Real>({{ f.arguments.join(", ") }}) -> {{ f.result }} {
{%- for statement in f.statements %}
    {{ statement.source() }}
{%- endfor %}
{%- if f.outputs.len() > 1 || !f.zeros.is_empty() %}
    __section!("Result");
{%- else if f.sets_result_off() %}
    __section!("");
{%- endif %}
{%- for (name, of) in f.zeros %}
    let {{ name }} = {{ of }}::splat(R::ZERO);
{%- endfor %}
{%- if f.outputs.len() == 1 %}
    {{ f.outputs[0].1 }}
{%- else %}
{%- for (name, value) in f.outputs %}
    let {{ name }} = {{ value }};
{%- endfor %}
    ({% for (name, _) in f.outputs %}{{ name }}{% if !loop.last %}, {% endif %}{% endfor %})
{%- endif %}
}
{%- endfor %}
