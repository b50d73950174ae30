//! What the new package may be called.

use crate::place::Place;
use ahv_generate::Failure;

/// The packages that this version of ahv is built of, as cargo locks them.
pub(crate) const LOCK: &str = include_str!("../starts/Cargo.lock");

/// Words of Rust, as package names are crate names, too.
const KEYWORDS: [&str; 51] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate",
    "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl",
    "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref",
    "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];
/// Crates that come with Rust.
const STANDARD: [&str; 5] = ["alloc", "core", "proc_macro", "std", "test"];
/// Folders that cargo writes beside the program.
const CARGO: [&str; 4] = ["build", "deps", "examples", "incremental"];
/// Devices of Windows, where no file can have such a name.
const DEVICES: [&str; 8] = ["aux", "con", "nul", "prn", "com1", "com2", "lpt1", "lpt2"];
const LONGEST: usize = 64;

/// The checked name of a package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Name(String);

impl Name {
    /// The name that is given, else that of the folder.
    ///
    /// # Errors
    /// A name that cargo or Rust does not take, or that a package of ahv has.
    pub(crate) fn check(given: Option<&str>, place: &Place) -> Result<Self, Failure> {
        let name = match given {
            Some(name) => name.to_owned(),
            None => place.name().to_lowercase(),
        };
        match fault(&name) {
            None => Ok(Self(name)),
            Some(fault) => Err(
                Failure::new(format!("`{name}` cannot be the name: {fault}"))
                    .with_help("choose another with --name, such as my-vehicle"),
            ),
        }
    }

    /// The name of the package with the program.
    pub(crate) fn program(&self) -> &str {
        &self.0
    }

    /// The name of the package with the models.
    pub(crate) fn models(&self) -> String {
        format!("{}-models", self.0)
    }
}

/// What is wrong with a name.
fn fault(name: &str) -> Option<String> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(plain) {
        return Some(
            "a name starts with a lower-case letter and holds lower-case letters, digits, - and _"
                .to_owned(),
        );
    }
    if name.len() > LONGEST {
        return Some(format!("it has more than {LONGEST} letters"));
    }
    let as_crate = name.replace('-', "_");
    let is_in = |names: &[&str]| names.contains(&as_crate.as_str());
    if is_in(&KEYWORDS) {
        Some("it is a keyword of Rust".to_owned())
    } else if is_in(&STANDARD) {
        Some("a crate of Rust has it".to_owned())
    } else if is_in(&CARGO) {
        Some("a folder of cargo has it".to_owned())
    } else if is_in(&DEVICES) {
        Some("a device of Windows has it".to_owned())
    } else {
        let models = format!("{as_crate}_models");
        let clash = packages().find(|it| {
            let package = it.replace('-', "_");
            package == as_crate || package == models
        })?;
        Some(format!("ahv is built of a package `{clash}`"))
    }
}

/// The packages of ahv and of what it is built of.
fn packages() -> impl Iterator<Item = &'static str> {
    let names = LOCK
        .lines()
        .filter_map(|line| line.strip_prefix("name = \""));
    names.filter_map(|rest| rest.strip_suffix('"'))
}

#[cfg(test)]
mod tests {
    use super::fault;

    #[test]
    fn names_of_vehicles_are_taken() {
        for name in ["w", "winged-cone", "my_vehicle", "x43", "pendulum"] {
            assert_eq!(fault(name), None, "{name}");
        }
    }

    #[test]
    fn what_is_wrong_with_a_name_is_said() {
        for (name, message) in [
            ("", "starts with a lower-case letter"),
            ("3d", "starts with a lower-case letter"),
            ("my vehicle", "starts with a lower-case letter"),
            ("Vehicle", "starts with a lower-case letter"),
            ("kg\u{e4}", "starts with a lower-case letter"),
            ("fn", "keyword"),
            ("gen", "keyword"),
            ("core", "a crate of Rust"),
            ("proc-macro", "a crate of Rust"),
            ("test", "a crate of Rust"),
            ("deps", "a folder of cargo"),
            ("con", "a device"),
            ("ahv", "a package `ahv"),
            ("ahv-core", "a package `ahv-core`"),
            ("ahv_core", "a package `ahv-core`"),
            ("clap", "a package `clap`"),
        ] {
            let fault = fault(name).unwrap_or_default();
            assert!(fault.contains(message), "{name}: {fault}");
        }
        assert!(fault(&"a".repeat(65)).is_some());
    }
}
