//! Why generation stopped, said once and clearly.

use std::fmt::Write as _;
use std::io;
use std::ops::Range;
use std::path::Path;

use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, Severity, SourceCode,
};

use crate::excerpt::Excerpt;

/// Faults that are shown at a time: more than that is one fault that stands behind them all.
const MOST_SHOWN: usize = 100;

/// Something that a table may not say, with the place where it says so.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct TableFault {
    /// What is wrong.
    pub message: String,
    severity: Severity,
    help: Option<String>,
    table: Excerpt,
}

impl Diagnostic for TableFault {
    fn severity(&self) -> Option<Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        let help = self.help.as_ref()?;
        Some(Box::new(help))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.table)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = LabeledSpan::underline(self.table.span.clone());
        Some(Box::new(std::iter::once(label)))
    }
}

impl TableFault {
    /// A fault in a part of the text of a file, in bytes, with what would be right.
    #[must_use]
    pub fn new(
        message: impl Into<String>,
        help: Option<String>,
        file: &str,
        text: &str,
        span: Range<usize>,
    ) -> Self {
        // An empty table has no text to point at.
        let end = span.end.min(text.len());
        let start = span.start.min(end);
        let table = Excerpt::new(file, &visible(text), start..end);
        Self {
            message: message.into(),
            severity: Severity::Error,
            help,
            table,
        }
    }

    /// The same as a warning: no generation is refused for it.
    #[must_use]
    pub fn as_warning(self) -> Self {
        let severity = Severity::Warning;
        Self { severity, ..self }
    }

    /// The same as a note: nothing is wrong.
    #[must_use]
    pub fn as_note(self) -> Self {
        let severity = Severity::Advice;
        Self { severity, ..self }
    }

    /// The text for people: drawn on a terminal, plain ASCII elsewhere.
    #[must_use]
    pub fn render(&self, terminal: bool) -> String {
        let mut theme = if terminal {
            GraphicalTheme::unicode()
        } else {
            GraphicalTheme::none()
        };
        theme.characters.error = "error:".to_owned();
        theme.characters.warning = "warning:".to_owned();
        theme.characters.advice = "note:".to_owned();
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_links(false)
            .with_wrap_lines(false);
        let mut drawn = String::new();
        if handler.render_report(&mut drawn, self).is_err() {
            drawn = format!("error: {self}\n");
        }
        // miette indents the first line, too.
        drawn.trim_start().to_owned()
    }
}

/// A text whose control characters and marks of direction cannot act on a terminal, of the same length in bytes.
fn visible(text: &str) -> String {
    let acts = |c: char| {
        (c.is_control() && !matches!(c, '\n' | '\r' | '\t'))
            || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let replaced = |c: char| match c.len_utf8() {
        _ if !acts(c) => c,
        1 => '?',
        2 => '\u{bf}',
        _ => char::REPLACEMENT_CHARACTER,
    };
    text.chars().map(replaced).collect()
}

/// Why generation stopped. Exit code 2, but after a signal.
#[derive(Debug)]
pub enum Failure {
    /// Tables that say what they may not.
    Tables(Vec<TableFault>),
    /// Everything else.
    Other {
        /// What happened.
        message: String,
        /// What to do about it.
        help: Option<String>,
    },
    /// SIGINT or SIGTERM. Exit code 128 + the signal's number.
    Interrupted {
        /// The number of the signal.
        signal: usize,
    },
}

impl Failure {
    /// What happened, in words.
    #[must_use]
    pub fn new(message: impl Into<String>) -> Self {
        Self::Other {
            message: message.into(),
            help: None,
        }
    }

    /// The same, with what to do about it.
    #[must_use]
    pub fn with_help(self, help: impl Into<String>) -> Self {
        match self {
            Self::Other { message, .. } => Self::Other {
                message,
                help: Some(help.into()),
            },
            other => other,
        }
    }

    /// For `map_err`: what could not be done to which path.
    pub fn file(deed: &str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let message = format!("cannot {deed} {}", path.display());
        move |error| Self::new(format!("{message}: {error}"))
    }

    /// The exit code that says so.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Interrupted { signal } => u8::try_from(128 + signal).unwrap_or(crate::FAILED),
            _ => crate::FAILED,
        }
    }

    /// The text for standard error: drawn on a terminal, plain ASCII elsewhere.
    #[must_use]
    pub fn render(&self) -> String {
        self.render_for(console::colors_enabled_stderr())
    }

    fn render_for(&self, terminal: bool) -> String {
        let mut text = String::new();
        match self {
            Self::Tables(faults) => {
                let shown = faults.iter().take(MOST_SHOWN);
                text.extend(shown.map(|fault| fault.render(terminal)));
                if let more @ 1.. = faults.len().saturating_sub(MOST_SHOWN) {
                    let _ = writeln!(text, "error: and {more} more faults");
                }
            }
            Self::Other { message, help } => {
                let _ = writeln!(text, "error: {message}");
                if let Some(help) = help {
                    let _ = writeln!(text, "  help: {help}");
                }
            }
            Self::Interrupted { .. } => text.push_str("interrupted: no file was changed\n"),
        }
        text
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.render_for(false).trim_end())
    }
}

impl std::error::Error for Failure {}
