//! Why there is no new repository.

use std::io;
use std::path::Path;

/// Why there is no new repository, and what to do about it.
#[derive(Debug)]
pub enum Failure {
    /// Something is not valid, or a file could not be written.
    Refused {
        /// What is wrong.
        message: String,
        /// What would be right.
        help: Option<String>,
    },
    /// The models could not be generated.
    Generate(ahv_generate::Failure),
}

impl Failure {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self::Refused {
            message: message.into(),
            help: None,
        }
    }

    pub(crate) fn with_help(self, text: impl Into<String>) -> Self {
        match self {
            Self::Refused { message, .. } => Self::Refused {
                message,
                help: Some(text.into()),
            },
            other => other,
        }
    }

    /// For `map_err`: what could not be done to which path.
    pub(crate) fn file(deed: &str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let message = format!("cannot {deed} {}", path.display());
        move |error| Self::new(format!("{message}: {error}"))
    }

    /// The exit code that says so: 2, or that of a signal.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Refused { .. } => ahv_generate::FAILED,
            Self::Generate(failure) => failure.exit_code(),
        }
    }

    /// The text for standard error.
    #[must_use]
    pub fn render(&self) -> String {
        match self {
            Self::Refused {
                message,
                help: None,
            } => format!("error: {message}\n"),
            Self::Refused {
                message,
                help: Some(help),
            } => format!("error: {message}\n  help: {help}\n"),
            Self::Generate(failure) => failure.render(),
        }
    }
}

impl From<ahv_generate::Failure> for Failure {
    fn from(failure: ahv_generate::Failure) -> Self {
        Self::Generate(failure)
    }
}
