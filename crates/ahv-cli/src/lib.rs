//! The command `ahv`: its general commands, and what further ones need. One module a command; no science in it.
//!
//! [`run`] is the whole program; an [`ExtraCommand`] adds a command of another crate. Such a command watches its work with
//! [`progress`], stops in order by [`signals`], leaves files and JSON by [`output`] and [`csv_file`], writes numbers by
//! [`number`] and fails by [`failure`], as those do that are here.
//!
//! ```
//! use ahv_cli::{ExtraCommand, failure::Failure};
//!
//! /// Greets somebody.
//! #[derive(clap::Args)]
//! struct Greeting {
//!     name: String,
//! }
//!
//! fn greet(greeting: &Greeting) -> Result<(), Failure> {
//!     println!("Hello, {}", greeting.name);
//!     Ok(())
//! }
//!
//! // A binary with the general commands and this one ends with `ahv_cli::run::<ahv_models::Models>(&commands)`.
//! let commands = [ExtraCommand::new("greet", greet)];
//! # assert_eq!(commands.len(), 1);
//! ```
#![forbid(unsafe_code)]

mod assignment;
mod covariance;
pub mod csv_file;
#[cfg(feature = "generate")]
mod diff;
mod disperse;
pub mod embedded;
pub mod failure;
#[cfg(feature = "generate")]
pub mod fit;
mod flight_condition;
mod flights;
mod forces;
mod gains;
#[cfg(feature = "generate")]
mod generate;
mod global_flags;
mod identify;
pub mod labels;
mod linearize;
mod lqr;
mod monte_carlo;
mod named;
mod names;
#[cfg(feature = "generate")]
mod new;
pub mod number;
pub mod output;
mod poles;
pub mod progress;
mod rare;
pub mod reduce;
mod reference;
mod registry;
mod show;
pub mod signals;
mod simulate;
pub mod steps;
mod table;
#[cfg(feature = "generate")]
mod tables;
mod trim;
pub mod units;
pub mod vehicle;

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{ArgMatches, Args, CommandFactory, FromArgMatches, Parser, Subcommand};

use ahv_core::ModelList;
use failure::{Failure, written};
use global_flags::Console;

/// Trims, linearises and flies models that were generated from tables.
#[derive(Parser)]
#[command(name = "ahv", version)]
struct Cli {
    #[command(flatten)]
    console: Console,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[cfg(feature = "generate")]
    Generate(generate::Arguments),
    #[cfg(feature = "generate")]
    New(new::Arguments),
    #[cfg(feature = "generate")]
    Table(tables::Arguments),
    #[cfg(feature = "generate")]
    Diff(diff::Arguments),
    #[cfg(feature = "generate")]
    Fit(Box<fit::Arguments>),
    Completions(reference::Completions),
    Man(reference::ManPages),
    #[command(flatten)]
    Model(Box<ModelCommand>),
}

/// What is done with the generated models.
#[derive(Subcommand)]
enum ModelCommand {
    Covariance(covariance::Arguments),
    Disperse(disperse::Arguments),
    Forces(forces::Arguments),
    Identify(identify::Arguments),
    Linearize(linearize::Arguments),
    Lqr(lqr::Arguments),
    #[command(name = "montecarlo")]
    MonteCarlo(monte_carlo::Arguments),
    Poles(poles::Arguments),
    Rare(rare::Arguments),
    Simulate(simulate::Arguments),
    Trim(trim::Arguments),
}

/// Reads its arguments from those of its command line, and runs.
type Run = Box<dyn Fn(&ArgMatches) -> Result<(), Failure>>;

/// A command of another crate.
pub struct ExtraCommand {
    name: &'static str,
    /// Adds its arguments, some of which are made of the models that are known by then.
    augment: fn(clap::Command) -> clap::Command,
    run: Run,
}

impl ExtraCommand {
    /// The command `name` with the arguments `A`, whose description is the command's.
    pub fn new<A: Args + 'static>(name: &'static str, run: fn(&A) -> Result<(), Failure>) -> Self {
        Self {
            name,
            augment: A::augment_args,
            run: Box::new(move |matches| {
                run(&A::from_arg_matches(matches).unwrap_or_else(|error| error.exit()))
            }),
        }
    }
}

/// The program `ahv` over the models `L`, with `extra` commands beside the general ones: reads the command line of this process, runs what it
/// asks for, and gives the exit code.
pub fn run<L: ModelList>(extra: &[ExtraCommand]) -> ExitCode {
    run_line::<L>(std::env::args_os(), extra).into()
}

/// As [`run`] for another command line, whose first word is the program's name, and with the exit code as a number.
pub fn run_line<L: ModelList>(
    line: impl IntoIterator<Item = OsString>,
    extra: &[ExtraCommand],
) -> u8 {
    registry::register::<L>();
    let (asked, console) = match asked(line, extra) {
        Ok(asked) => asked,
        Err(asked) => return answer(&asked),
    };
    console.apply();
    match asked {
        // They handle signals themselves.
        #[cfg(feature = "generate")]
        Asked::General(Command::Generate(arguments)) => generate::run(&arguments),
        #[cfg(feature = "generate")]
        Asked::General(Command::New(arguments)) => new::run(&arguments),
        #[cfg(feature = "generate")]
        Asked::General(Command::Table(arguments)) => listening(|| tables::run(&arguments)),
        #[cfg(feature = "generate")]
        Asked::General(Command::Diff(arguments)) => listening(|| done(diff::run(&arguments))),
        #[cfg(feature = "generate")]
        Asked::General(Command::Fit(arguments)) => listening(|| done(fit::run(&arguments))),
        Asked::General(Command::Model(command)) => listening(|| done(command.run())),
        Asked::General(Command::Completions(shell)) => {
            listening(|| done(shell.run(command(extra))))
        }
        Asked::General(Command::Man(pages)) => listening(|| done(pages.run(command(extra)))),
        Asked::Extra(extra, matches) => listening(|| done((extra.run)(&matches))),
    }
}

/// What a command line asks for.
enum Asked<'e> {
    General(Command),
    Extra(&'e ExtraCommand, ArgMatches),
}

/// Reads a command line.
///
/// # Errors
///
/// What is wrong with it, or the help or version that it asks for.
fn asked(
    line: impl IntoIterator<Item = OsString>,
    extra: &[ExtraCommand],
) -> Result<(Asked<'_>, Console), clap::Error> {
    let line: Vec<OsString> = line.into_iter().collect();
    let command = command(extra).color(global_flags::color(&line));
    let mut matches = command.try_get_matches_from(line)?;
    let console = Console::from_arg_matches(&matches)?;
    if let Some((name, matches)) = matches.subcommand()
        && let Some(extra) = extra.iter().find(|it| it.name == name)
    {
        return Ok((Asked::Extra(extra, matches.clone()), console));
    }
    let command = Cli::from_arg_matches_mut(&mut matches)?.command;
    Ok((Asked::General(command), console))
}

/// Prints help, the version, or what is wrong with the command line.
fn answer(asked: &clap::Error) -> u8 {
    let printed = asked.print().and_then(|()| io::stdout().flush());
    match written(printed) {
        Err(failure) if !asked.use_stderr() => failure.report(signals::exit_code()),
        _ => u8::try_from(asked.exit_code()).unwrap_or(2),
    }
}

/// The whole command line. What is done with models stands in the order of the names.
fn command(extra: &[ExtraCommand]) -> clap::Command {
    let added = extra
        .iter()
        .map(|it| (it.augment)(clap::Command::new(it.name)));
    let command = Cli::command().subcommands(added);
    command.mut_subcommands(|command| match command.get_name() {
        "diff" | "generate" | "new" | "table" => command,
        "completions" | "man" => command.display_order(2),
        _ => command.display_order(1),
    })
}

fn listening(run: impl FnOnce() -> Result<u8, Failure>) -> u8 {
    match signals::listen().and_then(|()| run()) {
        Ok(code) => code,
        Err(failure) => failure.report(signals::exit_code()),
    }
}

/// The exit code of what has no other than that it succeeds.
fn done(result: Result<(), Failure>) -> Result<u8, Failure> {
    result.map(|()| 0)
}

impl ModelCommand {
    fn run(&self) -> Result<(), Failure> {
        match self {
            Self::Covariance(arguments) => covariance::run(arguments),
            Self::Disperse(arguments) => disperse::run(arguments),
            Self::Forces(arguments) => forces::run(arguments),
            Self::Identify(arguments) => identify::run(arguments),
            Self::Linearize(arguments) => linearize::run(arguments),
            Self::Lqr(arguments) => lqr::run(arguments),
            Self::MonteCarlo(arguments) => monte_carlo::run(arguments),
            Self::Poles(arguments) => poles::run(arguments),
            Self::Rare(arguments) => rare::run(arguments),
            Self::Simulate(arguments) => simulate::run(arguments),
            Self::Trim(arguments) => trim::run(arguments),
        }
    }
}
