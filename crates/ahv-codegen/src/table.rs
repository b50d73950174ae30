//! The text of a table: its values and the places where they stand.

use ahv_table::{Part, Text, Unreadable};
use serde_json::{Map, Value as Json};
use std::collections::BTreeMap;
use std::ops::Range;
use toml_edit::{Item, TableLike, Value};

use crate::manifest::sha256;

/// A table as a file holds it.
#[derive(Debug)]
pub struct Table {
    /// `name` in `[table]`; empty where it is missing.
    pub name: String,
    /// Name of the file.
    pub file_name: String,
    text: Text,
}

impl Table {
    /// Reads TOML text.
    ///
    /// # Errors
    /// [`Unreadable`] with the place of the fault; a duplicate key is one.
    pub fn parse(file_name: &str, text: &str) -> Result<Self, Unreadable> {
        let text = Text::parse(text.to_owned())?;
        let name = text.item(&["table", "name"]).and_then(Item::as_str);
        Ok(Self {
            name: name.unwrap_or_default().to_owned(),
            file_name: file_name.to_owned(),
            text,
        })
    }

    /// The number at a path of keys.
    pub fn number(&self, path: &[&str]) -> Option<f64> {
        let item = self.text.item(path)?;
        item.as_float()
            .or_else(|| item.as_integer().map(|n| n as f64))
    }

    /// The text at a path of keys.
    pub fn text(&self, path: &[&str]) -> Option<&str> {
        self.text.item(path)?.as_str()
    }

    /// The Python files beside the table that it names: that of its family, then those of its parts.
    pub fn scripts(&self) -> Vec<&str> {
        let parts = self.text.item(&["parts"]).and_then(Item::as_table_like);
        let parts = parts.into_iter().flat_map(|parts| parts.iter());
        let family = self.text(&["table", "family"]).into_iter();
        let named = family.chain(parts.filter_map(|(_, part)| part.get("part")?.as_str()));
        named.filter(|name| name.ends_with(".py")).collect()
    }

    /// Where the key or the value at a path stands, in bytes; of the nearest enclosing entry where it is missing.
    pub fn span(&self, path: &[&str], part: Part) -> Option<Range<usize>> {
        self.text.span(path, part)
    }

    /// SHA-256 of the values: comments, order and layout do not count.
    pub fn sha256(&self) -> String {
        sha256(&canonical_table(self.text.root()).to_string())
    }
}

// Keys are sorted here, for whether `serde_json::Map` sorts depends on its features; a float prints in its shortest
// form: one text for one meaning.
fn canonical_table(table: &dyn TableLike) -> Json {
    let sorted: BTreeMap<String, Json> = table
        .iter()
        .map(|(key, item)| (key.to_owned(), canonical_item(item)))
        .collect();
    Json::Object(sorted.into_iter().collect::<Map<_, _>>())
}

fn canonical_item(item: &Item) -> Json {
    match item {
        Item::Value(value) => canonical_value(value),
        other => other.as_table_like().map_or(Json::Null, canonical_table),
    }
}

fn canonical_value(value: &Value) -> Json {
    match value {
        Value::String(text) => Json::from(text.value().as_str()),
        Value::Integer(number) => Json::from(*number.value() as f64),
        Value::Float(number) => Json::from(*number.value()),
        Value::Boolean(flag) => Json::from(*flag.value()),
        Value::Datetime(time) => Json::from(time.value().to_string()),
        Value::Array(array) => array.iter().map(canonical_value).collect(),
        Value::InlineTable(table) => canonical_table(table),
    }
}
