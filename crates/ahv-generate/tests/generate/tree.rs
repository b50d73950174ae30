//! What is written and what is found, for trees in every state.

use crate::scratch::Scratch;
use std::fs;
use std::time::{Duration, SystemTime};

const DCOM: &str = "generator/tables/dcom.toml";
const NOMINAL: &str = "generated/src/dcom/nominal.rs";

#[test]
fn a_tree_that_agrees_is_left_alone() {
    let scratch = Scratch::new();
    let before = scratch.snapshot("");
    assert!(scratch.check(&[]).expect("checked").agrees());
    assert!(scratch.check(&["--from-ir"]).expect("checked").agrees());
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(text.starts_with("nothing changed (derive "), "{text}");
    assert!(before == scratch.snapshot(""));
}

#[test]
fn a_changed_value_changes_one_line() {
    let scratch = Scratch::new();
    scratch.edit(DCOM, "value = 4.6773,", "value = 4.7773,");
    for line in [&[][..], &["--from-ir"]] {
        let text = scratch.disagreement(line);
        assert!(
            text.contains(&format!("error: {NOMINAL} does not match {DCOM}\n")),
            "{text}"
        );
        // Of the Rust, that is all.
        assert_eq!(text.matches("error: generated/src/").count(), 1, "{text}");
        assert!(
            text.contains(&format!("--- a/{NOMINAL}\n+++ b/{NOMINAL}\n@@ -")),
            "{text}"
        );
        assert!(
            text.contains("-    c_l_alpha: 4.6773,\n+    c_l_alpha: 4.7773,\n"),
            "{text}"
        );
        assert!(
            text.ends_with("To bring them up to date, run:  ahv generate\n"),
            "{text}"
        );
    }
    // The code comes first, what follows from it last, and of that only the beginning.
    let text = scratch.disagreement(&[]);
    let at = |what: &str| {
        text.find(what)
            .unwrap_or_else(|| panic!("no {what:?} in {text}"))
    };
    assert!(
        at("error: generated/src/") < at("error: generated/manifest.json"),
        "{text}"
    );
    assert!(
        at("error: generated/manifest.json") < at("error: generated/docs/"),
        "{text}"
    );
    assert!(
        text.contains(" more lines\n")
            && text.contains("\ncode: 1 file, +1 −1\nIR and manifest: 1 file, +8 −8\n"),
        "{text}"
    );
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(text.contains(&format!("{NOMINAL}  +1 −1\n")), "{text}");
    assert!(
        text.contains(" files changed, 0 created, 0 removed (derive "),
        "{text}"
    );
    assert_eq!(text.matches("generated/src/").count(), 1, "{text}");
    // The code comes first. The manifest: the hash of the table, of each file that shows the value, and its own.
    let files = text
        .lines()
        .filter(|it| it.starts_with("generated/"))
        .count()
        - 1;
    let count = format!("+{0} −{0}\n", 2 + files);
    let first = format!("{NOMINAL}  +1 −1\ngenerated/manifest.json  {count}generated/docs/");
    assert!(text.starts_with(&first), "{text}");
    let summary =
        format!("code: 1 file, +1 −1\nIR and manifest: 1 file, {count}documentation: 5 files, +");
    assert!(text.contains(&summary), "{text}");
    assert!(scratch.check(&[]).expect("checked").agrees());
}

#[test]
fn a_hand_edit_is_found_and_mended() {
    let scratch = Scratch::new();
    let before = scratch.snapshot("generated");
    scratch.edit("generated/src/dcom/drift.rs", "let ", "let mut ");
    let text = scratch.disagreement(&[]);
    assert!(
        text.contains("error: generated/src/dcom/drift.rs does not match"),
        "{text}"
    );
    assert!(
        text.contains("\n1 file differs. To bring it up to date, run:"),
        "{text}"
    );
    scratch.generate(&[]).expect("generated");
    assert!(before == scratch.snapshot("generated"));
}

#[test]
fn conflict_markers_are_mended() {
    let scratch = Scratch::new();
    let before = scratch.snapshot("generated");
    for file in [
        "generated/Cargo.toml",
        "generated/manifest.json",
        "generated/src/lib.rs",
    ] {
        let text = scratch.read(file);
        scratch.write(
            file,
            format!("<<<<<<< ours\n{text}=======\n{text}>>>>>>> theirs\n"),
        );
    }
    assert!(
        scratch
            .disagreement(&["--from-ir"])
            .contains("generated/manifest.json does not match")
    );
    assert!(scratch.disagreement(&[]).contains("3 files differ."));
    scratch.generate(&[]).expect("generated");
    assert!(before == scratch.snapshot("generated"));
}

#[test]
fn missing_and_stray_files_count() {
    let scratch = Scratch::new();
    let before = scratch.snapshot("generated");
    fs::remove_file(scratch.path(NOMINAL)).expect("removed");
    fs::create_dir(scratch.path("generated/src/old")).expect("made");
    scratch.write("generated/src/old/old.rs", "");
    scratch.list("src/old/old.rs");
    let text = scratch.disagreement(&[]);
    assert!(
        text.contains(&format!("error: {NOMINAL} is missing: {DCOM} gives it")),
        "{text}"
    );
    assert!(
        text.contains("error: generated/src/old/old.rs is stray: no table gives it"),
        "{text}"
    );
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(
        text.contains("generated/src/old/old.rs  removed: no table gives it"),
        "{text}"
    );
    assert!(before == scratch.snapshot("generated"));
    assert!(!scratch.path("generated/src/old").exists());
}

#[test]
fn an_empty_folder_is_filled() {
    let scratch = Scratch::new();
    let before = scratch.snapshot("generated");
    fs::remove_dir_all(scratch.path("generated")).expect("removed");
    let text = scratch.disagreement(&["--from-ir"]);
    assert!(
        text.contains("error: generated/ir/com.json is missing"),
        "{text}"
    );
    fs::create_dir(scratch.path("generated")).expect("made");
    scratch.disagreement(&[]);
    scratch.generate(&[]).expect("generated");
    assert!(before == scratch.snapshot("generated"));
}

#[test]
fn line_ends_do_not_count() {
    let scratch = Scratch::new();
    for file in [NOMINAL, "generated/ir/dcom.json", "generated/manifest.json"] {
        scratch.write(file, scratch.read(file).replace('\n', "\r\n"));
    }
    assert!(scratch.check(&[]).expect("checked").agrees());
    assert!(scratch.check(&["--from-ir"]).expect("checked").agrees());
}

#[test]
fn bytes_that_are_not_text_differ() {
    let scratch = Scratch::new();
    let before = scratch.snapshot("generated");
    scratch.write(NOMINAL, b"\xff\xfe");
    scratch.write("generated/ir/com.json", b"\xff\xfe");
    assert!(
        scratch
            .disagreement(&[])
            .contains(&format!("error: {NOMINAL} does not match"))
    );
    assert!(
        scratch
            .disagreement(&["--from-ir"])
            .contains("error: generated/ir/com.json does not")
    );
    scratch.generate(&[]).expect("generated");
    assert!(before == scratch.snapshot("generated"));
}

#[test]
fn an_edited_ir_is_named() {
    let scratch = Scratch::new();
    scratch.edit(
        "generated/ir/dcom.json",
        "\"title\": \"",
        "\"title\": \"My ",
    );
    for line in [&[][..], &["--from-ir"]] {
        let text = scratch.disagreement(line);
        assert!(
            text.contains(&format!("generated/ir/dcom.json does not match {DCOM}")),
            "{text}"
        );
    }
}

#[test]
fn a_table_that_its_ir_does_not_fit_differs() {
    let scratch = Scratch::new();
    scratch.edit(
        DCOM,
        "\"delta_e\" = { value = 0.76224, unit = \"1/rad\" }\n",
        "",
    );
    let text = scratch.disagreement(&["--from-ir"]);
    assert!(
        text.contains(&format!("generated/ir/dcom.json does not match {DCOM}")),
        "{text}"
    );
}

#[test]
fn an_ir_of_another_schema_version_is_refused() {
    let scratch = Scratch::new();
    scratch.edit(
        "generated/ir/dcom.json",
        "\"schema_version\": 5",
        "\"schema_version\": 99",
    );
    let failure = scratch
        .check(&["--from-ir"])
        .err()
        .expect("refused")
        .to_string();
    assert!(
        failure.starts_with("error: ") && failure.contains("99"),
        "{failure}"
    );
    assert_eq!(failure.lines().count(), 1, "{failure}");
}

#[test]
fn a_hidden_file_is_never_removed() {
    let scratch = Scratch::new();
    let before = scratch.snapshot("generated");
    let hour_ago = SystemTime::now() - Duration::from_secs(3600);
    // As a run that was killed leaves them: a name is no proof of who wrote a file.
    for name in ["generated/.ahv-Ab3dEf", "generated/src/.ahv-mynote"] {
        scratch.write(name, "notes");
        let file = fs::File::options().write(true).open(scratch.path(name));
        file.expect("open").set_modified(hour_ago).expect("set");
    }
    scratch.write("generator/tables/.#dcom.toml", "a lock");
    scratch.generate(&[]).expect("generated");
    for name in ["generated/.ahv-Ab3dEf", "generated/src/.ahv-mynote"] {
        fs::remove_file(scratch.path(name)).expect("still there");
    }
    assert!(before == scratch.snapshot("generated"));
}

#[test]
fn a_file_in_the_way_of_a_folder_leaves_the_tree_as_it_was() {
    let scratch = Scratch::new();
    fs::remove_dir_all(scratch.path("generated/src/com")).expect("removed");
    scratch.write("generated/src/com", "in the way");
    scratch.edit(DCOM, "value = 4.6773,", "value = 4.7773,");
    let message = scratch.refusal();
    assert!(message.contains("cannot make the folder"), "{message}");
    assert!(message.contains("generated/src/com"), "{message}");
}

#[test]
fn the_command_names_the_flags_that_were_given() {
    let scratch = Scratch::new();
    let line = ["--package", "my-models", "--core-path", "../my core"];
    let text = scratch.disagreement(&line);
    assert!(
        text.ends_with("ahv generate --package my-models --core-path '../my core'\n"),
        "{text}"
    );
    let text = scratch.disagreement(&["--core-workspace"]);
    assert!(text.contains("+ahv-core.workspace = true\n"), "{text}");
    assert!(text.ends_with("ahv generate --core-workspace\n"), "{text}");
    // Where the generator itself is at home, the command is one that needs no models to compile.
    fs::create_dir(scratch.path("generator/ahv_generator")).expect("made");
    let text = scratch.disagreement(&line);
    assert!(
        text.contains("run:  cargo xtask generate --package my-models"),
        "{text}"
    );
}

#[test]
fn si_is_a_flag_that_the_command_keeps() {
    let scratch = Scratch::new();
    assert!(!scratch.check(&["--units", "si"]).expect("checked").agrees());
    assert!(
        scratch
            .check(&["--units", "ft-slug-s-rad"])
            .expect("checked")
            .agrees()
    );
    scratch.generate(&["--units", "si"]).expect("generated");

    let nominal = scratch.read(NOMINAL);
    // 300 slug/ft and 17 ft; of the set section5.3, 191.3 slug/ft; 7000 ft/s of the box.
    for line in [
        "UNIT_SYSTEM: &str = \"si\";",
        "    m: 14364.07769",
        "    s: 5.1816",
        "    m: 9159.49354",
        "    velocity: Bounds::new(2133.6, ",
    ] {
        assert!(nominal.contains(line), "no {line:?} in\n{nominal}");
    }
    assert!(
        scratch
            .read("generated/src/dcom/parameters.rs")
            .contains("m: [\"kg/m\", \"kg/m\", 1.0]")
    );
    let module = scratch.read("generated/src/dcom/mod.rs");
    assert!(
        module.contains("m/s") && !module.contains("ft/s"),
        "{module}"
    );
    assert!(
        scratch
            .read("generated/src/lib.rs")
            .contains("metre, kilogram, second and radian")
    );
    for page in ["generated/docs/dcom.md", "generated/docs/dcom-table.md"] {
        let text = scratch.read(page);
        // The table's page ends with what each unit is in the other system.
        let own = text
            .split("One unit of this table")
            .next()
            .unwrap_or_default();
        assert!(own.contains("kg") && !own.contains("slug/"), "{page}");
    }

    for line in [&["--units", "si"][..], &["--units", "si", "--from-ir"]] {
        assert!(scratch.check(line).expect("checked").agrees(), "{line:?}");
    }
    let text = scratch.disagreement(&[]);
    assert!(
        text.contains("error: generated/src/dcom/nominal.rs does not match"),
        "{text}"
    );
    assert!(text.ends_with("run:  ahv generate\n"), "{text}");
    scratch.edit(NOMINAL, "    s: 5.1816", "    s: 5.1");
    let text = scratch.disagreement(&["--units", "si"]);
    assert!(text.ends_with("run:  ahv generate --units si\n"), "{text}");
}

#[test]
fn tables_in_two_unit_systems_need_a_choice() {
    let mut scratch = Scratch::new();
    let ir = scratch.path("generated/ir/flexible_mode.json");
    let system = "s/\"system\": \"ft-slug-s-rad\"/\"system\": \"si\"/; s/\"other\": \"si\"/\"other\": \"ft-slug-s-rad\"/";
    let folder = ir.parent().expect("a folder").display();
    let derive = format!("cp {folder}/*.json \"$8\"; sed -i '{system}' \"$8/flexible_mode.json\"");
    scratch.use_python(scratch.interpreter("3 11", "", &derive));
    let message = scratch.refusal();
    assert_eq!(
        message,
        "error: the tables are in different unit systems; choose one with --units"
    );
    assert!(scratch.generate(&["--units", "si", "--derive"]).is_ok());
}

#[test]
fn json_says_the_same() {
    let scratch = Scratch::new();
    let json = |text: String| serde_json::from_str::<serde_json::Value>(&text).expect("JSON");
    scratch.edit(NOMINAL, "c_l_alpha: 4.6773", "c_l_alpha: 4.7");
    fs::remove_file(scratch.path("generated/src/lib.rs")).expect("removed");
    scratch.write("generated/src/stray.rs", "");
    scratch.list("src/stray.rs");
    scratch.write("generated/src/mine.rs", "");

    let checked = json(scratch.check(&[]).expect("checked").json());
    assert_eq!(checked["agree"], false);
    assert_eq!(checked["command"], "ahv generate");
    let differing = checked["differing"].as_array().expect("a list");
    let found = |path: &str| {
        differing
            .iter()
            .find(|it| it["path"] == path)
            .expect("named")
    };
    assert_eq!(found(NOMINAL)["status"], "differs");
    assert!(
        found(NOMINAL)["diff"]
            .as_str()
            .expect("text")
            .contains("-    c_l_alpha: 4.7,\n")
    );
    assert_eq!(found("generated/src/lib.rs")["status"], "missing");
    assert_eq!(found("generated/src/stray.rs")["status"], "stray");
    assert!(found("generated/src/stray.rs")["kept"].is_null());
    assert_eq!(found("generated/src/mine.rs")["kept"], "unlisted");

    let done = json(scratch.generate(&[]).expect("generated").json());
    assert_eq!(done["up_to_date"], false);
    let line = serde_json::json!({ "path": NOMINAL, "added": 1, "removed": 1 });
    assert_eq!(done["changed"][0], line);
    assert_eq!(done["changed"][1]["path"], "generated/manifest.json");
    assert_eq!(done["created"], serde_json::json!(["generated/src/lib.rs"]));
    assert_eq!(
        done["removed"],
        serde_json::json!(["generated/src/stray.rs"])
    );
    let kept = serde_json::json!([{ "path": "generated/src/mine.rs", "reason": "unlisted" }]);
    assert_eq!(done["kept"], kept);
    assert!(done["seconds"]["derive"].as_f64() > Some(0.0));
}
