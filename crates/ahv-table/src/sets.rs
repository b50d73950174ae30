//! Checks the further sets of a table, and the rules that the numbers of each set must obey.

use ahv_core::{EntryKind, Rule};
use toml_edit::TableLike;

use crate::fault::suggestion;
use crate::reader::{Reader, SETS};
use crate::{Set, names};

impl Reader<'_> {
    /// The sets beside the table's own.
    pub(crate) fn sets(&mut self, own: &str) -> Vec<Set> {
        let Some(item) = self.entries.text.root().get(SETS) else {
            return Vec::new();
        };
        let Some(content) = item.as_table_like() else {
            let message = "`sets` must hold sections like `[sets.\"other\".vehicle]`";
            self.entries.value("shape", &[SETS], message, "");
            return Vec::new();
        };
        let (mut found, mut taken) = (Vec::new(), Vec::new());
        for (name, item) in content.iter() {
            if let Some(fault) = names::fault_of_set(name, own, &mut taken) {
                self.entries.key("set-name", &[SETS, name], &fault, "");
                continue;
            }
            let mut set = Set {
                name: name.to_owned(),
                entries: vec![None; self.table.entries.len()],
            };
            if let Some(sections) = item.as_table_like() {
                self.replacements(sections, &mut set);
            } else {
                let message = "a set holds sections like those of the table";
                self.entries.value("shape", &[SETS, name], message, "");
            }
            found.push(set);
        }
        found
    }

    /// The entries of a set, each of which replaces one that the table has.
    fn replacements(&mut self, sections: &dyn TableLike, set: &mut Set) {
        let name = set.name.clone();
        let known: Vec<&str> = self.sections.iter().map(|(name, _)| *name).collect();
        for (section, item) in sections.iter() {
            let path = [SETS, &name, section];
            let content = item.as_table_like().filter(|_| known.contains(&section));
            let Some(content) = content else {
                let message = format!("`{section}` is not a section of parameters");
                let help = suggestion(section, &known);
                self.entries.key("unknown-section", &path, &message, &help);
                continue;
            };
            let indices = self.indices(section);
            for (key, _) in content.iter() {
                let of_key = indices.iter().find(|&&index| self.keys[index] == Some(key));
                let path = [SETS, &name, section, key];
                match of_key {
                    // A fault of the table's own entry is reported there.
                    Some(&index) if self.own[index].is_none() => {}
                    Some(&index) => {
                        let expected = self.expected(index);
                        set.entries[index] = self.entries.entry(&path, expected);
                    }
                    None => self.nothing_to_replace(&path, &indices),
                }
            }
        }
    }

    /// Reports an entry of a set that the table does not have, unless it is a fault already that the table lacks it.
    fn nothing_to_replace(&mut self, path: &[&str; 4], indices: &[usize]) {
        let [_, _, section, key] = *path;
        let listed = self.entries.content(section);
        let listed: Vec<&str> = listed
            .iter()
            .flat_map(|it| it.iter().map(|it| it.0))
            .collect();
        let entries = indices.iter().map(|&index| self.table.entries[index]);
        let parameters = entries.filter(|entry| entry.kind == EntryKind::Parameter);
        let parameters: Vec<&str> = parameters.map(|entry| entry.key).collect();
        if !listed.contains(&key) && !parameters.contains(&key) {
            let message = format!("`[{section}]` of the table has no `{key}` to replace");
            let help = suggestion(key, &[parameters, listed].concat());
            self.entries
                .key("nothing-to-replace", path, &message, &help);
        }
    }

    /// Compares the table, and every set that replaces a parameter of a rule, with the rules.
    pub(crate) fn rules(&mut self, further: &[Set]) {
        for rule in self.table.rules {
            for set in std::iter::once(None).chain(further.iter().map(Some)) {
                self.rule(rule, set);
            }
        }
    }

    /// Compares the table's own values, with those of `set` in their place, with a rule.
    fn rule(&mut self, rule: &Rule, set: Option<&Set>) {
        let position = |name: &&str| self.family.names.iter().position(|known| known == name);
        let names = rule.terms.iter().flat_map(|term| term.parameters);
        let indices: Vec<usize> = names.filter_map(position).collect();
        let replaced = |index: usize| set.and_then(|set| set.entries[index]);
        let value = |index: usize| replaced(index).or(self.own[index]).map(|it| it.value);
        // What the table lacks is another fault, or no matter of the models that it lists.
        if indices.iter().any(|&index| value(index).is_none()) {
            return;
        }
        let of_name = |name: &str| position(&name).and_then(value).unwrap_or(f64::NAN);
        let mut indices = indices.into_iter();
        let first = indices.find(|&index| set.is_none() || replaced(index).is_some());
        let Some(index) = first.filter(|_| !rule.holds_for(of_name)) else {
            return;
        };
        let key = self.keys[index].unwrap_or_default();
        let own = [self.table.entries[index].section, key, "value"];
        match set {
            None => self.entries.value(rule.name, &own, rule.reason, ""),
            Some(set) => {
                let path = [&[SETS, &set.name], &own[..]].concat();
                self.entries.value(rule.name, &path, rule.reason, "");
            }
        }
    }
}
