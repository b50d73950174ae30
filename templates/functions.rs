//! Functions of {{ label }}. Units are {{ units }}.
{%- if paper_names %}
#![allow(non_snake_case)]
{%- endif %}

use super::{ {{- imports.join(", ") -}} };
use ahv_core::{ {%- if has_patterns() %}Pattern, {% endif -%} Real{% if needs_vector %}, Vector{% endif -%} };

{%- for item in items %}
{%- match item %}
{%- when Item::Pattern(pattern) %}
/// Where the entries of the compressed [`{{ pattern.alias }}`] stand.
pub const {{ pattern.name }}: Pattern<{{ pattern.dimensions }}> = Pattern::new([{{ pattern.shape }}], &[
    {%- for entry in pattern.entries %}{{ entry }}, {% endfor -%}
]);
{%- when Item::Function(f) %}
{%- for line in f.docs %}
///{% if !line.is_empty() %} {{ line }}{% endif %}
{%- endfor %}
#[inline(always)]
pub fn {{ f.name }}<R: Real>({{ f.arguments.join(", ") }}) -> {{ f.result }} {
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
{%- else %}
{%- for (name, value) in f.outputs %}
    let {{ name }} = {{ value }};
{%- endfor %}
    ({% for (name, _) in f.outputs %}{{ name }}{% if !loop.last %}, {% endif %}{% endfor %})
{%- endif %}
}
{%- endmatch %}
{%- endfor %}
