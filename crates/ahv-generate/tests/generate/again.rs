//! Generation of a tree that is there already: what has not changed is neither derived nor emitted, and the tree is the
//! same as from nothing.

use crate::scratch::Scratch;
use ahv_codegen::{Manifest, sha256};
use std::fs;

const COM: &str = "generator/tables/com.toml";
const DCOM: &str = "generator/tables/dcom.toml";
const MANIFEST: &str = "generated/manifest.json";
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

/// Everything else that the derivation reads, in a table with the name of its IR.
const STRUCTURE: [(&str, &str, &str, &str); 17] = [
    (
        "dcom",
        DCOM,
        "[C_D]\n",
        "[C_D]\n\"alpha^3\" = { value = 0.1, unit = \"1/rad^3\" }\n",
    ),
    (
        "dcom",
        DCOM,
        "\"delta_e\" = { value = 0.76224, unit = \"1/rad\" }\n",
        "",
    ),
    ("dcom", DCOM, "\"alpha^2\" =", "\"alpha^4\" ="),
    ("dcom", DCOM, "unit = \"slug/ft\"", "unit = \"slug/ft^1\""),
    ("dcom", DCOM, "units = \"ft-slug-s-rad\"", "units = \"si\""),
    ("dcom", DCOM, "source = \"plate\"", "source = \"table-3\""),
    ("dcom", DCOM, "status = \"derived\"", "status = \"assumed\""),
    ("dcom", DCOM, "uncertainty = 0", "uncertainty = 1"),
    ("dcom", DCOM, "\"sdcom_printed\", ", ""),
    (
        "dcom",
        DCOM,
        "\n[sets.\"section5.3\"",
        "\n[sets.new.vehicle]\nm = { value = 1.0, unit = \"slug/ft\" }\n[sets.\"section5.3\"",
    ),
    (
        "dcom",
        DCOM,
        "\n[sets.\"section5.3\".modes]",
        "\n[sets.\"section5.4\".modes]",
    ),
    ("dcom", DCOM, "set = \"section5.1\"", "set = \"section5.2\""),
    ("dcom", DCOM, "canard = \"none\"", "canard = \"slaved\""),
    ("dcom", DCOM, "velocity = {", "velocities = {"),
    ("dcom", DCOM, "value = 4.6773", "value = nan"),
    ("dcom", DCOM, "value = 4.6773", "value = \"4.6773\""),
    ("com", COM, "\"1\" = {", "\"1\" = { source = \"no\","),
];

/// A project whose interpreter keeps a list of its calls.
fn recorded() -> Scratch {
    let mut scratch = Scratch::new();
    let (calls, ir) = (scratch.path("calls"), scratch.path("../ir"));
    let derive = format!(
        "echo \"$@\" >> {}; cp {}/*.json \"$8\"",
        calls.display(),
        ir.display()
    );
    scratch.use_python(scratch.interpreter("3 11", "", &derive));
    scratch
}

/// What the interpreter was asked to derive since the last time.
fn calls(scratch: &Scratch) -> String {
    let calls = fs::read_to_string(scratch.path("calls")).unwrap_or_default();
    let _ = fs::remove_file(scratch.path("calls"));
    calls
}

/// The manifest, changed, with a seal that fits.
fn change_manifest(scratch: &Scratch, change: impl FnOnce(&mut Manifest)) {
    let mut manifest = Manifest::parse(&scratch.read(MANIFEST)).expect("a manifest");
    change(&mut manifest);
    scratch.write(MANIFEST, manifest.sealed().render());
}

/// The tree is the one that a generation into an empty folder gives.
#[track_caller]
fn assert_as_from_nothing(scratch: &Scratch, what: &str) {
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
fn everything_else_in_a_table_is_derived_again() {
    let scratch = recorded();
    for (name, table, from, to) in STRUCTURE {
        let before = (scratch.read(table), scratch.snapshot("generated"));
        scratch.edit(table, from, to);
        // What the stand-in derives need not fit the table.
        let _ = scratch.generate(&[]);
        let calls = calls(&scratch);
        assert!(calls.contains(" derive --out "), "{to}: not derived");
        assert!(
            !calls.contains(&format!("--known {name} ")),
            "{to}: {calls}"
        );
        assert!(
            calls.contains("--known flexible_mode ") && calls.contains("--audit-known"),
            "{to}: {calls}"
        );
        scratch.write(table, before.0);
        for (path, text) in before.1 {
            fs::write(path, text).expect("written");
        }
        assert!(
            scratch.generate(&[]).is_ok() && self::calls(&scratch).is_empty(),
            "{to}"
        );
    }
}

#[test]
fn the_check_from_the_ir_says_that_the_structure_changed() {
    let scratch = Scratch::small();
    for (from, to) in [
        ("status = \"published\"", "status = \"derived\""),
        ("value = 0.7,", "value = \"0.7\","),
    ] {
        let table = "generator/tables/flexible_mode.toml";
        let before = scratch.read(table);
        scratch.edit(table, from, to);
        // With the second nothing can be emitted.
        let text = scratch.disagreement(&["--from-ir"]);
        let reason = format!(
            "ir/flexible_mode.json does not match {table}: the structure of the table has changed"
        );
        assert!(text.contains(&reason), "{text}");
        scratch.write(table, before);
    }
    change_manifest(&scratch, |it| it.generator = sha256(""));
    let text = scratch.disagreement(&["--from-ir"]);
    assert!(
        text.contains(": another version of the generator derived it"),
        "{text}"
    );
}

#[test]
fn the_order_of_entries_is_structure() {
    let scratch = recorded();
    let text = scratch.read(COM);
    let at = text.find("[C_L]\n").expect("a section") + "[C_L]\n".len();
    let mut lines: Vec<&str> = text[at..].split_inclusive('\n').collect();
    lines.swap(0, 1);
    scratch.write(COM, text[..at].to_owned() + &lines.concat());
    scratch.generate(&[]).expect("generated");
    assert!(calls(&scratch).contains("--known dcom --known flexible_mode --audit-known"));
}

#[test]
fn a_table_that_comes_goes_or_is_renamed_is_derived() {
    let scratch = recorded();
    fs::rename(scratch.path(COM), scratch.path("generator/tables/a.toml")).expect("renamed");
    scratch.generate(&[]).expect("generated");
    assert!(calls(&scratch).contains("--known dcom --known flexible_mode --audit-known"));
    assert_as_from_nothing(&scratch, "renamed");
    calls(&scratch);

    // With the table of the printed equations the audit goes, which only the derivation knows.
    let dcom = scratch.read(DCOM);
    fs::remove_file(scratch.path(DCOM)).expect("removed");
    let audit = fs::read(scratch.path("../ir/audit.json")).expect("an audit");
    fs::remove_file(scratch.path("../ir/audit.json")).expect("removed");
    scratch.generate(&[]).expect("generated");
    assert!(calls(&scratch).contains("--known com --known flexible_mode --audit-known"));
    assert!(!scratch.path("generated/ir/audit.json").exists());
    assert_as_from_nothing(&scratch, "removed");
    calls(&scratch);

    scratch.write(DCOM, dcom);
    fs::write(scratch.path("../ir/audit.json"), audit).expect("written");
    scratch.generate(&[]).expect("generated");
    let calls = calls(&scratch);
    assert!(
        calls.contains("--known com --known flexible_mode ") && !calls.contains("--audit-known"),
        "{calls}"
    );
    assert_as_from_nothing(&scratch, "added");
}

#[test]
fn what_the_manifest_does_not_vouch_for_is_derived() {
    type Change = fn(&Scratch);
    let changes: [(&str, Change, bool); 9] = [
        (
            "another generator",
            |it| change_manifest(it, |m| m.generator = sha256("")),
            true,
        ),
        (
            "another CasADi",
            |it| {
                it.edit(
                    "generated/ir/dcom.json",
                    "\"casadi\": \"",
                    "\"casadi\": \"9.",
                );
                let hash = sha256(&it.read("generated/ir/dcom.json"));
                change_manifest(it, |m| drop(m.ir.insert("dcom".to_owned(), hash)));
            },
            false,
        ),
        (
            "an edited IR",
            |it| it.edit("generated/ir/dcom.json", "lift", "life"),
            false,
        ),
        (
            "an edited audit",
            |it| it.edit("generated/ir/audit.json", "\"", "\" "),
            false,
        ),
        (
            "an IR that has gone",
            |it| fs::remove_file(it.path("generated/ir/com.json")).expect("removed"),
            false,
        ),
        (
            "no manifest",
            |it| fs::remove_file(it.path(MANIFEST)).expect("removed"),
            true,
        ),
        (
            "an older manifest",
            |it| change_manifest(it, |m| m.structure.clear()),
            false,
        ),
        (
            "a merged manifest",
            |it| {
                let other = sha256("the other side");
                let own = Manifest::parse(&it.read(MANIFEST))
                    .expect("a manifest")
                    .emitter_sources;
                it.edit(MANIFEST, &own, &other);
            },
            true,
        ),
        (
            "a conflict",
            |it| {
                let text = it.read(MANIFEST);
                it.write(
                    MANIFEST,
                    format!("<<<<<<< a\n{text}=======\n{text}>>>>>>> b\n"),
                );
            },
            true,
        ),
    ];
    let scratch = recorded();
    let whole = scratch.snapshot("generated");
    for (what, change, all) in changes {
        change(&scratch);
        scratch.generate(&[]).expect("generated");
        let calls = calls(&scratch);
        assert!(calls.contains(" derive --out "), "{what}: not derived");
        assert!(!(all && calls.contains("known")), "{what}: {calls}");
        assert!(
            whole == scratch.snapshot("generated"),
            "{what}: another tree"
        );
    }
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
