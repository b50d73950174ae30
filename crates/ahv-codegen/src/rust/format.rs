//! Formats emitted Rust. prettyplease works on the syntax tree, which has no comments: they travel as macro
//! calls and become comments again afterwards.

use crate::EmitError;

/// A comment on a line of its own, with a blank line before it.
pub(super) const SECTION: &str = "__section!";
/// A comment at the end of the line before it.
pub(super) const TRAILING: &str = "__trailing!";

/// Addends of a sum, separated by `|`, one a line.
pub(super) const ADDENDS: &str = "__addends!";

/// A call of a macro of `ahv-core`, line by line, separated by `|`: the formatter does not lay out the body of a macro.
const CALL: &str = "__call!";

/// An `impl_vector!` with a line for each field.
pub(super) fn vector(name: &str, fields: &[String]) -> String {
    call("impl_vector", "", name, fields)
}

/// An `entries!` with a line for each entry.
pub(super) fn entries(about: &str, head: &str, entries: &[String]) -> String {
    call("entries", about, head, entries)
}

fn call(name: &str, about: &str, head: &str, fields: &[String]) -> String {
    let text = format!("{name}|{about}|{head}|{}", fields.join("|"));
    format!("{CALL}({text:?});")
}

/// The attribute of a struct that `record!` of `ahv-core` defines.
const RECORD: &str = "#[__record]";

/// Lines of code stay below this width, comments included.
const WIDTH: usize = 120;

/// Formats the text of a Rust file.
pub(crate) fn format_rust(path: &str, header: &str, text: &str) -> Result<String, EmitError> {
    let file = syn::parse_file(text).map_err(|error| EmitError::NotRust {
        path: path.to_owned(),
        message: error.to_string(),
    })?;
    let mut out = String::with_capacity(text.len() + header.len());
    for line in header.lines() {
        out += &format!("// {line}\n");
    }
    let formatted = prettyplease::unparse(&file);
    let mut lines = formatted.lines().peekable();
    let mut previous = "";
    while let Some(line) = lines.next() {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        if let Some(comment) = argument(code, SECTION) {
            // The first heading of a block needs no blank line above it.
            if !previous.ends_with('{') {
                out.push('\n');
            }
            if !comment.is_empty() {
                out += &format!("{indent}// {comment}\n");
            }
        } else if let Some(comment) = argument(code, TRAILING) {
            let width = out
                .lines()
                .next_back()
                .map_or(0, |last| last.chars().count());
            if width + comment.chars().count() + 4 <= WIDTH {
                out.truncate(out.trim_end().len());
                out += &format!(" // {comment}\n");
            }
        } else if let Some(call) = code.strip_prefix(CALL) {
            let mut call = call.to_owned();
            while !call.ends_with(");") {
                call += lines.next().map_or(");", str::trim);
            }
            out += &macro_call(&call);
        } else if code == RECORD {
            record(&mut out, &mut lines);
        } else if let Some((start, call)) = code.split_once(ADDENDS) {
            let mut call = call.to_owned();
            while !call.ends_with([';', ')']) {
                call += lines.next().map_or(";", str::trim);
            }
            let end = if call.ends_with(';') { ";" } else { "" };
            let listed = call.trim_start_matches("(\"").trim_end_matches(';');
            let listed = listed
                .trim_end_matches("\")")
                .replace('|', &format!("\n{indent}    "));
            let first = listed.lines().next().map_or(0, |line| line.chars().count());
            // A long name leaves no room for the first addend beside it.
            let start = if indent.len() + start.len() + first < WIDTH {
                start.to_owned()
            } else {
                format!("{}\n{indent}    ", start.trim_end())
            };
            out += &format!("{indent}{start}{listed}{end}\n");
        } else {
            if starts_item(indent, code, previous) {
                out.push('\n');
            }
            out += line;
            out.push('\n');
        }
        previous = line;
    }
    Ok(out)
}

/// The call of a macro that a marker stands for.
fn macro_call(marker: &str) -> String {
    let text = marker
        .trim_start_matches("(\"")
        .trim_end_matches("\");")
        .replace("\\\"", "\"");
    let mut parts = text.split('|');
    let mut part = || parts.next().unwrap_or_default().to_owned();
    let (name, about, head) = (part(), part(), part());
    let mut out = format!("\nahv_core::{name}! {{\n");
    if !about.is_empty() {
        out += &format!("    {about}\n");
    }
    out += &format!("    {head} {{\n");
    for field in parts {
        out += &format!("        {field}\n");
    }
    out + "    }\n}\n"
}

/// A struct as the body of `record!`. What is written of it already, its description, goes inside.
fn record<'a>(out: &mut String, lines: &mut impl Iterator<Item = &'a str>) {
    let about = out.trim_end().rfind("\n\n").map_or(0, |at| at + 2);
    let about: String = out.split_off(about);
    *out += "ahv_core::record! {\n";
    for line in about.lines() {
        *out += &format!("    {line}\n");
    }
    for line in lines {
        *out += &format!("    {line}\n");
        if line == "}" {
            break;
        }
    }
    *out += "}\n\n";
}

/// Whether a blank line separates an item from what stands before it.
fn starts_item(indent: &str, code: &str, previous: &str) -> bool {
    let group = |text: &str| {
        ["use ", "pub use ", "mod ", "//!", "#!["]
            .iter()
            .position(|start| text.starts_with(start))
    };
    let described =
        previous.trim_start().starts_with("///") || previous.trim_start().starts_with("#[");
    if code.starts_with(['}', ')', ']']) || described || previous.ends_with('{') {
        return false;
    }
    match indent.len() {
        0 => {
            let same = group(code).is_some() && group(code) == group(previous);
            // Attributes of a file follow its description.
            let attribute = code.starts_with("#![") && previous.starts_with("//!");
            !(same || attribute)
        }
        4 => {
            (code.starts_with("///") || code.starts_with("#["))
                && (previous == "    }" || previous.ends_with(';'))
        }
        _ => false,
    }
}

fn argument<'a>(code: &'a str, marker: &str) -> Option<&'a str> {
    code.strip_prefix(marker)?
        .strip_prefix("(\"")?
        .strip_suffix("\");")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_survive_formatting() {
        let source = r#"fn f() { __section!("Air, (2)"); let a = 1.0; __trailing!("ft"); __section!("Motion"); g(a); }"#;
        let formatted = format_rust("f.rs", "Made.", source).unwrap();
        assert_eq!(
            formatted,
            "// Made.\n\nfn f() {\n    // Air, (2)\n    let a = 1.0; // ft\n\n    // Motion\n    g(a);\n}\n"
        );
    }

    #[test]
    fn text_that_is_not_rust_names_its_file() {
        let error = format_rust("dcom/drift.rs", "", "fn (").unwrap_err();
        assert!(error.to_string().contains("dcom/drift.rs"), "{error}");
    }
}
