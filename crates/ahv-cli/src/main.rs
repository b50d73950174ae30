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
mod output;
mod place;
mod poles;
mod progress;
mod rare;
mod reduce;
mod reproduce;
mod simulate;
mod table;
mod track;
mod trim;
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
    let done = match Cli::parse().command {
        #[cfg(feature = "generate")]
        Command::Generate(arguments) => return generate::run(&arguments),
        Command::Covariance(arguments) => covariance::run(&arguments),
        Command::Disperse(arguments) => disperse::run(&arguments),
        Command::Linearize(arguments) => linearize::run(&arguments),
        Command::Lqr(arguments) => lqr::run(&arguments),
        Command::MonteCarlo(arguments) => monte_carlo::run(&arguments),
        Command::Poles(arguments) => poles::run(&arguments),
        Command::Rare(arguments) => rare::run(&arguments),
        Command::Reduce(arguments) => reduce::run(&arguments),
        Command::Reproduce(arguments) => reproduce::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Track(arguments) => track::run(&arguments),
        Command::Trim(arguments) => trim::run(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
