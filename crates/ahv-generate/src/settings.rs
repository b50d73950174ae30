//! What a project's `Cargo.toml` says of its generation, so that its commands need no flags.

use std::fs;
use std::path::Path;

use toml_edit::{Document, Item, TableLike};

use crate::failure::Failure;

/// The file that has them.
pub(crate) const FILE: &str = "Cargo.toml";
/// The section of `Cargo.toml`, below `[workspace.metadata]`.
const SECTION: &str = "ahv";
const KEYS: [&str; 6] = [
    "tables",
    "out",
    "package",
    "core-path",
    "core-workspace",
    "command",
];

/// `[workspace.metadata.ahv]` of a `Cargo.toml`. Each key stands for the flag of its name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Settings {
    /// Folder of the tables, relative to the file.
    pub(crate) tables: Option<String>,
    /// Folder of the generated package, relative to the file.
    pub(crate) out: Option<String>,
    /// Name of the generated package.
    pub(crate) package: Option<String>,
    /// Where the generated package finds `ahv-core`, relative to itself.
    pub(crate) core_path: Option<String>,
    /// Whether it finds `ahv-core` by its workspace.
    pub(crate) core_workspace: bool,
    /// The command that people of this project generate with, for messages.
    pub(crate) command: Option<String>,
}

impl Settings {
    /// Those of the `Cargo.toml` in a folder; none where it has no such section.
    ///
    /// # Errors
    /// A section that cannot be read, or that has a key or a value that it may not have.
    pub(crate) fn of(folder: &Path) -> Result<Option<Self>, Failure> {
        let Ok(text) = fs::read_to_string(folder.join(FILE)) else {
            return Ok(None);
        };
        Self::parse(&text).map_err(|message| {
            Failure::new(format!("{FILE}: {message}")).with_help(format!(
                "[workspace.metadata.{SECTION}] has the keys {}",
                KEYS.join(", ")
            ))
        })
    }

    fn parse(text: &str) -> Result<Option<Self>, String> {
        // Of a file without settings cargo says what is wrong.
        if !text.contains(SECTION) || !text.contains("metadata") {
            return Ok(None);
        }
        let document = Document::parse(text).map_err(|error| error.to_string())?;
        let inside = |item: &'_ Item, key: &str| item.get(key).cloned();
        let metadata = document
            .get("workspace")
            .and_then(|it| inside(it, "metadata"));
        let Some(section) = metadata.and_then(|it| inside(&it, SECTION)) else {
            return Ok(None);
        };
        let section = section
            .as_table_like()
            .ok_or_else(|| format!("workspace.metadata.{SECTION} is not a table"))?;
        Self::read(section).map(Some)
    }

    fn read(section: &dyn TableLike) -> Result<Self, String> {
        let mut settings = Self::default();
        for (key, item) in section.iter() {
            let text = || match item.as_str() {
                Some(text) if !text.is_empty() => Ok(Some(text.to_owned())),
                _ => Err(format!("`{key}` is not a text")),
            };
            match key {
                "tables" => settings.tables = text()?,
                "out" => settings.out = text()?,
                "package" => {
                    settings.package = text()?;
                    if let Some(name) = &settings.package {
                        package_name(name)?;
                    }
                }
                "core-path" => settings.core_path = text()?,
                "core-workspace" => {
                    settings.core_workspace = item
                        .as_bool()
                        .ok_or_else(|| format!("`{key}` is not true or false"))?;
                }
                "command" => settings.command = text()?,
                _ => return Err(format!("`{key}` is not a key of ahv")),
            }
        }
        if settings.core_workspace && settings.core_path.is_some() {
            return Err("`core-path` and `core-workspace` exclude each other".to_owned());
        }
        Ok(settings)
    }
}

/// A name that cargo takes for a package.
pub(crate) fn package_name(name: &str) -> Result<String, String> {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(plain) {
        Ok(name.to_owned())
    } else {
        Err("a package name starts with a letter and holds letters, digits, - and _".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::Settings;

    #[test]
    fn settings_are_read_from_their_section() {
        let text = "[workspace]\nmembers = [\"models\"]\n[workspace.metadata.ahv]\ntables = \"tables\"\ncore-workspace = true\n";
        let settings = Settings::parse(text).unwrap().unwrap();
        assert_eq!(settings.tables.as_deref(), Some("tables"));
        assert!(settings.core_workspace);
        assert_eq!(settings.package, None);
    }

    #[test]
    fn a_file_without_the_section_has_none() {
        for text in ["", "[workspace]\n", "[workspace.metadata.docs]\nahv = 1\n"] {
            assert_eq!(Settings::parse(text), Ok(None), "{text}");
        }
    }

    #[test]
    fn a_fault_is_named() {
        for (line, message) in [
            ("table = \"x\"", "`table` is not a key of ahv"),
            ("tables = 3", "`tables` is not a text"),
            (
                "core-workspace = 1",
                "`core-workspace` is not true or false",
            ),
            ("package = \"3\"", "a package name starts with a letter"),
            (
                "core-workspace = true\ncore-path = \"x\"",
                "exclude each other",
            ),
        ] {
            let said = Settings::parse(&format!("[workspace.metadata.ahv]\n{line}\n")).unwrap_err();
            assert!(said.contains(message), "{said}");
        }
    }
}
