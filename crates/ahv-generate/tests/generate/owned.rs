//! What belongs to somebody else: files that ahv did not write, and what lies behind links. None of it is lost.

use crate::scratch::Scratch;
use std::fs;
use std::os::unix::fs::symlink;

const COM: &str = "generator/tables/com.toml";
const MODE: &str = "generator/tables/flexible_mode.toml";
const MANIFEST: &str = "generated/manifest.json";
const DRIFT: &str = "generated/src/flexible_mode/drift.rs";

#[test]
fn a_folder_that_was_not_generated_is_not_touched() {
    let scratch = Scratch::small();
    fs::create_dir_all(scratch.path("mine/src")).expect("made");
    scratch.write("mine/src/lib.rs", "//! My work.\n");
    scratch.write("mine/notes.md", "Mine.\n");
    let before = scratch.snapshot("mine");
    let failure = scratch.generate(&["--out", "mine"]).err();
    let failure = failure.expect("refused").to_string();
    assert!(
        failure.contains("mine/src/lib.rs was not generated, and would be lost"),
        "{failure}"
    );
    assert!(before == scratch.snapshot("mine"));
    fs::remove_dir_all(scratch.path("mine/src")).expect("removed");
    scratch.generate(&["--out", "mine"]).expect("generated");
    assert_eq!(scratch.read("mine/notes.md"), "Mine.\n");
}

/// With the keys of one of ahv, too.
#[test]
fn the_manifest_of_another_program_gives_no_leave() {
    let scratch = Scratch::small();
    fs::create_dir_all(scratch.path("ext/src")).expect("made");
    for manifest in [
        "{ \"manifest_version\": 3 }\n",
        "{ \"emitter\": \"rollup\", \"templates\": [] }\n",
        "{ \"schema_version\": 2, \"emitter\": \"0.1.0\", \"tables\": {\"a\": \"1\"}, \"ir\": {}, \"templates\": \"x\" }\n",
    ] {
        scratch.write("ext/manifest.json", manifest);
        scratch.write("ext/src/main.rs", "fn main() {}\n");
        scratch.write("ext/src/lib.rs", "//! See `ahv generate`.\n");
        let before = scratch.snapshot("ext");
        let failure = scratch.generate(&["--out", "ext"]).err();
        let failure = failure.expect("refused").to_string();
        let reason = " was not generated, and would be lost: ext has no manifest.json of ahv";
        assert!(failure.contains(reason), "{failure}");
        assert!(before == scratch.snapshot("ext"));
    }
}

/// A check gives no advice that would be refused.
#[test]
fn a_check_among_files_of_others_says_what_is_in_the_way() {
    let scratch = Scratch::small();
    fs::create_dir_all(scratch.path("ext")).expect("made");
    scratch.write("ext/manifest.json", "{ \"manifest_version\": 3 }\n");
    scratch.write("file", "Mine.\n");
    for (out, why) in [
        (
            "ext",
            "ext/manifest.json was not generated, and would be lost",
        ),
        ("file", "file is not a folder"),
    ] {
        let refused = scratch.generate(&["--out", out]).err().expect("refused");
        assert!(refused.to_string().contains(why), "{refused}");
        let checked = scratch.check(&["--out", out]).expect("checked");
        let text = checked.text();
        assert!(
            text.contains("no command brings them up to date") && text.contains(why),
            "{text}"
        );
        assert!(text.contains("name another folder with --out"), "{text}");
        assert!(!text.contains("run:  "), "{text}");
        let json: serde_json::Value = serde_json::from_str(&checked.json()).expect("JSON");
        assert!(json["command"].is_null());
        assert!(
            json["obstacle"].as_str().is_some_and(|it| it.contains(why)),
            "{json}"
        );
    }
    assert_eq!(scratch.read("file"), "Mine.\n");
}

#[test]
fn a_table_that_went_takes_its_files_along() {
    let scratch = Scratch::small();
    fs::remove_file(scratch.path(MODE)).expect("removed");
    assert!(
        scratch
            .disagreement(&[])
            .contains(&format!("error: {DRIFT} is stray: no table gives it\n"))
    );
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(
        text.contains(&format!("{DRIFT}  removed: no table gives it\n")),
        "{text}"
    );
    assert!(!text.contains("kept"), "{text}");
    for gone in [
        "src/flexible_mode",
        "ir/flexible_mode.json",
        "docs/flexible_mode.md",
    ] {
        assert!(!scratch.path("generated").join(gone).exists(), "{gone}");
    }
    assert!(scratch.check(&[]).expect("checked").agrees());
}

/// Line ends are git's; they are no edit.
#[test]
fn what_was_edited_is_kept_and_reported() {
    let scratch = Scratch::small();
    fs::remove_file(scratch.path(MODE)).expect("removed");
    let edited = scratch.read(DRIFT) + "// mine\n";
    scratch.write(DRIFT, &edited);
    let other = "generated/src/flexible_mode/mod.rs";
    scratch.write(other, scratch.read(other).replace('\n', "\r\n"));
    let text = scratch.generate(&[]).expect("generated").text();
    let line =
        format!("{DRIFT}  stray, kept: no table gives it, and it was edited after ahv wrote it\n");
    assert!(text.contains(&line), "{text}");
    assert!(text.contains(", 1 stray kept (derive "), "{text}");
    assert_eq!(scratch.read(DRIFT), edited);
    assert!(!scratch.path(other).exists());
    // From now on nothing says that ahv wrote it.
    let text = scratch.disagreement(&[]);
    let line = format!("error: {DRIFT} is stray: no table gives it, and ahv did not write it\n");
    assert!(text.contains(&line), "{text}");
    let end = "1 file differs. Move it away: ahv removes only what it wrote\n";
    assert!(text.ends_with(end), "{text}");
}

#[test]
fn own_files_in_the_generated_folder_are_kept() {
    let scratch = Scratch::small();
    // One says that it was generated, and is not listed all the same.
    let own = [
        ("generated/src/com/mine.rs", "fn mine() {}\n"),
        ("generated/docs/notes.md", ""),
        (
            "generated/src/old.rs",
            "// Generated by `ahv generate` from old.toml. Do not edit.\n",
        ),
    ];
    for (path, text) in own {
        scratch.write(path, text);
    }
    scratch.edit(COM, "value = 4.6773,", "value = 4.7773,");
    let text = scratch.disagreement(&[]);
    let end =
        "Move the stray files away (ahv removes only what it wrote), and run:  ahv generate\n";
    assert!(text.ends_with(end), "{text}");
    let text = scratch.generate(&[]).expect("generated").text();
    for (path, own) in own {
        let line = format!("{path}  stray, kept: no table gives it, and ahv did not write it\n");
        assert!(text.contains(&line), "{text}");
        assert_eq!(scratch.read(path), own);
    }
    assert!(text.contains(" 0 removed, 3 stray kept (derive "), "{text}");
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(
        text.contains("\nnothing changed, 3 stray kept (derive "),
        "{text}"
    );
}

/// The manifests of older versions hold no list of files.
#[test]
fn a_manifest_without_a_list_gives_no_leave_to_remove() {
    let scratch = Scratch::small();
    let before = scratch.snapshot("generated");
    let text = scratch.read(MANIFEST);
    let list = text.find(",\n  \"files\"").expect("a list");
    scratch.write(MANIFEST, format!("{}\n}}\n", &text[..list]));
    scratch.write("generated/src/com/old.rs", "");
    // A hand edit is mended as ever, without its first line too.
    scratch.write("generated/src/com/drift.rs", "// mine\n");
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(
        text.contains("generated/src/com/old.rs  stray, kept"),
        "{text}"
    );
    fs::remove_file(scratch.path("generated/src/com/old.rs")).expect("still there");
    assert!(before == scratch.snapshot("generated"));
}

/// Both sides of a merge conflict say what ahv wrote.
#[test]
fn a_manifest_in_conflict_still_lists_the_files() {
    let scratch = Scratch::small();
    let text = scratch.read(MANIFEST);
    let line = text
        .lines()
        .find(|line| line.contains("\"com\":"))
        .expect("there");
    let theirs = line.replace(['a', 'b', '1'], "c");
    let conflict = format!("<<<<<<< ours\n{line}\n=======\n{theirs}\n>>>>>>> theirs");
    scratch.write(MANIFEST, text.replacen(line, &conflict, 1));
    fs::remove_file(scratch.path(MODE)).expect("removed");
    scratch.generate(&[]).expect("generated");
    assert!(!scratch.path(DRIFT).exists());
}

/// A file where a table that is new puts one of its own.
#[test]
fn a_file_that_the_manifest_does_not_list_is_not_overwritten() {
    let scratch = Scratch::small();
    let table = scratch.read(MODE);
    fs::remove_file(scratch.path(MODE)).expect("removed");
    scratch.generate(&[]).expect("generated");
    scratch.write(MODE, table);
    fs::create_dir(scratch.path("generated/src/flexible_mode")).expect("made");
    scratch.write(DRIFT, "fn mine() {}\n");
    let message = scratch.refusal();
    let expected = format!(
        "{DRIFT} was not generated, and would be lost: manifest.json of generated does not list it"
    );
    assert!(message.contains(&expected), "{message}");
}

#[test]
fn links_are_stray_and_never_followed() {
    let scratch = Scratch::small();
    fs::create_dir(scratch.path("victim")).expect("made");
    scratch.write("victim/work.rs", "fn work() {}\n");
    for (target, link) in [
        ("victim", "generated/src/link"),
        ("victim/work.rs", "generated/docs/work.md"),
        ("generated/src", "generated/src/com/back"),
        ("nowhere", "generated/ir/dangling"),
    ] {
        symlink(scratch.path(target), scratch.path(link)).expect("linked");
    }
    // Not even where the manifest of a hostile repository lists what lies behind.
    scratch.list("src/link/work.rs");
    let text = scratch.disagreement(&[]);
    assert_eq!(
        text.matches(" and it is a link, and ahv follows none\n")
            .count(),
        4,
        "{text}"
    );
    assert!(!text.contains("work.rs is stray"), "{text}");
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(text.contains("0 removed, 4 stray kept"), "{text}");
    assert_eq!(scratch.read("victim/work.rs"), "fn work() {}\n");
    assert!(scratch.path("generated/src/link").is_symlink());
}

/// Nothing is written behind a link, to a folder or to a file.
#[test]
fn a_link_in_the_place_of_a_folder_is_refused() {
    for part in ["src", "src/com", "src/com/nominal.rs"] {
        let scratch = Scratch::small();
        let place = format!("generated/{part}");
        fs::rename(scratch.path(&place), scratch.path("elsewhere")).expect("moved");
        symlink(scratch.path("elsewhere"), scratch.path(&place)).expect("linked");
        // Reading is harmless, and where nothing differs nothing is written.
        assert!(scratch.check(&[]).expect("checked").agrees());
        scratch.generate(&[]).expect("nothing to do");
        scratch.edit(COM, "value = 4.6773,", "value = 4.7773,");
        let before = scratch.snapshot("");
        let message = scratch.generate(&[]).err().expect("refused").to_string();
        assert!(
            message.contains(&format!("error: {place} is a link")),
            "{message}"
        );
        assert!(before == scratch.snapshot(""), "{part}");
    }
}

#[test]
fn a_pipe_in_the_tree_is_not_waited_for() {
    let scratch = Scratch::small();
    scratch.make_pipe("generated/src/pipe.rs");
    let text = scratch.generate(&[]).expect("generated").text();
    assert!(
        text.contains("kept: no table gives it, and it is not a regular file"),
        "{text}"
    );
    fs::remove_file(scratch.path("generated/src/lib.rs")).expect("removed");
    scratch.make_pipe("generated/src/lib.rs");
    let message = scratch.check(&[]).err().expect("refused").to_string();
    assert!(message.contains("src/lib.rs: it is a pipe"), "{message}");
}
