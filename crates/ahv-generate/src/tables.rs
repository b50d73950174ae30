//! Reading the tables, and finding where in their text a fault lies.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use ahv_codegen::{Part, Table, Unreadable};
use serde::Deserialize;

use crate::failure::{Failure, TableFault};
use crate::files;
use crate::project::Project;
use crate::settings;
use crate::structure;

/// A table's file.
pub(crate) struct Source {
    pub(crate) path: PathBuf,
    /// As messages name it.
    pub(crate) shown: String,
    text: String,
}

/// All tables of a project, in the order of their files' names.
pub(crate) struct Tables {
    pub(crate) sources: Vec<Source>,
    /// One a source, in the same order.
    pub(crate) parsed: Vec<Table>,
    /// Hash of the structure of each, by its name.
    pub(crate) structure: BTreeMap<String, String>,
}

/// What the derivation finds wrong with a table, at a key path, whose position only the text knows; or with the file of
/// a family, at a line.
#[derive(Debug, Deserialize)]
pub(crate) struct Diagnostic {
    pub(crate) rule: String,
    pub(crate) file: String,
    pub(crate) path: Vec<String>,
    pub(crate) part: DiagnosticPart,
    pub(crate) message: String,
    pub(crate) help: Option<String>,
    pub(crate) line: Option<usize>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum DiagnosticPart {
    Key,
    Value,
}

impl Diagnostic {
    /// A fault of a line of a family's file, which is named relative to the folder of the tables.
    pub(crate) fn of_line(file: &str, line: usize, message: String) -> Self {
        Self {
            rule: "family".to_owned(),
            file: file.to_owned(),
            path: Vec::new(),
            part: DiagnosticPart::Key,
            message,
            help: None,
            line: Some(line),
        }
    }

    /// A fault of the value at a path.
    pub(crate) fn of_value(rule: &str, table: &Table, path: &[&str], message: &str) -> Self {
        Self {
            rule: rule.to_owned(),
            file: table.file_name.clone(),
            path: path.iter().map(|&key| key.to_owned()).collect(),
            part: DiagnosticPart::Value,
            message: message.to_owned(),
            help: None,
            line: None,
        }
    }
}

impl Tables {
    /// Reads every `*.toml` in the folder of tables, but hidden ones and `Cargo.toml`.
    pub(crate) fn load(project: &Project) -> Result<Self, Failure> {
        let [tables, out] = [&project.tables, &project.out].map(|path| path.canonicalize().ok());
        if tables.is_some() && tables == out {
            // What is generated stands apart from what people edit.
            let folder = project.shown(&project.out);
            let message = format!(
                "{folder} holds the tables: the generated package needs a folder of its own"
            );
            return Err(Failure::new(message).with_help("name another folder with --out"));
        }
        let paths = table_files(project)?;
        let (mut sources, mut parsed, mut faults) = (Vec::new(), Vec::new(), Vec::new());
        let mut structure = BTreeMap::new();
        for path in paths {
            let shown = project.shown(&path);
            let bytes = files::read(&path)
                .map_err(|error| Failure::new(format!("cannot read {shown}: {error}")))?;
            match parse(&path, &shown, bytes) {
                Ok((text, table, hash)) => {
                    structure.insert(table.name.clone(), hash);
                    sources.push(Source { path, shown, text });
                    parsed.push(table);
                }
                Err(fault) => faults.push(*fault),
            }
        }
        let tables = Self {
            sources,
            parsed,
            structure,
        };
        faults.extend(tables.name_faults());
        if faults.is_empty() {
            Ok(tables)
        } else {
            Err(Failure::Tables(faults))
        }
    }

    /// Whether the files are still as they were read: what is derived from them is read again by Python.
    ///
    /// # Errors
    /// [`Failure::Other`] with the file that was changed meanwhile, those of [`Self::load`].
    pub(crate) fn hold_still(&self, project: &Project) -> Result<(), Failure> {
        let now = Self::load(project)?;
        let texts = |tables: &Self| -> Vec<(PathBuf, String)> {
            let sources = tables.sources.iter();
            sources
                .map(|it| (it.path.clone(), it.text.clone()))
                .collect()
        };
        if texts(self) == texts(&now) && self.structure == now.structure {
            return Ok(());
        }
        let changed = self
            .sources
            .iter()
            .zip(&self.parsed)
            .find(|(source, table)| {
                let text = now.sources.iter().find(|it| it.path == source.path);
                text.is_none_or(|it| it.text != source.text)
                    || now.structure.get(&table.name) != self.structure.get(&table.name)
            });
        let changed = changed.map_or("the folder of the tables", |(source, _)| &source.shown);
        let message = format!("{changed}, or a file beside it, was changed while it was derived");
        Err(Failure::new(message).with_help("generate again"))
    }

    /// One table by itself.
    ///
    /// # Errors
    /// It cannot be read, is no table, or has no name.
    pub(crate) fn of_file(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        let bytes = files::read(path)
            .map_err(|error| Failure::new(format!("cannot read {shown}: {error}")))?;
        let (text, table, hash) =
            parse(path, &shown, bytes).map_err(|fault| Failure::Tables(vec![*fault]))?;
        let tables = Self {
            structure: BTreeMap::from([(table.name.clone(), hash)]),
            sources: vec![Source {
                path: path.to_owned(),
                shown,
                text,
            }],
            parsed: vec![table],
        };
        match tables.name_faults() {
            faults if faults.is_empty() => Ok(tables),
            faults => Err(Failure::Tables(faults)),
        }
    }

    /// Files are named after tables: each needs a name of its own.
    fn name_faults(&self) -> Vec<TableFault> {
        let mut faults = Vec::new();
        for (index, table) in self.parsed.iter().enumerate() {
            let earlier = self.parsed[..index]
                .iter()
                .position(|it| it.name == table.name);
            let message = if table.name.is_empty() {
                "the table has no name".to_owned()
            } else if let Some(earlier) = earlier {
                format!(
                    "{} has the name {:?} already",
                    self.sources[earlier].shown, table.name
                )
            } else {
                continue;
            };
            let message = with_rule(&message, "table-name");
            faults.push(self.fault(index, &["table", "name"], Part::Value, message, None));
        }
        faults
    }

    /// The faults that the derivation reports, each at its place.
    pub(crate) fn faults(&self, diagnostics: Vec<Diagnostic>) -> Failure {
        let mut faults = Vec::new();
        for diagnostic in diagnostics {
            let named = |table: &Table| table.file_name == diagnostic.file;
            let Some(index) = self.parsed.iter().position(named) else {
                let Some(fault) = self.family_fault(&diagnostic) else {
                    let at = diagnostic.line.map_or(String::new(), |it| format!(":{it}"));
                    let Diagnostic { file, message, .. } = diagnostic;
                    return Failure::new(format!("{file}{at}: {message}"));
                };
                faults.push(fault);
                continue;
            };
            let path: Vec<&str> = diagnostic.path.iter().map(String::as_str).collect();
            let part = match diagnostic.part {
                DiagnosticPart::Key => Part::Key,
                DiagnosticPart::Value => Part::Value,
            };
            let message = with_rule(&diagnostic.message, &diagnostic.rule);
            faults.push(self.fault(index, &path, part, message, diagnostic.help));
        }
        Failure::Tables(faults)
    }

    /// A fault at a line of a family's file, which is named relative to the folder of the tables.
    fn family_fault(&self, diagnostic: &Diagnostic) -> Option<TableFault> {
        let (line, table) = (diagnostic.line?, self.sources.first()?);
        let bytes = files::read(&table.path.with_file_name(&diagnostic.file)).ok()?;
        let text = String::from_utf8(bytes).ok()?;
        let before: usize = text
            .split_inclusive('\n')
            .take(line.saturating_sub(1))
            .map(str::len)
            .sum();
        let content = text.get(before..)?.lines().next().unwrap_or_default();
        let start = before + content.len() - content.trim_start().len();
        let span = start..before + content.trim_end().len();
        let shown = Path::new(&table.shown).with_file_name(&diagnostic.file);
        let message = with_rule(&diagnostic.message, &diagnostic.rule);
        let (help, shown) = (diagnostic.help.clone(), shown.display().to_string());
        Some(TableFault::new(message, help, &shown, &text, span))
    }

    fn fault(
        &self,
        index: usize,
        path: &[&str],
        part: Part,
        message: String,
        help: Option<String>,
    ) -> TableFault {
        let source = &self.sources[index];
        // What is missing has no place of its own, nor may what encloses it.
        let span = self.parsed[index].span(path, part).unwrap_or(0..0);
        TableFault::new(message, help, &source.shown, &source.text, span)
    }
}

/// A message with the name of the rule that is broken, as `ahv ... --table` shows it, too.
fn with_rule(message: &str, rule: &str) -> String {
    format!("{message} [{rule}]")
}

/// The files of tables, in the order of their names.
pub(crate) fn table_files(project: &Project) -> Result<Vec<PathBuf>, Failure> {
    let folder = project.shown(&project.tables);
    let entries = fs::read_dir(&project.tables).map_err(|error| {
        Failure::new(format!(
            "cannot read the folder of tables, {folder}: {error}"
        ))
        .with_help("run it inside the project, or name the folder with --tables")
    })?;
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry
            .map_err(Failure::file("read", &project.tables))?
            .path();
        // Editors keep hidden files beside those that are open; a program may stand beside its tables.
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_toml = path.extension() == Some(OsStr::new("toml"));
        if is_toml && !name.starts_with('.') && name != settings::FILE {
            paths.push(path);
        }
    }
    if paths.is_empty() {
        return Err(Failure::new(format!("no table (*.toml) lies in {folder}"))
            .with_help("name the folder that holds the tables with --tables"));
    }
    paths.sort();
    Ok(paths)
}

/// Where the Python files beside a table stand that it names.
pub(crate) fn scripts_of(path: &Path, table: &[u8]) -> Vec<PathBuf> {
    let table = std::str::from_utf8(table).map(|text| Table::parse("", text));
    let Ok(Ok(table)) = table else {
        return Vec::new();
    };
    let scripts = table.scripts().into_iter();
    scripts.map(|script| path.with_file_name(script)).collect()
}

/// The files of family and parts beside a table; those that come along are hashed with the generator. What cannot be read
/// is the derivation's to refuse.
fn scripts_beside(path: &Path, table: &Table) -> Vec<Vec<u8>> {
    let read = |script| files::read(&path.with_file_name(script)).unwrap_or_default();
    table.scripts().into_iter().map(read).collect()
}

/// The text of a table, the table, and the hash of its structure.
fn parse(
    path: &Path,
    shown: &str,
    bytes: Vec<u8>,
) -> Result<(String, Table, String), Box<TableFault>> {
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
        let replaced = char::REPLACEMENT_CHARACTER.len_utf8();
        Box::new(TableFault::new(
            with_rule("this is not UTF-8 text", "unreadable"),
            None,
            shown,
            &text,
            at..at + replaced,
        ))
    })?;
    let file_name = path.file_name().unwrap_or_default().to_string_lossy();
    let read = || {
        let table = Table::parse(&file_name, &text)?;
        let structure = structure::of_table(&file_name, &text, &scripts_beside(path, &table))?;
        Ok((table, structure))
    };
    match read() {
        Ok((table, structure)) => Ok((text, table, structure)),
        Err(error @ Unreadable { .. }) => {
            let span = error.span.unwrap_or(0..0);
            Err(Box::new(TableFault::new(
                with_rule(&error.message, "unreadable"),
                None,
                shown,
                &text,
                span,
            )))
        }
    }
}
