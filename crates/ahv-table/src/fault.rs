//! What is wrong with a table, and where.

use std::fmt::{self, Display, Write as _};

use crate::Part;

/// A fault of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The rule that is broken, by the name that `ahv generate` has for it.
    pub rule: &'static str,
    /// Path of the keys to the entry at fault; of what lacks one, if an entry is missing.
    pub path: Vec<String>,
    /// Whether its key or its value is at fault.
    pub part: Part,
    message: String,
    /// What would be right; may be empty.
    help: String,
}

impl Fault {
    /// The table is not for this model.
    #[must_use]
    pub fn other_model(model: &str) -> Self {
        let message = format!("the table is not for {model}");
        let help = "`models` must list it";
        Self::new(
            "model-not-listed",
            &["table", "models"],
            Part::Value,
            &message,
            help,
        )
    }

    /// What is wrong, with no character that could act on a terminal.
    #[must_use]
    pub fn message(&self) -> String {
        visible(&self.message)
    }

    /// What would be right, likewise; may be empty.
    #[must_use]
    pub fn help(&self) -> String {
        visible(&self.help)
    }

    pub(crate) fn new(
        rule: &'static str,
        path: &[&str],
        part: Part,
        message: &str,
        help: &str,
    ) -> Self {
        Self {
            rule,
            path: path.iter().map(|&key| key.to_owned()).collect(),
            part,
            message: message.to_owned(),
            help: help.to_owned(),
        }
    }
}

impl Display for Fault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        Visible(&self.message).fmt(formatter)?;
        if !self.help.is_empty() {
            write!(formatter, "; {}", Visible(&self.help))?;
        }
        write!(formatter, " [{}]", self.rule)
    }
}

/// A text of a table for people: a character that could act on a terminal or a page is written as its code.
#[must_use]
pub fn visible(text: &str) -> String {
    Visible(text).to_string()
}

/// A text, in which a character that could act on a terminal is written as its code.
struct Visible<'a>(&'a str);

impl Display for Visible<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|c| match is_printable(c) {
            true => formatter.write_char(c),
            false => write!(formatter, "{}", c.escape_unicode()),
        })
    }
}

/// Whether a character can be shown: not a control, a mark of direction or the like.
pub(crate) fn is_printable(c: char) -> bool {
    // A mark that joins the letter before it can be shown, too.
    "\"'\\".contains(c) || format!("a{c}").escape_debug().nth(2).is_none()
}

/// The start of a text of a table.
pub(crate) fn shortened(text: &str) -> String {
    const LONGEST: usize = 60;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

/// The nearest of the known words, or all of them, if there are any.
pub(crate) fn suggestion(word: &str, known: &[&str]) -> String {
    const SIMILAR: f64 = 0.8;
    let word = word.to_lowercase();
    let nearest = known
        .iter()
        .map(|known| (strsim::jaro_winkler(&word, &known.to_lowercase()), known))
        .filter(|&(similarity, _)| similarity > SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((_, nearest)) => format!("did you mean `{nearest}`?"),
        None if known.is_empty() => "nothing is known here".to_owned(),
        None => format!("known here: `{}`", known.join("`, `")),
    }
}

#[cfg(test)]
mod tests {
    use super::{Fault, is_printable};
    use crate::Part;

    #[test]
    fn no_character_acts_on_a_terminal() {
        let fault = Fault::new("r", &[], Part::Key, "a\u{1b}[\u{202e}é'\"\\\u{301}", "b\n");
        assert_eq!(
            fault.to_string(),
            "a\\u{1b}[\\u{202e}é'\"\\\u{301}; b\\u{a} [r]"
        );
        assert!(!is_printable('\u{a0}') && is_printable(' '));
    }
}
