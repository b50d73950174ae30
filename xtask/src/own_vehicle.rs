//! The proof that the general crates know no model: packages of a stranger's tables, each with an `ahv` of its own, built
//! outside the workspace and run.

mod answers;
mod commands;
mod tables;

use std::fs;
use std::path::{Path, PathBuf};

use ahv_generate::{Args, Surroundings};
use answers::Answers;
use clap::Parser as _;
use commands::Own;

use crate::shell;

const PLACE: &str = "tests/own-vehicle";
/// Where the packages find `ahv-core`.
const CORE: &str = "../../../../crates/ahv-core";
/// Packages, and the folders with their tables and families; `tank` is the smallest model that there may be.
const PACKAGES: [(&str, &str); 5] = [
    ("own-models", "examples/two-mode"),
    ("four-mode-models", "examples/four-mode"),
    ("parker-canard-models", "examples/parker-canard"),
    ("pendulum-models", "generator/tests/pendulum"),
    ("tank-models", "generator/tests/tank"),
];
/// The example of which `ahv new` makes a repository; the program has its name.
const NEW: &str = "wang-stengel";
/// The examples whose packages are checked in.
const CHECKED_IN: [(&str, &str); 2] = [
    ("six-dof", commands::SIX_DOF),
    ("winged-cone", commands::WINGED_CONE),
];
/// The program over the examples whose README joins a gust: folder, and name of table and family.
const GUSTY: &str = "gusty";
const GUSTY_EXAMPLES: [(&str, &str); 2] = [
    ("wang-stengel", "wang_stengel"),
    ("winged-cone", "winged_cone"),
];
/// The page that tells a stranger what to do, and the commands there.
const PAGE: &str = "docs/link.md";
const GENERATE: &str = "ahv generate";
const RUN: &str = "cargo run --release -- ";
/// Makes the packages, builds their programs and runs them.
pub(crate) fn run() -> Result<(), String> {
    let place = shell::root().join(PLACE);
    // What an earlier run made of tables that are gone is no model of this one.
    let made = place.join("made");
    if made.exists() {
        fs::remove_dir_all(&made).map_err(problem("remove", &made))?;
    }
    for (package, folder) in PACKAGES {
        copied(&place, package, &shell::root().join(folder))?;
    }
    let com = read(&shell::root().join("generator/tables/com.toml"))?;
    let com = tables::com_rigid_alone(&com)?;
    write(&tables_of(&place, "com-rigid-alone").join("own.toml"), &com)?;
    generate(&place, "com-rigid-alone")?;
    gusty(&place)?;
    // The tank's table leaves them out.
    if place.join("made/tank-models/src/tank/hessian.rs").exists() {
        return Err("error: second derivatives of the tank were emitted".to_owned());
    }
    println!("building {PLACE}");
    build(&place)?;
    let answers = Answers::load()?;
    for (program, models, questions) in [
        (
            "own-vehicle",
            ["dcom", "sdcom"].as_slice(),
            commands::TWO_MODES,
        ),
        ("com-rigid-alone", &["com_rigid"], commands::COM_RIGID_ALONE),
        ("four-mode", &["dcom"], commands::FOUR_MODE),
        ("parker-canard", &["parker_canard"], commands::PARKER_CANARD),
        ("pendulum", &["pendulum"], commands::PENDULUM),
        ("tank", &["tank"], commands::TANK),
        (
            GUSTY,
            &[
                "wang_stengel",
                "gusty_wang_stengel",
                "winged_cone",
                "gusty_cone",
            ],
            commands::GUSTY,
        ),
    ] {
        println!("{program}");
        let own = Own::new(program, &made);
        own.knows(models)?;
        own.answers(questions)?;
    }
    for program in ["own-vehicle", "four-mode", "parker-canard"] {
        println!("{program}");
        answers.compare(program, &Own::new(program, &place.join("made")))?;
    }
    let line = "rare --model pendulum --t-end 1 --passes angle=1deg";
    let message = "pendulum has no noise, by which copies part";
    Own::new("pendulum", &place.join("made")).refuses(line, message)?;
    let message = "--state-deviation: tank names no deviation that costs 1";
    Own::new("tank", &place.join("made")).refuses("lqr --model tank", message)?;
    new_repository(&place, &answers)?;
    for (example, questions) in CHECKED_IN {
        checked_in(example, questions, &answers)?;
    }
    documented(&place)
}

/// `ahv new` makes a repository that builds, passes its test and answers as published.
fn new_repository(place: &Path, answers: &Answers) -> Result<(), String> {
    let folder = place.join("made").join(NEW);
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(problem("remove", &folder))?;
    }
    println!("ahv new {NEW}");
    // As `cargo test` has built it.
    let mut cargo = shell::cargo();
    shell::run(
        cargo
            .args(["build", "--example", "new"])
            .args(shell::WORKSPACE),
    )?;
    let mut make = shell::program(shell::target().join("debug/examples/new"));
    make.arg(format!("{PLACE}/made/{NEW}"));
    shell::output(make.args(["--example", NEW, "--ahv", "."]))?;
    built(&folder, &["test", "--quiet"])?;
    let own = Own::new(NEW, &folder);
    own.answers(commands::WANG_STENGEL)?;
    answers.compare(NEW, &own)?;
    own.does("generate --check --from-ir")?;
    own.does("generate --check")
}

/// An example that is checked in with its package builds as it is, and answers as published.
fn checked_in(example: &str, questions: &str, answers: &Answers) -> Result<(), String> {
    let folder = shell::root().join("examples").join(example);
    println!("examples/{example}");
    build(&folder)?;
    let own = Own::new(example, &shell::target().join("debug"));
    own.answers(questions)?;
    answers.compare(example, &own)
}

/// Makes the package of the tables and families in a folder.
fn copied(place: &Path, package: &str, folder: &Path) -> Result<(), String> {
    let entries = fs::read_dir(folder).map_err(problem("read", folder))?;
    for entry in entries {
        let path = entry.map_err(problem("read", folder))?.path();
        if let (Some("toml" | "py"), Some(name)) = (extension(&path), path.file_name()) {
            write(&tables_of(place, package).join(name), &read(&path)?)?;
        }
    }
    generate(place, package)
}

fn extension(path: &Path) -> Option<&str> {
    path.extension()?.to_str()
}

/// Where the tables of a package are.
fn tables_of(place: &Path, package: &str) -> PathBuf {
    place.join(format!("made/tables-of-{package}"))
}

/// Makes the package of the examples with the gusts that their READMEs join.
fn gusty(place: &Path) -> Result<(), String> {
    let package = format!("{GUSTY}-models");
    let folder = tables_of(place, &package);
    for (example, name) in GUSTY_EXAMPLES {
        let example = shell::root().join("examples").join(example);
        let file = |ending: &str| read(&example.join(format!("{name}.{ending}")));
        let table = tables::joined(&file("toml")?, &read(&example.join("README.md"))?)?;
        write(&folder.join(format!("{name}.toml")), &table)?;
        write(&folder.join(format!("{name}.py")), &file("py")?)?;
    }
    generate(place, &package)
}

/// What the documentation tells a stranger to do is what is done here.
fn documented(place: &Path) -> Result<(), String> {
    let page = read(&shell::root().join(PAGE))?;
    let program = read(&place.join("src/main.rs"))?;
    let code = program.split_once("\n\n").map_or("", |(_, code)| code);
    if code.is_empty() || !page.contains(code) {
        return Err(format!("error: {PAGE} does not have the program\n{code}"));
    }
    let told = |command: &str| {
        let line = page.lines().find_map(|line| line.strip_prefix(command));
        line.ok_or_else(|| format!("error: {PAGE} has no line `{command}...`"))
    };
    let generate = format!("generate{}", told(GENERATE)?);
    GenerateLine::try_parse_from(generate.split(' '))
        .map_err(|error| format!("{PAGE}: {error}"))?;
    Own::new("own-vehicle", &place.join("made")).does(told(RUN)?)
}

/// The command line of `ahv generate`.
#[derive(clap::Parser)]
struct GenerateLine {
    #[command(flatten)]
    args: Args,
}

fn generate(place: &Path, package: &str) -> Result<(), String> {
    let line = format!(
        "generate --tables made/tables-of-{package} --out made/{package} --package {package} --core-path {CORE}"
    );
    let args = GenerateLine::parse_from(line.split(' ')).args;
    let surroundings = Surroundings::of_process().map_err(|failure| failure.to_string())?;
    let surroundings = Surroundings {
        current_dir: place.to_owned(),
        ..surroundings
    };
    let done = ahv_generate::generate(&args, &surroundings);
    done.map(drop).map_err(|failure| failure.to_string())
}

/// Builds a workspace, of the versions that that of this repository is locked to.
fn build(workspace: &Path) -> Result<(), String> {
    let lock = workspace.join("Cargo.lock");
    fs::copy(shell::root().join("Cargo.lock"), &lock).map_err(problem("write", &lock))?;
    built(workspace, &["build", "--quiet"])
}

/// Runs cargo in a workspace of its own; what it compiles must give no warning.
fn built(workspace: &Path, arguments: &[&str]) -> Result<(), String> {
    let mut cargo = shell::cargo();
    cargo.args(arguments).arg("--target-dir");
    cargo.arg(shell::target()).current_dir(workspace);
    let said = shell::messages(&mut cargo)?;
    if said.contains("warning:") {
        let shown = workspace.display();
        return Err(format!("error: {shown} compiles with warnings\n{said}"));
    }
    Ok(())
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(problem("read", path))
}

/// Writes a file where it is not like that already, so that cargo builds nothing anew for it.
fn write(path: &Path, text: &str) -> Result<(), String> {
    if fs::read_to_string(path).is_ok_and(|found| found == text) {
        return Ok(());
    }
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder).map_err(problem("make", folder))?;
    fs::write(path, text).map_err(problem("write", path))
}

fn problem(deed: &str, path: &Path) -> impl FnOnce(std::io::Error) -> String {
    let message = format!("error: cannot {deed} {}", path.display());
    move |error| format!("{message}: {error}")
}
