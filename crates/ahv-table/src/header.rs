//! Checks the header of a table and its sources: everything before the sections of its family.

use toml_edit::Item;

use crate::entries::{Entries, shown};
use crate::fault::{is_printable, suggestion};
use crate::reader::{GENERATE, HEADER, Reader, SI, SOURCES};
use crate::{Checked, Family, Fault, Text, names};

const KEYS: [&str; 8] = [
    "name",
    "family",
    "models",
    "units",
    "set",
    "source",
    "status",
    "uncertainty",
];

pub(crate) const FOOT_SLUG: &str = "ft-slug-s-rad";

/// Checks the table for the family of the models that it lists.
pub(crate) fn check(text: &Text, families: &[Family]) -> Result<Checked, Vec<Fault>> {
    let mut entries = Entries {
        text,
        faults: Vec::new(),
        system: FOOT_SLUG,
        uncertainty: f64::NAN,
    };
    let own_set = identity(&mut entries);
    sources(&mut entries);
    let Some((family, models)) = listed(&mut entries, families) else {
        return Err(entries.faults);
    };
    if entries.system == FOOT_SLUG && family.table.unit_system == SI {
        let message = "the models were generated in si, and take no table in ft-slug-s-rad";
        entries.value("needs-generation", &[HEADER, "units"], message, GENERATE);
    }
    Reader::new(entries, family, models).read(own_set)
}

/// The header without the models. Returns the name of the table's own set.
fn identity(entries: &mut Entries<'_>) -> String {
    let Some(header) = entries.section(HEADER) else {
        return String::new();
    };
    entries.only("unknown-key", &[HEADER], header, &KEYS);
    for key in KEYS {
        if header.get(key).is_none() {
            let message = format!("`{key}` is missing in `[{HEADER}]`");
            entries.key("missing", &[HEADER], &message, "");
        }
    }
    if let Some(name) = header.get("name")
        && let Some(fault) = names::fault_of_table(name.as_str())
    {
        entries.value("table-name", &[HEADER, "name"], &fault, "");
    }
    if let Some(units) = header.get("units") {
        let known = [FOOT_SLUG, SI];
        let found = known.into_iter().find(|it| units.as_str() == Some(it));
        entries.system = found.unwrap_or_else(|| {
            let text = shown(units);
            let message = format!("unknown unit system `{text}`");
            let help = suggestion(&text, &known);
            entries.value("unit-system", &[HEADER, "units"], &message, &help);
            FOOT_SLUG
        });
    }
    let set = header
        .get("set")
        .map(|set| set.as_str().unwrap_or_default());
    if set.is_some_and(|set| !names::is_set(set)) {
        let letters = names::SET_LETTERS;
        let message = format!("`set` must name the table's own parameter set, in {letters}");
        entries.value("set-name", &[HEADER, "set"], &message, "");
    }
    entries.uncertainty = entries.provenance(header, &[HEADER]);
    set.unwrap_or_default().to_owned()
}

fn sources(entries: &mut Entries<'_>) {
    let Some(content) = entries.section(SOURCES) else {
        return;
    };
    for (key, text) in content.iter() {
        let plain = key
            .chars()
            .all(|c| is_printable(c) && c != '"' && c != '\\');
        if !plain || text.as_str().is_none() {
            let message = "a source is a plain key with a text that says what it is";
            entries.key("source", &[SOURCES, key], message, "");
        }
    }
}

/// The family of the models that the table lists, and those that are known, in order; `None` if none is.
fn listed(entries: &mut Entries<'_>, families: &[Family]) -> Option<(Family, Vec<&'static str>)> {
    // What a table should hold is not known without its family.
    entries.text.item(&[HEADER, "family"])?;
    let path = [HEADER, "models"];
    let item = entries.text.item(&path)?;
    let known: Vec<&str> = families
        .iter()
        .flat_map(|it| it.table.models)
        .copied()
        .collect();
    let listed: Vec<Item> = item.as_array().map_or_else(Vec::new, |models| {
        models.iter().cloned().map(Item::Value).collect()
    });
    let names: Vec<&str> = listed.iter().filter_map(Item::as_str).collect();
    let is_known = |item: &&Item| item.as_str().is_some_and(|name| known.contains(&name));
    let unknown: Vec<&Item> = listed.iter().filter(|item| !is_known(item)).collect();
    for model in &unknown {
        let text = shown(model);
        let message = format!("unknown model `{text}`");
        entries.value("unknown-model", &path, &message, &suggestion(&text, &known));
    }
    // That of the first model that is known.
    let family = names.iter().find_map(|name| {
        let mut families = families.iter();
        families.find(|family| family.table.models.contains(name))
    });
    let models = family.into_iter().flat_map(|family| family.table.models);
    let ordered: Vec<&'static str> = models.copied().filter(|it| names.contains(it)).collect();
    if unknown.is_empty() && (ordered.is_empty() || ordered != names) {
        let lists = families
            .iter()
            .map(|it| format!("`{}`", it.table.models.join("`, `")));
        let lists: Vec<String> = lists.collect();
        let message = "`models` must list models of one family, each once, in this order";
        let help = format!("the families are: {}", lists.join("; "));
        entries.value("models", &path, message, &help);
    }
    Some((*family?, ordered))
}
