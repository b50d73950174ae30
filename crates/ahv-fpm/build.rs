//! Makes the geometry table `vehicle.toml` constants of the crate: parameters with their units, values, origins and rules.
//!
//! The table is the one place of its numbers. What a comment at the end of an entry says is its description.

use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

use ahv_table::{Text, degrees, in_radians, in_si};
use toml_edit::{Item, TableLike};

/// The table.
const TABLE: &str = "vehicle.toml";
/// Sections of it that hold parameters.
const SECTIONS: [&str; 6] = [
    "vehicle",
    "geometry",
    "engine",
    "structure",
    "air",
    "environment",
];
/// Parameters that may be of any sign. All others must be positive.
const OF_ANY_SIGN: [&str; 9] = [
    "tau_u", "tau_l", "tau_t", "x_e", "z_el", "z_e", "x_c", "z_c", "lapse_0",
];

type Failure = Box<dyn Error>;

fn main() -> Result<(), Failure> {
    println!("cargo::rerun-if-changed={TABLE}");
    let source = fs::read_to_string(TABLE)?;
    let table = Text::parse(source.clone())?;
    let mut fields = String::new();
    let mut values = String::new();
    let mut origins = String::new();
    let mut entries = String::new();
    let mut rules = String::new();
    for section in SECTIONS {
        for (key, item) in content(&table, &[section])?.iter() {
            let name = key.to_lowercase();
            let unit = text(item, "unit")?;
            let turns = degrees(unit).ok_or(format!("{key}: {unit} is no unit"))?;
            let unit = unit.replace("deg", "rad");
            let (si, factor) = in_si(&unit).ok_or(format!("{key}: {unit} is no unit"))?;
            let doc = described(&source, item).ok_or(format!("{key} has no description"))?;
            let value = in_radians(number(item, "value")?, turns);
            writeln!(
                fields,
                "/// {}, {unit}.\n{name}: [{unit:?}, {si:?}, {factor:?}],",
                capital(&doc)
            )?;
            writeln!(values, "{name}: {value:?},")?;
            writeln!(origins, "{name}: {},", origin(&table, item)?)?;
            writeln!(entries, "Entry::parameter({section:?}, {key:?}, {doc:?}),")?;
            if !OF_ANY_SIGN.contains(&key) {
                let reason = format!("`{key}` ({doc}) must be positive");
                writeln!(
                    rules,
                    "Rule::new(\"positive\", {reason:?}, Sign::Positive, &[Term::new(1.0, &[{name:?}])]),"
                )?;
            }
        }
    }
    let mut bounds = String::new();
    for (key, item) in content(&table, &["validity"])?.iter() {
        let turns = degrees(text(item, "unit")?).ok_or("no unit")?;
        let [min, max] =
            [number(item, "min")?, number(item, "max")?].map(|it| in_radians(it, turns));
        let name = key.to_uppercase();
        writeln!(
            bounds,
            "/// Validity of {key}.\npub(crate) const {name}: Bounds = Bounds::new({min:?}, {max:?});"
        )?;
    }
    let set = text(table.item(&["table"]).ok_or("no [table]")?, "set")?;
    let earth = table.item(&["choices", "earth"]).and_then(Item::as_str);
    let spherical = f64::from(u8::from(earth == Some("spherical")));
    let made = format!(
        "ahv_core::vector! {{
            /// Parameters of the first-principles model: the numbers of its geometry table.
            pub struct Parameters<T> {{
                {fields}
                /// Share of the Earth's curvature in the motion: 1 spherical, 0 flat, dimensionless.
                spherical_earth: [\"1\", \"1\", 1.0],
            }}
        }}
        /// Values of the table.
        pub const NOMINAL: Parameters<f64> = Parameters {{ {values} spherical_earth: {spherical:?} }};
        /// Source, status and relative uncertainty of each value of the table.
        pub const PROVENANCE: Parameters<Provenance> = Parameters {{
            {origins} spherical_earth: Provenance::new(\"choices\", Status::Assumed, 0.0)
        }};
        /// Name of the table's own set.
        pub(crate) const SET: &str = {set:?};
        pub(crate) const ENTRIES: &[Entry] = &[
            {entries} Entry::switch(\"earth\", \"share of the Earth's curvature in the motion: 1 spherical, 0 flat\")
        ];
        pub(crate) const RULES: &[Rule] = &[{rules}];
        /// The validity box.
        pub(crate) mod validity {{
            use ahv_core::Bounds;
            {bounds}
        }}"
    );
    let place = env::var("OUT_DIR")?;
    Ok(fs::write(Path::new(&place).join("table.rs"), made)?)
}

fn content<'a>(table: &'a Text, path: &[&str]) -> Result<&'a dyn TableLike, Failure> {
    let found = table.item(path).and_then(Item::as_table_like);
    Ok(found.ok_or(format!("{TABLE} has no [{}]", path.join(".")))?)
}

fn field<'a>(item: &'a Item, key: &str) -> Option<&'a Item> {
    item.as_table_like()?.get(key)
}

fn text<'a>(item: &'a Item, key: &str) -> Result<&'a str, Failure> {
    let found = field(item, key).and_then(Item::as_str);
    Ok(found.ok_or(format!("{item}: no text {key}"))?)
}

fn number(item: &Item, key: &str) -> Result<f64, Failure> {
    let found = field(item, key).and_then(Item::as_float);
    Ok(found.ok_or(format!("{item}: no number {key}"))?)
}

/// The comment behind an entry.
fn described(source: &str, item: &Item) -> Option<String> {
    let behind = source.get(item.span()?.end..)?.lines().next()?;
    Some(behind.trim().strip_prefix('#')?.trim().to_owned())
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

/// Source, status and uncertainty of an entry; those of the header where it does not say.
fn origin(table: &Text, item: &Item) -> Result<String, Failure> {
    let header = table.item(&["table"]).ok_or("no [table]")?;
    let own = |key: &str| field(item, key).or_else(|| field(header, key));
    let source = own("source").and_then(Item::as_str).ok_or("no source")?;
    let status = own("status").and_then(Item::as_str).ok_or("no status")?;
    let uncertainty = own("uncertainty")
        .and_then(Item::as_float)
        .ok_or("no uncertainty")?;
    let status = capital(status);
    Ok(format!(
        "Provenance::new({source:?}, Status::{status}, {uncertainty:?})"
    ))
}
