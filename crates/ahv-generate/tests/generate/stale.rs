//! What is derived again: everything but a changed value.

use crate::again::assert_as_from_nothing;
use crate::scratch::Scratch;
use ahv_codegen::{Manifest, sha256};
use std::fs;

const COM: &str = "generator/tables/com.toml";
const DCOM: &str = "generator/tables/dcom.toml";
const MANIFEST: &str = "generated/manifest.json";

/// Everything else that the derivation reads: table, text, what takes its place, `\n` for an end of a line.
const STRUCTURE: &str = r#"
dcom | [C_D]\n | [C_D]\n"alpha^3" = { value = 0.1, unit = "1/rad^3" }\n
dcom | "delta_e" = { value = 0.76224, unit = "1/rad" }\n | (nothing)
dcom | "alpha^2" = | "alpha^4" =
dcom | unit = "slug/ft" | unit = "slug/ft^1"
dcom | units = "ft-slug-s-rad" | units = "si"
dcom | source = "plate" | source = "table-3"
dcom | status = "derived" | status = "assumed"
dcom | uncertainty = 0 | uncertainty = 1
dcom | "sdcom_printed",  | (nothing)
dcom | \n[sets."section5.3" | \n[sets.new.vehicle]\nm = { value = 1.0, unit = "slug/ft" }\n[sets."section5.3"
dcom | \n[sets."section5.3".modes] | \n[sets."section5.4".modes]
dcom | set = "section5.1" | set = "section5.2"
dcom | canard = "none" | canard = "slaved"
dcom | velocity = { | velocities = {
dcom | value = 4.6773 | value = nan
dcom | value = 4.6773 | value = "4.6773"
com | "1" = { | "1" = { source = "no",
"#;

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
pub(crate) fn change_manifest(scratch: &Scratch, change: impl FnOnce(&mut Manifest)) {
    let mut manifest = Manifest::parse(&scratch.read(MANIFEST)).expect("a manifest");
    change(&mut manifest);
    scratch.write(MANIFEST, manifest.sealed().render());
}

#[test]
fn everything_else_in_a_table_is_derived_again() {
    let scratch = recorded();
    for line in STRUCTURE.trim().lines() {
        let line = line.replace("\\n", "\n").replace("(nothing)", "");
        let [name, from, to] = line.split(" | ").collect::<Vec<_>>()[..] else {
            panic!("{line}");
        };
        let table = &format!("generator/tables/{name}.toml");
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
