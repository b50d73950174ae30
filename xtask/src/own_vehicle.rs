//! The proof that the general crates know no model: packages of a stranger's tables, each with an `ahv` of its own, built
//! outside the workspace and run.

mod commands;
mod tables;

use std::fs;
use std::path::Path;

use ahv_generate::{Args, Surroundings};
use clap::Parser as _;
use commands::Own;

use crate::shell;

const PLACE: &str = "tests/own-vehicle";
/// Where the packages find `ahv-core`.
const CORE: &str = "../../../../crates/ahv-core";
/// Families in a file of their own; `tank` is the smallest model that there may be.
const OWN_FAMILIES: [&str; 2] = ["pendulum", "tank"];
/// Where they lie, each with its table in a folder of its name.
const FAMILIES: &str = "generator/tests";
/// The example that `ahv new` starts from; the program has its name.
const NEW: &str = "winged-cone";
/// The same in turbulence: the example's README joins a gust, and the program has this name.
const GUSTY: &str = "gusty-cone";
/// The page that tells a stranger what to do, and the commands there.
const PAGE: &str = "docs/link.md";
const GENERATE: &str = "ahv generate";
const RUN: &str = "cargo run --release -- ";
/// Makes the packages, builds their programs and runs them.
pub(crate) fn run() -> Result<(), String> {
    let place = shell::root().join(PLACE);
    for (package, table, made_by) in [
        ("own-models", "dcom", tables::two_modes as fn(&str) -> _),
        ("dcom-alone", "dcom", tables::dcom_alone),
        ("com-rigid-alone", "com", tables::com_rigid_alone),
    ] {
        let table = shell::root().join(format!("generator/tables/{table}.toml"));
        let text = made_by(&read(&table)?)?;
        let folder = place.join(format!("made/tables-of-{package}"));
        write(&folder.join("own.toml"), &text)?;
        generate(&place, package)?;
    }
    for family in OWN_FAMILIES {
        own_family(&place, family)?;
    }
    gusty(&place)?;
    // The tank's table leaves them out.
    if place.join("made/tank-models/src/tank/hessian.rs").exists() {
        return Err("error: second derivatives of the tank were emitted".to_owned());
    }
    build(&place)?;
    for (program, models, questions) in [
        (
            "own-vehicle",
            ["dcom", "sdcom"].as_slice(),
            commands::TWO_MODES,
        ),
        ("dcom-alone", &["dcom"], commands::DCOM_ALONE),
        ("com-rigid-alone", &["com_rigid"], commands::COM_RIGID_ALONE),
        ("pendulum", &["pendulum"], commands::PENDULUM),
        ("tank", &["tank"], commands::TANK),
        (GUSTY, &["winged_cone", "gusty_cone"], commands::GUSTY_CONE),
    ] {
        println!("{program}");
        let own = Own::new(program, &place.join("made"));
        own.knows(models)?;
        own.answers(questions)?;
    }
    let line = "rare --model pendulum --t-end 1 --passes angle=1deg";
    let message = "pendulum has no noise, by which copies part";
    Own::new("pendulum", &place.join("made")).refuses(line, message)?;
    let message = "--state-deviation: tank names no deviation that costs 1";
    Own::new("tank", &place.join("made")).refuses("lqr --model tank", message)?;
    new_repository(&place)?;
    documented(&place)
}

/// `ahv new` makes a repository that builds, passes its test and answers as published.
fn new_repository(place: &Path) -> Result<(), String> {
    let folder = place.join("made").join(NEW);
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(problem("remove", &folder))?;
    }
    println!("ahv new {NEW}");
    let mut make = shell::cargo();
    make.args(["run", "--quiet", "--package", "ahv-new", "--example", "new"]);
    make.args(["--", &format!("{PLACE}/made/{NEW}")]);
    shell::output(make.args(["--example", NEW, "--ahv", "."]))?;
    let mut test = shell::cargo();
    test.args(["test", "--quiet", "--target-dir"]);
    test.arg(shell::target()).current_dir(&folder);
    let said = shell::messages(&mut test)?;
    if said.contains("warning:") {
        return Err(format!("error: {NEW} compiles with warnings\n{said}"));
    }
    let own = Own::new(NEW, &folder);
    own.answers(commands::WINGED_CONE)?;
    own.does("generate --check --from-ir")?;
    own.does("generate --check")
}

/// Makes the package of a family in a file beside its table.
fn own_family(place: &Path, family: &str) -> Result<(), String> {
    let package = format!("{family}-models");
    for file in [format!("{family}.toml"), format!("{family}.py")] {
        let text = read(&shell::root().join(FAMILIES).join(family).join(&file))?;
        let folder = place.join(format!("made/tables-of-{package}"));
        write(&folder.join(file), &text)?;
    }
    generate(place, &package)
}

/// Makes the package of the example with the gust that its README joins.
fn gusty(place: &Path) -> Result<(), String> {
    let example = shell::root().join("examples").join(NEW);
    let package = format!("{GUSTY}-models");
    let folder = place.join(format!("made/tables-of-{package}"));
    let table = tables::joined(
        &read(&example.join("winged_cone.toml"))?,
        &read(&example.join("README.md"))?,
    )?;
    write(&folder.join("winged_cone.toml"), &table)?;
    let family = read(&example.join("winged_cone.py"))?;
    write(&folder.join("winged_cone.py"), &family)?;
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

/// Builds all programs, of the versions that the workspace is locked to.
fn build(place: &Path) -> Result<(), String> {
    let lock = place.join("Cargo.lock");
    fs::copy(shell::root().join("Cargo.lock"), &lock).map_err(problem("write", &lock))?;
    let mut cargo = shell::cargo();
    cargo.args(["build", "--quiet", "--target-dir"]);
    cargo.arg(shell::target()).current_dir(place);
    println!("building {PLACE}");
    let said = shell::messages(&mut cargo)?;
    if said.contains("warning:") {
        return Err(format!("error: {PLACE} compiles with warnings\n{said}"));
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
