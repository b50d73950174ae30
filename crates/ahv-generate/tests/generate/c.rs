//! The C library: guarded like the Rust, in a folder of its own.

use crate::scratch::Scratch;
use std::fs;

const DCOM: &str = "generator/tables/dcom.toml";
const MODE: &str = "generator/tables/flexible_mode.toml";
const C: [&str; 2] = ["--target", "c"];

/// A project with a C library beside the Rust.
fn with_c() -> Scratch {
    let scratch = Scratch::small();
    scratch.generate(&C).expect("generated");
    scratch
}

#[test]
fn a_library_agrees_beside_the_package() {
    let scratch = with_c();
    for line in [&[][..], &["--from-ir"], &C, &["--target", "c", "--from-ir"]] {
        assert!(scratch.check(line).expect("checked").agrees(), "{line:?}");
    }
    let before = scratch.snapshot("generated");
    for line in [&[][..], &C] {
        let text = scratch.generate(line).expect("generated").text();
        assert!(text.starts_with("nothing changed (derive "), "{text}");
    }
    assert!(before == scratch.snapshot("generated"));
}

/// The derivation gives the audit of printed equations too, which is no part of the library.
#[test]
fn a_changed_value_changes_one_line_of_c() {
    const HEADER: &str = "generated/c/src/dcom_parameters.h";
    let scratch = Scratch::new();
    scratch.generate(&C).expect("generated");
    let from_ir = ["--target", "c", "--from-ir"];
    assert!(scratch.check(&from_ir).expect("checked").agrees());
    scratch.edit(DCOM, "value = 4.6773,", "value = 4.7773,");
    for line in [&C[..], &from_ir] {
        let text = scratch.disagreement(line);
        let start = format!("error: {HEADER} does not match {DCOM}\n--- a/{HEADER}\n");
        assert!(text.starts_with(&start), "{text}");
        assert_eq!(text.matches("error: generated/c/src/").count(), 1, "{text}");
        let lines = "-    4.6773, /* c_l_alpha */\n+    4.7773, /* c_l_alpha */\n";
        assert!(text.contains(lines), "{text}");
        let end = "To bring them up to date, run:  ahv generate --target c\n";
        assert!(text.ends_with(end), "{text}");
    }
    let text = scratch.generate(&C).expect("generated").text();
    assert!(text.contains(&format!("{HEADER}  +1 −1\n")), "{text}");
    assert!(
        text.contains("2 files changed, 0 created, 0 removed"),
        "{text}"
    );
    assert!(scratch.check(&C).expect("checked").agrees());
}

#[test]
fn edited_missing_and_stray_files_are_found_and_mended() {
    let scratch = with_c();
    let before = scratch.snapshot("generated/c");
    scratch.edit("generated/c/src/com.c", "0.5", "0.6");
    fs::remove_file(scratch.path("generated/c/src/com.h")).expect("removed");
    scratch.write("generated/c/src/mine.c", "");
    for line in [&C[..], &["--target", "c", "--from-ir"]] {
        let text = scratch.disagreement(line);
        for found in [
            "error: generated/c/src/com.c does not match generator/tables/com.toml\n",
            "error: generated/c/src/com.h is missing: generator/tables/com.toml gives it\n",
            "error: generated/c/src/mine.c is stray: no table gives it, and ahv did not write it\n",
        ] {
            assert!(text.contains(found), "{text}");
        }
    }
    scratch.generate(&C).expect("generated");
    fs::remove_file(scratch.path("generated/c/src/mine.c")).expect("still there");
    assert!(before == scratch.snapshot("generated/c"));
}

#[test]
fn a_table_that_went_takes_its_c_along() {
    let scratch = with_c();
    fs::remove_file(scratch.path(MODE)).expect("removed");
    scratch.generate(&C).expect("generated");
    for file in ["flexible_mode.c", "flexible_mode_parameters.h"] {
        let path = scratch.path("generated/c/src").join(file);
        assert!(!path.exists(), "{file}");
    }
    assert!(scratch.check(&C).expect("checked").agrees());
}

/// Neither language removes or overwrites the files of the other.
#[test]
fn two_languages_do_not_share_a_folder() {
    let scratch = with_c();
    let before = scratch.snapshot("generated");
    for (line, message) in [
        (
            &["--target", "c", "--out", "generated"][..],
            "generated holds models in Rust; models in C need a folder of their own",
        ),
        (
            &["--out", "generated/c"],
            "generated/c holds models in C; models in Rust need a folder of their own",
        ),
    ] {
        let refused = scratch.generate(line).err().expect("refused").to_string();
        assert!(refused.contains(message), "{refused}");
        assert!(
            refused.contains("name another folder with --out"),
            "{refused}"
        );
        let checked = scratch.check(line).err().expect("refused").to_string();
        assert!(checked.contains(message), "{checked}");
    }
    assert!(before == scratch.snapshot("generated"));
}

#[test]
fn flags_of_a_rust_package_are_refused() {
    let scratch = with_c();
    for (flag, value) in [
        ("--package", Some("my-models")),
        ("--core-path", Some("../core")),
        ("--core-workspace", None),
    ] {
        let line: Vec<&str> = C.into_iter().chain([flag]).chain(value).collect();
        let message = format!("{flag} describes a Rust package, and --target c writes a C library");
        for failure in [scratch.generate(&line).err(), scratch.check(&line).err()] {
            let failure = failure.expect("refused").to_string();
            assert!(failure.contains(&message), "{failure}");
            assert!(failure.contains(&format!("leave {flag} out")), "{failure}");
        }
    }
}

/// Rust has no use for these words; C and C++ have.
#[test]
fn words_of_c_and_cpp_are_refused_for_c_alone() {
    for word in ["register", "new"] {
        let scratch = Scratch::small();
        let table = scratch.read(MODE);
        scratch.write(MODE, table.replace("zeta = {", &format!("{word} = {{")));
        for ir in [
            "../ir/flexible_mode.json",
            "generated/ir/flexible_mode.json",
        ] {
            let text = scratch.read(ir);
            let text = text.replace("\"p.zeta\"", &format!("\"p.{word}\""));
            scratch.write(ir, text.replace("\"zeta\"", &format!("\"{word}\"")));
        }
        scratch.generate(&[]).expect("generated");
        let message = scratch.generate(&C).err().expect("refused").to_string();
        assert_eq!(
            message,
            format!(
                "error: `{word}` of model `flexible_mode` is a word of C or C++; choose another name, or generate Rust \
                 (--target rust)"
            )
        );
        assert!(!scratch.path("generated/c").exists());
    }
}
