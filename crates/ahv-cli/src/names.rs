//! Names that a person types.

/// Similarity above which an unknown name is taken for a slip of a known one.
const SIMILAR: f64 = 0.7;

/// What to say of an unknown `name` of a `kind` of thing: the known ones, and the one that was perhaps meant.
pub(crate) fn unknown(kind: &str, name: &str, known: &[&str]) -> String {
    let all = known.join(", ");
    let name = printable(name);
    let nearest = known
        .iter()
        .map(|known| (strsim::jaro_winkler(&name.to_lowercase(), known), known))
        .filter(|&(similarity, _)| similarity > SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((_, nearest)) => {
            format!("unknown {kind} `{name}`; did you mean `{nearest}`? Known: {all}")
        }
        None => format!("unknown {kind} `{name}`; known: {all}"),
    }
}

/// A text of the user's without what would move the cursor of a terminal.
pub(crate) fn printable(text: &str) -> String {
    let shown = |it: char| match it.is_control() {
        true => it.escape_default().to_string(),
        false => it.to_string(),
    };
    text.chars().map(shown).collect()
}

/// The first name that stands twice.
pub(crate) fn twice(names: &[impl AsRef<str>]) -> Option<&str> {
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    let mut all = names.iter().enumerate();
    all.find_map(|(index, name)| names[..index].contains(name).then_some(*name))
}

/// `a`, `a and b`, `a, b and c`.
pub(crate) fn list(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::list;

    #[test]
    fn names_are_listed() {
        assert_eq!(list(&[]), "");
        assert_eq!(list(&["a"]), "a");
        assert_eq!(list(&["a", "b"]), "a and b");
        assert_eq!(list(&["a", "b", "c"]), "a, b and c");
    }
}
