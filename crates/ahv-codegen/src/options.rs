//! What the generated package is to be: its name and language, where it finds `ahv-core`, its units.

use crate::graph::passes::Passes;
use crate::ir::UnitSystem;

/// What the generated package is called and where it finds `ahv-core`.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the package.
    pub package: String,
    /// Where `ahv-core` comes from.
    pub core: Core,
    /// Unit system; without one that of the table.
    pub units: Option<UnitSystem>,
    /// The rules by which expressions are rewritten.
    pub passes: Passes,
    /// The language.
    pub target: Target,
}

/// A language that models are emitted in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// A crate, with documentation.
    #[default]
    Rust,
    /// A C99 library.
    C,
}

impl Target {
    /// What the manifest calls the language; it names none for Rust.
    #[must_use]
    pub fn language(self) -> Option<&'static str> {
        match self {
            Self::Rust => None,
            Self::C => Some("c"),
        }
    }
}

/// Where the generated package finds `ahv-core`.
#[derive(Clone, Debug)]
pub enum Core {
    /// At a path relative to the package.
    Path(String),
    /// Where the workspace around the package says.
    Workspace,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            package: "ahv-models".to_owned(),
            core: Core::Path("../crates/ahv-core".to_owned()),
            units: None,
            passes: Passes::default(),
            target: Target::default(),
        }
    }
}

impl Options {
    /// The line of the package's manifest that names `ahv-core`.
    pub(crate) fn core_dependency(&self) -> String {
        match &self.core {
            Core::Path(path) => {
                let version = env!("CARGO_PKG_VERSION");
                // A TOML string of its own: a path may hold quotes and backslashes.
                let path = toml_edit::Value::from(path.as_str());
                format!(
                    "ahv-core = {{ version = \"{version}\", path = {} }}",
                    path.to_string().trim()
                )
            }
            Core::Workspace => "ahv-core.workspace = true".to_owned(),
        }
    }
}
