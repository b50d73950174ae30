//! Names that the generated code cannot have, or has already. The generator has the same list (`names.py`).

/// Of this name is the file beside the IRs that holds the audit of the printed equations.
const AUDIT: &str = "audit";

/// Those of every edition, and those that Rust keeps for later.
const KEYWORDS: &str = " abstract as async await become box break const continue crate do dyn else enum extern false \
    final fn for gen if impl in let loop macro match mod move mut override priv pub ref return self static struct super \
    trait true try type typeof unsafe unsized use virtual where while yield ";

/// What stands in a generated module beside the constants of the sets.
const CONSTANTS: &str = " nominal provenance sets unit_system validity state_bounds input_bounds noise_class \
    noise_commutes table degree ";

/// Files are named after tables; file systems end names at 255 bytes, with what is added to them.
const LONGEST_TABLE: usize = 64;

/// So end the constants of the functions' compressed outputs.
const OF_FUNCTIONS: &str = "_pattern";

pub(crate) const SET_LETTERS: &str = "lower-case letters, digits, `.`, `_`, `-`";

/// Why a table cannot have this name.
pub(crate) fn fault_of_table(name: Option<&str>) -> Option<String> {
    match name {
        Some(name) if is_word(name, "_") => {
            let letters = name.len();
            if letters > LONGEST_TABLE {
                Some(format!(
                    "the name has {letters} letters; it names files, and may have {LONGEST_TABLE}"
                ))
            } else if listed(KEYWORDS, name) {
                Some(format!(
                    "`{name}` is a keyword of Rust; choose another name"
                ))
            } else {
                (name == AUDIT).then(|| {
                    format!("`name` must be other than `{AUDIT}`, which is the audit of the printed equations")
                })
            }
        }
        _ => Some("`name` must be a lower-case identifier: letters a to z, digits, `_`".to_owned()),
    }
}

/// Whether it is a name for a set.
pub(crate) fn is_set(name: &str) -> bool {
    is_word(name, "._-")
}

/// Why a set cannot have this name beside sets that make the constants `taken`, which its own constants join.
pub(crate) fn fault_of_set(name: &str, own: &str, taken: &mut Vec<String>) -> Option<String> {
    const OWN_NAME: &str = "a set has a name of its own";
    if name == own {
        return Some(format!(
            "{OWN_NAME}; `{own}` is that of the table's own values"
        ));
    }
    if !is_set(name) {
        return Some(format!("{OWN_NAME}, of {SET_LETTERS}"));
    }
    let constant = name.replace(['.', '-'], "_");
    let made = [constant.clone(), format!("{constant}_provenance")];
    let clash = made.iter().find(|made| {
        listed(CONSTANTS, made) || taken.contains(made) || made.ends_with(OF_FUNCTIONS)
    });
    if let Some(clash) = clash {
        let clash = clash.to_uppercase();
        return Some(format!(
            "{OWN_NAME}: `{name}` would make the constant {clash} once more"
        ));
    }
    taken.extend(made);
    None
}

/// Whether it begins with a lower-case letter, and goes on with such, digits and `others`.
fn is_word(text: &str, others: &str) -> bool {
    let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || others.contains(c);
    text.starts_with(|c: char| c.is_ascii_lowercase()) && text.chars().all(allowed)
}

fn listed(words: &str, word: &str) -> bool {
    words.split(' ').any(|it| it == word)
}
