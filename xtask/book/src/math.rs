//! Formulas: LaTeX to MathML, which browsers show without help.

use math_core::{LatexToMathML, MathCoreConfig, MathDisplay};

/// Converts formulas.
pub(super) struct Formulas(LatexToMathML);

impl Formulas {
    pub(super) fn new() -> Result<Self, String> {
        let converter = LatexToMathML::new(MathCoreConfig::default());
        converter
            .map(Self)
            .map_err(|(error, ..)| format!("error: {error}"))
    }

    /// A formula inside a sentence.
    pub(super) fn inline(&self, latex: &str) -> Result<String, String> {
        self.convert(latex, MathDisplay::Inline)
    }

    /// A formula by itself, with its number at the right.
    pub(super) fn display(&self, latex: &str) -> Result<String, String> {
        let (latex, tag) = tagged(latex.trim());
        let formula = self.convert(latex, MathDisplay::Block)?;
        let tag = tag.map_or_else(String::new, |tag| {
            format!("<span class=\"tag\">({})</span>", escaped(tag))
        });
        Ok(format!("<div class=\"formula\">{formula}{tag}</div>\n"))
    }

    fn convert(&self, latex: &str, display: MathDisplay) -> Result<String, String> {
        let done = self.0.convert_with_local_state(latex, display);
        let done =
            done.map_err(|error| format!("{error}\n    {}", latex.replace('\n', "\n    ")))?;
        Ok(done.mathml)
    }
}

/// A formula without the `\tag{…}` that ends it, and the tag.
fn tagged(latex: &str) -> (&str, Option<&str>) {
    let parts = latex
        .rsplit_once("\\tag{")
        .and_then(|(formula, tag)| Some((formula, tag.strip_suffix('}')?)));
    match parts {
        Some((formula, tag)) if !tag.contains(['{', '}']) => (formula.trim_end(), Some(tag)),
        _ => (latex, None),
    }
}

/// Text of an HTML page.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
