//! Findings in SARIF 2.1.0, the format in which code hosts take the findings of tools.

use serde_json::{Value, json};

use crate::{Finding, LINTS, Reviewed};

const SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";

/// The findings as a log of one run.
///
/// # Errors
/// None that is known: every part is text or a number.
pub fn sarif(reviewed: &[Reviewed]) -> Result<String, serde_json::Error> {
    let rules = LINTS.iter().map(|lint| {
        json!({
            "id": lint.name,
            "shortDescription": { "text": lint.doc },
            "defaultConfiguration": { "level": lint.severity.name() },
        })
    });
    let results = reviewed.iter().flat_map(|file| {
        let findings = file.findings.iter();
        findings.map(|finding| result(file, finding))
    });
    let driver = json!({
        "name": "ahv",
        "version": env!("CARGO_PKG_VERSION"),
        "rules": rules.collect::<Vec<_>>(),
    });
    serde_json::to_string_pretty(&json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": driver },
            "columnKind": "unicodeCodePoints",
            "results": results.collect::<Vec<Value>>(),
        }],
    }))
}

fn result(file: &Reviewed, finding: &Finding) -> Value {
    let text = match finding.help.as_str() {
        "" => finding.message.clone(),
        help => format!("{}; {help}", finding.message),
    };
    let [(line, column), (end_line, end_column)] =
        [finding.span.start, finding.span.end].map(|at| file.place(at));
    json!({
        "ruleId": finding.rule,
        "level": finding.severity.name(),
        "message": { "text": text },
        "locations": [{ "physicalLocation": {
            "artifactLocation": { "uri": uri(&file.file) },
            "region": {
                "startLine": line,
                "startColumn": column,
                "endLine": end_line,
                "endColumn": end_column,
            },
        } }],
    })
}

/// A path as a URI: code hosts take it relative to the repository.
fn uri(path: &str) -> String {
    let path = path.strip_prefix("./").unwrap_or(path);
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let bytes = path.bytes().map(|byte| match byte {
        b'\\' => "/".to_owned(),
        _ if plain(byte) => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    });
    bytes.collect()
}
