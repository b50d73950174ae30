//! The candidates: how each is built and where its values lie.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::commands;
use crate::kernel::{self, Kernel, Layout, Work};
use crate::steppers::END;
use crate::subject::{SUBJECTS, Subject};

/// The one that the others are compared with.
pub(crate) const REFERENCE: &str = "CasADi C";
/// The one that the goals are about.
pub(crate) const PRODUCT: &str = "ahv";

/// A way to compute the subjects.
pub(crate) struct Candidate {
    pub(crate) name: &'static str,
    /// What it was compiled with.
    pub(crate) built: String,
    /// One a subject.
    pub(crate) kernels: Vec<Kernel>,
}

/// What the peers say of themselves.
pub(crate) struct Peers {
    pub(crate) casadi: Value,
    pub(crate) wrenfold: Value,
}

const NATIVE: &str = "-C target-cpu=native";
/// How all C is compiled.
pub(crate) const GCC: [&str; 5] = ["-O3", "-march=native", "-shared", "-fPIC", "-std=c99"];

/// Builds and loads all candidates.
pub(crate) fn build(
    root: &Path,
    python: &Path,
    out: &Path,
) -> Result<(Peers, Vec<Candidate>), String> {
    let peers = Peers {
        casadi: derive(
            root,
            python,
            "casadi_peer",
            &out.join("casadi"),
            &["--end".to_owned(), END.to_string()],
        )?,
        wrenfold: derive(root, python, "wrenfold_peer", &out.join("wrenfold"), &[])?,
    };
    for peer in [&peers.casadi, &peers.wrenfold] {
        check_parameters(peer)?;
    }
    let mut candidates = vec![casadi(&peers.casadi, &out.join("casadi"))?];
    for (names, flags) in [
        (["ahv", "wrenfold"], ""),
        (["ahv, native", "wrenfold, native"], NATIVE),
    ] {
        candidates.push(own(names[0], flags, root, out)?);
        candidates.push(wrenfold(names[1], flags, root, out)?);
    }
    Ok((peers, candidates))
}

/// Runs a peer's script, and reads what it says.
fn derive(
    root: &Path,
    python: &Path,
    script: &str,
    out: &Path,
    options: &[String],
) -> Result<Value, String> {
    commands::make_folder(out)?;
    let mut command = peer(root, python, script);
    command.arg("--out").arg(out).args(options);
    command.args(commands::tables(root)?);
    commands::output(&mut command)?;
    commands::read_json(&out.join("peer.json"))
}

/// A peer's script, to be given its arguments.
pub(crate) fn peer(root: &Path, python: &Path, script: &str) -> Command {
    let mut command = Command::new(python);
    command
        .env("PYTHONPATH", root.join("generator"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .args(["-X", "utf8"])
        .arg(root.join(format!("crates/ahv-bench/peers/{script}.py")));
    command
}

/// The parameters go to the peers as an array, so all must have the same order.
fn check_parameters(peer: &Value) -> Result<(), String> {
    for subject in &SUBJECTS {
        let names = subject.model.parameters().0;
        let theirs = peer["kernels"][subject.symbol]["parameters"].as_array();
        if !theirs.is_some_and(|theirs| theirs.iter().eq(names.iter().copied())) {
            return Err(format!(
                "error: {} has other parameters than the tables: run cargo xtask generate",
                subject.model.name()
            ));
        }
    }
    Ok(())
}

fn casadi(peer: &Value, out: &Path) -> Result<Candidate, String> {
    let library = compiled(out, "peer")?;
    let kernels = |subject: &Subject| {
        let said = &peer["kernels"][subject.symbol];
        let outputs = said["outputs"].as_array().into_iter().flatten();
        let layout = shifted(outputs.map(numbers).collect(), subject);
        let work = work(&said["work"])?;
        Kernel::new(kernel::load(&library)?, subject, None, layout, work)
    };
    Ok(Candidate {
        name: REFERENCE,
        built: format!("gcc {}", GCC[..2].join(" ")),
        kernels: SUBJECTS.iter().map(kernels).collect::<Result<_, _>>()?,
    })
}

fn numbers(value: &Value) -> Vec<usize> {
    let numbers = value.as_array().into_iter().flatten();
    numbers
        .filter_map(Value::as_u64)
        .map(|it| it as usize)
        .collect()
}

/// The working memory that CasADi says a function of its C needs.
pub(crate) fn work(said: &Value) -> Result<Work, String> {
    let &[arguments, results, integers, reals] = &numbers(said)[..] else {
        return Err("error: CasADi's peer.json lacks a function".to_owned());
    };
    Ok(Work {
        arguments,
        results,
        integers,
        reals,
    })
}

/// Compiles `name`.c in `folder` to a library.
pub(crate) fn compiled(folder: &Path, name: &str) -> Result<PathBuf, String> {
    let library = folder.join(format!("lib{name}.so"));
    let mut gcc = Command::new("gcc");
    gcc.args(GCC).arg("-o").arg(&library);
    gcc.arg(folder.join(format!("{name}.c"))).arg("-lm");
    commands::output(&mut gcc)?;
    Ok(library)
}

fn own(name: &'static str, flags: &str, root: &Path, out: &Path) -> Result<Candidate, String> {
    let mut cargo = cargo(root, flags, &target(out, flags));
    cargo.args(["--package", "ahv-bench-kernels"]);
    commands::output(&mut cargo)?;
    let library = kernel::load(&built(&target(out, flags), "ahv_bench_kernels"))?;
    let kernels = SUBJECTS.iter().map(|subject| {
        let prepare = format!("{}_prepare", subject.model.name());
        let rows = subject
            .shapes
            .iter()
            .map(|(rows, columns)| (0..rows * columns).collect());
        let layout = shifted(rows.collect(), subject);
        Kernel::new(library, subject, Some(&prepare), layout, Work::default())
    });
    Ok(Candidate {
        name,
        built: rustc(flags),
        kernels: kernels.collect::<Result<_, _>>()?,
    })
}

fn wrenfold(name: &'static str, flags: &str, root: &Path, out: &Path) -> Result<Candidate, String> {
    let target = target(&out.join("wrenfold"), flags);
    let mut cargo = cargo(
        &root.join("crates/ahv-bench/peers/wrenfold-kernels"),
        flags,
        &target,
    );
    cargo
        .arg("--locked")
        .env("AHV_BENCH_WRENFOLD", out.join("wrenfold"));
    commands::output(&mut cargo)?;
    let library = kernel::load(&built(&target, "ahv_bench_wrenfold"))?;
    let kernels = SUBJECTS.iter().map(|subject| {
        let columns = subject.shapes.iter().map(|&(rows, columns)| {
            let place = |k: usize| k % rows * columns + k / rows;
            (0..rows * columns).map(place).collect()
        });
        let layout = shifted(columns.collect(), subject);
        Kernel::new(library, subject, None, layout, Work::default())
    });
    Ok(Candidate {
        name,
        built: rustc(flags),
        kernels: kernels.collect::<Result<_, _>>()?,
    })
}

/// Positions within each output become positions within all outputs, one after the other.
fn shifted(layout: Layout, subject: &Subject) -> Layout {
    let mut start = 0;
    let outputs = layout.into_iter().zip(subject.shapes);
    let shift = |(positions, (rows, columns)): (Vec<usize>, &(usize, usize))| {
        let all = positions.into_iter().map(|it| start + it).collect();
        start += rows * columns;
        all
    };
    outputs.map(shift).collect()
}

/// cargo with exactly these flags of rustc.
pub(crate) fn cargo(folder: &Path, flags: &str, target: &Path) -> Command {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .current_dir(folder)
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env("RUSTFLAGS", flags)
        .args(["build", "--quiet", "--release", "--target-dir"])
        .arg(target);
    cargo
}

fn target(out: &Path, flags: &str) -> PathBuf {
    out.join(if flags.is_empty() {
        "baseline"
    } else {
        "native"
    })
}

fn built(target: &Path, name: &str) -> PathBuf {
    let (prefix, suffix) = (env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    target.join(format!("release/{prefix}{name}{suffix}"))
}

fn rustc(flags: &str) -> String {
    let flags = if flags.is_empty() {
        "baseline target"
    } else {
        flags
    };
    format!("rustc -O, thin LTO, {flags}")
}
