//! What was done or found, as text for people and as JSON.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter, Write as _};
use std::path::Path;

use serde::Serialize;
use serde_json::{Value, json};

use crate::compare::{Difference, Status};
use crate::failure::Failure;
use crate::manifest::MANIFEST;
use crate::project::Project;
use crate::tables::Tables;

/// Why a person must act on a stray file.
const KEPT_BY_HAND: &str = "ahv removes only what it wrote";

/// Wall-clock time of the two steps.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Seconds {
    pub(crate) derive: f64,
    pub(crate) emit: f64,
}

impl Display for Seconds {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let Self { derive, emit } = self;
        write!(formatter, "(derive {derive:.2} s, emit {emit:.2} s)")
    }
}

/// Lines that are printed of a difference which follows from others: in the documentation, or in the hashes of the manifest.
const FOLDED_LINES: usize = 12;

/// What a file is, in the order in which a reader wants to see differences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Code,
    Ir,
    Documentation,
}

impl Kind {
    const ALL: [Self; 3] = [Self::Code, Self::Ir, Self::Documentation];

    fn of(path: &str) -> Self {
        match path.split_once('/') {
            Some(("docs" | "schema", _)) => Self::Documentation,
            Some(("ir", _)) => Self::Ir,
            None if path == MANIFEST => Self::Ir,
            _ => Self::Code,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Code => "code",
            Self::Ir => "IR and manifest",
            Self::Documentation => "documentation",
        }
    }
}

/// A line a kind of file: how many differ, in how many lines.
fn summary(differences: &[(String, Difference)]) -> String {
    let mut text = String::new();
    for kind in Kind::ALL {
        let of_kind = differences
            .iter()
            .filter(|(_, it)| Kind::of(&it.path) == kind);
        let counts: Vec<(usize, usize)> = of_kind.map(|(_, it)| it.counts()).collect();
        let (added, removed): (usize, usize) = (
            counts.iter().map(|it| it.0).sum(),
            counts.iter().map(|it| it.1).sum(),
        );
        let files = match counts.len() {
            0 => continue,
            1 => "1 file".to_owned(),
            many => format!("{many} files"),
        };
        let _ = writeln!(text, "{}: {files}, +{added} −{removed}", kind.name());
    }
    text
}

/// Which table gives the modules of which name.
pub(crate) struct Owners(BTreeMap<String, String>);

impl Owners {
    /// A table gives the modules of its own name and of its models, and its parameters in C.
    pub(crate) fn new(tables: &Tables, irs: &BTreeMap<String, String>) -> Self {
        let mut owners = BTreeMap::new();
        for (source, table) in tables.sources.iter().zip(&tables.parsed) {
            let ir = irs
                .get(&table.name)
                .and_then(|text| serde_json::from_str::<Value>(text).ok());
            let models = ir.as_ref().and_then(|ir| ir["models"].as_array());
            for name in models
                .into_iter()
                .flatten()
                .filter_map(|model| model["name"].as_str())
            {
                owners.insert(name.to_owned(), source.shown.clone());
            }
            let parameters = format!("{}_parameters", ahv_codegen::c_identifier(&table.name));
            for name in [table.name.clone(), parameters] {
                owners.insert(name, source.shown.clone());
            }
        }
        Self(owners)
    }

    /// The table that gives a file, where it is one alone.
    fn of(&self, path: &str) -> Option<&str> {
        let module = path.split('/').nth(1)?;
        let stem = Path::new(module).file_stem()?.to_str()?;
        self.0.get(stem).map(String::as_str)
    }
}

/// What `generate` did.
pub struct Generated {
    differences: Vec<(String, Difference)>,
    /// The tables that were derived; of the others only values have changed, or nothing.
    derived: Vec<String>,
    seconds: Seconds,
}

impl Generated {
    pub(crate) fn new(
        project: &Project,
        differences: Vec<Difference>,
        derived: Vec<String>,
        seconds: Seconds,
    ) -> Self {
        Self {
            differences: shown(project, differences),
            derived,
            seconds,
        }
    }

    fn of(&self, status: Status) -> impl Iterator<Item = &(String, Difference)> {
        self.differences
            .iter()
            .filter(move |(_, it)| it.status == status && it.kept.is_none())
    }

    /// Stray files that were left where they are.
    fn kept(&self) -> impl Iterator<Item = &(String, Difference)> {
        self.differences.iter().filter(|(_, it)| it.kept.is_some())
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (path, difference) in &self.differences {
            let (added, removed) = difference.counts();
            let _ = match difference.status {
                Status::Differs => writeln!(text, "{path}  +{added} −{removed}"),
                Status::Missing => writeln!(text, "{path}  created, +{added}"),
                Status::Stray => match difference.kept {
                    None => writeln!(text, "{path}  removed: no table gives it"),
                    Some(kept) => writeln!(
                        text,
                        "{path}  stray, kept: no table gives it, and {}",
                        kept.reason()
                    ),
                },
            };
        }
        text.push_str(&summary(&self.differences));
        let count = |status| self.of(status).count();
        let (changed, created, removed, kept) = (
            count(Status::Differs),
            count(Status::Missing),
            count(Status::Stray),
            self.kept().count(),
        );
        if changed + created + removed == 0 {
            text.push_str("nothing changed");
        } else {
            let files = if changed == 1 { "file" } else { "files" };
            let _ = write!(
                text,
                "{changed} {files} changed, {created} created, {removed} removed"
            );
        }
        if kept > 0 {
            let _ = write!(text, ", {kept} stray kept");
        }
        let _ = writeln!(text, " {}", self.seconds);
        text
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> String {
        let paths = |status| self.of(status).map(|(path, _)| path).collect::<Vec<_>>();
        let changed = self.of(Status::Differs).map(|(path, difference)| {
            let (added, removed) = difference.counts();
            json!({ "path": path, "added": added, "removed": removed })
        });
        let kept = self
            .kept()
            .map(|(path, difference)| json!({ "path": path, "reason": difference.kept }));
        let value = json!({
            "changed": changed.collect::<Vec<_>>(),
            "created": paths(Status::Missing),
            "removed": paths(Status::Stray),
            "kept": kept.collect::<Vec<_>>(),
            "up_to_date": self.differences.is_empty(),
            "derived": self.derived,
            "seconds": self.seconds,
        });
        format!("{value:#}\n")
    }
}

/// What `generate --check` found.
pub struct Checked {
    differences: Vec<(String, Difference)>,
    /// One a difference: the table that the file comes from.
    tables: Vec<String>,
    places: (String, String),
    /// The command that brings the tree up to date, or why none does.
    mending: Result<String, Failure>,
    seconds: Seconds,
}

impl Checked {
    pub(crate) fn new(
        project: &Project,
        differences: Vec<Difference>,
        owners: &Owners,
        mending: Result<String, Failure>,
        seconds: Seconds,
    ) -> Self {
        let differences = shown(project, differences);
        let places = (project.shown(&project.out), project.shown(&project.tables));
        let all = format!("a table in {}", places.1);
        let table = |(_, it): &(String, Difference)| {
            owners
                .of(&it.path)
                .map_or_else(|| all.clone(), str::to_owned)
        };
        let tables = differences.iter().map(table).collect();
        Self {
            differences,
            tables,
            places,
            mending,
            seconds,
        }
    }

    /// Whether tree and tables agree.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.differences.is_empty()
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        if self.agrees() {
            let (out, tables) = &self.places;
            return format!("{out} agrees with {tables} {}\n", self.seconds);
        }
        let mut text = String::new();
        for ((path, difference), table) in self.differences.iter().zip(&self.tables) {
            let _ = match difference.status {
                Status::Differs => {
                    let reason = difference.reason.map(|it| format!(": {it}"));
                    let reason = reason.unwrap_or_default();
                    writeln!(text, "error: {path} does not match {table}{reason}")
                }
                Status::Missing => writeln!(text, "error: {path} is missing: {table} gives it"),
                Status::Stray => match difference.kept {
                    None => writeln!(text, "error: {path} is stray: no table gives it"),
                    Some(kept) => writeln!(
                        text,
                        "error: {path} is stray: no table gives it, and {}",
                        kept.reason()
                    ),
                },
            };
            text.push_str(&folded(&difference.diff(path), &difference.path));
        }
        text.push_str(&summary(&self.differences));
        let _ = writeln!(text, "{}", self.seconds);
        let total = self.differences.len();
        let kept = self.differences.iter().filter(|(_, it)| it.kept.is_some());
        let kept = kept.count();
        let (count, it) = match total {
            1 => ("1 file differs".to_owned(), "it"),
            count => (format!("{count} files differ"), "them"),
        };
        let _ = match (kept, &self.mending) {
            _ if kept == total => writeln!(text, "{count}. Move {it} away: {KEPT_BY_HAND}"),
            (_, Err(failure)) => {
                let why = failure.to_string();
                let why = why.strip_prefix("error: ").unwrap_or(&why);
                writeln!(
                    text,
                    "{count}, and no command brings {it} up to date: {why}"
                )
            }
            (0, Ok(command)) => {
                writeln!(text, "{count}. To bring {it} up to date, run:  {command}")
            }
            (_, Ok(command)) => writeln!(
                text,
                "{count}. Move the stray files away ({KEPT_BY_HAND}), and run:  {command}"
            ),
        };
        text
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> String {
        let differing = self.differences.iter().map(|(path, difference)| {
            json!({
                "path": path,
                "status": difference.status,
                "diff": difference.diff(path),
                "kept": difference.kept,
                "reason": difference.reason,
            })
        });
        let value = json!({
            "agree": self.agrees(),
            "seconds": self.seconds,
            "differing": differing.collect::<Vec<_>>(),
            "command": self.mending.as_ref().ok(),
            "obstacle": self.mending.as_ref().err().map(Failure::to_string),
        });
        format!("{value:#}\n")
    }
}

/// A difference without its last lines, where it is long and follows from others.
fn folded(diff: &str, path: &str) -> String {
    let follows = path == MANIFEST || Kind::of(path) == Kind::Documentation;
    let lines = diff.lines().count();
    if !follows || lines <= FOLDED_LINES + 1 {
        return diff.to_owned();
    }
    let first = diff.split_inclusive('\n').take(FOLDED_LINES);
    let more = lines - FOLDED_LINES;
    first
        .chain([&*format!("... {more} more lines\n")])
        .collect()
}

/// Differences with their paths as messages name them: the numbers first, then other code, and what follows from both last.
fn shown(project: &Project, mut differences: Vec<Difference>) -> Vec<(String, Difference)> {
    let rank = |it: &Difference| {
        (
            Kind::of(&it.path),
            !it.path.ends_with("/nominal.rs"),
            it.path.clone(),
        )
    };
    differences.sort_by_cached_key(rank);
    let named = |it: Difference| (project.shown_out(&it.path), it);
    differences.into_iter().map(named).collect()
}
