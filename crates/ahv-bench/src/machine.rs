//! What the figures depend on.

use std::env;
use std::fs;
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
}

impl Machine {
    /// Names and values, in order.
    pub(crate) fn lines(&self) -> [(&'static str, &str); 7] {
        [
            ("CPU", &self.cpu),
            ("system", &self.system),
            ("rustc", &self.rustc),
            ("gcc", &self.gcc),
            ("libc", &self.libc),
            ("CasADi", &self.casadi),
            ("wrenfold", &self.wrenfold),
        ]
    }
}

/// Asks the system and the tools.
pub(crate) fn describe(peers: &Peers) -> Result<Machine, String> {
    let version = |value: &serde_json::Value| value["version"].as_str().unwrap_or("?").to_owned();
    Ok(Machine {
        cpu: cpu(),
        system: format!("{} {}", env::consts::OS, env::consts::ARCH),
        rustc: first_line(env::var("RUSTC").as_deref().unwrap_or("rustc"))?,
        gcc: first_line("gcc")?,
        // Not there with another libc than glibc.
        libc: first_line("ldd").unwrap_or_else(|_| "unknown".to_owned()),
        casadi: version(&peers.casadi),
        wrenfold: version(&peers.wrenfold),
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

fn first_line(program: &str) -> Result<String, String> {
    let said = commands::output(Command::new(program).arg("--version"))?;
    Ok(said.lines().next().unwrap_or_default().to_owned())
}
