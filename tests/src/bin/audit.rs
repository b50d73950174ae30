//! `cargo xtask audit`: the generated functions against the oracle at many points, with the worst of each function.
#![forbid(unsafe_code)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use ahv_codegen::sha256;
use ahv_tests::evaluate::{MODELS, evaluate};
use ahv_tests::measure::{Worst, compare};
use ahv_tests::vectors::read_oracle;
use clap::Parser;

/// In units of 2⁻⁵²·K.
const BAR: f64 = 8.0;

/// Audits the generated functions against mpmath at 50 digits.
#[derive(Parser)]
struct Arguments {
    /// Points for each model.
    #[arg(long, default_value_t = 10_000)]
    points: u32,
    /// Seed of the points.
    #[arg(long, default_value_t = 2)]
    seed: u64,
    /// Python interpreter that has SymPy.
    #[arg(long)]
    python: PathBuf,
    /// The project's folder.
    #[arg(long, default_value = ".")]
    root: PathBuf,
    /// Folder where the oracle's values stay for the next audit of the same points.
    #[arg(long)]
    cache: Option<PathBuf>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let mut all_within = true;
    for report in audit_all(&arguments) {
        match report {
            Ok((text, within)) => {
                print!("{text}");
                all_within &= within;
            }
            Err(message) => {
                eprintln!("error: {message}");
                return ExitCode::from(2);
            }
        }
    }
    if all_within {
        println!("every error is at most {BAR} in units of 2^-52 K");
        ExitCode::SUCCESS
    } else {
        println!("an error exceeds {BAR} in units of 2^-52 K");
        ExitCode::FAILURE
    }
}

/// What a model's audit says, and whether all its errors are within the bar.
type Report = Result<(String, bool), String>;

/// Audits the models, as many at a time as there are processors; reports in the order of the models.
fn audit_all(arguments: &Arguments) -> Vec<Report> {
    let next = AtomicUsize::new(0);
    let reports = Mutex::new(BTreeMap::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers.min(MODELS.len()) {
            scope.spawn(|| {
                while let Some((model, table)) = MODELS.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let report = audit(arguments, model, table);
                    let mut reports = reports.lock().unwrap_or_else(PoisonError::into_inner);
                    reports.insert(*model, report);
                }
            });
        }
    });
    let mut reports = reports.into_inner().unwrap_or_else(PoisonError::into_inner);
    MODELS
        .iter()
        .filter_map(|(model, _)| reports.remove(model))
        .collect()
}

/// Audits one model.
fn audit(arguments: &Arguments, model: &str, table: &str) -> Report {
    let folder = tempfile::tempdir().map_err(|e| format!("no temporary folder: {e}"))?;
    let file = match &arguments.cache {
        Some(cache) => kept(arguments, cache, model, table)?,
        None => folder.path().join("vectors.txt"),
    };
    if !file.exists() {
        draw(arguments, model, table, &file)?;
    }
    let mut worst: BTreeMap<String, Worst> = BTreeMap::new();
    for point in read_oracle(&file) {
        compare(&point, &evaluate::<f64>(model, &point.inputs), &mut worst);
    }
    let mut text = format!(
        "{model}, {} points, error in units of 2^-52 K:\n",
        arguments.points
    );
    for (function, found) in &worst {
        text += &format!(
            "  {function:<30} {:>6.2}  at {}\n",
            found.error, found.label
        );
    }
    if let Some(found) = worst.values().max_by(|a, b| a.error.total_cmp(&b.error)) {
        let point: Vec<String> = found
            .point
            .iter()
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        text += &format!("  worst point: {}\n", point.join(" "));
    }
    Ok((text, worst.values().all(|found| found.error <= BAR)))
}

/// The file in the cache for the oracle's values of a model. Its name holds the hash of all that they depend on; files of other
/// hashes are removed.
fn kept(arguments: &Arguments, cache: &Path, model: &str, table: &str) -> Result<PathBuf, String> {
    let generator = arguments.root.join("generator");
    let mut sources = entries(&generator.join("ahv_oracle"))?;
    sources.retain(|path| path.extension().is_some_and(|it| it == "py"));
    sources.push(generator.join("requirements-dev.txt"));
    sources.push(generator.join(format!("tables/{table}.toml")));
    let Arguments {
        points,
        seed,
        python,
        ..
    } = arguments;
    let mut all = format!(
        "{model}, {points} points, seed {seed}, {}\n",
        python.display()
    );
    for path in sources {
        all += &fs::read_to_string(&path).map_err(problem("read", &path))?;
    }
    let of_model = format!("{model}-");
    let name = format!("{of_model}{}.txt", sha256(&all));
    fs::create_dir_all(cache).map_err(problem("make", cache))?;
    for path in entries(cache)? {
        let found = path.file_name().unwrap_or_default().to_string_lossy();
        if found.starts_with(&of_model) && found != *name {
            fs::remove_file(&path).map_err(problem("remove", &path))?;
        }
    }
    Ok(cache.join(name))
}

/// What lies in a folder, in the order of the names.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let found = fs::read_dir(folder).map_err(problem("read", folder))?;
    let mut paths: Vec<_> = found
        .map(|entry| entry.map(|it| it.path()))
        .collect::<Result<_, _>>()
        .map_err(problem("read", folder))?;
    paths.sort();
    Ok(paths)
}

fn problem(deed: &str, path: &Path) -> impl FnOnce(std::io::Error) -> String {
    let message = format!("cannot {deed} {}", path.display());
    move |error| format!("{message}: {error}")
}

fn draw(arguments: &Arguments, model: &str, table: &str, file: &Path) -> Result<(), String> {
    let generator = arguments.root.join("generator");
    let output = Command::new(&arguments.python)
        .args(["-m", "ahv_oracle", "vectors", "--model", model])
        .arg("--table")
        .arg(generator.join(format!("tables/{table}.toml")))
        .args(["--points", &arguments.points.to_string()])
        .args(["--seed", &arguments.seed.to_string()])
        .arg("--out")
        .arg(file)
        .env("PYTHONPATH", &generator)
        .output()
        .map_err(|e| format!("{} does not run: {e}", arguments.python.display()))?;
    if output.status.success() {
        Ok(())
    } else {
        Err(format!(
            "the oracle failed: {}",
            String::from_utf8_lossy(&output.stderr).trim()
        ))
    }
}
