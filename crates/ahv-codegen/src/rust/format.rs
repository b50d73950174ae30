//! Formats emitted Rust. prettyplease works on the syntax tree, which has no comments: they travel as macro
//! calls and become comments again afterwards. What it breaks too early is joined again.

use crate::EmitError;

use super::layout::{is_import, laid_out, length};

/// A comment on a line of its own, with a blank line before it.
pub(super) const SECTION: &str = "__section!";
/// A comment at the end of the line before it.
pub(super) const TRAILING: &str = "__trailing!";

/// Lines as they are: the formatter does not lay out the body of a macro.
const VERBATIM: &str = "__verbatim!";

/// An item whose lines are laid out already.
pub(super) fn verbatim(text: &str) -> String {
    format!("{VERBATIM}({text:?});")
}

/// Formats the text of a Rust file.
pub(crate) fn format_rust(path: &str, header: &str, text: &str) -> Result<String, EmitError> {
    let not_rust = |error: syn::Error| EmitError::NotRust {
        path: path.to_owned(),
        message: error.to_string(),
    };
    let file = syn::parse_file(text).map_err(not_rust)?;
    let mut out = String::with_capacity(text.len() + header.len());
    for line in header.lines() {
        out += &format!("// {line}\n");
    }
    let formatted = prettyplease::unparse(&file);
    let lines: Vec<&str> = formatted.lines().collect();
    let (mut at, mut previous) = (0, "");
    while let Some(&line) = lines.get(at) {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        let mut taken = 1;
        if let Some(comment) = argument(code, SECTION) {
            // The first heading of a block needs no blank line above it.
            if !previous.ends_with('{') {
                out.push('\n');
            }
            if !comment.is_empty() {
                out += &format!("{indent}// {comment}\n");
            }
        } else if code.starts_with(VERBATIM) {
            let end = lines[at..].iter().position(|line| line.ends_with(");"));
            taken = end.map_or(1, |end| end + 1);
            let literal: String = lines[at..at + taken].iter().map(|it| it.trim()).collect();
            let literal = literal.trim_start_matches(VERBATIM).trim_end_matches(");");
            let literal = syn::parse_str::<syn::LitStr>(literal.trim_start_matches('('));
            out += &format!("\n{}\n", literal.map_err(not_rust)?.value());
        } else {
            if starts_item(indent, code, previous) {
                out.push('\n');
            }
            taken = length(&lines[at..]);
            let next = lines.get(at + taken).map(|next| next.trim_start());
            let comment = next.and_then(|next| argument(next, TRAILING));
            let text = laid_out(&lines[at..at + taken], comment.unwrap_or_default());
            if text.is_none() {
                // What does not fit has lines of its own, as the formatter broke it.
                taken = 1;
            }
            out += &text.unwrap_or_else(|| format!("{line}\n"));
            taken += usize::from(comment.is_some());
        }
        // A list of imports is known by its first line, the head of a function ends with its block's beginning.
        let last = lines[at + taken - 1];
        previous = if last.ends_with('{') { last } else { line };
        at += taken;
    }
    Ok(out)
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
    let opens = previous.ends_with('{') && !is_import(previous);
    if code.starts_with(['}', ')', ']']) || described || opens {
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
    use super::super::layout::ADDENDS;
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

    /// The body of a function of this text, formatted.
    fn body(statements: &str) -> String {
        let text = format_rust("f.rs", "", &format!("fn f() {{ {statements} }}")).unwrap();
        let body = text.trim().strip_prefix("fn f() {\n");
        body.unwrap().trim_end_matches('}').to_owned()
    }

    #[test]
    fn what_fits_stands_on_one_line_and_the_rest_breaks_at_sums() {
        let (long, name) = (
            "a_value_with_a_long_name",
            "another_value_with_a_name_as_long",
        );
        let one = format!("let x = {long} * {name} + {name};");
        assert!(
            one.len() > 89 && body(&one) == format!("    {one}\n"),
            "{}",
            body(&one)
        );
        let two = format!("let x = {long} * {name} * {long} + {long} * {name};");
        let broken = format!("    let x = {long} * {name} * {long}\n        + {long} * {name};\n");
        assert_eq!(body(&two), broken);
        let listed = format!("let x = {ADDENDS}(\"{long} * {name}|+ {name}|+ {long} * {name}\");");
        let lines =
            format!("    let x = {long} * {name}\n        + {name}\n        + {long} * {name};\n");
        assert_eq!(body(&listed), lines);
        let short = format!("let x = {ADDENDS}(\"a|+ b|+ c\");");
        assert_eq!(body(&short), "    let x = a + b + c;\n");
    }

    #[test]
    fn where_a_statement_breaks_depends_on_no_unit() {
        let (long, name) = (
            "a_value_with_a_long_name",
            "another_value_with_a_name_as_long",
        );
        let statement = format!("let x = {long} * {name} * {long};");
        let with = |unit: &str| body(&format!("{statement} {TRAILING}({unit:?});"));
        let (short, wide) = (with("m"), with("slug^0.5*ft^1.5/s^2/rad^2"));
        assert_eq!(short.replace(" // m", ""), format!("    {statement}\n"));
        // A unit without room stands above.
        assert_eq!(
            wide,
            format!("    // slug^0.5*ft^1.5/s^2/rad^2\n    {statement}\n")
        );
    }

    #[test]
    fn heads_imports_and_items_are_filled() {
        let types: Vec<String> = (0..9).map(|k| format!("ALongTypeName{k}")).collect();
        let imports = format!("use super::{{{}}};", types.join(", "));
        let text = format_rust("f.rs", "", &imports).unwrap();
        let lines: Vec<&str> = text.lines().filter(|line| !line.is_empty()).collect();
        assert_eq!(lines.len(), 4, "{text}");
        assert!(
            lines[1].len() > 100 && lines.iter().all(|line| line.len() <= 120),
            "{text}"
        );
        let call = "let x = [Rule::new(\"a rule with a name\", \"and a reason for it that is long\", Sign::Positive)];";
        let items = format!("const A: &[Rule] = &{}", &call["let x = ".len()..]);
        let text = format_rust("f.rs", "", &items).unwrap();
        assert!(
            text.contains("for it that is long\", Sign::Positive)"),
            "{text}"
        );
    }

    #[test]
    fn text_that_is_not_rust_names_its_file() {
        let error = format_rust("dcom/drift.rs", "", "fn (").unwrap_err();
        assert!(error.to_string().contains("dcom/drift.rs"), "{error}");
    }
}
