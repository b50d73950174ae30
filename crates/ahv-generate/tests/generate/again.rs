//! Generation of a tree that is there already: what has not changed is neither derived nor emitted, and the tree is the
//! same as from nothing.

use crate::scratch::Scratch;
use crate::stale::change_manifest;
use ahv_codegen::sha256;
use std::fs;

const COM: &str = "generator/tables/com.toml";
const DCOM: &str = "generator/tables/dcom.toml";
const NO_PYTHON: &str = "/nowhere/python";

/// Values: table, what stands there, and what is written in its place.
const VALUES: [(&str, &str, &str); 9] = [
    (
        DCOM,
        "\"alpha\" = { value = 4.6773,",
        "\"alpha\" = { value = 4.7773,",
    ),
    (DCOM, "value = 4.6773,", "value = 0.0,"),
    (DCOM, "value = 4.6773,", "value = 1,"),
    (DCOM, "value = 4.6773,", "value = -4.6773e-300,"),
    // Of a set, of the box, and of a table that has no more than that.
    (DCOM, "m = { value = 191.3,", "m = { value = 192.3,"),
    (
        DCOM,
        "min = 7000.0, max = 11000.0",
        "min = 6900, max = 12000.0",
    ),
    (COM, "max = 11000.0", "max = 12000.0"),
    (
        "generator/tables/flexible_mode.toml",
        "value = 0.7, unit",
        "value = 0.71, unit",
    ),
    // A value is the same in other digits.
    (DCOM, "value = 4.6773,", "value = 46.773e-1,"),
];

/// The tree is the one that a generation into an empty folder gives.
#[track_caller]
pub(crate) fn assert_as_from_nothing(scratch: &Scratch, what: &str) {
    let _ = fs::remove_dir_all(scratch.path("elsewhere"));
    scratch
        .generate(&["--out", "elsewhere"])
        .expect("generated");
    let [tree, whole] = ["generated", "elsewhere"].map(|folder| {
        let root = scratch.path(folder);
        let relative = |(path, text): (std::path::PathBuf, Vec<u8>)| {
            let path = path.strip_prefix(&root).expect("below it").to_owned();
            (path, String::from_utf8(text).expect("text"))
        };
        scratch
            .snapshot(folder)
            .into_iter()
            .map(relative)
            .collect::<Vec<_>>()
    });
    for (one, other) in tree.iter().zip(&whole) {
        assert!(
            one == other,
            "{what}: {:?} differs from {:?}",
            one.0,
            other.0
        );
    }
    assert_eq!(tree.len(), whole.len(), "{what}");
}

#[test]
fn a_changed_value_starts_no_python() {
    let mut scratch = Scratch::new();
    let python = scratch.python();
    for (table, from, to) in VALUES {
        let before = scratch.read(table);
        scratch.edit(table, from, to);
        scratch.use_python(NO_PYTHON);
        let generated = scratch.generate(&[]).expect("generated without Python");
        assert!(
            generated.json().contains("\"derived\": []"),
            "{}",
            generated.json()
        );
        scratch.use_python(&python);
        assert_as_from_nothing(&scratch, to);
        scratch.write(table, before);
    }
}

#[test]
fn comments_layout_and_the_order_of_sections_start_no_python_and_change_nothing() {
    let mut scratch = Scratch::new();
    scratch.use_python(NO_PYTHON);
    let before = scratch.snapshot("generated");
    scratch.edit(DCOM, "[C_D]\n", "# drag\n[C_D]   # polar\n\n");
    scratch.edit(DCOM, "unit = \"1/rad\" }", "unit  =  '1/rad'  }");
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(text.starts_with("nothing changed"), "{text}");
    assert!(before == scratch.snapshot("generated"));
}

#[test]
fn files_of_another_emitter_are_emitted_again() {
    let mut scratch = Scratch::new();
    scratch.use_python(NO_PYTHON);
    let whole = scratch.snapshot("generated");
    // What that one wrote is what its manifest says.
    for file in ["src/dcom/drift.rs", "docs/passes.md", "docs/com.md"] {
        let path = format!("generated/{file}");
        scratch.write(&path, scratch.read(&path) + "\n");
        let hash = sha256(&scratch.read(&path));
        change_manifest(&scratch, |it| drop(it.files.insert(file.to_owned(), hash)));
    }
    let vouched = scratch.generate(&[]).expect("generated").text();
    assert!(vouched.starts_with("nothing changed"), "{vouched}");
    change_manifest(&scratch, |it| it.emitter_sources = sha256("another"));
    scratch.generate(&[]).expect("generated");
    assert!(whole == scratch.snapshot("generated"));
}

/// Hashes that fit are believed, but not by the check, whose advice then helps.
#[test]
fn what_only_a_derivation_finds_is_mended_by_one() {
    let scratch = Scratch::new();
    let whole = scratch.snapshot("generated");
    scratch.edit(
        "generated/ir/com.json",
        "\"title\": \"",
        "\"title\": \"new ",
    );
    let hash = sha256(&scratch.read("generated/ir/com.json"));
    change_manifest(&scratch, |it| drop(it.ir.insert("com".to_owned(), hash)));
    scratch.generate(&[]).expect("generated");
    let text = scratch.disagreement(&[]);
    assert!(text.ends_with("run:  ahv generate --derive\n"), "{text}");
    scratch.generate(&["--derive"]).expect("generated");
    assert!(whole == scratch.snapshot("generated"));
}

#[test]
fn a_bad_value_is_refused_without_python() {
    let mut scratch = Scratch::new();
    scratch.use_python(NO_PYTHON);
    for (from, to, fault, place) in [
        (
            "m = { value = 300.0",
            "m = { value = -300.0",
            "`m` (vehicle mass) must be positive [positive]",
            "m = { value = -300.0",
        ),
        (
            "m = { value = 191.3",
            "m = { value = 0",
            "`m` (vehicle mass) must be positive [positive]",
            "m = { value = 0",
        ),
        (
            "min = 7000.0",
            "min = 11000.0",
            "`min` must be below `max` [range]",
            "velocity = { min = 11000.0",
        ),
        (
            "\"delta_c\" = { value = 0.44838",
            "\"delta_c\" = { value = 0.0",
            "law (4) divides by",
            "\"delta_c\" = { value = 0.0",
        ),
    ] {
        let before = scratch.read(DCOM);
        scratch.edit(DCOM, from, to);
        let message = scratch.refusal_of(&[]);
        assert!(message.contains(fault), "{message}");
        let text = scratch.read(DCOM);
        let line = 1 + text
            .lines()
            .position(|it| it.starts_with(place))
            .expect("there");
        let column = place.rfind("= ").expect("a number") + 3;
        assert!(
            message.contains(&format!("dcom.toml:{line}:{column}]")),
            "{line}:{column}: {message}"
        );
        scratch.write(DCOM, before);
    }
}

/// Edits at random, of values and of generated files: the tree is always the one from nothing.
#[test]
fn any_edits_give_the_tree_from_nothing() {
    let mut scratch = Scratch::new();
    let python = scratch.python();
    let mut state = 2_u64;
    let mut random = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        usize::try_from(state >> 33).expect("31 bits") % below
    };
    for round in 0..5 {
        for _ in 0..=random(3) {
            let table = [DCOM, COM][random(2)];
            let text = scratch.read(table);
            let places: Vec<usize> = text
                .match_indices("{ value = ")
                .map(|(at, it)| at + it.len())
                .collect();
            let at = places[random(places.len())];
            let end = at + text[at..].find(',').expect("a unit");
            let value: f64 = text[at..end].trim().parse().expect("a number");
            // Not so far that a rule could break.
            let value = value * (1.0 + 1e-3 * (1 + random(9)) as f64);
            scratch.write(table, format!("{}{value:?}{}", &text[..at], &text[end..]));
        }
        for _ in 0..random(3) {
            let files = scratch.snapshot("generated/src");
            let (path, text) = &files[random(files.len())];
            match random(2) {
                0 => fs::remove_file(path).expect("removed"),
                _ => fs::write(path, [text.as_slice(), b"// mine\n"].concat()).expect("written"),
            }
        }
        scratch.use_python(NO_PYTHON);
        scratch.generate(&[]).expect("generated without Python");
        scratch.use_python(&python);
        assert_as_from_nothing(&scratch, &format!("round {round}"));
    }
}

#[test]
fn options_of_another_run_are_not_taken_for_these() {
    let mut scratch = Scratch::new();
    let whole = scratch.snapshot("generated");
    let python = scratch.python();
    for line in [
        &["--units", "si"][..],
        &["--package", "my-models"],
        &["--core-workspace"],
        &["--without-pass", "hoisting"],
    ] {
        scratch.use_python(NO_PYTHON);
        scratch.generate(line).expect("generated without Python");
        scratch.use_python(&python);
        let _ = fs::remove_dir_all(scratch.path("elsewhere"));
        scratch
            .generate(&[line, &["--out", "elsewhere"]].concat())
            .expect("generated");
        let texts = |folder: &str| {
            scratch
                .snapshot(folder)
                .into_iter()
                .map(|it| it.1)
                .collect::<Vec<_>>()
        };
        assert!(texts("generated") == texts("elsewhere"), "{line:?}");
        scratch.use_python(NO_PYTHON);
        scratch.generate(&[]).expect("generated without Python");
        assert!(whole == scratch.snapshot("generated"), "{line:?}");
    }
}
