//! Where the numbers of the table come from.

use super::Parameters;
use ahv_core::{Provenance, Status};

/// Source, status and relative uncertainty of each parameter.
pub const PROVENANCE: Parameters<Provenance> = Parameters {
{%- for p in parameters %}
    {{ p.name }}: Provenance::new({{ "{:?}"|format(p.source) }}, Status::{{ p.status_variant() }}, {{ "{:?}"|format(p.uncertainty) }}),
{%- endfor %}
};
