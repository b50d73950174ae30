//! The command `ahv`. One module a command; no science in it.
#![forbid(unsafe_code)]

mod assignment;
mod condition;
mod covariance;
mod csv_file;
mod disperse;
mod failure;
mod flights;
mod gains;
#[cfg(feature = "generate")]
mod generate;
mod linearize;
mod lqr;
mod monte_carlo;
mod names;
mod number;
mod output;
mod place;
mod poles;
mod progress;
mod rare;
mod reduce;
mod reproduce;
mod signals;
mod simulate;
mod table;
mod track;
mod trim;
mod units;
mod vehicle;

use std::io::{self, Write as _};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::{Failure, written};

/// Flight models of an air-breathing hypersonic vehicle.
#[derive(Parser)]
#[command(name = "ahv", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[cfg(feature = "generate")]
    Generate(generate::Arguments),
    #[command(flatten)]
    Model(Box<ModelCommand>),
}

/// What is done with the generated models.
#[derive(Subcommand)]
enum ModelCommand {
    Covariance(covariance::Arguments),
    Disperse(disperse::Arguments),
    Linearize(linearize::Arguments),
    Lqr(lqr::Arguments),
    #[command(name = "montecarlo")]
    MonteCarlo(monte_carlo::Arguments),
    Poles(poles::Arguments),
    Rare(rare::Arguments),
    Reduce(reduce::Arguments),
    Reproduce(reproduce::Arguments),
    Simulate(simulate::Arguments),
    Track(track::Arguments),
    Trim(trim::Arguments),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(asked) => return answer(&asked),
    };
    match cli.command {
        // It handles signals itself.
        #[cfg(feature = "generate")]
        Command::Generate(arguments) => generate::run(&arguments),
        Command::Model(command) => match signals::listen().and_then(|()| command.run()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => failure.report(signals::exit_code()),
        },
    }
}

/// Prints help, the version, or what is wrong with the command line.
fn answer(asked: &clap::Error) -> ExitCode {
    let printed = asked.print().and_then(|()| io::stdout().flush());
    match written(printed) {
        Err(failure) if !asked.use_stderr() => failure.report(signals::exit_code()),
        _ => ExitCode::from(u8::try_from(asked.exit_code()).unwrap_or(2)),
    }
}

impl ModelCommand {
    fn run(&self) -> Result<(), Failure> {
        match self {
            Self::Covariance(arguments) => covariance::run(arguments),
            Self::Disperse(arguments) => disperse::run(arguments),
            Self::Linearize(arguments) => linearize::run(arguments),
            Self::Lqr(arguments) => lqr::run(arguments),
            Self::MonteCarlo(arguments) => monte_carlo::run(arguments),
            Self::Poles(arguments) => poles::run(arguments),
            Self::Rare(arguments) => rare::run(arguments),
            Self::Reduce(arguments) => reduce::run(arguments),
            Self::Reproduce(arguments) => reproduce::run(arguments),
            Self::Simulate(arguments) => simulate::run(arguments),
            Self::Track(arguments) => track::run(arguments),
            Self::Trim(arguments) => trim::run(arguments),
        }
    }
}
