//! What an emission takes from an earlier tree.

use std::fs;

use ahv_codegen::{Earlier, Known, Manifest, Options, Table, emit_again, sha256};

use crate::{TABLES, irs, parsed, root, table, text_of};

#[test]
fn emission_gives_the_checked_in_tree() {
    let manifest = fs::read_to_string(root().join("generated/manifest.json")).unwrap();
    let Manifest {
        generator,
        structure,
        ..
    } = Manifest::parse(&manifest).unwrap();
    let known = Known {
        generator,
        structure,
        earlier: None,
    };
    let tree = emit_again(&TABLES.map(table), &irs(), &Options::default(), &known).unwrap();
    for (path, text) in &tree {
        let kept = fs::read_to_string(root().join("generated").join(path)).unwrap();
        assert!(*text == kept, "{path} differs; run `cargo xtask generate`");
    }
}

/// An emission that knows an earlier tree gives the same as one that does not.
#[test]
fn what_is_known_is_taken_and_the_tree_is_the_same() {
    let structure = || TABLES.map(|name| (name.to_owned(), sha256(name)));
    let emit = |tables: &[Table], earlier| {
        let (generator, structure) = (sha256("generator"), structure().into());
        let known = Known {
            generator,
            structure,
            earlier,
        };
        emit_again(tables, &irs(), &Options::default(), &known).unwrap()
    };
    let old = emit(&TABLES.map(table), None);
    let manifest = || Manifest::parse(&old["manifest.json"]).unwrap();
    let text = text_of("dcom").replace("value = 4.6773", "value = 4.7773");
    let tables = [table("com"), parsed("dcom", &text), table("flexible_mode")];
    let new = emit(&tables, None);
    let differing = new
        .iter()
        .filter(|(path, text)| old[*path] != **text)
        .count();
    assert_eq!(differing, 7);
    assert_eq!(
        emit(&tables, Some(Earlier::new(manifest(), old.clone()))),
        new
    );
    // What is not as it was written is no help, nor is a tree of which parts have gone.
    let mut edited = old.clone();
    edited
        .get_mut("src/dcom/drift.rs")
        .unwrap()
        .push_str("// mine\n");
    edited.remove("src/com/drift.rs");
    edited.remove("docs/passes.md");
    assert_eq!(emit(&tables, Some(Earlier::new(manifest(), edited))), new);
    // Of another emitter nothing is taken, though its hashes fit.
    let mut foreign = old.clone();
    foreign.insert("src/com/drift.rs".to_owned(), "foreign".to_owned());
    let mut by_another = manifest();
    by_another
        .files
        .insert("src/com/drift.rs".to_owned(), sha256("foreign"));
    by_another.emitter_sources = sha256("another");
    assert_eq!(emit(&tables, Some(Earlier::new(by_another, foreign))), new);
}
