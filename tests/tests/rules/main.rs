//! Both readers of tables have the same rules: that of `ahv generate`, which is Python, and that of `--table`, which is
//! the crate ahv-table. Random changes of the tables of this repository are given to both. Both must accept a table, or
//! report the same faults: rule, path, and key or value. What may differ is listed at [`agree`].
#![forbid(unsafe_code)]

mod change;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use ahv_core::{GeneratedModel, ModelList, ModelVisitor};
use ahv_generate::Surroundings;
use ahv_table::{Family, Part, Text};
use change::{Random, changed};

const TABLES: [&str; 3] = ["com", "dcom", "flexible_mode"];
/// Changes of each table.
const CHANGES: u64 = 400;

/// Changes that one of the readers once took: table, text, what takes its place. Both refuse them.
const ONCE_TAKEN: &str = r#"
com | [C_L] | [C_L]\n"alpha^1" = { value = 9.9, unit = "1/rad" }
com | value = 4.6773 | uncertanty = 0.01, value = 4.6773
com | value = 32.17405 | value = 0.0
com | psi_1 = { value = 401.86 | psi_1 = { value = 1e200
com | [T] | [t]
dcom | [vehicle] | [vehicle]\nM = { value = 500.0, unit = "slug/ft" }
dcom | sigma_1 = { value = 17.0 | sigma_1 = { value = -17.0
dcom | gust_rms = { value = 1 | gust_rms = { value = -1
dcom | value = 0.44838 | value = 0.0
dcom | "delta_c" = { value = 0.44838 | # "delta_c" = { value = 0.44838
dcom | "delta_e" = { value = 0.76224 | # "delta_e" = { value = 0.76224
dcom | status = "published" | status = "true"
dcom | source = "plate" | source = "plat"
dcom | canard = "none" | canrad = "none"
dcom | set = "section5.1" | set = "section5.1"\nversion = 1
dcom | set = "section5.1" | set = nan
dcom | min = 0.05, max = 1.2 | min = 1.2, max = 1.2
dcom | omega_1 = { value = 20.5 | omega_1 = { value = 0.0
dcom | I_yy = { value = 86723.0 | i_yy = { value = 86723.0
dcom | unit = "rad/s" | unit = "rad^0/s"
flexible_mode | ["flexible_mode"] | [true]
"#;

/// Rule, part, path.
type Found = BTreeSet<Vec<String>>;

/// How far two readers agree.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Agreement {
    Accepted,
    Refused,
    /// The table is not TOML, which ends `ahv generate` before its Python starts.
    Unreadable,
    /// The table has entries that the package does not have.
    NeedsGeneration,
    /// The table has other sections than the package, by which a family may count what it has.
    OtherSections,
    /// The table names another family, or a model of another one.
    OtherFamily,
}

/// Whether the faults that `--table` and the generator's reader find are the same; `None` if not. They may differ:
///
/// * if the text is not TOML: `ahv generate` reads tables with the same parser before it starts Python;
/// * in and under a coefficient that the package does not have, of which `--table` says `needs-generation`;
/// * if sections are missing or unknown. The sections of a table may say how many modes it has, to the generator.
///   Both refuse it;
/// * if the family is another, or a model is of another. The generator takes the family that the table names, `--table`
///   that of the models, whose name the package does not say.
fn agree(ours: &Found, theirs: &Found) -> Option<Agreement> {
    let rule = |fault: &&Vec<String>, name: &str| fault[0] == name;
    if ours.iter().any(|fault| rule(&fault, "unreadable")) {
        return Some(Agreement::Unreadable);
    }
    if ours == theirs {
        let refused = !ours.is_empty();
        return Some(if refused {
            Agreement::Refused
        } else {
            Agreement::Accepted
        });
    }
    let of_family =
        |fault: &Vec<String>| ["unknown-family", "unknown-model"].contains(&fault[0].as_str());
    if theirs.iter().any(of_family) {
        return Some(Agreement::OtherFamily);
    }
    let new: Vec<&[String]> = ours
        .iter()
        .filter(|fault| rule(fault, "needs-generation"))
        .map(|fault| &fault[2..])
        .collect();
    let elsewhere = |fault: &&Vec<String>| !new.iter().any(|path| fault[2..].starts_with(path));
    let [ours_elsewhere, theirs_elsewhere] =
        [ours, theirs].map(|found| found.iter().filter(elsewhere).collect::<BTreeSet<_>>());
    if !new.is_empty() && ours_elsewhere == theirs_elsewhere {
        return Some(Agreement::NeedsGeneration);
    }
    let of_sections = |fault: &Vec<String>| match fault[0].as_str() {
        "missing" => fault.len() == 2,
        "unknown-section" => fault.len() == 3,
        _ => false,
    };
    let both = ours.iter().any(of_sections) && !theirs.is_empty();
    both.then_some(Agreement::OtherSections)
}

struct Families(Vec<Family>);

impl ModelVisitor for Families {
    fn visit<M: GeneratedModel>(&mut self) {
        self.0.push(Family::of::<M>());
    }
}

/// The faults that `--table` finds.
fn of_table(text: &str, families: &[Family]) -> Found {
    let Ok(text) = Text::parse(text.to_owned()) else {
        return Found::from([vec!["unreadable".to_owned(), "key".to_owned()]]);
    };
    let faults = ahv_table::check(&text, families).err().unwrap_or_default();
    let found = faults.into_iter().map(|fault| {
        let part = if fault.part == Part::Key {
            "key"
        } else {
            "value"
        };
        let head = [fault.rule.to_owned(), part.to_owned()];
        head.into_iter().chain(fault.path).collect()
    });
    found.collect()
}

fn text_of(table: &str) -> String {
    let path = format!("../generator/tables/{table}.toml");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read_to_string(path).expect("it is there")
}

/// The faults that the generator's reader finds in each of the texts.
fn of_generator(cases: &[(String, String)]) -> Vec<Found> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (index, (_, text)) in cases.iter().enumerate() {
        fs::write(folder.path().join(format!("{index:05}.toml")), text).expect("writable");
    }
    let generator = Path::new(env!("CARGO_MANIFEST_DIR")).join("../generator");
    let requirements = fs::read_to_string(generator.join("requirements.txt")).expect("it is there");
    let surroundings = Surroundings::of_process().expect("a cache");
    let python = ahv_generate::environment("generation", &requirements, &surroundings);
    let output = Command::new(python.expect("a Python environment"))
        .arg(generator.join("tests/faults.py"))
        .arg(folder.path())
        .env("PYTHONPATH", &generator)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .expect("Python starts");
    let problem = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{problem}");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let found = text
        .lines()
        .map(|line| serde_json::from_str(line).expect("a list of faults"));
    let found: Vec<Found> = found.collect();
    assert_eq!(found.len(), cases.len());
    found
}

fn families() -> Vec<Family> {
    let mut families = Families(Vec::new());
    ahv_models::Models::visit(&mut families);
    families.0
}

#[test]
fn what_was_taken_once_is_refused_by_both() {
    let change = |line: &str| {
        let parts: Vec<String> = line
            .split(" | ")
            .map(|it| it.replace("\\n", "\n"))
            .collect();
        let [table, from, to] = &parts[..] else {
            panic!("{line}");
        };
        let text = text_of(table);
        assert!(text.contains(from), "{from}");
        (format!("{table}: {to}"), text.replacen(from, to, 1))
    };
    let cases: Vec<_> = ONCE_TAKEN.trim().lines().map(change).collect();
    let families = families();
    for ((case, text), theirs) in cases.iter().zip(of_generator(&cases)) {
        let ours = of_table(text, &families);
        assert_eq!(ours, theirs, "{case}");
        assert!(!ours.is_empty(), "{case}");
    }
}

#[test]
fn both_readers_have_the_same_rules() {
    let families = families();
    let mut cases = Vec::new();
    for table in TABLES {
        let text = text_of(table);
        for seed in 0..CHANGES {
            let mut random = Random(seed);
            let mut other = changed(&text, &mut random);
            if seed % 4 == 3 {
                other = changed(&other, &mut random);
            }
            cases.push((format!("{table}.toml, seed {seed}"), other));
        }
    }
    let found = of_generator(&cases);
    let (mut agreements, mut problems) = (Vec::new(), Vec::new());
    for ((case, text), theirs) in cases.iter().zip(&found) {
        let ours = of_table(text, &families);
        match agree(&ours, theirs) {
            Some(agreement) => agreements.push(agreement),
            None => problems.push(format!(
                "{case}: --table finds {ours:?}, the generator {theirs:?}"
            )),
        }
    }
    assert!(
        problems.is_empty(),
        "{}\n{}",
        problems.len(),
        problems.join("\n")
    );
    agreements.sort();
    let count = |wanted| agreements.iter().filter(|it| **it == wanted).count();
    let (accepted, refused) = (count(Agreement::Accepted), count(Agreement::Refused));
    println!(
        "{} changes: {accepted} accepted, {refused} refused with the same faults, {} not TOML, {} need generation, \
         {} with other sections, {} with another family",
        cases.len(),
        count(Agreement::Unreadable),
        count(Agreement::NeedsGeneration),
        count(Agreement::OtherSections),
        count(Agreement::OtherFamily),
    );
    assert!(
        accepted * 20 > cases.len() && refused * 3 > cases.len(),
        "the changes test little"
    );
}
