//! Tables: places of their entries, and their hash.

use ahv_codegen::{Part, Table};

#[test]
fn spans_point_at_keys_and_values() {
    let text = "[table]\nname = \"t\"\n[C_L]\n\"alpha\" = { value = 4.5, unit = \"1/rad\" }\n";
    let table = Table::parse("t.toml", text).unwrap();
    let at = |path: &[&str], part| &text[table.span(path, part).unwrap()];
    assert_eq!(at(&["C_L", "alpha"], Part::Key), "\"alpha\"");
    assert_eq!(at(&["C_L", "alpha", "value"], Part::Value), "4.5");
    assert_eq!(at(&["C_L", "alpha", "unit"], Part::Key), "unit");
    // What is missing is shown at what should hold it.
    assert_eq!(at(&["C_L", "beta"], Part::Key), "C_L");
    assert!(table.span(&["C_D"], Part::Key).is_none());
}

#[test]
fn text_that_is_not_toml_has_a_place() {
    let error = Table::parse("t.toml", "[C_L]\n\"alpha\" = \n").unwrap_err();
    assert!(error.span.is_some(), "{error:?}");
    let twice = Table::parse("t.toml", "[C_L]\na = 1\na = 2\n").unwrap_err();
    assert!(twice.message.contains("duplicate key"), "{twice:?}");
    assert!(twice.span.is_some());
}

#[test]
fn the_hash_is_that_of_the_values() {
    let hash = |text: &str| Table::parse("t.toml", text).unwrap().sha256();
    let plain = hash("[a]\nb = 1.0\nc = 2.0\n");
    assert_eq!(plain, hash("# a comment\n[a]\nc = 2.0\nb = 1.00\n"));
    assert_ne!(plain, hash("[a]\nb = 1.0\nc = 2.1\n"));
}
