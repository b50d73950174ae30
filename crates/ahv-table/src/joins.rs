//! Checks `[parts]` and `[joined]`: the parts that join a model are compiled, so that a table cannot change them.

use toml_edit::Item;

use crate::entries::shown;
use crate::reader::{GENERATE, JOINED, PARTS, Reader};

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

#[cfg(test)]
mod tests {
    use ahv_core::Table;

    use crate::{Family, Fault, Text, check};

    static TABLE: Table = Table {
        name: "t",
        models: &["a", "b"],
        unit_system: "si",
        entries: &[],
        choices: &[],
        joins: &[
            ["parts", "gust", "part", "dryden"],
            ["parts", "gust", "state", "alpha"],
            ["joined", "b", "model", "a"],
            ["joined", "b", "parts", "gust"],
        ],
        validity: &[],
        fits: &[],
        rules: &[],
    };
    const TEXT: &str = "[table]\nname = \"t\"\nfamily = \"t.py\"\nmodels = [\"a\", \"b\"]\nunits = \"si\"\nset = \"own\"\n\
        source = \"s\"\nstatus = \"assumed\"\nuncertainty = 0.1\n[sources]\ns = \"nobody\"\n[validity]\n[emit]\nfunctions = []\n\
        [parts]\ngust = { part = \"dryden\", state = \"alpha\" }\n[joined.b]\nmodel = \"a\"\ntitle = \"A in a gust\"\nparts = [\"gust\"]\n";

    /// Rule, path and message of each fault of the table with a change.
    fn faults(from: &str, to: &str) -> Vec<(&'static str, Vec<String>, String)> {
        assert!(TEXT.contains(from), "no {from:?}");
        let text = Text::parse(TEXT.replacen(from, to, 1)).expect("TOML");
        let family = Family {
            table: &TABLE,
            names: &[],
            units: &[],
            si_units: &[],
        };
        let found = check(&text, &[family]).err().unwrap_or_default();
        let said = |fault: Fault| (fault.rule, fault.path.clone(), fault.to_string());
        found.into_iter().map(said).collect()
    }

    #[test]
    fn the_parts_that_were_compiled_are_accepted_whatever_their_title() {
        assert_eq!(faults("A in a gust", "another title"), []);
        // A table of the first model has no use for them.
        let (start, _) = TEXT.split_once("[parts]").expect("parts");
        let alone = start.replacen("[\"a\", \"b\"]", "[\"a\"]", 1);
        assert_eq!(faults(TEXT, &alone), []);
    }

    #[test]
    fn other_parts_need_generation() {
        for (from, to, path, said) in [
            (
                "state = \"alpha\"",
                "state = \"gamma\"",
                vec!["parts", "gust", "state"],
                "another `state` of `gust`",
            ),
            (
                "\"dryden\"",
                "\"gust.py\"",
                vec!["parts", "gust", "part"],
                "another `part` of `gust`",
            ),
            (
                "parts = [\"gust\"]",
                "parts = [\"gust\", \"gust\"]",
                vec!["joined", "b", "parts"],
                "another `parts` of `b`",
            ),
            (
                ", state = \"alpha\"",
                "",
                vec!["parts"],
                "made with `gust.state` = `alpha`",
            ),
        ] {
            let [(rule, found, message)] = faults(from, to).try_into().expect("one fault");
            assert_eq!(
                (rule, found),
                (
                    "needs-generation",
                    path.iter().map(|it| (*it).to_owned()).collect()
                )
            );
            assert!(message.contains(said), "{message}");
        }
        let (without, _) = TEXT.split_once("[parts]").expect("parts");
        assert_eq!(faults(TEXT, without).len(), TABLE.joins.len());
    }
}
