//! `cargo xtask demo`: the main job on real input. Change a number in a table, regenerate, read the
//! diff, and fly both models with both values.

use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use ahv_generate::{Args, Surroundings};
use clap::Parser as _;
use serde_json::Value;

use crate::plot::{self, Pair};
use crate::shell;
use crate::trajectory::{Trajectory, setting};

const TABLE: &str = "generator/tables/dcom.toml";
const SECTION: &str = "[C_L]";
const ENTRY: &str = r#""alpha" ="#;
const VALUE: &str = "value =";
/// The lift slope by about two per cent: well inside its uncertainty, and plain in the flight.
const STEP: f64 = 0.1;
const MODELS: [&str; 2] = ["dcom", "sdcom"];
/// The airframe is unstable, so an open-loop flight is short.
const T_END: &str = "3";
const DT: &str = "0.01";
const SEED: &str = "1";

/// Runs the demo, and says where everything lies.
pub(crate) fn run() -> Result<(), String> {
    let demo = shell::root().join("target/demo");
    let scratch = demo.join("scratch");
    fs::create_dir_all(&demo).map_err(problem("make", &demo))?;
    let table = shell::root().join(TABLE);
    let change = Change::read(&fs::read_to_string(&table).map_err(problem("read", &table))?)?;

    heading("Regenerate from the tables");
    print!("{}", generate(shell::root())?);
    print!("{}", check(shell::root())?);

    heading(&format!(
        "Change a coefficient in a scratch copy: C_L alpha, {} to {} per rad",
        change.nominal, change.changed
    ));
    copy_project(&scratch)?;
    change_coefficient(&scratch.join(TABLE))?;
    print!("{}", check(&scratch)?);

    heading("Regenerate there");
    print!("{}", generate(&scratch)?);

    heading("Build ahv: the longest step the first time");
    let ahv = build()?;

    heading("Fly both models with both values");
    println!(
        "All flights start at the trim of the nominal table and hold its inputs, so that what"
    );
    println!(
        "differs is the coefficient's doing. The airframe is unstable: they end at {T_END} s."
    );
    println!(
        "The changed value comes by --table, which needs no second build; a build of the scratch copy has it too."
    );
    let mut pairs = Vec::new();
    for model in MODELS {
        pairs.push(fly(model, &ahv, &scratch.join(TABLE), &change, &demo)?);
    }
    let picture = demo.join("flights.svg");
    plot::draw(&pairs, &change.names(), &picture)?;

    heading("Where everything lies");
    for model in MODELS {
        println!("{}", demo.join(format!("{model}-nominal.csv")).display());
        println!("{}", demo.join(format!("{model}-changed.csv")).display());
    }
    println!("{}", picture.display());
    println!("{}  the project with the changed table", scratch.display());
    Ok(())
}

fn heading(text: &str) {
    println!("\n== {text}");
}

/// The command line of `cargo xtask generate`, for its defaults.
#[derive(clap::Parser)]
struct GenerateLine {
    #[command(flatten)]
    args: Args,
}

fn generate(root: &Path) -> Result<String, String> {
    let (args, surroundings) = generation(root)?;
    let done = ahv_generate::generate(&args, &surroundings);
    done.map(|done| done.text())
        .map_err(|failure| failure.to_string())
}

fn check(root: &Path) -> Result<String, String> {
    let (args, surroundings) = generation(root)?;
    let done = ahv_generate::check(&args, &surroundings);
    done.map(|done| done.text())
        .map_err(|failure| failure.to_string())
}

fn generation(root: &Path) -> Result<(Args, Surroundings), String> {
    let surroundings = Surroundings::of_process().map_err(|failure| failure.to_string())?;
    let args = GenerateLine::parse_from(["generate"]).args;
    Ok((
        args,
        Surroundings {
            current_dir: root.to_owned(),
            ..surroundings
        },
    ))
}

/// The coefficient's value as the table has it, and the one that the demo gives it.
struct Change {
    nominal: String,
    changed: String,
    /// Where the value stands in the table's text.
    at: Range<usize>,
}

impl Change {
    fn read(table: &str) -> Result<Self, String> {
        let missing = || {
            format!(
                "error: the demo changes `{ENTRY} {{ value = ...` of {SECTION}, which {TABLE} lacks"
            )
        };
        let at = value_of_entry(table).ok_or_else(missing)?;
        let nominal = &table[at.clone()];
        let value: f64 = nominal.parse().map_err(|_| missing())?;
        // Sums of decimal fractions are not exact: 4.6773 is to give 4.7773.
        let changed = ((value + STEP) * 1e10).round() / 1e10;
        Ok(Self {
            nominal: nominal.to_owned(),
            changed: format!("{changed:?}"),
            at,
        })
    }

    /// What to call the flights with the nominal value and with the changed one.
    fn names(&self) -> [String; 2] {
        [&self.nominal, &self.changed].map(|value| format!("C_L alpha = {value} / rad"))
    }
}

/// Where the coefficient's value stands in the table.
fn value_of_entry(table: &str) -> Option<Range<usize>> {
    let (mut at, mut inside) = (0, false);
    for line in table.split_inclusive('\n') {
        if line.starts_with('[') {
            inside = line.starts_with(SECTION);
        } else if inside && line.starts_with(ENTRY) {
            let key = line.find(VALUE)?;
            let rest = line[key + VALUE.len()..].trim_start();
            let start = at + line.len() - rest.len();
            let end = rest.find(|c: char| c == ',' || c == '}' || c.is_whitespace())?;
            return Some(start..start + end);
        }
        at += line.len();
    }
    None
}

fn change_coefficient(table: &Path) -> Result<(), String> {
    let mut text = fs::read_to_string(table).map_err(problem("read", table))?;
    let change = Change::read(&text)?;
    text.replace_range(change.at, &change.changed);
    fs::write(table, text).map_err(problem("write", table))
}

fn build() -> Result<PathBuf, String> {
    let mut cargo = shell::cargo();
    // With all that generates, which was built with this program.
    cargo.args(["build", "--package", "ahv", "--bin", "ahv"]);
    shell::run(&mut cargo)?;
    let built = shell::target()
        .join("debug")
        .join(format!("ahv{}", std::env::consts::EXE_SUFFIX));
    println!("{}", built.display());
    Ok(built)
}

/// Flies the nominal model from its trim, and the changed one from that same state and inputs.
fn fly(
    model: &str,
    ahv: &Path,
    changed_table: &Path,
    change: &Change,
    demo: &Path,
) -> Result<Pair, String> {
    let simulate = |name: &str, start: &[String]| {
        let out = demo.join(format!("{model}-{name}.csv"));
        let mut command = shell::program(ahv);
        command.args([
            "simulate", "--json", "--model", model, "--t-end", T_END, "--dt", DT,
        ]);
        command
            .args(["--seed", SEED])
            .args(start)
            .arg("--out")
            .arg(&out);
        let report = shell::output(&mut command)?;
        Ok::<_, String>((Trajectory::read(&out)?, report))
    };
    let (nominal, report) = simulate("nominal", &[])?;
    let start = [
        "--input".to_owned(),
        inputs(&report)?,
        "--initial".to_owned(),
        nominal.start(),
        "--table".to_owned(),
        changed_table.display().to_string(),
    ];
    let (changed, _) = simulate("changed", &start)?;
    println!("{model}: {} {}", start[0], start[1]);
    println!("{:1$}  {2} {3}", "", model.len(), start[2], start[3]);
    let end = |flight: &Trajectory| flight.end("alpha").map(f64::to_degrees);
    match (end(&nominal), end(&changed)) {
        (Some(a), Some(b)) if a != b => println!(
            "{:1$}  angle of attack at {T_END} s: {a:.4} deg with {2}, {b:.4} deg with {3}",
            "",
            model.len(),
            change.nominal,
            change.changed
        ),
        _ => return Err(format!("error: {model} flies alike with both values")),
    }
    Ok(Pair {
        model: model.to_uppercase(),
        nominal,
        changed,
    })
}

/// The held inputs of a simulation's report, as `--input` takes them.
fn inputs(report: &str) -> Result<String, String> {
    let unreadable = || format!("error: no inputs in the report of ahv simulate:\n{report}");
    let report: Value = serde_json::from_str(report).map_err(|_| unreadable())?;
    let inputs = report["input"].as_object().ok_or_else(unreadable)?;
    let mut settings = Vec::new();
    for (name, value) in inputs {
        let value = value.as_f64().ok_or_else(unreadable)?;
        settings.push(setting(
            name,
            value,
            report["units"][name].as_str().unwrap_or_default(),
        ));
    }
    Ok(settings.join(","))
}

/// Copies the project, without what is built from it.
fn copy_project(scratch: &Path) -> Result<(), String> {
    if scratch.exists() {
        fs::remove_dir_all(scratch).map_err(problem("remove", scratch))?;
    }
    copy_folder(shell::root(), scratch).map_err(problem("copy the project to", scratch))
}

fn copy_folder(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (name, kind) = (entry.file_name(), entry.file_type()?);
        let (source, target) = (entry.path(), to.join(&name));
        let built = ["target", ".git", ".venv", "__pycache__"];
        if built.iter().any(|skipped| name == *skipped) {
            continue;
        } else if kind.is_symlink() {
            copy_link(&source, &target)?;
        } else if kind.is_dir() {
            copy_folder(&source, &target)?;
        } else {
            fs::copy(&source, &target)?;
        }
    }
    Ok(())
}

/// The project's links are relative, so they lead to the same place in the copy.
#[cfg(unix)]
fn copy_link(source: &Path, target: &Path) -> io::Result<()> {
    std::os::unix::fs::symlink(fs::read_link(source)?, target)
}

#[cfg(not(unix))]
fn copy_link(source: &Path, target: &Path) -> io::Result<()> {
    if source.is_dir() {
        copy_folder(source, target)
    } else {
        fs::copy(source, target).map(drop)
    }
}

fn problem(deed: &str, path: &Path) -> impl FnOnce(io::Error) -> String {
    let message = format!("error: cannot {deed} {}", path.display());
    move |error| format!("{message}: {error}")
}

#[cfg(test)]
mod tests {
    use super::Change;

    #[test]
    fn the_value_is_read_and_changed() {
        let table = "[C_D]\n\"alpha\" = { value = 1.0 }\n[C_L]\n\"alpha\" = { value = 4.6773, unit = \"1/rad\" }\n";
        let change = Change::read(table).expect("read");
        assert_eq!((&*change.nominal, &*change.changed), ("4.6773", "4.7773"));
        assert_eq!(&table[change.at], "4.6773");
        for none in ["", "[C_L]\n", &table.replace("4.6773", "many")] {
            let message = Change::read(none).err().expect("refused");
            assert!(message.ends_with("which generator/tables/dcom.toml lacks"));
        }
    }
}
