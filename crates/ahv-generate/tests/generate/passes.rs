//! Trees that were emitted without some pass.

use crate::scratch::Scratch;

#[test]
fn a_tree_without_a_pass_does_not_agree() {
    let scratch = Scratch::new();
    scratch
        .generate(&["--without-pass", "sin-cos", "--without-pass", "hoisting"])
        .expect("generated");
    let manifest = scratch.read("generated/manifest.json");
    assert!(
        manifest.contains("\"without_passes\": [\n    \"hoisting\",\n    \"sin-cos\"\n  ]"),
        "{manifest}"
    );
    for line in [&[][..], &["--from-ir"]] {
        let text = scratch.disagreement(line);
        for file in ["generated/src/dcom/drift.rs", "generated/manifest.json"] {
            assert!(
                text.contains(&format!("error: {file} does not match ")),
                "{text}"
            );
        }
        assert!(
            text.ends_with("To bring them up to date, run:  ahv generate\n"),
            "{text}"
        );
    }
    scratch.generate(&[]).expect("generated");
    assert!(scratch.check(&[]).expect("checked").agrees());
}
