//! What the figures depend on.

use std::env;
use std::fs;
use std::process::Command;

use serde::Serialize;

use crate::candidates::Peers;
use crate::commands;
use crate::setting::Setting;

/// The machine and its tools.
#[derive(Serialize)]
pub(crate) struct Machine {
    pub(crate) cpu: String,
    pub(crate) system: String,
    pub(crate) rustc: String,
    pub(crate) gcc: String,
    /// sin, cos and exp of all candidates but the product's own.
    pub(crate) libc: String,
    /// Packages of the peers and their versions.
    pub(crate) peers: Vec<(&'static str, String)>,
}

/// Packages of Python, and what they are called.
const PACKAGES: [(&str, &str); 8] = [
    ("casadi", "CasADi"),
    ("wrenfold", "wrenfold"),
    ("symforce", "SymForce"),
    ("numba", "numba"),
    ("jax", "JAX"),
    ("diffrax", "diffrax"),
    ("numpy", "NumPy"),
    ("scipy", "SciPy"),
];
const CRATES: [&str; 2] = ["ode_solvers", "diffsol"];

impl Machine {
    /// Names and values, in order.
    pub(crate) fn lines(&self) -> Vec<(&'static str, &str)> {
        let mut lines: Vec<(&str, &str)> = vec![
            ("CPU", &self.cpu),
            ("system", &self.system),
            ("rustc", &self.rustc),
            ("gcc, g++", &self.gcc),
            ("libc", &self.libc),
        ];
        lines.extend(
            self.peers
                .iter()
                .map(|(name, version)| (*name, version.as_str())),
        );
        lines
    }
}

/// Asks the system and the tools.
pub(crate) fn describe(setting: &Setting, peers: &Peers) -> Result<Machine, String> {
    let said = &peers.casadi["versions"];
    let packages = PACKAGES.into_iter().filter_map(|(package, name)| {
        let used = setting.peers || package == "casadi";
        Some((name, said[package].as_str().filter(|_| used)?.to_owned()))
    });
    let mut versions: Vec<_> = packages.collect();
    if setting.peers {
        let lock = commands::read(&setting.peer_file("solver-crates/Cargo.lock"))?;
        versions.extend(CRATES.map(|name| (name, locked(&lock, name))));
    }
    Ok(Machine {
        cpu: cpu(),
        system: format!("{} {}", env::consts::OS, env::consts::ARCH),
        rustc: first_line(env::var("RUSTC").as_deref().unwrap_or("rustc"))?,
        gcc: first_line("gcc")?,
        // Not there with another libc than glibc.
        libc: first_line("ldd").unwrap_or_else(|_| "unknown".to_owned()),
        peers: versions,
    })
}

fn cpu() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let value = |key: &str| {
        let line = text.lines().find(|line| line.starts_with(key))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    match (value("model name"), value("cpu family"), value("model")) {
        (Some(name), Some(family), Some(_)) => {
            let model = text.lines().find_map(|line| line.strip_prefix("model\t"));
            let model = model
                .and_then(|rest| rest.split_once(':'))
                .map_or("?", |it| it.1.trim());
            format!("{name}, family {family}, model {model}")
        }
        _ => "unknown".to_owned(),
    }
}

/// The version of a package in the text of a Cargo.lock.
fn locked(lock: &str, package: &str) -> String {
    let after = lock.split_once(&format!("name = \"{package}\"\nversion = \""));
    let version = after.and_then(|(_, rest)| rest.split_once('"'));
    version.map_or("?", |it| it.0).to_owned()
}

fn first_line(program: &str) -> Result<String, String> {
    let said = commands::output(Command::new(program).arg("--version"))?;
    Ok(said.lines().next().unwrap_or_default().to_owned())
}
