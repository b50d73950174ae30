//! What is wrong with a table, and what looks wrong: all of it at once, in the order of the places.

mod magnitude;
mod provenance;
mod terms;

use ahv_table::{Fault, Part, Text, Unreadable, visible};

use crate::Subject;
use crate::contents::Contents;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing; nothing is wrong.
    Note,
    /// Probably a slip.
    Warning,
    /// No model can be made of the table.
    Error,
}

impl Severity {
    /// Its name in messages and in JSON; SARIF has the same names.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// A rule beyond those that every table must keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lint {
    /// Its name.
    pub name: &'static str,
    /// How much a finding of it matters.
    pub severity: Severity,
    /// What it finds.
    pub doc: &'static str,
}

const NEEDS_GENERATION: &str = "needs-generation";

/// The rules beyond those that every table must keep, which are errors.
pub const LINTS: [Lint; 11] = [
    lint_of(
        NEEDS_GENERATION,
        Severity::Note,
        "the generated models have no such entry yet",
    ),
    lint_of(
        "no-source",
        Severity::Warning,
        "an entry has a status of its own, and the source of the table",
    ),
    lint_of(
        "no-uncertainty",
        Severity::Warning,
        "a number that is unverified has the uncertainty 0",
    ),
    lint_of(
        "unused-source",
        Severity::Warning,
        "no entry cites a source",
    ),
    lint_of(
        "unverified",
        Severity::Note,
        "how many numbers are unverified",
    ),
    lint_of(
        "zero",
        Severity::Note,
        "a coefficient is 0: its term is computed and adds nothing",
    ),
    lint_of(
        "negligible",
        Severity::Warning,
        "a term is negligible over the whole validity box",
    ),
    lint_of(
        "collinear",
        Severity::Warning,
        "two monomials are proportional over the validity box",
    ),
    lint_of(
        "outside-box",
        Severity::Warning,
        "the default flight condition is outside the validity box",
    ),
    lint_of(
        "degrees",
        Severity::Warning,
        "a number is off by a power of 57.3: degrees in the place of radians",
    ),
    lint_of(
        "pounds",
        Severity::Warning,
        "a number is off by a power of 32.2: pounds in the place of slugs",
    ),
];

const fn lint_of(name: &'static str, severity: Severity, doc: &'static str) -> Lint {
    Lint {
        name,
        severity,
        doc,
    }
}

/// From which number on something is suspicious.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// A term is negligible below this share of its quantity.
    pub negligible: f64,
    /// Monomials are collinear above this cosine of the angle between them.
    pub collinear: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            negligible: 1e-4,
            collinear: 0.999,
        }
    }
}

/// Something that is wrong with a table, or looks wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The rule.
    pub rule: String,
    /// How much it matters.
    pub severity: Severity,
    /// What is wrong.
    pub message: String,
    /// What would be right, or what to do; may be empty.
    pub help: String,
    /// Where it stands, in bytes.
    pub span: std::ops::Range<usize>,
}

/// Collects findings of one table.
struct Findings<'a> {
    text: &'a Text,
    found: Vec<Finding>,
}

impl Findings<'_> {
    /// Records a finding of one of [`LINTS`].
    fn add(&mut self, rule: &'static str, path: &[&str], part: Part, message: String, help: &str) {
        let severity = LINTS.iter().find(|it| it.name == rule);
        self.found.push(Finding {
            rule: rule.to_owned(),
            severity: severity.map_or(Severity::Error, |it| it.severity),
            message: visible(&message),
            help: help.to_owned(),
            span: self.text.span(path, part).unwrap_or(0..0),
        });
    }
}

impl Finding {
    /// An error at a path of keys.
    #[must_use]
    pub fn error(
        text: &Text,
        rule: &str,
        (path, part): (&[String], Part),
        message: &str,
        help: &str,
    ) -> Self {
        let severity = match rule {
            NEEDS_GENERATION => Severity::Note,
            _ => Severity::Error,
        };
        Self {
            rule: rule.to_owned(),
            severity,
            message: visible(message),
            help: visible(help),
            span: text.span(path, part).unwrap_or(0..0),
        }
    }
}

/// What the check of a table of the models of `subject` finds.
#[must_use]
pub fn faults(text: &Text, subject: &Subject) -> Vec<Finding> {
    let found = ahv_table::check(text, &[subject.family]).err();
    let found = found.into_iter().flatten();
    let finding = |it: Fault| {
        Finding::error(
            text,
            it.rule,
            (&it.path, it.part),
            &it.message(),
            &it.help(),
        )
    };
    found.map(finding).collect()
}

/// Everything that is found in a table of the models of `subject`, in the order of the places: its faults, as [`faults`] or
/// its family finds them, and what looks wrong.
#[must_use]
pub fn lint(text: &Text, subject: &Subject, limits: &Limits, faults: Vec<Finding>) -> Vec<Finding> {
    let mut findings = Findings {
        text,
        found: faults,
    };
    let contents = Contents::read(text, subject.family);
    provenance::find(&mut findings, &contents);
    terms::find(&mut findings, &contents, limits);
    terms::outside(&mut findings, &contents, subject);
    magnitude::find(&mut findings, &contents, subject);
    let mut found = findings.found;
    found.sort_by_key(|finding| finding.span.start);
    found
}

/// The finding that a text is not TOML.
#[must_use]
pub fn unreadable(error: &Unreadable) -> Finding {
    Finding {
        rule: "unreadable".to_owned(),
        severity: Severity::Error,
        message: error.message.clone(),
        help: String::new(),
        span: error.span.clone().unwrap_or(0..0),
    }
}
