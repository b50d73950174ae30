//! The files of the new repository.

use std::fs;
use std::path::{Path, PathBuf};

use ahv_generate::Surroundings;
use clap::Parser as _;
use serde_json::Value;

use crate::name::{LOCK, Name};
use crate::origin::{CRATES, Origin};
use crate::slashed;
use crate::start::Start;
use ahv_generate::Failure;

/// Where the tables lie.
const TABLES: &str = "tables";
/// Where the IR of the generated package lies.
const IR: &str = "models/ir";

/// Files whose text has placeholders, written before the models are generated: with them `generate` needs no flags.
const FIRST: &[(&str, &str)] = &[
    ("Cargo.toml", include_str!("../templates/Cargo.toml.txt")),
    ("src/main.rs", include_str!("../templates/main.rs.txt")),
    (
        "tests/models.rs",
        include_str!("../templates/models.rs.txt"),
    ),
    (".gitignore", include_str!("../templates/gitignore.txt")),
    (
        ".gitattributes",
        include_str!("../templates/gitattributes.txt"),
    ),
    (
        ".pre-commit-config.yaml",
        include_str!("../templates/pre-commit.yaml.txt"),
    ),
    (
        ".github/workflows/ahv.yml",
        include_str!("../templates/workflow.yml.txt"),
    ),
];
/// Names the models, and so is written after them.
const README: (&str, &str) = ("README.md", include_str!("../templates/README.md.txt"));

/// The command line of `ahv generate`.
#[derive(clap::Parser)]
struct GenerateLine {
    #[command(flatten)]
    args: ahv_generate::Args,
}

/// Writes the repository in an empty folder and generates its models; returns the files.
pub(crate) fn write(
    folder: &Path,
    name: &Name,
    start: &Start,
    origin: &Origin,
    surroundings: &Surroundings,
) -> Result<Vec<String>, Failure> {
    let mut words = words(name, start, origin);
    for (file, text) in FIRST {
        put(folder, file, &filled(text, &words))?;
    }
    put(folder, "Cargo.lock", LOCK)?;
    for (file, text) in &start.files {
        put(folder, &format!("{TABLES}/{file}"), text)?;
    }
    let inside = Surroundings {
        current_dir: folder.to_owned(),
        ..surroundings.clone()
    };
    let line = GenerateLine::parse_from(["generate"]);
    ahv_generate::generate(&line.args, &inside)?;

    let models = models(folder)?;
    let flag = match models.as_slice() {
        // The only model is the default.
        [] | [_] => String::new(),
        [first, ..] => format!(" --model {}", first.name),
    };
    words.push(("model-flag", flag));
    let lines = models
        .iter()
        .map(|it| format!("| `{}` | {} |", it.name, it.title));
    words.push(("models", lines.collect::<Vec<_>>().join("\n")));
    put(folder, README.0, &filled(README.1, &words))?;
    files(folder)
}

/// What stands in the place of `@word@`.
fn words(name: &Name, start: &Start, origin: &Origin) -> Vec<(&'static str, String)> {
    let tables = start
        .files
        .iter()
        .filter(|(file, _)| file.ends_with(".toml"));
    let table = tables.map(|(file, _)| format!("{TABLES}/{file}")).next();
    let family = start.files.iter().find(|(file, _)| file.ends_with(".py"));
    let family = family.map(|(file, _)| {
        format!("| `{TABLES}/{file}` | the family: equations, trim problem, modes | you |\n")
    });
    let (checkout, source) = match origin {
        Origin::Folder(path) => (
            format!(
                "      # Cargo.toml takes ahv from the folder {path}: check it out there, or name a git repository in Cargo.toml.\n"
            ),
            format!("the folder `{path}`"),
        ),
        Origin::Git { url, rev } => (String::new(), format!("<{url}>, revision `{rev}`")),
    };
    let mut words = vec![
        ("name", name.program().to_owned()),
        ("models-package", name.models()),
        ("models-crate", name.models().replace('-', "_")),
        ("rust-version", env!("CARGO_PKG_RUST_VERSION").to_owned()),
        ("start", start.said.clone()),
        ("table", table.unwrap_or_default()),
        ("family-row", family.unwrap_or_default()),
        ("checkout", checkout),
        ("source", source),
    ];
    words.extend(CRATES.map(|package| (package, origin.dependency(package))));
    words
}

/// A template with its words. What a word stands for is not read again.
fn filled(template: &str, words: &[(&str, String)]) -> String {
    let mut text = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('@') {
        text.push_str(before);
        let value = |name: &str| words.iter().find(|(word, _)| *word == name);
        match after.split_once('@') {
            Some((name, tail)) if let Some((_, value)) = value(name) => {
                text.push_str(value);
                rest = tail;
            }
            _ => {
                text.push('@');
                rest = after;
            }
        }
    }
    text.push_str(rest);
    text
}

/// Writes a file, and the folders that it needs.
fn put(folder: &Path, file: &str, text: &str) -> Result<(), Failure> {
    let path = folder.join(file);
    let parent = path.parent().unwrap_or(folder);
    fs::create_dir_all(parent).map_err(Failure::file("make the folder", parent))?;
    fs::write(&path, text).map_err(Failure::file("write", &path))
}

/// A generated model.
struct Model {
    name: String,
    title: String,
}

/// The generated models, as the IR has them.
fn models(folder: &Path) -> Result<Vec<Model>, Failure> {
    let mut models = Vec::new();
    for file in files(&folder.join(IR))? {
        let path = folder.join(IR).join(file);
        let text = fs::read_to_string(&path).map_err(Failure::file("read", &path))?;
        let ir: Value = serde_json::from_str(&text)
            .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
        let text = |model: &Value, key: &str| model[key].as_str().unwrap_or_default().to_owned();
        for model in ir["models"].as_array().into_iter().flatten() {
            models.push(Model {
                name: text(model, "name"),
                title: text(model, "title"),
            });
        }
    }
    Ok(models)
}

/// All files below a folder, relative to it, in order.
fn files(folder: &Path) -> Result<Vec<String>, Failure> {
    let mut found = Vec::new();
    let mut open: Vec<PathBuf> = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(&next).map_err(Failure::file("read", &next))? {
            let path = entry.map_err(Failure::file("read", &next))?.path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.push(slashed(path.strip_prefix(folder).unwrap_or(&path)));
            }
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::filled;

    #[test]
    fn words_are_filled_in_and_other_signs_stay() {
        let words = [("name", "w@x".to_owned()), ("b", "c".to_owned())];
        for (template, text) in [
            ("a @name@ b", "a w@x b"),
            ("@name@@b@", "w@xc"),
            ("actions/checkout@v6\n@b@", "actions/checkout@v6\nc"),
            ("a@b", "a@b"),
            ("@name@-@name@", "w@x-w@x"),
            ("none", "none"),
        ] {
            assert_eq!(filled(template, &words), text, "{template}");
        }
    }
}
