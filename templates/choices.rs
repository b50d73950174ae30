//! What is chosen by name.

use super::Parameters;
use ahv_core::Real;

{%- for choice in choices %}
/// {{ choice.doc }}
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum {{ choice.type_name }} {
{%- for option in choice.options %}
    /// {{ option.doc }}
    {{ option.variant }},
{%- endfor %}
}

impl {{ choice.type_name }} {
    /// All there is to choose from.
    pub const ALL: [Self; {{ choice.options.len() }}] = [{% for option in choice.options %}Self::{{ option.variant }}, {% endfor %}];

    /// The name, as tables and command lines have it.
    pub const fn name(self) -> &'static str {
        match self {
{%- for option in choice.options %}
            Self::{{ option.variant }} => "{{ option.name }}",
{%- endfor %}
        }
    }

    /// The choice of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|choice| choice.name() == name)
    }
}

impl<R: Real> Parameters<R> {
    /// The parameters with this choice made.
    pub fn with_{{ choice.name }}(self, choice: {{ choice.type_name }}) -> Self {
        match choice {
{%- for option in choice.options %}
            {{ choice.type_name }}::{{ option.variant }} => Self {
{%- for (name, value) in option.values %}
                {{ name }}: {{ value }},
{%- endfor %}
                ..self
            },
{%- endfor %}
        }
    }
}
{%- endfor %}
