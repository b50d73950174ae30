//! `ahv new` in a temporary folder, with an interpreter that stands in for Python: it answers with the IR that is checked in.
//! `cargo xtask own-vehicle` makes a repository with the real one, builds it and flies it.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::{Path, PathBuf};

use ahv_generate::Surroundings;
use ahv_new::{Args, Created, Failure, create};
use clap::Parser as _;
use tempfile::TempDir;

const REPOSITORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[derive(clap::Parser)]
struct Line {
    #[command(flatten)]
    args: Args,
}

/// A folder in which a user stands.
struct Here {
    folder: TempDir,
    python: PathBuf,
}

impl Here {
    fn new() -> Self {
        Self::deriving(&format!(
            "cp {REPOSITORY}/generated/ir/flexible_mode.json \"$8\""
        ))
    }

    /// With a Python that derives so.
    fn deriving(script: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let python = folder.path().join("python");
        let probe = "if [ \"$2\" = -c ]; then echo '3 11'; echo; exit; fi";
        fs::write(&python, format!("#!/bin/sh\n{probe}\n{script}\n")).expect("written");
        fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).expect("executable");
        fs::create_dir(folder.path().join("here")).expect("made");
        Self { folder, python }
    }

    fn path(&self, relative: &str) -> PathBuf {
        self.folder.path().join("here").join(relative)
    }

    fn surroundings(&self) -> Surroundings {
        Surroundings {
            current_dir: self.path(""),
            python: Some(self.python.clone().into()),
            cache: Some(self.folder.path().join("cache")),
        }
    }

    /// A vehicle of the built-in family `flexible_mode`.
    fn create(&self, line: &[&str]) -> Result<Created, Failure> {
        let usual = ["new", "--ahv", REPOSITORY];
        let line = Line::parse_from([usual.as_slice(), line].concat());
        create(&line.args, &self.surroundings())
    }

    fn refuses(&self, line: &[&str], words: &[&str]) {
        let failure = self.create(line).expect_err("refused");
        let said = failure.render();
        assert_eq!(failure.exit_code(), 2, "{said}");
        for word in words {
            assert!(said.contains(word), "no {word:?} in {said}");
        }
    }

    /// What lies in the folder, hidden files included.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.path("")).expect("a folder");
        let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        let mut names: Vec<String> = entries
            .map(|entry| name(entry.expect("an entry")))
            .collect();
        names.sort();
        names
    }
}

const MODE: [&str; 3] = ["--family", "flexible_mode", "w"];

#[test]
fn a_repository_has_all_that_it_needs() {
    let here = Here::new();
    let created = here.create(&MODE).expect("created");
    for file in [
        ".gitattributes",
        ".github/workflows/ahv.yml",
        ".gitignore",
        ".pre-commit-config.yaml",
        "Cargo.lock",
        "Cargo.toml",
        "README.md",
        "models/Cargo.toml",
        "models/manifest.json",
        "models/src/flexible_mode/drift.rs",
        "src/main.rs",
        "tables/flexible_mode.toml",
        "tests/models.rs",
    ] {
        assert!(created.files.iter().any(|it| it == file), "{file}");
    }
    assert!(
        created
            .files
            .iter()
            .all(|file| here.path("w").join(file).is_file())
    );
    assert_eq!(here.names(), ["w"]);
    let read = |file: &str| fs::read_to_string(here.path("w").join(file)).expect("a text");
    assert!(read("src/main.rs").contains("ahv_cli::run::<w_models::Models>(&[])"));
    assert!(read("models/Cargo.toml").contains("ahv-core.workspace = true"));
    assert!(read("README.md").contains("| `flexible_mode` | "));
    for file in created.files.iter().filter(|it| !it.starts_with("models/")) {
        let text = read(file);
        assert!(
            !text.contains("@name") && !text.contains("@model"),
            "{file}"
        );
    }
    let mode = fs::metadata(here.path("w"))
        .expect("a folder")
        .permissions()
        .mode();
    assert_ne!(mode & 0o050, 0, "others of the group may read it: {mode:o}");
}

#[test]
fn generate_needs_no_flags_there() {
    #[derive(clap::Parser)]
    struct Check {
        #[command(flatten)]
        args: ahv_generate::Args,
    }
    let here = Here::new();
    here.create(&MODE).expect("created");
    let inside = Surroundings {
        current_dir: here.path("w/src"),
        ..here.surroundings()
    };
    let check = Check::parse_from(["generate", "--check", "--from-ir"]).args;
    let checked = ahv_generate::check(&check, &inside).expect("checked");
    assert!(checked.agrees(), "{}", checked.text());

    let table = here.path("w/tables/flexible_mode.toml");
    let text = fs::read_to_string(&table).expect("a table");
    fs::write(&table, text.replacen("19.7437", "19.8", 1)).expect("written");
    let said = ahv_generate::check(&check, &inside)
        .expect("checked")
        .text();
    assert!(said.contains("models/src/flexible_mode/"), "{said}");
    assert!(
        said.trim_end().ends_with("run:  cargo run -- generate"),
        "{said}"
    );
}

#[test]
fn ahv_comes_from_a_folder_or_from_git() {
    let manifest = |here: &Here| {
        let text = fs::read_to_string(here.path("w/Cargo.toml")).expect("a manifest");
        text.parse::<toml_edit::DocumentMut>().expect("TOML")
    };
    let cli = |document: &toml_edit::DocumentMut, key: &str| {
        let source = &document["workspace"]["dependencies"]["ahv-cli"][key];
        source.as_str().unwrap_or_default().to_owned()
    };
    let here = Here::new();
    here.create(&MODE).expect("created");
    assert!(Path::new(&cli(&manifest(&here), "path")).is_absolute());

    let here = Here::new();
    symlink(REPOSITORY, here.path("ahv")).expect("linked");
    let line = Line::parse_from([&["new", "--ahv", "ahv"], MODE.as_slice()].concat());
    create(&line.args, &here.surroundings()).expect("created");
    let path = cli(&manifest(&here), "path");
    assert!(path.starts_with("../"), "{path}");
    assert!(here.path("w").join(path).join("Cargo.toml").is_file());

    let here = Here::new();
    let git = [
        "new",
        "--ahv",
        "https://example.org/ahv.git",
        "--rev",
        "abc",
    ];
    let line = Line::parse_from([git.as_slice(), &MODE].concat());
    create(&line.args, &here.surroundings()).expect("created");
    assert_eq!(cli(&manifest(&here), "git"), "https://example.org/ahv.git");
    assert_eq!(cli(&manifest(&here), "rev"), "abc");
}

#[test]
fn nothing_is_overwritten() {
    let here = Here::new();
    fs::create_dir(here.path("full")).expect("made");
    fs::write(here.path("full/own.txt"), "mine").expect("written");
    fs::write(here.path("file"), "mine").expect("written");
    symlink("full", here.path("link")).expect("linked");
    symlink("nowhere", here.path("dangling")).expect("linked");
    here.refuses(&["full"], &["full is not empty"]);
    here.refuses(&["file"], &["file is not a folder"]);
    here.refuses(&["link"], &["link is a link"]);
    here.refuses(&["link/"], &["is a link"]);
    here.refuses(&["dangling"], &["dangling is a link"]);
    assert_eq!(here.names(), ["dangling", "file", "full", "link"]);
}

#[test]
fn an_empty_folder_is_filled() {
    let here = Here::new();
    fs::create_dir(here.path("w")).expect("made");
    here.create(&MODE).expect("created");
    assert!(here.path("w/Cargo.toml").is_file());
    assert_eq!(here.names(), ["w"]);
}

#[test]
fn what_is_not_valid_is_refused_before_anything_is_written() {
    let here = Here::new();
    here.refuses(&["fn"], &["`fn`", "keyword", "--name"]);
    here.refuses(&["w", "--name", "core"], &["`core`", "a crate of Rust"]);
    here.refuses(&["w", "--name", "ahv-core"], &["a package `ahv-core`"]);
    here.refuses(
        &["w", "--example", "saucer"],
        &["van-der-pol, wang-stengel, winged-cone"],
    );
    here.refuses(&["w", "--family", "saucer"], &["com, dcom, flexible_mode"]);
    here.refuses(&["w", "--family", "kite.py"], &["kite.toml", "--table"]);
    here.refuses(&["w", "--rev", "abc"], &["--rev is for the URL"]);
    let line = Line::parse_from(["new", "w", "--ahv", "https://example.org/ahv.git"]);
    let said = create(&line.args, &here.surroundings())
        .expect_err("no revision")
        .render();
    assert!(said.contains("--rev"), "{said}");
    let line = Line::parse_from(["new", "w", "--ahv", "."]);
    let said = create(&line.args, &here.surroundings())
        .expect_err("no ahv")
        .render();
    assert!(said.contains("is not a repository of ahv"), "{said}");
    assert!(here.names().is_empty());
}

#[test]
fn a_derivation_that_fails_leaves_nothing() {
    let here = Here::deriving("echo broken >&2; exit 1");
    here.refuses(&["deep/down/w", "--family", "flexible_mode"], &["error: "]);
    assert!(here.names().is_empty());
}

#[test]
fn a_family_of_ones_own_comes_with_its_table() {
    let here = Here::new();
    fs::write(here.path("kite.py"), "").expect("written");
    fs::write(here.path("kite.toml"), "[table]\nfamily = \"hawk.py\"\n").expect("written");
    here.refuses(
        &["w", "--family", "kite.py"],
        &[
            "kite.toml names the family \"hawk.py\"",
            "family = \"kite.py\"",
        ],
    );
}
