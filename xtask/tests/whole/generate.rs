//! `cargo xtask generate` as a person meets it: the real derivation, exit codes, and messages.

use crate::common::Scratch;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::process::Command;

const COM: &str = "generator/tables/com.toml";
const DCOM: &str = "generator/tables/dcom.toml";

#[test]
fn the_whole_way_there_and_back() {
    let scratch = Scratch::new();
    let before = scratch.snapshot();
    assert_eq!(scratch.generate(&["--check"]).code, 0);
    assert_eq!(scratch.generate(&["--check", "--from-ir"]).code, 0);

    scratch.edit(DCOM, "value = 4.6773,", "value = 4.7773,");
    let checked = scratch.generate(&["--check"]);
    assert_eq!(checked.code, 1);
    assert!(
        checked
            .stderr
            .contains("-    c_l_alpha: 4.6773,\n+    c_l_alpha: 4.7773,\n")
    );
    assert!(before == scratch.snapshot(), "a check writes nothing");

    let done = scratch.generate(&[]);
    assert_eq!(done.code, 0);
    assert!(
        done.stdout
            .contains("generated/src/dcom/nominal.rs  +1 −1\n"),
        "{}",
        done.stdout
    );
    // Nothing was derived for it, and a derivation gives the same.
    assert_eq!(scratch.generate(&["--check"]).code, 0);

    scratch.edit(DCOM, "value = 4.7773,", "value = 4.6773,");
    assert_eq!(scratch.generate(&[]).code, 0);
    assert!(before == scratch.snapshot());
}

/// What is wrong with a table, its text, what takes its place, and what the message says; `⏎` is an end of a line.
const BAD: &str = r#"
not TOML | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpha" = { value = 4.6773 unit | unit
twice | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpha" = { value = 4.6773, unit = "1/rad" }⏎"alpha" = { value = 4.6773, unit = "1/rad" } | "alpha" = { value = 4.6773, unit = "1/rad" }
misspelt monomial | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpah" = { value = 4.6773, unit = "1/rad" } | alpah
misspelt quantity | [C_L] | [C_l] | C_l
unknown key | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpha" = { value = 4.6773, units = "1/rad" } | units
not a number | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpha" = { value = nan, unit = "1/rad" } | nan
infinity | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpha" = { value = inf, unit = "1/rad" } | inf
another unit | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpha" = { value = 4.6773, unit = "ft" } | ft
missing | m = { value = 300.0, unit = "slug/ft" }⏎ |  | [vehicle]
no choices | [choices] | [choises] | did you mean `choices`?
unknown choice | canard = "none" | canrad = "none" | did you mean `canard`?
unknown option | canard = "none" | canard = "slave" | did you mean `slaved`?
unknown section of a set | [sets."section5.3".vehicle]⏎m = { value = 191.3, unit = "slug/ft" | [sets."section5.3".vehicel]⏎m = { value = 191.3, unit = "slug/ft" | did you mean `vehicle`?
unknown key of a set | [sets."section5.3".vehicle]⏎m = { value = 191.3, unit = "slug/ft" | [sets."section5.3".vehicle]⏎mm = { value = 191.3, unit = "slug/ft" | no `mm` to replace
bad name of a set | [sets."section5.3".vehicle]⏎m = { value = 191.3, unit = "slug/ft" | [sets."Section 5.3".vehicle]⏎m = { value = 191.3, unit = "slug/ft" | a set has a name of its own
set of the table's name | [sets."section5.3".vehicle]⏎m = { value = 191.3, unit = "slug/ft" | [sets."section5.1".vehicle]⏎m = { value = 191.3, unit = "slug/ft" | a set has a name of its own
unit in a set | [sets."section5.3".vehicle]⏎m = { value = 191.3, unit = "slug/ft" | [sets."section5.3".vehicle]⏎m = { value = 191.3, unit = "ft" | does not fit
value in a set | omega_1 = { value = 20.5, | omega_1 = { value = 0.0, | must be positive
models of two families | "sdcom_gust"] | "com"] | `com` is not a model of the family
models in another order | ["dcom", "sdcom", | ["sdcom", "dcom", | in this order
no gust | gust_rms = | gust_rmse = | did you mean `gust_rms`?
a degree too high | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpha^5*alpha^6" = { value = 4.6773, unit = "1/rad" } | is of degree 11; the highest is 9
a key in two lines | "alpha" = { value = 4.6773, unit = "1/rad" } | "alpha\n" = { value = 4.6773, unit = "1/rad" } | `alpha\n` is not a monomial
unit system | units = "ft-slug-s-rad" | units = "SI" | did you mean `si`?
"#;

/// What the derivation finds is shown in the text of the table.
#[test]
fn bad_tables_have_exit_code_2_and_a_place() {
    for line in BAD.trim().lines() {
        let line = line.replace('⏎', "\n");
        let [name, from, to, offending] = line.split(" | ").collect::<Vec<_>>()[..] else {
            panic!("{line}");
        };
        let scratch = Scratch::new();
        let before = scratch.snapshot();
        scratch.edit(DCOM, from, to);
        let answer = scratch.generate(&[]);
        assert_eq!(answer.code, 2, "{name}: {}", answer.stderr);
        let place = answer.stderr.split("generator/tables/dcom.toml:").nth(1);
        let place = place.and_then(|rest| rest.split(']').next());
        let numbers = place.map(|place| {
            place
                .split(':')
                .filter(|it| it.parse::<u32>().is_ok())
                .count()
        });
        assert_eq!(
            numbers,
            Some(2),
            "{name}: no line and column in {}",
            answer.stderr
        );
        assert!(
            answer.stderr.contains(offending),
            "{name}: {}",
            answer.stderr
        );
        assert!(answer.stdout.is_empty(), "{name}: {}", answer.stdout);
        assert!(before == scratch.snapshot(), "{name}: the tree changed");
    }
}

/// Mass is positive, and so must be the mass matrix of pitch and cantilevers, in the table and in a set.
#[test]
fn an_inertia_that_the_modes_use_up_has_a_place() {
    let set = "[sets.\"section5.3\"]";
    let light = format!(
        "{set}\n[sets.\"section5.3\".vehicle]\nI_yy = {{ value = 86723.0, unit = \"slug*ft\" }}"
    );
    for (from, to, line) in [
        (
            "I_yy = { value = 5.0e5",
            "I_yy = { value = 2.4e5",
            "I_yy = { value = 2.4e5",
        ),
        (set, light.as_str(), "I_yy = { value = 86723.0"),
    ] {
        let scratch = Scratch::new();
        scratch.edit(COM, from, to);
        let answer = scratch.generate(&[]);
        assert_eq!(answer.code, 2, "{}", answer.stderr);
        let text = fs::read_to_string(scratch.path(COM)).expect("a text file");
        let line = 1 + text
            .lines()
            .position(|it| it.starts_with(line))
            .expect("there");
        assert!(
            answer.stderr.contains("must exceed the sum of the squares"),
            "{}",
            answer.stderr
        );
        assert!(
            answer.stderr.contains(&format!("{COM}:{line}:")),
            "{}",
            answer.stderr
        );
    }
}

/// With the real derivation: a package in SI is one, and stays one.
#[test]
fn a_package_in_si() {
    let scratch = Scratch::new();
    assert_eq!(scratch.generate(&["--units", "si"]).code, 0);
    assert_eq!(scratch.generate(&["--check", "--units", "si"]).code, 0);
    assert_eq!(
        scratch
            .generate(&["--check", "--units", "si", "--from-ir"])
            .code,
        0
    );
    let answer = scratch.generate(&["--check", "--from-ir"]);
    assert_eq!(answer.code, 1);
    assert!(
        answer
            .stderr
            .contains("+pub const UNIT_SYSTEM: &str = \"ft-slug-s-rad\";"),
        "{}",
        answer.stderr
    );
}

#[test]
fn no_python() {
    let scratch = Scratch::new();
    let before = scratch.snapshot();
    let mut command = scratch.command(&["--derive"]);
    command
        .env("PATH", "")
        .env("AHV_CACHE_DIR", scratch.path("empty-cache"));
    let answer = crate::common::answer(&mut command);
    assert_eq!(answer.code, 2);
    let expected = "error: found no Python 3.11 or newer, which deriving needs\n  help: ";
    assert!(answer.stderr.starts_with(expected), "{}", answer.stderr);
    assert!(before == scratch.snapshot());
    // Where nothing is derived, none is needed, and none by the check from the IR.
    assert_eq!(
        crate::common::answer(scratch.command(&[]).env("PATH", "")).code,
        0
    );
    let mut command = scratch.command(&["--check", "--from-ir"]);
    assert_eq!(crate::common::answer(command.env("PATH", "")).code, 0);
}

/// Python variables that would send it elsewhere, keep it waiting, or make its output unreadable.
#[test]
fn hostile_variables_of_python_change_nothing() {
    let scratch = Scratch::new();
    let modules = scratch.path("modules");
    fs::create_dir(&modules).expect("made");
    for name in ["json", "argparse", "sitecustomize", "usercustomize"] {
        let text = "raise RuntimeError('the wrong module')\n";
        fs::write(modules.join(format!("{name}.py")), text).expect("written");
    }
    let hostile = |command: &mut Command| {
        for (name, value) in [
            ("PYTHONHOME", "/nowhere"),
            ("PYTHONINSPECT", "1"),
            ("PYTHONIOENCODING", "utf-16"),
            ("PYTHONUTF8", "0"),
            ("PYTHONWARNINGS", "error"),
            ("PYTHONOPTIMIZE", "2"),
            ("PYTHONPLATLIBDIR", "nowhere"),
        ] {
            command.env(name, value);
        }
        let answer = crate::common::answer(command.env("PYTHONPATH", &modules));
        assert_eq!(answer.code, 0, "{}", answer.stderr);
        assert!(answer.stdout.contains("agrees with"), "{}", answer.stdout);
    };
    hostile(&mut scratch.command(&["--check"]));
    let python = crate::common::generation_python();
    hostile(scratch.command(&["--check"]).env("AHV_PYTHON", python));
}

#[test]
fn no_casadi() {
    let scratch = Scratch::new();
    let bare = scratch.path("bare-python");
    // -S: without the packages that are installed.
    executable(&bare, "#!/bin/sh\nexec python3 -S \"$@\"\n");
    let answer = crate::common::answer(scratch.command(&["--derive"]).env("AHV_PYTHON", &bare));
    assert_eq!(answer.code, 2);
    assert!(
        answer.stderr.contains("which has no casadi and no pint\n"),
        "{}",
        answer.stderr
    );
}

/// A limit on the size of files stands in for a full disk: writing fails in the middle.
#[test]
fn a_full_disk_leaves_the_tree_as_it_was() {
    let scratch = Scratch::new();
    // Any work done by Python is exempt: it is the writing of the tree that must fail.
    let python = scratch.path("python");
    let unlimited = format!(
        "#!/bin/sh\nulimit -S -f unlimited\nexec {} \"$@\"\n",
        crate::common::generation_python().display()
    );
    executable(&python, &unlimited);
    // What is kept in the cache has its place before the room runs out.
    assert_eq!(scratch.generate(&["--check"]).code, 0);
    let before = scratch.snapshot();
    scratch.edit(DCOM, "value = 4.6773,", "value = 4.7773,");
    for file in ["generated/src/dcom/drift.rs", "generated/ir/dcom.json"] {
        fs::remove_file(scratch.path(file)).expect("removed");
    }
    let damaged = scratch.snapshot();

    let mut command = Command::new("sh");
    command.args(["-c", "trap '' XFSZ; ulimit -S -f 8; exec \"$0\" generate"]);
    command
        .arg(env!("CARGO_BIN_EXE_xtask"))
        .current_dir(scratch.path(""));
    let answer = crate::common::answer(command.env("AHV_PYTHON", &python));
    assert_eq!(answer.code, 2, "{}", answer.stderr);
    assert!(
        answer.stderr.starts_with("error: cannot write ") && answer.stderr.contains("generated/"),
        "{}",
        answer.stderr
    );
    assert!(damaged == scratch.snapshot(), "the tree changed");

    scratch.edit(DCOM, "value = 4.7773,", "value = 4.6773,");
    assert_eq!(scratch.generate(&[]).code, 0);
    assert!(before == scratch.snapshot());
}

/// The derivation runs out of room: one message, no traceback.
#[test]
fn a_full_disk_while_deriving_leaves_the_tree_as_it_was() {
    let scratch = Scratch::new();
    let before = scratch.snapshot();
    let mut command = Command::new("sh");
    command.args([
        "-c",
        "trap '' XFSZ; ulimit -S -f 8; exec \"$0\" generate --derive",
    ]);
    command
        .arg(env!("CARGO_BIN_EXE_xtask"))
        .current_dir(scratch.path(""));
    let python = crate::common::generation_python();
    let answer = crate::common::answer(command.env("AHV_PYTHON", python));
    assert_eq!(answer.code, 2, "{}", answer.stderr);
    assert!(
        answer.stderr.starts_with("error: ") && !answer.stderr.contains("Traceback"),
        "{}",
        answer.stderr
    );
    assert!(before == scratch.snapshot(), "the tree changed");
}

/// A place that nobody can write to, root included.
#[cfg(target_os = "linux")]
#[test]
fn a_read_only_place_is_named() {
    let answer = Scratch::new().generate(&["--out", "/sys/ahv-models"]);
    assert_eq!(answer.code, 2, "{}", answer.stderr);
    assert!(
        answer
            .stderr
            .starts_with("error: cannot make the folder /sys/ahv-models"),
        "{}",
        answer.stderr
    );
}

/// The command that messages name works when `generated/` is no package at all.
#[test]
fn xtask_builds_and_mends_when_generated_does_not() {
    let scratch = Scratch::of(&[
        "Cargo.toml",
        "Cargo.lock",
        "crates",
        "generated",
        "generator",
        "templates",
        "xtask",
    ]);
    let before = scratch.snapshot();
    // The program is that of the same sources: what could keep cargo from building it is a workspace that does not load.
    let mends = |damage: &str| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["metadata", "--offline", "--locked", "--format-version", "1"]);
        cargo.args(["--manifest-path", "xtask/Cargo.toml"]);
        let loaded = crate::common::answer(cargo.current_dir(scratch.path("")));
        assert_eq!(loaded.code, 0, "{damage}: {}", loaded.stderr);
        let answer = scratch.generate(&[]);
        assert_eq!(answer.code, 0, "{damage}: {}", answer.stderr);
        assert!(before == scratch.snapshot(), "{damage}");
    };

    scratch.edit("generated/src/lib.rs", "pub mod", "pub mood");
    scratch.edit("generated/Cargo.toml", "[package]", "[package");
    mends("a bad hand edit");
    for file in [
        "generated/Cargo.toml",
        "generated/manifest.json",
        "generated/src/lib.rs",
    ] {
        let text = fs::read_to_string(scratch.path(file)).expect("a text file");
        let text = format!("<<<<<<< ours\n{text}=======\n{text}>>>>>>> theirs\n");
        fs::write(scratch.path(file), text).expect("written");
    }
    mends("conflict markers");
    fs::remove_dir_all(scratch.path("generated")).expect("removed");
    fs::create_dir(scratch.path("generated")).expect("made");
    mends("an empty folder");
}

fn executable(path: &std::path::Path, text: &str) {
    fs::write(path, text).expect("written");
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("executable");
}
