//! `cargo xtask vectors`: the reference vectors of `tests/vectors`, drawn and computed again.

use std::fs;

use crate::{python, shell};

/// Points for each model: `cargo xtask audit` draws many more.
const POINTS: &str = "30";
const SEED: &str = "1";
/// The models of the package, each with its table, as the IRs list them.
fn models() -> Result<Vec<(String, String)>, String> {
    let folder = shell::root().join("generated/ir");
    let unreadable = |error: &dyn std::fmt::Display| format!("{}: {error}", folder.display());
    let mut models = Vec::new();
    for entry in fs::read_dir(&folder).map_err(|error| unreadable(&error))? {
        let path = entry.map_err(|error| unreadable(&error))?.path();
        let text = fs::read_to_string(&path).map_err(|error| unreadable(&error))?;
        let ir: serde_json::Value =
            serde_json::from_str(&text).map_err(|error| unreadable(&error))?;
        let table = ir["provenance"]["table"].as_str().unwrap_or_default();
        // The audit lists no models.
        for model in ir["models"].as_array().into_iter().flatten() {
            let name = model["name"].as_str().unwrap_or_default();
            models.push((name.to_owned(), table.to_owned()));
        }
    }
    models.sort();
    Ok(models)
}

/// Writes the oracle's points and values and CasADi's values at the same points, then SciPy's flights, Riccati
/// solutions, poles and zeros, the answers of the examples' programs, and mpmath's elementary functions and normal numbers. SLICOT's zeros and
/// reductions, `zeros.txt` and `reduction.txt`, are made by hand, since `slycot` is no requirement: `zeros.py` and `reduction.py` of
/// `generator/ahv_oracle` say how.
pub(crate) fn run() -> Result<(), String> {
    let python = python::development()?;
    for (model, table) in models()? {
        let table = format!("tables/{table}.toml");
        let points = format!("../tests/vectors/{model}.sympy.txt");
        let values = format!("../tests/vectors/{model}.casadi.txt");
        let mut oracle = shell::program(&python);
        oracle.args([
            "-m",
            "ahv_oracle",
            "vectors",
            "--points",
            POINTS,
            "--seed",
            SEED,
        ]);
        oracle.args(["--table", &table, "--model", &model, "--out", &points]);
        shell::run(oracle.current_dir(shell::root().join("generator")))?;
        let mut casadi = shell::program(&python);
        casadi.args(["-m", "ahv_generator", "evaluate", "--points", &points]);
        casadi.args(["--table", &table, "--model", &model, "--out", &values]);
        shell::run(casadi.current_dir(shell::root().join("generator")))?;
        println!("tests/vectors/{model}.sympy.txt\ntests/vectors/{model}.casadi.txt");
    }
    let mut scipy = shell::program(&python);
    scipy.args(["-m", "ahv_oracle", "flights", "--table", "tables/dcom.toml"]);
    scipy.args(["--out", "../tests/vectors/dcom.flights.txt"]);
    shell::run(scipy.current_dir(shell::root().join("generator")))?;
    println!("tests/vectors/dcom.flights.txt");
    for name in [
        "identify",
        "riccati",
        "elementary",
        "transcendental",
        "normals",
        "gas_dynamics",
        "fpm",
        "least_squares",
        "fit_samples",
    ] {
        let mut alone = shell::program(&python);
        let out = format!("tests/vectors/{name}.txt");
        alone.args(["-m", "ahv_oracle", name, "--out", &format!("../{out}")]);
        shell::run(alone.current_dir(shell::root().join("generator")))?;
        println!("{out}");
    }
    for (name, tables, file) in [
        ("roots", "tables", "roots.txt"),
        ("answers", "../examples", "answers.json"),
    ] {
        let mut of_tables = shell::program(&python);
        let out = format!("tests/vectors/{file}");
        of_tables.args(["-m", "ahv_oracle", name, "--tables", tables]);
        of_tables.args(["--out", &format!("../{out}")]);
        shell::run(of_tables.current_dir(shell::root().join("generator")))?;
        println!("{out}");
    }
    Ok(())
}
