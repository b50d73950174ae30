//! `cargo xtask names`: values of the generated code that are numbered for want of a name.

use std::collections::BTreeMap;
use std::fs;

use ahv_codegen::{Table, numbered};

use crate::shell;

/// Prints them, one a line with its reason, and how many there are.
pub(crate) fn run() -> Result<(), String> {
    let (mut tables, mut irs) = (Vec::new(), BTreeMap::new());
    let folder = shell::root().join("generator/tables");
    let listed = fs::read_dir(&folder).map_err(|error| error.to_string())?;
    let paths = listed.map(|entry| entry.map(|it| it.path()));
    let mut paths = paths
        .collect::<Result<Vec<_>, _>>()
        .map_err(|error| error.to_string())?;
    paths.sort();
    for path in paths
        .iter()
        .filter(|path| path.extension().is_some_and(|it| it == "toml"))
    {
        let name = path.file_name().map(|it| it.to_string_lossy().into_owned());
        let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
        let table =
            Table::parse(&name.unwrap_or_default(), &text).map_err(|error| error.to_string())?;
        let ir = shell::root().join(format!("generated/ir/{}.json", table.name));
        let ir = fs::read_to_string(ir).map_err(|error| error.to_string())?;
        irs.insert(table.name.clone(), ir);
        tables.push(table);
    }
    let found = numbered(&tables, &irs).map_err(|error| error.to_string())?;
    for it in &found {
        println!("{}::{}  {}: {}", it.model, it.function, it.name, it.reason);
    }
    println!("{} values are numbered", found.len());
    Ok(())
}
