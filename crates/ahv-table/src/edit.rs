//! Changes of a table that leave the rest of its text as it is.

use toml_edit::{DocumentMut, Item, Value, value};

use crate::Text;

/// A table whose entries change. Comments and order stay.
#[derive(Debug)]
pub struct Edit {
    document: DocumentMut,
}

impl Text {
    /// Starts to change the table.
    #[must_use]
    pub fn edit(&self) -> Edit {
        Edit {
            document: self.mutable(),
        }
    }
}

impl Edit {
    /// Writes a number at a path of keys; what is missing on the way is made, as inline tables.
    pub fn number(&mut self, path: &[&str], number: f64) {
        self.set(path, number.into());
    }

    /// Writes a text at a path of keys.
    pub fn text(&mut self, path: &[&str], text: &str) {
        self.set(path, text.into());
    }

    /// Removes what stands at a path of keys.
    pub fn remove(&mut self, path: &[&str]) {
        let Some((last, way)) = path.split_last() else {
            return;
        };
        let root = self.document.as_item_mut();
        let holder = way.iter().try_fold(root, |item, key| item.get_mut(key));
        if let Some(holder) = holder.and_then(Item::as_table_like_mut) {
            holder.remove(last);
        }
    }

    /// The text of the changed table.
    #[must_use]
    pub fn into_text(self) -> String {
        self.document.to_string()
    }

    fn set(&mut self, path: &[&str], new: Value) {
        let mut item = self.document.as_item_mut();
        for key in path {
            item = &mut item[*key];
        }
        let old = item.as_value().map(|it| it.decor().clone());
        *item = value(new);
        if let (Some(decor), Some(new)) = (old, item.as_value_mut()) {
            *new.decor_mut() = decor;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Text;

    #[test]
    fn the_rest_of_the_text_stays() {
        let text = "# top\n[C_L] # lift\n\"alpha\" = { value = 1.0, unit = \"1/rad\" } # slope\n\"1\" = { value = 2, unit = \"1\" }\n";
        let mut edit = Text::parse(text.to_owned()).expect("a table").edit();
        edit.number(&["C_L", "alpha", "value"], 4.5);
        edit.text(&["C_L", "alpha", "status"], "derived");
        edit.remove(&["C_L", "1"]);
        edit.remove(&["C_D", "1"]);
        edit.number(&["C_L", "alpha^2", "value"], -1.0);
        let wanted = "# top\n[C_L] # lift\n\"alpha\" = { value = 4.5, unit = \"1/rad\" , status = \"derived\" } # slope\n\
                      \"alpha^2\" = { value = -1.0 }\n";
        let found = edit.into_text();
        assert_eq!(found.replace(" ,", ","), wanted.replace(" ,", ","));
    }
}
