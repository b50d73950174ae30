//! A table that a stranger might write, made from one of this repository.

use toml_edit::{Array, DocumentMut, Item, TableLike, value};

/// The COM's table with its rigid model alone.
pub(super) fn com_rigid_alone(com: &str) -> Result<String, String> {
    let mut table = read(com)?;
    rename(&mut table, "rigid", &["com_rigid"])?;
    for name in ["modes", "N_1", "N_2"] {
        table.remove(name);
    }
    for name in ["eta", "eta_dot"] {
        inside(&mut table, "validity")?.remove(name);
    }
    for (_, set) in inside(&mut table, "sets")?.iter_mut() {
        set.as_table_like_mut().map(|set| set.remove("modes"));
    }
    Ok(table.to_string())
}

/// A table with the parts that a page joins in its block of TOML: `models` of the header, entries of `[validity]`, and
/// sections of their own.
pub(super) fn joined(table: &str, page: &str) -> Result<String, String> {
    let block = page
        .split_once("```toml\n")
        .and_then(|(_, it)| it.split_once("```"));
    let (block, _) = block.ok_or("error: the page has no block of TOML")?;
    let (mut table, block) = (read(table)?, read(block)?);
    for (name, item) in block.iter() {
        match name {
            "models" => drop(inside(&mut table, "table")?.insert(name, item.clone())),
            "validity" => {
                let validity = inside(&mut table, name)?;
                for (name, interval) in item.as_table_like().into_iter().flat_map(|it| it.iter()) {
                    validity.insert(name, interval.clone());
                }
            }
            _ => drop(table.insert(name, item.clone())),
        }
    }
    Ok(table.to_string())
}

fn read(text: &str) -> Result<DocumentMut, String> {
    text.parse()
        .map_err(|error| format!("error: a table cannot be read: {error}"))
}

fn inside<'a>(table: &'a mut DocumentMut, section: &str) -> Result<&'a mut dyn TableLike, String> {
    let found = table.get_mut(section).and_then(Item::as_table_like_mut);
    found.ok_or_else(|| format!("error: the table has no [{section}]"))
}

/// Another name, other models, and another name for the values as they stand.
fn rename(table: &mut DocumentMut, name: &str, models: &[&str]) -> Result<(), String> {
    let head = inside(table, "table")?;
    head.insert("name", value(name));
    head.insert("models", value(models.iter().copied().collect::<Array>()));
    head.insert("set", value("own"));
    Ok(())
}
