//! What the figures depend on.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde::Serialize;

use crate::candidates::Peers;
use crate::commands;

/// The machine and its tools.
#[derive(Serialize)]
pub(crate) struct Machine {
    pub(crate) cpu: String,
    pub(crate) system: String,
    pub(crate) rustc: String,
    pub(crate) gcc: String,
    /// sin, cos and exp of all candidates but the product's own.
    pub(crate) libc: String,
    pub(crate) casadi: String,
    pub(crate) wrenfold: String,
    pub(crate) scipy: String,
    pub(crate) ode_solvers: String,
    pub(crate) diffsol: String,
}

impl Machine {
    /// Names and values, in order.
    pub(crate) fn lines(&self) -> [(&'static str, &str); 10] {
        [
            ("CPU", &self.cpu),
            ("system", &self.system),
            ("rustc", &self.rustc),
            ("gcc", &self.gcc),
            ("libc", &self.libc),
            ("CasADi", &self.casadi),
            ("wrenfold", &self.wrenfold),
            ("SciPy", &self.scipy),
            ("ode_solvers", &self.ode_solvers),
            ("diffsol", &self.diffsol),
        ]
    }
}

/// Asks the system and the tools.
pub(crate) fn describe(root: &Path, peers: &Peers) -> Result<Machine, String> {
    let said = |peer: &serde_json::Value, key: &str| peer[key].as_str().unwrap_or("?").to_owned();
    let lock = root.join("crates/ahv-bench/peers/solver-crates/Cargo.lock");
    let lock = commands::read(&lock)?;
    Ok(Machine {
        cpu: cpu(),
        system: format!("{} {}", env::consts::OS, env::consts::ARCH),
        rustc: first_line(env::var("RUSTC").as_deref().unwrap_or("rustc"))?,
        gcc: first_line("gcc")?,
        // Not there with another libc than glibc.
        libc: first_line("ldd").unwrap_or_else(|_| "unknown".to_owned()),
        casadi: said(&peers.casadi, "version"),
        wrenfold: said(&peers.wrenfold, "version"),
        scipy: said(&peers.casadi, "scipy"),
        ode_solvers: locked(&lock, "ode_solvers"),
        diffsol: locked(&lock, "diffsol"),
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
