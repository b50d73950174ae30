//! The page of the audit: each printed equation beside the derived one, with every difference classed.

use askama::Template;
use serde::Deserialize;

use super::tidy;
use crate::EmitError;
use crate::template::render;

/// The schema of the audit that this crate reads.
const SCHEMA_VERSION: u64 = 1;

/// The text of the page's template, for the manifest.
pub(crate) const TEMPLATE: &str = include_str!("../../templates/docs/audit.md");

/// The audit as the derivation hands it over.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Audit {
    schema_version: u64,
    equations: Vec<Equation>,
    table: Vec<TableRow>,
    checks: Vec<Check>,
}

/// A printed equation, or a function or matrix element of one. Formulas are LaTeX without delimiters.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Equation {
    number: String,
    #[serde(rename = "name")]
    _name: String,
    symbol: String,
    section: String,
    verdict: String,
    printed: String,
    derived: Option<String>,
    corrected: Option<String>,
    notes: Vec<String>,
    /// Dimension of the left-hand side.
    dimension: String,
    /// How many terms were compared with it.
    terms: usize,
    clashes: Vec<Clash>,
    differences: Vec<Difference>,
}

/// A term whose dimension is not that of the left-hand side.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Clash {
    term: String,
    dimension: String,
}

/// A difference between a printed equation and the derived one.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Difference {
    class: String,
    kind: String,
    printed: Option<String>,
    derived: Option<String>,
    reason: String,
    dimension_betrays: bool,
}

/// A row of the paper's Table 2.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TableRow {
    symbol: String,
    value: String,
    unit: String,
    dimension: String,
    unit_dimension: String,
    finding: String,
    reason: String,
}

/// A statement that was decided by computation.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Check {
    equation: String,
    statement: String,
    holds: bool,
    left_over: Option<String>,
}

#[derive(Template)]
#[template(path = "docs/audit.md")]
struct AuditPage<'a> {
    definitions: String,
    results: usize,
    as_derived: usize,
    truncated: usize,
    misprinted: usize,
    truncations: usize,
    summary: Vec<SummaryRow<'a>>,
    misprints: Vec<MisprintRow<'a>>,
    swapped: Vec<&'a TableRow>,
    checks: &'a [Check],
    sections: Vec<Section<'a>>,
    table: &'a [TableRow],
}

struct SummaryRow<'a> {
    number: &'a str,
    symbol: &'a str,
    verdict: &'a str,
    misprints: String,
    truncations: String,
    dimensions: &'static str,
}

struct MisprintRow<'a> {
    number: &'a str,
    symbol: &'a str,
    printed: String,
    derived: String,
    kind: &'a str,
    reason: &'a str,
    betrayed: &'static str,
}

struct Section<'a> {
    number: &'a str,
    equations: Vec<&'a Equation>,
}

impl Equation {
    /// Whether the equation was compared with a derived one.
    fn is_result(&self) -> bool {
        self.derived.is_some()
    }

    fn differs(&self) -> bool {
        self.derived.as_ref() != Some(&self.printed)
    }

    /// The corrected form, where truncations tell it from the derived one.
    fn corrected_apart(&self) -> Option<&str> {
        self.corrected
            .as_deref()
            .filter(|text| self.derived.as_deref() != Some(*text))
    }

    fn derived_title(&self) -> &'static str {
        if self.corrected.is_some() && self.corrected_apart().is_none() {
            "Derived, and what it should read"
        } else {
            "Derived"
        }
    }

    fn of<'a>(&'a self, class: &'a str) -> impl Iterator<Item = &'a Difference> {
        self.differences.iter().filter(move |d| d.class == class)
    }

    /// What the dimensional analysis says, as a paragraph.
    fn dimensions(&self) -> String {
        let side = format!("the left-hand side, ${}$", self.dimension);
        match (self.terms, self.clashes.as_slice()) {
            (0, []) => format!("Dimensions: {side}; nothing to compare."),
            (1, []) => format!("Dimensions: as {side}."),
            (terms, []) => {
                format!("Dimensions: all {terms} terms are as {side}.")
            }
            (_, clashes) => {
                let found: Vec<String> = clashes
                    .iter()
                    .map(|c| format!("${}$ has ${}$", c.term, c.dimension))
                    .collect();
                format!("**Dimensions clash** with {side}: {}.", found.join(", "))
            }
        }
    }
}

impl Difference {
    /// The term, and what it stands for where it does.
    fn terms(&self) -> String {
        match (&self.printed, &self.derived) {
            (Some(printed), Some(derived)) => format!("${printed}$ for ${derived}$"),
            (Some(only), None) | (None, Some(only)) => format!("${only}$"),
            (None, None) => String::new(),
        }
    }
}

impl TableRow {
    fn unit_text(&self) -> &str {
        if self.unit == "1" { "none" } else { &self.unit }
    }

    fn finding_text(&self) -> String {
        if self.finding.is_empty() {
            "fits".to_owned()
        } else {
            format!("**{}**: {}", self.finding, self.reason)
        }
    }
}

/// The page of the audit, from its JSON text.
///
/// # Errors
/// [`EmitError::Mismatch`] where the text is not an audit of the schema that this crate reads.
pub(crate) fn audit(text: &str) -> Result<String, EmitError> {
    let unreadable =
        |message: String| EmitError::Mismatch(format!("the audit cannot be read: {message}"));
    let audit: Audit = serde_json::from_str(text).map_err(|error| unreadable(error.to_string()))?;
    if audit.schema_version != SCHEMA_VERSION {
        return Err(unreadable(format!(
            "it has schema version {}, but this version of ahv reads {SCHEMA_VERSION}",
            audit.schema_version
        )));
    }
    Ok(tidy(&render(&page(&audit))?))
}

fn page(audit: &Audit) -> AuditPage<'_> {
    let results: Vec<&Equation> = audit.equations.iter().filter(|e| e.is_result()).collect();
    let having = |verdict: &str| results.iter().filter(|e| e.verdict == verdict).count();
    let mut sections: Vec<Section<'_>> = Vec::new();
    for equation in &audit.equations {
        match sections.last_mut() {
            Some(last) if last.number == equation.section => last.equations.push(equation),
            _ => sections.push(Section {
                number: &equation.section,
                equations: vec![equation],
            }),
        }
    }
    let definitions: Vec<&str> = audit
        .equations
        .iter()
        .filter(|e| e.verdict == "definition")
        .map(|e| e.number.as_str())
        .collect();
    AuditPage {
        definitions: definitions.join(" and "),
        results: results.len(),
        as_derived: having("as derived"),
        truncated: having("truncated"),
        misprinted: having("misprinted"),
        truncations: results.iter().map(|e| e.of("truncation").count()).sum(),
        summary: results.iter().map(|e| summary(e)).collect(),
        misprints: results.iter().flat_map(|e| misprints(e)).collect(),
        swapped: audit
            .table
            .iter()
            .filter(|row| row.finding == "swapped")
            .collect(),
        checks: &audit.checks,
        sections,
        table: &audit.table,
    }
}

fn summary(equation: &Equation) -> SummaryRow<'_> {
    let count = |class: &str| match equation.of(class).count() {
        0 => String::new(),
        some => some.to_string(),
    };
    SummaryRow {
        number: &equation.number,
        symbol: &equation.symbol,
        verdict: &equation.verdict,
        misprints: count("misprint"),
        truncations: count("truncation"),
        dimensions: if equation.clashes.is_empty() {
            "agree"
        } else {
            "**clash**"
        },
    }
}

fn misprints(equation: &Equation) -> impl Iterator<Item = MisprintRow<'_>> {
    let term = |latex: &Option<String>| match latex {
        Some(latex) => format!("${latex}$"),
        None => "nothing".to_owned(),
    };
    equation.of("misprint").map(move |d| MisprintRow {
        number: &equation.number,
        symbol: &equation.symbol,
        printed: term(&d.printed),
        derived: term(&d.derived),
        kind: &d.kind,
        reason: &d.reason,
        betrayed: if d.dimension_betrays { "yes" } else { "no" },
    })
}

#[cfg(test)]
mod tests {
    use super::audit;

    const SAMPLE: &str = r#"{
  "schema_version": 1,
  "equations": [
    {"number": "(18)", "name": "d_chi", "symbol": "d\\chi_1", "section": "3", "verdict": "definition",
     "printed": "d\\chi_1 = -a \\chi_1 dt + b dw", "derived": null, "corrected": null, "notes": [],
     "dimension": "\\mathsf{L}", "terms": 2, "clashes": [], "differences": []},
    {"number": "(24)", "name": "d_chi", "symbol": "d\\chi_1", "section": "3", "verdict": "misprinted",
     "printed": "d\\chi_1 = -\\omega_1 dt", "derived": "d\\chi_1 = -\\omega_1 \\chi_1 dt",
     "corrected": "d\\chi_1 = -\\omega_1 \\chi_1 dt", "notes": ["a note"], "dimension": "\\mathsf{L}", "terms": 1,
     "clashes": [{"term": "-\\omega_1 dt", "dimension": "1"}],
     "differences": [
       {"class": "misprint", "kind": "factor", "printed": "-\\omega_1 dt", "derived": "-\\omega_1 \\chi_1 dt",
        "reason": "the factor $\\chi_1$ is missing", "dimension_betrays": true},
       {"class": "truncation", "kind": "transient", "printed": null, "derived": "e^{-t}",
        "reason": "decays exponentially", "dimension_betrays": false}]},
    {"number": "(32)", "name": "g_alpha", "symbol": "g_\\alpha", "section": "4", "verdict": "as derived",
     "printed": "g_\\alpha = 1", "derived": "g_\\alpha = 1", "corrected": null, "notes": [],
     "dimension": "1", "terms": 1, "clashes": [], "differences": []}
  ],
  "table": [
    {"symbol": "V", "value": "85000", "unit": "ft", "dimension": "\\mathsf{L}\\,\\mathsf{T}^{-1}",
     "unit_dimension": "\\mathsf{L}", "finding": "swapped", "reason": "the printed unit is that of $h$"},
    {"symbol": "\\phi", "value": "0.2514", "unit": "1", "dimension": "1", "unit_dimension": "1", "finding": "",
     "reason": ""}
  ],
  "checks": [
    {"equation": "(15)", "statement": "the printed (15) satisfies (5)", "holds": true, "left_over": null},
    {"equation": "(15)", "statement": "it starts as given", "holds": false, "left_over": "2 \\zeta_1"}
  ]
}"#;

    #[test]
    fn a_page_shows_printed_derived_differences_and_dimensions() {
        let page = audit(SAMPLE).expect("the sample is an audit");
        for wanted in [
            "Of 2 printed results 1 are as derived, 0 differ by truncations alone, and 1 are misprinted.",
            "| (24) | $d\\chi_1$ | misprinted | 1 | 1 | **clash** |",
            "| (24) | $d\\chi_1$ | $-\\omega_1 dt$ | $-\\omega_1 \\chi_1 dt$ | factor | the factor $\\chi_1$ is missing | yes |",
            "| Table 2 | $V$ | 85000 ft | the value of the other row | swap | the printed unit is that of $h$ | yes |",
            "| (15) | it starts as given | **no** | $2 \\zeta_1$ |",
            "Derived, and what it should read:\n\n```math\nd\\chi_1 = -\\omega_1 \\chi_1 dt\n```\n",
            "| $e^{-t}$ | truncation | transient | decays exponentially |",
            "**Dimensions clash** with the left-hand side, $\\mathsf{L}$: $-\\omega_1 dt$ has $1$.",
            "### (32) $g_\\alpha$\n\nPrinted (as derived):\n\n```math\ng_\\alpha = 1\n```\n\nDimensions: as",
            "| $\\phi$ | 0.2514 | none | $1$ | $1$ | fits |",
            "Note: a note.",
        ] {
            assert!(page.contains(wanted), "{wanted} is not in\n{page}");
        }
    }

    #[test]
    fn what_is_not_an_audit_is_refused() {
        let other = SAMPLE.replace("\"schema_version\": 1", "\"schema_version\": 2");
        assert!(audit(&other).is_err_and(|e| e.to_string().contains("schema version 2")));
        let unknown = SAMPLE.replace("\"checks\"", "\"tests\"");
        assert!(audit(&unknown).is_err_and(|e| e.to_string().contains("the audit cannot be read")));
    }
}
