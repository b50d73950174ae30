//! Findings for people and for programs.

use ahv_generate::TableFault;
use serde::Serialize;

use crate::{Finding, Severity};

/// What was found in a file.
#[derive(Clone, Debug)]
pub struct Reviewed {
    /// The file, as messages name it.
    pub file: String,
    /// Its text.
    pub text: String,
    /// What was found in it, in the order of the places.
    pub findings: Vec<Finding>,
}

impl Reviewed {
    /// Makes findings of these rules errors.
    pub fn deny(&mut self, rules: &[String]) {
        for finding in &mut self.findings {
            if rules.contains(&finding.rule) {
                finding.severity = Severity::Error;
            }
        }
    }

    /// Line and column of a place in bytes, both counted from 1; columns in characters.
    pub(crate) fn place(&self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or_default();
        let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
        (before.matches('\n').count() + 1, column)
    }
}

/// How many findings there are of a severity.
pub(crate) fn count(reviewed: &[Reviewed], severity: Severity) -> usize {
    let findings = reviewed.iter().flat_map(|it| &it.findings);
    findings.filter(|it| it.severity == severity).count()
}

/// The findings for people: the lines with the place underlined, what would be right, and how many there are.
#[must_use]
pub fn rendered(reviewed: &[Reviewed], terminal: bool) -> String {
    let mut text = String::new();
    for file in reviewed {
        for finding in &file.findings {
            let help = Some(finding.help.clone()).filter(|help| !help.is_empty());
            let message = format!("{} [{}]", finding.message, finding.rule);
            let span = finding.span.clone();
            let fault = TableFault::new(message, help, &file.file, &file.text, span);
            let fault = match finding.severity {
                Severity::Error => fault,
                Severity::Warning => fault.as_warning(),
                Severity::Note => fault.as_note(),
            };
            text.push_str(&fault.render(terminal));
        }
    }
    let counted = |severity| match count(reviewed, severity) {
        1 => format!("1 {}", severity.name()),
        many => format!("{many} {}s", severity.name()),
    };
    let [errors, warnings, notes] =
        [Severity::Error, Severity::Warning, Severity::Note].map(counted);
    let files = match reviewed.len() {
        1 => "1 table".to_owned(),
        many => format!("{many} tables"),
    };
    text + &format!("{files}: {errors}, {warnings}, {notes}\n")
}

#[derive(Serialize)]
struct Document<'a> {
    errors: usize,
    warnings: usize,
    notes: usize,
    files: Vec<File<'a>>,
}

#[derive(Serialize)]
struct File<'a> {
    file: &'a str,
    findings: Vec<Found<'a>>,
}

#[derive(Serialize)]
struct Found<'a> {
    rule: &'a str,
    severity: &'static str,
    line: usize,
    column: usize,
    message: &'a str,
    help: Option<&'a str>,
}

/// The findings for programs.
///
/// # Errors
/// None that is known: every part is text or a number.
pub fn json(reviewed: &[Reviewed]) -> Result<String, serde_json::Error> {
    let files = reviewed.iter().map(|file| File {
        file: &file.file,
        findings: file.findings.iter().map(|it| found(file, it)).collect(),
    });
    serde_json::to_string_pretty(&Document {
        errors: count(reviewed, Severity::Error),
        warnings: count(reviewed, Severity::Warning),
        notes: count(reviewed, Severity::Note),
        files: files.collect(),
    })
}

fn found<'a>(file: &Reviewed, finding: &'a Finding) -> Found<'a> {
    let (line, column) = file.place(finding.span.start);
    Found {
        rule: &finding.rule,
        severity: finding.severity.name(),
        line,
        column,
        message: &finding.message,
        help: Some(finding.help.as_str()).filter(|help| !help.is_empty()),
    }
}
