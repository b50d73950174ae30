//! `ahv table`: what people do with a table before models are made of it. What is found, laid out and shown is of
//! `ahv-review`.

use std::path::{Path, PathBuf};

use ahv_analysis::erased::AnyModel;
use ahv_generate::{Described, FamilyFault, Surroundings};
use ahv_review::{
    Condition, Finding, LINTS, Limits, Overview, Reference, Reviewed, Severity, Subject,
};
use ahv_table::{Family, Text};
use clap::{Subcommand, ValueEnum};

use crate::failure::{Failure, print};
use crate::registry::{family, models};
use crate::{names, output, table};

/// Something was found: an error or what `--deny` makes one, or a file that `fmt --check` would change.
const FOUND: u8 = 1;

/// Finds what is wrong with tables, aligns their columns, and shows what each number contributes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Lint(Lint),
    Fmt(Layout),
    Show(Show),
}

/// Reports everything that is wrong with tables, or looks wrong.
///
/// Errors are what `ahv generate` refuses. Exit code 0: no error; 1: an error, or a finding of a rule that is denied;
/// 2: a file cannot be read.
#[derive(clap::Args)]
struct Lint {
    /// Tables
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Make findings of a rule errors; `all` denies warnings of every rule
    #[arg(long, value_name = "RULE", value_parser = rule)]
    deny: Vec<String>,
    /// How findings are written
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// As --format json
    #[arg(long, conflicts_with = "format")]
    json: bool,
    /// A term is negligible below this share of its quantity over the validity box
    #[arg(long, value_name = "SHARE", default_value_t = Limits::default().negligible, value_parser = share)]
    negligible: f64,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people: the lines with the place underlined
    Text,
    /// For programs
    Json,
    /// SARIF 2.1.0, for code hosts
    Sarif,
}

/// Aligns the columns of tables. Order, numbers, comments and empty lines stay.
#[derive(clap::Args)]
struct Layout {
    /// Tables
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Write nothing; exit code 1 if a file is not laid out
    #[arg(long)]
    check: bool,
}

/// Shows a table: aligned, with units, sources and the share that each term has in its quantity over the validity box.
#[derive(clap::Args)]
struct Show {
    /// Table
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Write one page of HTML to this file
    #[arg(long, value_name = "PAGE", conflicts_with = "json")]
    html: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    match &arguments.command {
        Command::Lint(lint) => lint.run(),
        Command::Fmt(layout) => layout.run(),
        Command::Show(show) => show.run(),
    }
}

/// The name of a rule that can be denied.
fn rule(name: &str) -> Result<String, String> {
    let mut known: Vec<&str> = LINTS.iter().map(|lint| lint.name).collect();
    known.push(ALL);
    match known.contains(&name) {
        true => Ok(name.to_owned()),
        false => Err(names::unknown("rule", name, &known)),
    }
}

/// Every rule whose findings are warnings.
const ALL: &str = "all";

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|it| (0.0..1.0).contains(it));
    share.ok_or_else(|| "a share is a number from 0 to below 1".to_owned())
}

impl Lint {
    fn run(&self) -> Result<u8, Failure> {
        let limits = Limits {
            negligible: self.negligible,
            ..Limits::default()
        };
        let reviewed = self.files.iter().map(|path| reviewed(path, &limits));
        let mut reviewed = reviewed.collect::<Result<Vec<_>, _>>()?;
        reviewed.iter_mut().for_each(|it| it.deny(&self.denied()));
        let unwritten = |error| Failure::Numeric(format!("cannot write the findings: {error}"));
        match self.format {
            Format::Json => print(&ahv_review::json(&reviewed).map_err(unwritten)?)?,
            Format::Text if self.json => print(&ahv_review::json(&reviewed).map_err(unwritten)?)?,
            Format::Sarif => print(&ahv_review::sarif(&reviewed).map_err(unwritten)?)?,
            Format::Text => {
                let text = ahv_review::rendered(&reviewed, console::colors_enabled());
                print(text.trim_end())?;
            }
        }
        let mut findings = reviewed.iter().flat_map(|it| &it.findings);
        Ok(match findings.any(|it| it.severity == Severity::Error) {
            true => FOUND,
            false => 0,
        })
    }

    fn denied(&self) -> Vec<String> {
        let warnings = LINTS.iter().filter(|it| it.severity == Severity::Warning);
        let all = self.deny.iter().any(|it| it == ALL);
        let all = warnings.filter(|_| all).map(|it| it.name.to_owned());
        self.deny.iter().cloned().chain(all).collect()
    }
}

fn reviewed(path: &Path, limits: &Limits) -> Result<Reviewed, Failure> {
    let text = read(path)?;
    let findings = match Text::parse(text.clone()) {
        Ok(table) => {
            let Known { subject, faults } = known(&table, path)?;
            ahv_review::lint(&table, &subject, limits, faults)
        }
        Err(error) => vec![ahv_review::unreadable(&error)],
    };
    Ok(Reviewed {
        file: names::printable(&path.display().to_string()),
        text,
        findings,
    })
}

impl Layout {
    fn run(&self) -> Result<u8, Failure> {
        let mut code = 0;
        for path in &self.files {
            let table = parsed(path)?;
            let laid_out = ahv_review::laid_out(&table)
                .map_err(|error| Failure::Numeric(format!("{}: {error}", path.display())))?;
            if laid_out == table.raw() {
                continue;
            }
            if self.check {
                code = FOUND;
                let shown = names::printable(&path.display().to_string());
                print(&format!(
                    "{shown} is not laid out; run:  ahv table fmt {shown}"
                ))?;
            } else {
                output::write(path, laid_out)?;
            }
        }
        Ok(code)
    }
}

impl Show {
    fn run(&self) -> Result<u8, Failure> {
        let table = parsed(&self.file)?;
        let overview = Overview::new(&table, &known(&table, &self.file)?.subject);
        match &self.html {
            Some(path) => output::write(path, ahv_review::page(&overview))?,
            None if self.json => output::print_json(&overview)?,
            None => print(overview.to_string().trim_end())?,
        }
        Ok(0)
    }
}

fn read(path: &Path) -> Result<String, Failure> {
    let shown = names::printable(&path.display().to_string());
    table::text_of(path).map_err(|error| Failure::Request(format!("cannot read {shown}: {error}")))
}

/// The table at a path.
///
/// # Errors
///
/// [`Failure::Request`] for a file that cannot be read, or is not TOML.
pub(crate) fn parsed(path: &Path) -> Result<Text, Failure> {
    let (shown, text) = (names::printable(&path.display().to_string()), read(path)?);
    Text::parse(text.clone()).map_err(|unreadable| Failure::Request(unreadable.line(&shown, &text)))
}

/// What is wrong with a table, and what it may hold.
pub(crate) struct Known {
    pub(crate) subject: Subject,
    faults: Vec<Finding>,
}

/// What the models of this program say of a table; where they find a fault, or are other models, what its family says: it may make
/// other models of other sections.
///
/// # Errors
///
/// [`Failure::Request`] if the program does not have the models, and the family cannot be asked.
pub(crate) fn known(table: &Text, path: &Path) -> Result<Known, Failure> {
    let compiled = compiled(table).map(|subject| Known {
        faults: ahv_review::faults(table, &subject),
        subject,
    });
    if let Some(known) = compiled.as_ref().filter(|it| it.faults.is_empty()) {
        return Ok(Known {
            subject: known.subject.clone(),
            faults: Vec::new(),
        });
    }
    let described = Surroundings::of_process().and_then(|it| ahv_generate::describe(path, &it));
    match (described, compiled) {
        (Ok(Described::Table { models, document }), compiled) => {
            let subject = Subject::of_ir(&document, &models);
            let references = compiled.map(|it| it.subject.references_of(&subject));
            Ok(Known {
                faults: ahv_review::faults(table, &subject),
                subject: Subject {
                    references: references.unwrap_or_default(),
                    ..subject
                },
            })
        }
        (Ok(Described::Faults(faults)), compiled) => Ok(Known {
            faults: faults.iter().map(|it| finding(table, it)).collect(),
            // What it should hold is not known: its numbers are looked at as far as they are those of known models.
            subject: compiled.map_or_else(|| Subject::new(Family::NONE), |it| it.subject),
        }),
        // Without Python what this program knows must do.
        (Err(_), Some(known)) => Ok(known),
        (Err(failure), None) => {
            let said = failure.to_string();
            Err(Failure::Request(
                said.trim_start_matches("error: ").to_owned(),
            ))
        }
    }
}

/// What a table without fault may hold.
///
/// # Errors
///
/// [`Failure::Request`] with the faults of the table, a line each.
pub(crate) fn sound(table: &Text, path: &Path) -> Result<Subject, Failure> {
    let Known { subject, faults } = known(table, path)?;
    if faults.is_empty() {
        return Ok(subject);
    }
    let reviewed = Reviewed {
        file: names::printable(&path.display().to_string()),
        text: table.raw().to_owned(),
        findings: faults,
    };
    let rendered = ahv_review::rendered(&[reviewed], false);
    Err(Failure::Request(rendered.trim_end().to_owned()))
}

fn finding(table: &Text, fault: &FamilyFault) -> Finding {
    let help = fault.help.as_deref().unwrap_or_default();
    let place = (fault.path.as_slice(), fault.part);
    Finding::error(table, &fault.rule, place, &fault.message, help)
}

/// The models of this program that a table lists.
fn compiled(table: &Text) -> Option<Subject> {
    let listed = ahv_review::models(table);
    let compiled = models().filter(|it| listed.contains(&it.name()));
    let compiled: Vec<&dyn AnyModel> = compiled.collect();
    Some(of_models(*compiled.first()?, &compiled))
}

fn of_models(first: &dyn AnyModel, listed: &[&dyn AnyModel]) -> Subject {
    let references = first.sets().into_iter().map(|set| Reference {
        label: format!("the set `{}` of the generated models", set.name),
        values: set.parameters,
    });
    let conditions = listed.iter().flat_map(|model| {
        let given = model.trim_problem().given.iter();
        given.map(|given| Condition {
            model: model.name().to_owned(),
            state: given.name.to_owned(),
            value: given.default,
        })
    });
    Subject {
        references: references.collect(),
        conditions: conditions.collect(),
        ..Subject::new(family(first))
    }
}
