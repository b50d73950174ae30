//! Where the numbers of the table come from.

use super::Parameters;
use ahv_core::{Provenance, Status};

{%- for list in lists %}
/// Source, status and relative uncertainty of each parameter{% if !list.set.is_empty() %} of the set `{{ list.set }}`{% endif %}.
pub const {{ list.constant }}: Parameters<Provenance> = Parameters {
{%- for (name, source, status, uncertainty) in list.entries %}
    {{ name }}: Provenance::new({{ source }}, Status::{{ status|fmt("{:?}") }}, {{ uncertainty }}),
{%- endfor %}
{%- if list.rest %}
    ..PROVENANCE
{%- endif %}
};
{%- endfor %}
