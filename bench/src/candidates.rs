//! The candidates for kernels: how each is built and where its values lie.

use ahv_bench_kernels::lanes::Scalar;
use serde_json::Value;

use crate::arrays::Arrays;
use crate::commands;
use crate::interpreted::Interpreted;
use crate::kernel::{self, Evaluate, Kernel, Layout, Work};
use crate::lanes;
use crate::layout;
use crate::setting::{Built, NATIVE, Setting, rustc};
use crate::steppers::END;
use crate::subject::{SUBJECTS, Subject};

/// The one that the others are compared with: it comes first.
pub(crate) const REFERENCE: &str = "CasADi C";
/// The one that the goals are about.
pub(crate) const PRODUCT: &str = "ahv";
/// Members side by side: the same bits.
pub(crate) const LANES: &str = "ahv, 8 lanes";

/// A way to compute the subjects.
pub(crate) struct Candidate {
    pub(crate) name: &'static str,
    /// What it was compiled with.
    pub(crate) built: String,
    /// Seconds of compilation before it is loaded.
    pub(crate) compiled: f64,
    /// One a subject.
    pub(crate) kernels: Vec<Box<dyn Evaluate>>,
}

/// What the peers say of themselves.
pub(crate) struct Peers {
    pub(crate) casadi: Value,
    /// Null where it does not run.
    pub(crate) wrenfold: Value,
}

/// Runs CasADi's script, and those of the other code generators.
///
/// # Errors
/// A script that fails, or one whose tables are not those of the product.
pub(crate) fn derive(setting: &Setting) -> Result<Peers, String> {
    let end = END.to_string();
    // The loops of whole flights take long to compile.
    let loops: &[&str] = if setting.peers { &["--end", &end] } else { &[] };
    let mut peers = Peers {
        casadi: told(setting, "casadi", loops)?,
        wrenfold: Value::Null,
    };
    check_parameters(&peers.casadi)?;
    if setting.peers {
        peers.wrenfold = told(setting, "wrenfold", &[])?;
        check_parameters(&peers.wrenfold)?;
        check_parameters(&told(setting, "symforce", &[])?)?;
    }
    Ok(peers)
}

/// Builds and loads all candidates.
pub(crate) fn build(
    setting: &Setting,
    peers: &Peers,
    arrays: Option<&Arrays>,
) -> Result<Vec<Candidate>, String> {
    let mut candidates = vec![casadi(setting, &peers.casadi)?];
    for (names, flags) in [
        (["ahv", "wrenfold"], ""),
        (["ahv, native", "wrenfold, native"], NATIVE),
    ] {
        candidates.push(own(names[0], flags, setting)?);
        if setting.peers {
            candidates.push(wrenfold(names[1], flags, setting)?);
        }
    }
    let in_lanes = if lanes::all_in_a_register() {
        side_by_side::<lanes::Exact, lanes::Exact>
    } else {
        side_by_side::<lanes::Short, lanes::Exact>
    };
    candidates.push(in_lanes(LANES, lanes::EXACT));
    if let Some(arrays) = arrays {
        candidates.push(symforce(setting)?);
        let numba = "`njit` of CasADi's instructions and of the loop over the points";
        let jax = "`jit` and `vmap` over all points, one call";
        for (name, built, service) in [("numba", numba, &arrays.numba), ("JAX", jax, &arrays.jax)] {
            let kernel = |subject: &Subject| -> Box<dyn Evaluate> {
                Box::new(Interpreted::new(&service[0], subject))
            };
            candidates.push(Candidate {
                name,
                built: built.to_owned(),
                compiled: 0.0,
                kernels: SUBJECTS.iter().map(kernel).collect(),
            });
        }
    }
    Ok(candidates)
}

/// Runs a peer's script, and reads what it says.
fn told(setting: &Setting, peer: &str, options: &[&str]) -> Result<Value, String> {
    let out = setting.out.join(peer);
    commands::make_folder(&out)?;
    let mut command = setting.script(&format!("{peer}_peer"));
    command.arg("--out").arg(&out).args(options);
    command.args(setting.tables()?);
    commands::output(&mut command)?;
    commands::read_json(&out.join("peer.json"))
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

fn casadi(setting: &Setting, peer: &Value) -> Result<Candidate, String> {
    let built = setting.c(&setting.out.join("casadi"), "peer")?;
    let describe = |subject: &Subject| {
        let said = &peer["kernels"][subject.symbol];
        let outputs = said["outputs"].as_array().into_iter().flatten();
        Ok((
            outputs.map(layout::numbers).collect(),
            layout::work(&said["work"])?,
        ))
    };
    loaded(
        REFERENCE,
        "gcc -O3 -march=native".to_owned(),
        &built,
        None,
        describe,
    )
}

fn own(name: &'static str, flags: &str, setting: &Setting) -> Result<Candidate, String> {
    let packages = ["ahv-bench-kernels", "ahv-models"];
    let built = setting.rust(&setting.root.join("bench"), flags, &setting.out, &packages)?;
    let own = |subject: &Subject| Ok((layout::own_layout(subject), Work::default()));
    loaded(name, rustc(flags), &built, Some("prepare"), own)
}

/// The product's functions for members side by side.
fn side_by_side<S: Scalar, L: Scalar>(name: &'static str, built: &str) -> Candidate {
    Candidate {
        name,
        built: built.to_owned(),
        compiled: 0.0,
        kernels: lanes::kernels::<S, L>(),
    }
}

fn wrenfold(name: &'static str, flags: &str, setting: &Setting) -> Result<Candidate, String> {
    let folder = setting.peer_file("wrenfold-kernels");
    let target = setting.out.join("wrenfold");
    let built = setting.rust(&folder, flags, &target, &["ahv-bench-wrenfold"])?;
    let by_columns = |subject: &Subject| {
        let columns = subject.shapes.iter().map(|&(rows, columns)| {
            let place = |k: usize| k % rows * columns + k / rows;
            (0..rows * columns).map(place).collect()
        });
        Ok((columns.collect(), Work::default()))
    };
    loaded(name, rustc(flags), &built, None, by_columns)
}

fn symforce(setting: &Setting) -> Result<Candidate, String> {
    let folder = setting.out.join("symforce");
    let built = setting.cpp(&folder, "peer", &folder.join("peer.cpp"))?;
    loaded(
        "SymForce",
        "g++ -O3 -march=native".to_owned(),
        &built,
        None,
        by_rows,
    )
}

/// Dense outputs, row by row.
fn by_rows(subject: &Subject) -> Result<(Layout, Work), String> {
    let rows = subject
        .shapes
        .iter()
        .map(|(rows, columns)| (0..rows * columns).collect());
    Ok((rows.collect(), Work::default()))
}

/// The functions of a library; `describe` says how each lays out its outputs, and what memory it wants.
fn loaded(
    name: &'static str,
    built_with: String,
    built: &Built,
    prepare: Option<&str>,
    describe: impl Fn(&Subject) -> Result<(Layout, Work), String>,
) -> Result<Candidate, String> {
    let library = kernel::load(&built.library)?;
    let kernel = |subject: &Subject| -> Result<Box<dyn Evaluate>, String> {
        let (layout, work) = describe(subject)?;
        let prepare = prepare.map(|it| format!("{}_{it}", subject.model.name()));
        let layout = layout::shifted(layout, subject);
        let kernel = Kernel::new(library, subject, prepare.as_deref(), layout, work)?;
        Ok(Box::new(kernel))
    };
    Ok(Candidate {
        name,
        built: built_with,
        compiled: built.seconds,
        kernels: SUBJECTS.iter().map(kernel).collect::<Result<_, _>>()?,
    })
}
