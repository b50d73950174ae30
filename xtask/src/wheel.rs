//! The wheel of Python: built, installed in a clean environment, and tested there as a user has it.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{python, shell};

const PLACE: &str = "crates/ahv-python";

/// Builds the wheel, checks and tests it.
pub(crate) fn run(release: bool) -> Result<(), String> {
    let place = shell::root().join(PLACE);
    let locked = python::bindings()?;
    let sources = place.join("python");
    for (folder, module) in [
        (&place, ["ruff", "check", "."].as_slice()),
        (&place, &["ruff", "format", "--check", "."]),
        (
            &sources,
            &["mypy", "--config-file", "../pyproject.toml", "ahv"],
        ),
    ] {
        shell::run(
            shell::program(&locked)
                .current_dir(folder)
                .arg("-m")
                .args(module),
        )?;
    }
    let wheel = built(&place, &locked, release)?;
    let installed = installed(&wheel, &locked)?;
    let mut tests = shell::program(installed);
    tests
        .current_dir(&place)
        .args(["-m", "pytest", "--quiet", "tests"]);
    shell::run(tests.env("AHV_SOURCE", shell::root()))
}

/// The wheel, alone in its folder.
fn built(place: &Path, locked: &Path, release: bool) -> Result<PathBuf, String> {
    let folder = shell::target().join("wheels");
    anew(&folder)?;
    let mut maturin = shell::program(locked);
    maturin
        .current_dir(place)
        .args(["-m", "maturin", "build", "--quiet", "--locked", "--profile"]);
    maturin.arg(if release { "release" } else { "dev" });
    maturin
        .arg("--interpreter")
        .arg(locked)
        .arg("--out")
        .arg(&folder);
    shell::run(maturin.env("CARGO_TARGET_DIR", shell::target()))?;
    let entries = fs::read_dir(&folder).map_err(problem("read", &folder))?;
    let mut files = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let wheel = files.find(|file| file.extension() == Some(OsStr::new("whl")));
    wheel.ok_or_else(|| format!("error: no wheel in {}", folder.display()))
}

/// The interpreter of a new environment with the wheel. What the tests compare it with is seen from there, not installed.
fn installed(wheel: &Path, locked: &Path) -> Result<PathBuf, String> {
    let folder = shell::target().join("wheel-environment");
    anew(&folder)?;
    shell::run(
        shell::program(locked)
            .args(["-m", "venv", "--without-pip"])
            .arg(&folder),
    )?;
    let python = folder.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    });
    let packages = |python: &Path| {
        let line = "import sysconfig; print(sysconfig.get_path('purelib'))";
        shell::output(shell::program(python).args(["-c", line]))
    };
    let seen = Path::new(packages(&python)?.trim()).join("locked.pth");
    fs::write(&seen, packages(locked)?).map_err(problem("write", &seen))?;
    let mut pip = shell::program(locked);
    pip.args(["-m", "pip", "--python"]).arg(&python);
    pip.args([
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--no-index",
        "--no-deps",
    ]);
    shell::run(pip.arg(wheel))?;
    Ok(python)
}

/// An empty folder.
fn anew(folder: &Path) -> Result<(), String> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(problem("remove", folder))?;
    }
    fs::create_dir_all(folder).map_err(problem("make", folder))
}

fn problem(what: &str, path: &Path) -> impl FnOnce(std::io::Error) -> String {
    let shown = path.display().to_string();
    let what = what.to_owned();
    move |error| format!("error: cannot {what} {shown}: {error}")
}
