//! The command `ahv`. One module a command; no science in it.
#![forbid(unsafe_code)]

mod assignment;
mod condition;
mod failure;
#[cfg(feature = "generate")]
mod generate;
mod names;
mod simulate;
mod units;
mod vehicle;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

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
    Simulate(simulate::Arguments),
}

fn main() -> ExitCode {
    match Cli::parse().command {
        #[cfg(feature = "generate")]
        Command::Generate(arguments) => generate::run(&arguments),
        Command::Simulate(arguments) => match simulate::run(&arguments) {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => failure.report(),
        },
    }
}
