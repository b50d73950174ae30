//! `cargo xtask bench`: what generation takes, how many operations the generated functions have, how long
//! they take beside CasADi's C and wrenfold's Rust, and how long the steppers take beside other solvers.

mod agreement;
mod candidates;
mod commands;
mod generation;
mod kernel;
mod machine;
mod operations;
mod points;
mod report;
mod steppers;
mod subject;
mod table;
mod timing;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;

use points::Points;
use report::Report;
use subject::SUBJECTS;

/// Measure generation, the generated functions and the steppers, beside their peers.
#[derive(Parser)]
#[command(name = "ahv-bench")]
struct Args {
    /// Python that has the packages of peers/requirements.txt
    #[arg(long, value_name = "PROGRAM")]
    python: PathBuf,

    /// Program whose `generate --json` is timed, such as xtask
    #[arg(long, value_name = "PROGRAM")]
    generate: PathBuf,

    /// Folder for what is built and measured
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Rounds in which each candidate has a turn
    #[arg(long, default_value_t = 1000)]
    rounds: u32,

    /// Rounds in which each stepper and solver has a turn
    #[arg(long, default_value_t = 15)]
    solver_rounds: u32,

    /// Number of random points
    #[arg(long, default_value_t = 1000)]
    points: usize,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), String> {
    commands::make_folder(&args.out)?;
    eprintln!("building the candidates");
    let (peers, mut candidates) = candidates::build(root(), &args.python, &args.out)?;
    let points: Vec<Points> = SUBJECTS
        .iter()
        .map(|subject| Points::of(subject.model, args.points))
        .collect();
    let agreement = agreement::check(&mut candidates, &points)?;
    eprintln!("timing the candidates");
    let timings = timing::measure(&mut candidates, &points, args.rounds);
    let steppers = steppers::measure(root(), &args.python, &args.out, &peers, args.solver_rounds)?;
    eprintln!("timing generation");
    let report = Report {
        machine: machine::describe(root(), &peers)?,
        generation: generation::measure(&args.generate, &args.out)?,
        operations: operations::compare(root(), &peers)?,
        agreement,
        points: args.points,
        rounds: args.rounds,
        timings,
        steppers,
    };
    print!("{}", report.text());
    let json = args.out.join("bench.json");
    let markdown = root().join("docs/benchmarks.md");
    commands::write(&json, &report.json()?)?;
    commands::write(&markdown, &report.markdown())?;
    println!("\n{}\n{}", json.display(), markdown.display());
    Ok(())
}

/// The folder of the repository.
fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here)
}
