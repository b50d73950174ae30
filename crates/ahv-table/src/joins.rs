//! Checks `[parts]` and `[joined]`: the parts that join a model are compiled, so that a table cannot change them.

use toml_edit::Item;

use crate::entries::shown;
use crate::reader::{GENERATE, Reader};

pub(crate) const PARTS: &str = "parts";
pub(crate) const JOINED: &str = "joined";
/// A title is not compared: it changes no number.
const TITLE: &str = "title";

impl Reader<'_> {
    /// Compares parts and joined models with those that were compiled.
    pub(crate) fn joins(&mut self) {
        for section in [PARTS, JOINED] {
            let mut found = Vec::new();
            let content = self.entries.content(section);
            for (name, entry) in content.into_iter().flat_map(|content| content.iter()) {
                let entry = entry.as_table_like();
                for (key, item) in entry.into_iter().flat_map(|entry| entry.iter()) {
                    found.push([section, name, key].map(str::to_owned));
                    if key != TITLE && !self.is_compiled([section, name, key, &text(item)]) {
                        let message =
                            format!("the models were made with another `{key}` of `{name}`");
                        let path = [section, name, key];
                        self.entries
                            .value("needs-generation", &path, &message, GENERATE);
                    }
                }
            }
            for [of, name, key, text] in self.table.joins {
                let is_listed = found.iter().any(|it| it == &[*of, *name, *key]);
                if *of == section && self.is_joined(section, name) && !is_listed {
                    let message = format!("the models were made with `{name}.{key}` = `{text}`");
                    self.entries
                        .key("needs-generation", &[section], &message, GENERATE);
                }
            }
        }
    }

    fn is_compiled(&self, entry: [&str; 4]) -> bool {
        self.table.joins.contains(&entry)
    }

    /// Whether a joined model is among those that the table lists, or a part is one of such a model.
    fn is_joined(&self, section: &str, name: &str) -> bool {
        if section == JOINED {
            return self.models.contains(&name);
        }
        self.table.joins.iter().any(|[of, model, key, parts]| {
            let is_listed = *of == JOINED && *key == PARTS && self.models.contains(model);
            is_listed && parts.split(", ").any(|part| part == name)
        })
    }
}

/// A text, or a list of texts with commas between.
fn text(item: &Item) -> String {
    match item.as_array() {
        Some(list) => {
            let texts = list.iter().map(|it| it.as_str().unwrap_or_default());
            texts.collect::<Vec<_>>().join(", ")
        }
        None => shown(item),
    }
}
