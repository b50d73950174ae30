//! The chain as a user of the tables meets it: a changed value, a new monomial.

use crate::common::{Scratch, copy, repository};
use std::fs;
use std::path::Path;
use std::process::Command;

const DCOM: &str = "generator/tables/dcom.toml";

/// A changed number, with what git has to say of `generated/src`: one line of one file.
const CHANGES: [(&str, &str, &str, &str); 4] = [
    (
        "a value",
        "value = 4.6773,",
        "value = 4.7773,",
        "c_l_alpha: 4.7773,",
    ),
    (
        "a value of a set",
        "value = 191.3,",
        "value = 191.4,",
        "m: 191.4,",
    ),
    (
        "a choice",
        "canard = \"none\"",
        "canard = \"slaved\"",
        "canard_slaving: 1.0,",
    ),
    (
        "another choice",
        "reduction = \"printed\"",
        "reduction = \"moment\"",
        "moment_matching: 1.0,",
    ),
];

/// One value: one line of Rust, and git says so. The documentation shows values, too. The manifest has a line for the
/// table and one for each of these files.
#[test]
fn a_changed_value_is_one_line_for_git() {
    let scratch = Scratch::new();
    let git = |line: &[&str]| {
        let mut command = Command::new("git");
        command.args(["-c", "user.name=test", "-c", "user.email=test@localhost"]);
        let output = command.args(line).current_dir(scratch.path("")).output();
        let output = output.expect("git runs");
        assert!(output.status.success(), "git {line:?}");
        String::from_utf8(output.stdout).expect("text")
    };
    git(&["init", "--quiet"]);
    for (name, from, to, line) in CHANGES {
        git(&["add", "--all"]);
        git(&["commit", "--quiet", "--message", name]);
        scratch.edit(DCOM, from, to);
        assert_eq!(scratch.generate(&[]).code, 0, "{name}");
        git(&["add", "--all"]);
        let changed =
            |how: &str, place: &[&str]| git(&[&["diff", "--cached", how, "--"], place].concat());
        assert_eq!(
            changed("--numstat", &["generated/src"]),
            "1\t1\tgenerated/src/dcom/nominal.rs\n",
            "{name}"
        );
        assert!(
            changed("-U0", &["generated/src"]).contains(&format!("+    {line}\n")),
            "{name}"
        );
        let pages = changed("--numstat", &["generated/docs"]).lines().count();
        // The hashes of the table and of nominal.rs, those of the pages, and the seal over all; a choice is structure.
        let lines = 3 + pages + usize::from(name.ends_with("choice"));
        assert_eq!(
            changed(
                "--numstat",
                &["generated", ":!generated/src", ":!generated/docs"]
            ),
            format!("{lines}\t{lines}\tgenerated/manifest.json\n"),
            "{name}"
        );
    }
}

/// At most this many changed lines for each term that a new monomial adds, Jacobians included.
const LINES_A_TERM: usize = 3;

/// Terms of all functions of a package: the additions that its documentation counts.
fn terms_in(documents: &Path) -> usize {
    let mut sum = 0;
    for entry in fs::read_dir(documents).expect("readable") {
        let text = fs::read_to_string(entry.expect("readable").path()).expect("a text file");
        let counted = text.lines().filter(|line| line.starts_with("| `"));
        for line in counted.filter(|line| line.contains(" operations: ")) {
            let mut parts = line.split([':', ',']).map(str::trim);
            let additions = parts.find_map(|part| part.split_once(" addition"));
            sum += additions.map_or(0, |(count, _)| count.parse().expect("a number"));
        }
    }
    sum
}

/// A new monomial costs few lines: what a reviewer reads grows with what was added, not with the size of the models.
#[test]
fn a_new_monomial_is_a_few_lines_a_term() {
    let scratch = Scratch::new();
    for (fit, monomial, unit) in [
        ("C_L", "alpha^2", "1/rad^2"),
        ("C_M", "alpha^3", "1/rad^3"),
        ("C_D", "alpha^2*delta_e", "1/rad^3"),
        ("C_L", "alpha*eta_1", "1/rad/(ft*slug)^0.5"),
    ] {
        let before = scratch.path(&format!("before {fit} {}", monomial.len()));
        copy(&scratch.path("generated"), &before);
        // A rigid vehicle has no modes.
        let tables = [DCOM, "generator/tables/com.toml"];
        for table in &tables[..if monomial.contains("eta_") { 1 } else { 2 }] {
            let entry = format!("[{fit}]\n\"{monomial}\" = {{ value = 0.5, unit = \"{unit}\" }}\n");
            scratch.edit(table, &format!("[{fit}]\n"), &entry);
        }
        assert_eq!(scratch.generate(&[]).code, 0);
        let terms = terms_in(&scratch.path("generated/docs")) - terms_in(&before.join("docs"));
        let (before, after) = (before.join("src"), scratch.path("generated/src"));
        let mut git = Command::new("git");
        git.args(["diff", "--no-index", "--numstat"])
            .args([&before, &after]);
        let answer = crate::common::answer(&mut git);
        assert_eq!(answer.code, 1, "{}", answer.stderr);
        let inserted = answer
            .stdout
            .lines()
            .filter_map(|line| line.split('\t').next()?.parse::<usize>().ok());
        let lines: usize = inserted.sum();
        println!("{fit} {monomial}: {lines} lines for {terms} terms");
        assert!(terms > 50, "{terms} terms");
        assert!(
            lines <= LINES_A_TERM * terms,
            "{fit} {monomial}: {lines} lines for {terms} terms:\n{}",
            answer.stdout
        );
    }
}

/// What the new term must add, in closed form: q S c alpha^2 / (m V) to the rate of gamma.
const PROBE: &str = r#"
use ahv_models::{dcom, sdcom};

fn main() {
    let with = dcom::NOMINAL;
    let mut without = with;
    without.c_l_alpha_2 = 0.0;
    let x = dcom::State { velocity: 7702.0, altitude: 85_000.0, gamma: 0.01, alpha: 0.03, pitch_rate: 0.0,
        eta_1: 0.6, eta_dot_1: 0.0, eta_2: 0.0, eta_dot_2: 0.0, eta_3: 0.0, eta_dot_3: 0.0 };
    let u = dcom::Input { phi: 0.28, delta_e: 0.2, delta_c: 0.01 };
    let (p, q) = (dcom::prepare(&with), dcom::prepare(&without));
    let (full, less) = (dcom::drift(&x, &u, &p), dcom::drift(&x, &u, &q));
    let (by_state, _) = dcom::jacobians(&x, &u, &p);
    let (by_state_less, _) = dcom::jacobians(&x, &u, &q);
    // At the reference altitude the density is rho_0.
    let scale = 0.5 * with.rho_0 * x.velocity * with.s / with.m * with.c_l_alpha_2;
    close(full.gamma - less.gamma, scale * x.alpha * x.alpha);
    close(full.velocity - less.velocity, 0.0);
    close(by_state.gamma.alpha - by_state_less.gamma.alpha, 2.0 * scale * x.alpha);
    close(by_state.gamma.velocity - by_state_less.gamma.velocity, scale * x.alpha * x.alpha / x.velocity);

    let y = sdcom::State { velocity: 7702.0, altitude: 85_000.0, gamma: 0.01, alpha: 0.03, pitch_rate: 0.0,
        chi_1: 0.1, chi_2: 0.0, chi_3: 0.0 };
    let v = sdcom::Input { phi: 0.28, delta_e: 0.2, delta_c: 0.01 };
    let (p, q) = (sdcom::prepare(&with), sdcom::prepare(&without));
    // Not linear in alpha: the split leaves it to f_gamma, and H_gamma has its derivative.
    close(sdcom::f_gamma(&y, &v, &p) - sdcom::f_gamma(&y, &v, &q), scale * y.alpha * y.alpha);
    close(sdcom::g_gamma(&y, &v, &p) - sdcom::g_gamma(&y, &v, &q), 0.0);
    close(sdcom::H_gamma(&y, &v, &p) - sdcom::H_gamma(&y, &v, &q), 2.0 * scale * y.alpha);
    println!("the new term is right");
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-13, "{found} instead of {expected}");
}
"#;

/// A new monomial gives a new term, in value and Jacobian, without any code being touched.
#[test]
fn a_new_monomial_flies() {
    let scratch = Scratch::new();
    let entry = "[C_L]\n\"alpha^2\" = { value = 0.5, unit = \"1/rad^2\" }\n";
    scratch.edit(DCOM, "[C_L]\n", entry);
    let core = repository().join("crates/ahv-core");
    let core = core.to_str().expect("a path in Unicode");
    let done = scratch.generate(&["--core-path", core]);
    assert_eq!(done.code, 0, "{}", done.stderr);

    let stages = scratch.path("generated/src/dcom/stages.rs");
    let stages = fs::read_to_string(stages).expect("stages.rs");
    assert!(stages.contains("p.c_l_alpha_2 * i.alpha_2"), "{stages}");

    fs::create_dir_all(scratch.path("probe/src")).expect("a folder");
    fs::write(scratch.path("probe/src/main.rs"), PROBE).expect("written");
    let manifest = "[workspace]\n[package]\nname = \"probe\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\
                    [dependencies]\nahv-models = { path = \"../generated\" }\n";
    fs::write(scratch.path("probe/Cargo.toml"), manifest).expect("written");
    // The versions that the workspace is locked to.
    fs::copy(
        repository().join("Cargo.lock"),
        scratch.path("probe/Cargo.lock"),
    )
    .expect("copied");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--target-dir"]);
    cargo.arg(scratch.path("probe/target"));
    let answer = crate::common::answer(cargo.current_dir(scratch.path("probe")));
    assert_eq!(answer.code, 0, "{}", answer.stderr);
    assert_eq!(answer.stdout, "the new term is right\n");
}
