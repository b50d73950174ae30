//! The command `ahv`. One module a command; no science in it.
#![forbid(unsafe_code)]

mod assignment;
mod failure;
mod simulate;

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
    Simulate(simulate::Arguments),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Simulate(arguments) => simulate::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
