//! `cargo xtask bench`: what generation takes, how many operations the generated functions have, how long they and the
//! steppers take beside their peers, and how many members a second an ensemble flies.

mod agreement;
mod arrays;
mod bars;
mod candidates;
mod commands;
mod compilation;
mod ensembles;
mod found;
mod generation;
mod interpreted;
mod interval;
mod kernel;
mod lanes;
mod layout;
mod machine;
mod modes;
mod moments;
mod monte_carlo;
mod operations;
mod picture;
mod points;
mod ports;
mod process;
mod race;
mod report;
mod rk4;
mod rounds;
mod service;
mod setting;
mod steppers;
mod subject;
mod table;
mod threads;
mod timing;
mod weak;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use serde_json::json;

use arrays::Arrays;
use ensembles::Ensembles;
use found::Found;
use points::Points;
use report::Report;
use setting::Setting;
use steppers::{Steppers, Steps};
use subject::{Model, SUBJECTS};

/// Measure the generated functions and the steppers beside CasADi's C.
#[derive(Parser)]
#[command(name = "ahv-bench")]
struct Args {
    /// Python that has CasADi, or with --peers the packages of peers/requirements.txt
    #[arg(long, value_name = "PROGRAM")]
    python: PathBuf,

    /// Folder for what is built and measured
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Beside all peers, with the time of this program's `generate --json`, and write docs/benchmarks.md
    #[arg(long, value_name = "AHV")]
    peers: Option<PathBuf>,

    /// Rounds in which each candidate has a turn, as a share of the usual number; with less than 1 nothing is documented
    #[arg(long, default_value_t = 1.0)]
    effort: f64,
}

/// Random points of the box of validity.
const POINTS: usize = 1000;
/// Rounds of kernels, of steppers and solvers, and of ensembles: with peers and without.
const ROUNDS: [[f64; 3]; 2] = [[1000.0, 11.0, 7.0], [200.0, 5.0, 5.0]];

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
    let setting = Setting {
        root: root().to_owned(),
        python: args.python.clone(),
        out: std::path::absolute(&args.out).map_err(commands::problem("find", &args.out))?,
        peers: args.peers.is_some(),
    };
    let report = measure(&setting, args)?;
    print!("{}", report.text());
    let json = setting.out.join("bench.json");
    commands::write(&json, &report.json()?)?;
    println!("\n{}", json.display());
    if setting.peers {
        let documented = args.effort >= 1.0;
        let folder = if documented { root() } else { &setting.out };
        let files = [
            ("docs/benchmarks.md", report.markdown()),
            (picture::PATH, picture::draw(&report.found)?),
        ];
        for (path, text) in files {
            let path = folder.join(path);
            commands::make_folder(path.parent().unwrap_or(folder))?;
            commands::write(&path, &text)?;
            println!("{}", path.display());
        }
    }
    Ok(())
}

fn measure(setting: &Setting, args: &Args) -> Result<Report, String> {
    let usual = if setting.peers { ROUNDS[0] } else { ROUNDS[1] };
    let [kernels, solvers, races] = usual.map(|it| (it * args.effort).ceil() as u32);
    commands::make_folder(&setting.out)?;
    eprintln!("building the candidates");
    let peers = candidates::derive(setting)?;
    let points: Vec<Points> = SUBJECTS
        .iter()
        .map(|subject| Points::of(subject.model, POINTS))
        .collect();
    let arrays = setting.peers.then(|| Arrays::start(setting, &problem()));
    let arrays = arrays.transpose()?;
    let mut candidates = candidates::build(setting, &peers, arrays.as_ref())?;
    let agreement = agreement::check(&mut candidates, &points)?;
    let steps = setting.c(&setting.out.join("casadi"), "steps")?;
    let steps = Steps::new(&steps.library, &peers.casadi)?;
    let ensembles = Ensembles::build(setting)?;

    eprintln!("timing the candidates");
    let timings = timing::measure(&mut candidates, &points, kernels)?;
    let steppers = Steppers {
        steps: steppers::steps(&steps, solvers)?,
        precision: setting
            .peers
            .then(|| steppers::precision(setting, &steps, solvers))
            .transpose()?,
    };
    let trajectories = rk4::measure(&steps, arrays.as_ref(), races)?;
    let monte_carlo = monte_carlo::measure(ensembles, arrays.as_ref(), races)?;
    let modes = modes::measure(ensembles, arrays.as_ref(), races)?;
    let process = |program: &PathBuf| process::measure(setting, program, &problem());
    let processes = args.peers.as_ref().map(process).transpose()?;
    let interval =
        |program: &PathBuf| interval::measure(setting, program, ensembles, races.div_ceil(2));
    let interval = args.peers.as_ref().map(interval).transpose()?;
    let weak = setting.peers.then(|| weak::measure(races)).transpose()?;
    let groups = [
        ("RK4 of DCOM", &trajectories.finishes),
        ("Monte Carlo of SDCOM", &monte_carlo.finishes),
        ("section 5.1", &modes.finishes),
    ];
    let compilation = compilation::all(&candidates, &ensembles, &groups);
    let generate = |program: &PathBuf| generation::measure(program, &setting.out);
    Ok(Report::of(Found {
        machine: machine::describe(setting, &peers)?,
        compilation: setting.peers.then_some(compilation),
        generation: args.peers.as_ref().map(generate).transpose()?,
        operations: operations::compare(&setting.root, &peers)?,
        agreement,
        points: POINTS,
        rounds: kernels,
        timings,
        steppers,
        trajectories,
        monte_carlo,
        processes,
        interval,
        modes,
        weak,
        bound: ports::measure(&setting.root)?,
    }))
}

/// What the peers in Python are told.
fn problem() -> serde_json::Value {
    let of = |model: Model| (Points::of(model, POINTS).json(), model.parameters().1);
    let [(dcom, dcom_parameters), (sdcom, sdcom_parameters)] = [of(Model::Dcom), of(Model::Sdcom)];
    json!({
        "points": {"dcom": dcom, "sdcom": sdcom},
        "parameters": {"dcom": dcom_parameters, "sdcom": sdcom_parameters},
        "rk4": rk4::problem(),
        "monte_carlo": monte_carlo::problem(),
        "modes": modes::problem(),
    })
}

/// The folder of the repository.
fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here)
}
