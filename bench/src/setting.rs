//! Where everything is, and how programs are started and built.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use crate::commands;

/// The folders and the interpreter of a run.
pub(crate) struct Setting {
    /// The repository.
    pub(crate) root: PathBuf,
    /// Python with what the peers need.
    pub(crate) python: PathBuf,
    /// Where everything is built.
    pub(crate) out: PathBuf,
    /// Whether all peers run, and what is compiled is compiled anew, for its time.
    pub(crate) peers: bool,
}

/// What a compiler made, and how long it took.
pub(crate) struct Built {
    pub(crate) library: PathBuf,
    pub(crate) seconds: f64,
}

/// For the machine at hand.
pub(crate) const NATIVE: &str = "-C target-cpu=native";
const GCC: [&str; 5] = ["-O3", "-march=native", "-shared", "-fPIC", "-std=c99"];
const GXX: [&str; 5] = ["-O3", "-march=native", "-shared", "-fPIC", "-std=c++17"];

impl Setting {
    /// A peer's script, to be given its arguments.
    pub(crate) fn script(&self, name: &str) -> Command {
        let mut command = Command::new(&self.python);
        command
            .env("PYTHONPATH", self.root.join("generator"))
            // Where what they compile for themselves may lie.
            .current_dir(&self.out)
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .args(["-X", "utf8"])
            .arg(self.peer_file(&format!("{name}.py")));
        command
    }

    /// A file of the peers.
    pub(crate) fn peer_file(&self, name: &str) -> PathBuf {
        self.root.join("bench/peers").join(name)
    }

    /// The tables of the project.
    pub(crate) fn tables(&self) -> Result<Vec<PathBuf>, String> {
        commands::tables(&self.root)
    }

    /// Compiles `name`.c in `folder` to a library.
    pub(crate) fn c(&self, folder: &Path, name: &str) -> Result<Built, String> {
        let mut gcc = Command::new("gcc");
        gcc.args(GCC).arg(folder.join(format!("{name}.c")));
        linked(&mut gcc, folder.join(format!("lib{name}.so")))
    }

    /// Compiles `source` to a library in `folder`, where it finds what it includes.
    pub(crate) fn cpp(&self, folder: &Path, name: &str, source: &Path) -> Result<Built, String> {
        let mut gxx = Command::new("g++");
        gxx.args(GXX).arg("-I").arg(folder).arg(source);
        linked(&mut gxx, folder.join(format!("lib{name}.so")))
    }

    /// A cargo command with exactly these flags of rustc, in a folder of its own.
    pub(crate) fn cargo(
        &self,
        command: &str,
        folder: &Path,
        flags: &str,
        target: &Path,
    ) -> Command {
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo
            .current_dir(folder)
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            .env("RUSTFLAGS", flags)
            .args([command, "--quiet", "--release", "--target-dir"])
            .arg(target);
        cargo
    }

    /// Builds the library of the first of these packages, of which all are compiled in the time.
    pub(crate) fn rust(
        &self,
        folder: &Path,
        flags: &str,
        target: &Path,
        packages: &[&str],
    ) -> Result<Built, String> {
        let target = target.join(if flags.is_empty() {
            "baseline"
        } else {
            "native"
        });
        let package = packages.first().copied().unwrap_or_default();
        let run = |command: &str, packages: &[&str]| {
            let mut cargo = self.cargo(command, folder, flags, &target);
            cargo.arg("--locked");
            cargo.env("AHV_BENCH_WRENFOLD", self.out.join("wrenfold"));
            for package in packages {
                cargo.args(["--package", package]);
            }
            commands::output(&mut cargo)
        };
        if self.peers {
            // What the packages depend on is there before.
            run("build", &[package])?;
            run("clean", packages)?;
        }
        let start = Instant::now();
        run("build", &[package])?;
        let seconds = start.elapsed().as_secs_f64();
        let (prefix, suffix) = (env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
        let name = package.replace('-', "_");
        Ok(Built {
            library: target.join(format!("release/{prefix}{name}{suffix}")),
            seconds,
        })
    }
}

fn linked(compiler: &mut Command, library: PathBuf) -> Result<Built, String> {
    let start = Instant::now();
    commands::output(compiler.arg("-o").arg(&library).args(["-lm", "-pthread"]))?;
    Ok(Built {
        library,
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// How a library of Rust was built, for people.
pub(crate) fn rustc(flags: &str) -> String {
    let flags = if flags.is_empty() {
        "baseline target"
    } else {
        flags
    };
    format!("rustc -O, thin LTO, {flags}")
}
