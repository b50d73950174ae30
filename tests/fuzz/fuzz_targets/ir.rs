//! An intermediate representation, as `ahv generate --check --from-ir` reads it: the document, then the package of its table.
#![no_main]

use std::collections::BTreeMap;
use std::sync::LazyLock;

use ahv_codegen::{Options, Table, emit, ir::Document};
use libfuzzer_sys::fuzz_target;

const TABLE: &str = include_str!("../../../generator/tables/flexible_mode.toml");

fuzz_target!(|text: &str| {
    static TABLES: LazyLock<[Table; 1]> = LazyLock::new(|| {
        [Table::parse("flexible_mode.toml", TABLE).expect("a table of this repository")]
    });
    if Document::parse("flexible_mode", text).is_err() {
        return;
    }
    let irs = BTreeMap::from([("flexible_mode".to_owned(), text.to_owned())]);
    if let Err(error) = emit(&*TABLES, &irs, &Options::default()) {
        assert!(!error.to_string().is_empty());
    }
});
