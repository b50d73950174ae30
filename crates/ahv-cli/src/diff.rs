//! `ahv diff`: what changed between tables, and what that does to the models.

mod effect;
mod flown;
mod picture;
mod regulated;
mod report;
mod whole_box;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, io};

use ahv_analysis::erased::AnyModel;
use ahv_generate::{ChangedFile, Surroundings};
use ahv_review::Difference;
use ahv_table::Text;
use clap::ValueEnum;
use tempfile::TempDir;

use crate::failure::{Failure, print};
use crate::registry::models;
use crate::{names, output, tables};
use effect::{Asked, Effect};

/// Compares tables: which numbers changed, by how much, and what that does to the models.
///
/// For the models that this program has: trim, poles, zeros, slopes of forces and moments and the margins of the old gains at the default
/// flight condition; trims and the largest change of each force and moment over the validity box. Tables of other families are compared
/// without them.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Table or folder of tables before the change, or a git revision, in which NEW is looked up
    old: String,
    /// Table or folder of tables after it
    new: PathBuf,
    /// How the differences are written
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// As --format json
    #[arg(long, conflicts_with = "format")]
    json: bool,
    /// Fly each model N times for 3 s with each table, with noise and dispersed parameters, for the probability to leave the validity box
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1_000_000))]
    flights: Option<u64>,
    /// Count the lines of generated code that change: derives and emits both tables, which needs Python
    #[arg(long)]
    code: bool,
    /// Folder for a picture of each model that changes, to which --format markdown links
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Text,
    /// For programs
    Json,
    /// For a pull request
    Markdown,
}

/// A table before and after a change.
pub(crate) struct Compared {
    /// The name of its file.
    name: String,
    change: Kind,
}

enum Kind {
    /// It is new, or was removed.
    Whole(&'static str),
    Changed(Box<Changed>),
}

struct Changed {
    difference: Difference,
    effects: Vec<Effect>,
    /// One an effect, if they are asked for: the path of its picture.
    pictures: Vec<PathBuf>,
    /// Files of generated code that change, if they are asked for.
    code: Option<Vec<ChangedFile>>,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for a file that cannot be read or written, is no table, or a revision that does not have it;
/// [`Failure::Interrupted`]
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let pairs = Pairs::find(&arguments.old, &arguments.new)?;
    if let Some(folder) = &arguments.pictures {
        output::folder(folder)?;
    }
    let compared = pairs.files.iter().map(|it| it.compare(arguments));
    let compared = compared.collect::<Result<Vec<_>, _>>()?;
    match arguments.format {
        Format::Text if !arguments.json => print(report::text(&compared).trim_end()),
        Format::Markdown => print(report::markdown(&compared).trim_end()),
        Format::Text | Format::Json => output::print_json(&report::json(&compared)),
    }
}

/// The files that are compared.
struct Pairs {
    files: Vec<Pair>,
    /// Where those of a revision lie; removed at the end.
    _revision: Option<TempDir>,
}

struct Pair {
    name: String,
    old: Option<PathBuf>,
    new: Option<PathBuf>,
}

impl Pairs {
    fn find(old: &str, new: &Path) -> Result<Self, Failure> {
        let (old, revision) = match Path::new(old) {
            path if fs::symlink_metadata(path).is_ok() => (path.to_owned(), None),
            _ => {
                let folder = at_revision(old, new)?;
                let path = match new.is_dir() {
                    true => folder.path().to_owned(),
                    false => folder.path().join(new.file_name().unwrap_or_default()),
                };
                (path, Some(folder))
            }
        };
        let files = if old.is_dir() && new.is_dir() {
            let [before, after] = [tables_in(&old)?, tables_in(new)?];
            let mut names: Vec<String> = before.iter().chain(&after).cloned().collect();
            names.sort();
            names.dedup();
            let at = |folder: &Path, has: &[String], name: &String| {
                has.contains(name).then(|| folder.join(name))
            };
            let pair = |name: String| Pair {
                old: at(&old, &before, &name),
                new: at(new, &after, &name),
                name,
            };
            names.into_iter().map(pair).collect()
        } else if old.is_dir() || new.is_dir() {
            let message = "OLD and NEW are two tables or two folders";
            return Err(Failure::Request(message.to_owned()));
        } else {
            vec![Pair {
                name: new
                    .file_name()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned(),
                old: Some(old),
                new: Some(new.to_owned()),
            }]
        };
        Ok(Self {
            files,
            _revision: revision,
        })
    }
}

/// The names of the tables in a folder, as `ahv generate` finds them.
fn tables_in(folder: &Path) -> Result<Vec<String>, Failure> {
    let unread = |error: io::Error| {
        Failure::Request(format!(
            "cannot read the folder {}: {error}",
            folder.display()
        ))
    };
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(unread)? {
        let name = entry.map_err(unread)?.file_name();
        let name = name.to_string_lossy();
        if name.ends_with(".toml") && !name.starts_with('.') && name != "Cargo.toml" {
            found.push(name.into_owned());
        }
    }
    Ok(found)
}

/// What a git revision has in the place of a table or a folder of tables, and of the families beside them.
fn at_revision(revision: &str, new: &Path) -> Result<TempDir, Failure> {
    let refused = |why: &str| {
        let revision = names::printable(revision);
        Failure::Request(format!(
            "{revision} is no file, and as a git revision: {why}"
        ))
    };
    if revision.starts_with('-') {
        return Err(refused("it begins with a dash"));
    }
    let folder = match (new.is_dir(), new.parent()) {
        (true, _) => new,
        (false, Some(parent)) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let git = |arguments: &[&str]| {
        let output = Command::new("git")
            .arg("-C")
            .arg(folder)
            .args(arguments)
            .output();
        let output = output.map_err(|error| refused(&format!("git does not run: {error}")))?;
        match output.status.success() {
            true => Ok(output.stdout),
            false => {
                let said = String::from_utf8_lossy(&output.stderr);
                Err(refused(said.lines().next().unwrap_or("git refuses it")))
            }
        }
    };
    let listed = git(&["ls-tree", "--name-only", "-z", revision, "./"])?;
    let listed = String::from_utf8_lossy(&listed);
    let unwritten = |error: io::Error| Failure::Request(format!("cannot keep {revision}: {error}"));
    let kept = tempfile::tempdir().map_err(unwritten)?;
    let files = listed
        .split('\0')
        .map(|path| path.rsplit('/').next().unwrap_or(path));
    for name in files.filter(|it| it.ends_with(".toml") || it.ends_with(".py")) {
        let text = git(&["show", &format!("{revision}:./{name}")])?;
        fs::write(kept.path().join(name), text).map_err(unwritten)?;
    }
    Ok(kept)
}

impl Pair {
    fn compare(&self, arguments: &Arguments) -> Result<Compared, Failure> {
        let change = match (&self.old, &self.new) {
            (Some(old), Some(new)) => Kind::Changed(Box::new(self.changed([old, new], arguments)?)),
            (Some(_), None) => Kind::Whole("removed"),
            _ => Kind::Whole("new"),
        };
        Ok(Compared {
            name: names::printable(&self.name),
            change,
        })
    }

    fn changed(&self, [old, new]: [&Path; 2], arguments: &Arguments) -> Result<Changed, Failure> {
        let [before, after] = [tables::parsed(old)?, tables::parsed(new)?];
        let subject = tables::known(&after, new)?.subject;
        let difference = Difference::new(&before, &after, &subject);
        let mut changed = Changed {
            difference,
            effects: Vec::new(),
            pictures: Vec::new(),
            code: None,
        };
        if changed.difference.is_empty() {
            return Ok(changed);
        }
        let listed =
            |text: &Text, model: &dyn AnyModel| ahv_review::models(text).contains(&model.name());
        let asked = Asked {
            flights: arguments.flights,
        };
        for model in models().filter(|it| listed(&before, *it) && listed(&after, *it)) {
            let effect = Effect::new(model, [old, new], &asked)?;
            if let Some(folder) = &arguments.pictures {
                let path = folder.join(picture::file_name(&self.name, effect.model));
                output::picture(&path, picture::figure(&effect).svg())?;
                changed.pictures.push(path);
            }
            changed.effects.push(effect);
        }
        if arguments.code {
            let code =
                Surroundings::of_process().and_then(|it| ahv_generate::changed_code(old, new, &it));
            changed.code = Some(code.map_err(|failure| {
                let said = failure.to_string();
                Failure::Request(format!("--code: {}", said.trim_start_matches("error: ")))
            })?);
        }
        Ok(changed)
    }
}
