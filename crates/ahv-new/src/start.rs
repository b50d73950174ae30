//! What a new repository starts from: tables, and the file of a family where it is not a built-in one.

use std::fs;
use std::path::Path;

use crate::Args;
use ahv_generate::Failure;

/// What kind of start one is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Example,
    Family,
}

/// Name and text of a file.
type File = (&'static str, &'static str);

const STARTS: &[(Kind, &str, &[File])] = include!(concat!(env!("OUT_DIR"), "/starts.rs"));
const DEFAULT: &str = "winged-cone";

/// The files that people edit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Start {
    /// What it is, for the README.
    pub(crate) said: String,
    /// Names and texts of tables and family files, in the folder of the tables.
    pub(crate) files: Vec<(String, String)>,
}

impl Start {
    /// What the command line says.
    ///
    /// # Errors
    /// No such example, family or file; the message lists what there is.
    pub(crate) fn find(args: &Args, here: &Path) -> Result<Self, Failure> {
        match &args.family {
            None => embedded(Kind::Example, args.example.as_deref().unwrap_or(DEFAULT)),
            Some(family) if family.ends_with(".py") => of_file(args, family, here),
            Some(family) if args.table.is_none() => embedded(Kind::Family, family),
            Some(family) => Err(Failure::new(format!(
                "--table is for a Python file, and `{family}` is a built-in family with a table"
            ))),
        }
    }
}

fn embedded(kind: Kind, name: &str) -> Result<Start, Failure> {
    let of_kind = || STARTS.iter().filter(|(it, _, _)| *it == kind);
    let Some((_, _, files)) = of_kind().find(|(_, it, _)| *it == name) else {
        let known: Vec<&str> = of_kind().map(|(_, it, _)| *it).collect();
        let (what, more) = match kind {
            Kind::Example => ("an example", ""),
            Kind::Family => ("a built-in family", "; a file of your own ends in .py"),
        };
        return Err(Failure::new(format!("`{name}` is not {what}"))
            .with_help(format!("there are {}{more}", known.join(", "))));
    };
    let owned = |(name, text): &File| ((*name).to_owned(), (*text).to_owned());
    Ok(Start {
        said: match kind {
            Kind::Example => format!("the example `{name}`"),
            Kind::Family => format!("the built-in family `{name}`"),
        },
        files: files.iter().map(owned).collect(),
    })
}

/// A family in a file of its own, and its table.
fn of_file(args: &Args, family: &str, here: &Path) -> Result<Start, Failure> {
    let family = here.join(family);
    let table = match &args.table {
        Some(table) => here.join(table),
        None => family.with_extension("toml"),
    };
    let table_text = fs::read_to_string(&table).map_err(|error| {
        Failure::file("read the table", &table)(error)
            .with_help("name the table of the family with --table; docs/families.md has one")
    })?;
    let family_text =
        fs::read_to_string(&family).map_err(Failure::file("read the family", &family))?;
    let name = |path: &Path| -> Result<String, Failure> {
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| Failure::new(format!("{} has no name", path.display())))?;
        Ok(name.to_owned())
    };
    let (table_name, family_name) = (name(&table)?, name(&family)?);
    if !table_name.ends_with(".toml") || table_name.starts_with('.') {
        let message = format!(
            "{} is not a table: its name must end in .toml",
            table.display()
        );
        return Err(Failure::new(message));
    }
    let parts = named_by(&table_text, &table_name, &family_name)?;
    let said = format!("the family `{family_name}`");
    let mut files = vec![(table_name, table_text), (family_name, family_text)];
    for part in parts {
        let path = table.with_file_name(&part);
        let text = fs::read_to_string(&path).map_err(Failure::file("read the part", &path))?;
        files.push((part, text));
    }
    Ok(Start { said, files })
}

/// The table must name the family by a file beside it, for so they lie in the new repository. Returns the files of parts that
/// it names.
fn named_by(table: &str, table_name: &str, family_name: &str) -> Result<Vec<String>, Failure> {
    let document: toml_edit::DocumentMut = table
        .parse()
        .map_err(|error| Failure::new(format!("{table_name}: {error}")))?;
    let header = document.get("table").and_then(|it| it.get("family"));
    let named = header.and_then(toml_edit::Item::as_str);
    if named == Some(family_name) {
        return Ok(parts(&document));
    }
    let found = named.map_or("no family".to_owned(), |it| format!("the family {it:?}"));
    Err(
        Failure::new(format!("{table_name} names {found}, not {family_name:?}"))
            .with_help(format!("write family = {family_name:?} in [table]")),
    )
}

/// The files of parts beside the table, each once.
fn parts(document: &toml_edit::DocumentMut) -> Vec<String> {
    let parts = document.get("parts").and_then(|it| it.as_table_like());
    let parts = parts.into_iter().flat_map(|parts| parts.iter());
    let named = parts.filter_map(|(_, part)| part.get("part")?.as_str());
    // A path that leads out of the folder is the derivation's to refuse.
    let beside = named.filter(|file| file.ends_with(".py") && !file.contains(".."));
    let mut files: Vec<String> = beside.map(str::to_owned).collect();
    files.sort();
    files.dedup();
    files
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::{Kind, embedded, named_by};

    #[test]
    fn examples_have_table_and_family() {
        let start = embedded(Kind::Example, "winged-cone").expect("an example");
        let names: Vec<&str> = start.files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["winged_cone.py", "winged_cone.toml"]);
    }

    /// The folders of `examples/` with a file that is a table.
    fn with_a_table() -> Vec<String> {
        let has_table = |folder: &Path| {
            let files = fs::read_dir(folder).expect("a folder").flatten();
            files.map(|it| it.path()).any(|it| {
                it.extension().is_some_and(|it| it == "toml") && !it.ends_with("Cargo.toml")
            })
        };
        let folders = fs::read_dir("../../examples").expect("examples").flatten();
        let folders = folders.filter(|it| it.path().is_dir() && has_table(&it.path()));
        let mut names: Vec<String> = folders
            .map(|it| it.file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn what_there_is_not_is_answered_with_what_there_is() {
        let said = embedded(Kind::Example, "saucer")
            .expect_err("unknown")
            .render();
        assert!(said.contains("`saucer` is not an example"), "{said}");
        let offered = format!("there are {}\n", with_a_table().join(", "));
        assert!(said.contains(&offered), "{said}");
        assert!(offered.contains("van-der-pol") && offered.contains("winged-cone"));
        let said = embedded(Kind::Family, "saucer")
            .expect_err("unknown")
            .render();
        assert!(said.contains("com, dcom, flexible_mode"), "{said}");
    }

    #[test]
    fn a_table_must_name_its_family() {
        let table = "[table]\nfamily = \"glider.py\"\n";
        assert_eq!(
            named_by(table, "glider.toml", "glider.py").ok(),
            Some(Vec::new())
        );
        let joined = "[table]\nfamily = \"glider.py\"\n[parts]\nelevator = { part = \"servo.py\" }\n\
            flap = { part = \"servo.py\" }\ngust = { part = \"dryden\" }\n";
        let parts = named_by(joined, "glider.toml", "glider.py").ok();
        assert_eq!(parts, Some(vec!["servo.py".to_owned()]));
        let failure = named_by(table, "glider.toml", "kite.py").expect_err("another");
        assert!(
            failure
                .render()
                .contains("glider.toml names the family \"glider.py\"")
        );
    }
}
