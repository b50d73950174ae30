//! What the table says beside its numbers.

use super::nominal::{UNIT_SYSTEM, {% if !document.validity.is_empty() %}VALIDITY{% endif %}};
use ahv_core::{
    {%- if !document.choices.is_empty() %}Choice, ChoiceOption, {% endif -%}
    Entry,
    {%- if !document.fits.is_empty() %} Fit, FitVariable,{% endif %}
    {%- if !document.validity.is_empty() %} Interval,{% endif -%}
    {%- if !document.rules.is_empty() %} Rule, Sign,{% endif %} Table
    {%- if !document.rules.is_empty() %}, Term{% endif -%}
};

/// Entries, choices, validity box and rules of the table.
pub const TABLE: Table = Table {
    name: "{{ name }}",
    models: &{{ models|texts }},
    unit_system: UNIT_SYSTEM,
    entries: &[
{%- for p in document.parameters %}
        Entry::{{ p.kind }}({% if p.kind.is_of_section() %}{{ p.path.0|text }}, {% endif %}{{ p.path.1|text }}, {{ p.doc|text }}){{ only_for(p.models) }},
{%- endfor %}
    ],
    choices: &[
{%- for choice in document.choices %}
        Choice::new({{ choice.name|text }}, {{ choice.doc|text }}, &[
{%- for option in choice.options %}
            ChoiceOption::new({{ option.name|text }}, {{ option.doc|text }}, &[
                {%- for (name, value) in option.values %}("{{ name }}", {{ value|number }}), {% endfor -%}
            ]),
{%- endfor %}
        ]),
{%- endfor %}
    ],
    joins: &[
{%- for join in document.joins %}
        {{ join|texts }},
{%- endfor %}
    ],
    validity: &[
{%- for v in document.validity %}
        Interval::new("{{ v.name }}", {{ v.unit|text }}, VALIDITY.{{ v.name }}, &{{ bounded(v.name)|texts }}){{ only_for(v.models) }},
{%- endfor %}
    ],
    fits: &[
{%- for fit in document.fits %}
        Fit::new({{ fit.section|text }}, {{ fit.unit|text }}, {{ fit.doc|text }}, &[
            {%- for v in fit.variables %}{% match v.interval %}
                {%- when Some(interval) %}FitVariable::new({{ v.name|text }}, {{ v.unit|text }}, {{ interval|text }}), {% when None %}FitVariable::unbounded({{ v.name|text }}, {{ v.unit|text }}), {% endmatch %}
            {%- endfor -%}
        ], &{{ fit.affine|texts }}){{ only_for(fit.models) }},
{%- endfor %}
    ],
    rules: &[
{%- for rule in document.rules %}
        Rule::new({{ rule.name|text }}, {{ rule.reason|text }}, Sign::{{ rule.must|fmt("{:?}") }}, &[
            {%- for (factor, parameters) in rule.terms %}Term::new({{ factor|number }}, &{{ parameters|texts }}), {% endfor -%}
        ]),
{%- endfor %}
    ],
};
