//! Nothing that steps is forgotten.
#![forbid(unsafe_code)]

use std::collections::BTreeSet;

const SOURCES: [&str; 4] = [
    include_str!("../src/lib.rs"),
    include_str!("../src/fixed.rs"),
    include_str!("../src/controlled.rs"),
    include_str!("../src/stochastic.rs"),
];

/// Exports of `ahv-integrate` that do nothing by themselves: what is handed over, what comes back, and traits that a type
/// above fulfils.
const PASSIVE: [&str; 16] = [
    "Admits",
    "Anywhere",
    "Attempt",
    "EmbeddedPair",
    "Ending",
    "Failure",
    "HeldColoured",
    "NoiseError",
    "Precision",
    "RosenbrockTableau",
    "Sense",
    "Start",
    "StepError",
    "Tableau",
    "Validity",
    "saturate",
];

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
}

#[test]
fn every_export_of_the_steppers_is_visited() {
    let library = include_str!("../../../crates/ahv-integrate/src/lib.rs");
    let exports: BTreeSet<&str> = library
        .split("pub use ")
        .skip(1)
        .filter_map(|text| text.split_once("::")?.1.split_once(';'))
        .flat_map(|(names, _)| words(names))
        .collect();
    assert!(exports.contains("Rk4") && exports.contains("bisect"));
    let used: BTreeSet<&str> = SOURCES.into_iter().flat_map(words).collect();
    let passive = BTreeSet::from(PASSIVE);
    let forgotten: Vec<_> = exports
        .iter()
        .filter(|name| !used.contains(*name) && !passive.contains(*name))
        .collect();
    assert!(
        forgotten.is_empty(),
        "let tests/steppers visit {forgotten:?}, or say in this test that they do nothing by themselves"
    );
    let stale: Vec<_> = passive.difference(&exports).collect();
    assert!(stale.is_empty(), "no longer exported: {stale:?}");
}

#[test]
fn every_model_is_visited() {
    let library = include_str!("../../../generated/src/lib.rs");
    let used: BTreeSet<&str> = SOURCES.into_iter().flat_map(words).collect();
    let models: Vec<&str> = library
        .split("\npub mod ")
        .skip(1)
        .filter_map(|text| text.split(';').next())
        .collect();
    assert!(models.contains(&"dcom"));
    for model in models {
        assert!(used.contains(model), "let tests/steppers visit {model}");
    }
}
