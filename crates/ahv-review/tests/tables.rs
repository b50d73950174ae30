//! Reviews of the tables of this repository, and of changes in them.

use std::fs;
use std::path::{Path, PathBuf};

use ahv_codegen::ir::Document;
use ahv_core::{GeneratedModel, ModelList, ModelVisitor, ParameterSetOf, Vector};
use ahv_review::{
    Condition, Difference, Finding, LINTS, Limits, Overview, Reference, Reviewed, Severity,
    Subject, faults, laid_out, lint,
};
use ahv_table::{Family, Text};

/// The tables that come along, with the folders of their generated packages.
const TABLES: [(&str, &str); 5] = [
    ("generator/tables/com.toml", "generated"),
    ("generator/tables/dcom.toml", "generated"),
    ("generator/tables/flexible_mode.toml", "generated"),
    (
        "examples/six-dof/six_dof.toml",
        "examples/six-dof/generated",
    ),
    (
        "examples/winged-cone/winged_cone.toml",
        "examples/winged-cone/generated",
    ),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn text(path: &str) -> String {
    fs::read_to_string(root().join(path)).expect("it is there")
}

/// What the package of this repository says of its models.
struct Compiled {
    table: String,
    subject: Option<Subject>,
}

impl ModelVisitor for Compiled {
    fn visit<M: GeneratedModel>(&mut self) {
        if M::TABLE.name != self.table {
            return;
        }
        let subject = self
            .subject
            .get_or_insert_with(|| Subject::new(Family::of::<M>()));
        if subject.references.is_empty() {
            subject.references = M::SETS.iter().map(reference::<M>).collect();
        }
        subject
            .conditions
            .extend(M::TRIM.given.iter().map(|given| Condition {
                model: M::NAME.to_owned(),
                state: given.name.to_owned(),
                value: given.default,
            }));
    }
}

fn reference<M: GeneratedModel>(set: &ParameterSetOf<M>) -> Reference {
    let values = (0..M::ParametersOf::<f64>::NAMES.len()).filter_map(|it| set.parameters.get(it));
    Reference {
        label: format!("the set `{}`", set.name),
        values: values.collect(),
    }
}

/// By the package of this repository if it has the table's models, else by the IR.
fn subject(path: &str, package: &str) -> Subject {
    let name = Path::new(path)
        .file_stem()
        .expect("a name")
        .to_string_lossy();
    let mut compiled = Compiled {
        table: name.clone().into_owned(),
        subject: None,
    };
    ahv_models::Models::visit(&mut compiled);
    compiled.subject.unwrap_or_else(|| of_ir(&name, package))
}

fn of_ir(name: &str, package: &str) -> Subject {
    let ir = text(&format!("{package}/ir/{name}.json"));
    let document = Document::parse(name, &ir).expect("an IR");
    let models: Vec<String> = document.models.iter().map(|it| it.name.clone()).collect();
    Subject::of_ir(&document, &models)
}

fn found(text: &str, subject: &Subject) -> Vec<Finding> {
    let text = Text::parse(text.to_owned()).expect("TOML");
    lint(&text, subject, &Limits::default(), faults(&text, subject))
}

/// Findings of a change in `dcom.toml` that the table itself does not have, by their rules.
#[track_caller]
fn changed(from: &str, to: &str) -> Vec<Finding> {
    let own = text("generator/tables/dcom.toml");
    assert!(own.contains(from), "no {from:?}");
    let subject = subject("generator/tables/dcom.toml", "generated");
    let usual = found(&own, &subject);
    let mut found = found(&own.replacen(from, to, 1), &subject);
    found.retain(|it| {
        !usual
            .iter()
            .any(|known| known.rule == it.rule && known.message == it.message)
    });
    found
}

#[test]
fn the_tables_that_come_along_are_clean() {
    for (path, package) in TABLES {
        let of_package = subject(path, package);
        let name = Path::new(path)
            .file_stem()
            .expect("a name")
            .to_string_lossy();
        for subject in [of_package, of_ir(&name, package)] {
            let found = found(&text(path), &subject);
            let loud: Vec<&Finding> = found
                .iter()
                .filter(|it| it.severity > Severity::Note)
                .collect();
            assert!(loud.is_empty(), "{path}: {loud:#?}");
        }
    }
}

#[test]
fn each_rule_finds_its_slip_and_nothing_else() {
    let alpha = "[C_L]\n\"alpha\" = { value = 4.6773, unit = \"1/rad\" }";
    for (rule, from, to) in [
        (
            "needs-generation",
            alpha,
            "[C_L]\n\"alpha\" = { value = 4.6773, unit = \"1/rad\" }\n\"alpha^2\" = { value = -1.2, unit = \"1/rad^2\" }",
        ),
        (
            "no-source",
            alpha,
            "[C_L]\n\"alpha\" = { value = 4.6773, unit = \"1/rad\", status = \"assumed\" }",
        ),
        (
            "no-uncertainty",
            "source = \"mean-earth-radius\", status = \"derived\"",
            "source = \"mean-earth-radius\", status = \"unverified\"",
        ),
        (
            "unused-source",
            "[sources]\n",
            "[sources]\nnobody = \"Nobody cites this\"\n",
        ),
        (
            "unverified",
            "sigma_1 = { value = 17.0, unit = \"(ft*slug)^0.5/s^1.5\", source = \"paper-37\" }",
            "sigma_1 = { value = 17.0, unit = \"(ft*slug)^0.5/s^1.5\", source = \"paper-37\", status = \"unverified\" }",
        ),
        (
            "zero",
            "\"delta_e\" = { value = 2.7699e-4",
            "\"delta_e\" = { value = 0.0",
        ),
        (
            "negligible",
            "\"delta_e\" = { value = 2.7699e-4",
            "\"delta_e\" = { value = 2.7699e-5",
        ),
        ("collinear", "phi = { min = 0.05", "phi = { min = 1.15"),
        (
            "outside-box",
            "velocity = { min = 7000.0",
            "velocity = { min = 7800.0",
        ),
        (
            "degrees",
            "\"alpha\" = { value = 4.6773",
            "\"alpha\" = { value = 0.081634",
        ),
        ("pounds", "m = { value = 300.0", "m = { value = 9652.2"),
        // The reverse, and a power.
        (
            "degrees",
            "\"alpha\" = { value = 2.1335, unit = \"1/rad\" }",
            "\"alpha\" = { value = 2.1335, unit = \"1/deg\" }",
        ),
        (
            "degrees",
            "\"alpha^2\" = { value = 5.8224",
            "\"alpha^2\" = { value = 0.0017736",
        ),
        (
            "pounds",
            "[vehicle]\nm = { value = 300.0",
            "[vehicle]\nm = { value = 9.3243",
        ),
    ] {
        let found = changed(from, to);
        // One number more that is unverified changes how many are; a narrow box makes four pairs collinear.
        let rules = found.iter().map(|it| it.rule.as_str());
        let mut rules: Vec<&str> = rules
            .filter(|it| *it == rule || *it != "unverified")
            .collect();
        rules.dedup();
        assert_eq!(rules, [rule], "{to}: {found:#?}");
        let lint = LINTS.iter().find(|lint| lint.name == rule);
        let own = found.iter().find(|it| it.rule == rule);
        assert_eq!(own.map(|it| it.severity), lint.map(|it| it.severity));
    }
}

#[test]
fn faults_and_lints_are_reported_at_once_in_their_order() {
    let own = text("generator/tables/dcom.toml");
    let wrong = own
        .replacen("m = { value = 300.0", "m = { value = -300.0", 1)
        .replacen(
            "\"alpha\" = { value = 4.6773",
            "\"alhpa\" = { value = 4.6773",
            1,
        )
        .replacen(
            "\"1\" = { value = 0.010131",
            "\"1\" = { value = 0.010131, sorce = 3",
            1,
        )
        .replacen(
            "\"delta_e\" = { value = 2.7699e-4",
            "\"delta_e\" = { value = 2.7699e-5",
            1,
        );
    let found = found(&wrong, &subject("generator/tables/dcom.toml", "generated"));
    let loud = found.iter().filter(|it| it.severity > Severity::Note);
    let rules: Vec<&str> = loud.map(|it| it.rule.as_str()).collect();
    assert_eq!(rules, ["positive", "monomial", "negligible", "unknown-key"]);
}

#[test]
fn the_unit_of_a_new_monomial_is_checked() {
    let line =
        |unit: &str| format!("[C_L]\n\"alpha*delta_e\" = {{ value = 1.0, unit = \"{unit}\" }}");
    for (unit, rules) in [
        ("1/rad^2", vec!["needs-generation"]),
        ("1/deg/rad", vec!["needs-generation"]),
        ("1/rad", vec!["needs-generation", "unit"]),
        ("ft/rad^2", vec!["needs-generation", "unit"]),
    ] {
        let found = changed("[C_L]", &line(unit));
        let found: Vec<&str> = found
            .iter()
            .map(|it| it.rule.as_str())
            .filter(|it| *it != "degrees")
            .collect();
        assert_eq!(found, rules, "{unit}");
    }
}

/// Every coefficient of an angle, with the slip, in the table of whose models the program is made.
#[test]
fn a_number_per_degree_is_found_wherever_it_stands() {
    let own = text("generator/tables/dcom.toml");
    let subject = subject("generator/tables/dcom.toml", "generated");
    let mut slips = 0;
    for line in own.lines() {
        let Some((start, rest)) = line.split_once("value = ") else {
            continue;
        };
        let (number, end) = rest.split_once(',').expect("a unit");
        let value: f64 = number.parse().expect("a number");
        if !end.contains("unit = \"1/rad\"") || value == 0.0 {
            continue;
        }
        let slip = format!("{start}value = {:e},{end}", value / 57.295_78);
        let found = found(&own.replacen(line, &slip, 1), &subject);
        assert!(
            found.iter().any(|it| it.rule == "degrees"),
            "{slip}: {found:#?}"
        );
        slips += 1;
    }
    assert!(slips > 10, "{slips}");
}

#[test]
fn siblings_betray_a_slip_where_nothing_else_is_known() {
    let subject = of_ir("dcom", "generated");
    let own = text("generator/tables/dcom.toml");
    let slip = own.replacen(
        "\"alpha\" = { value = -1.5004e-2",
        "\"alpha\" = { value = -2.6187e-4",
        1,
    );
    let found = found(&slip, &subject);
    assert!(found.iter().any(|it| it.rule == "degrees"), "{found:#?}");
}

#[test]
fn denied_rules_are_errors_and_the_reports_agree() {
    let own = text("generator/tables/dcom.toml");
    let findings = found(&own, &subject("generator/tables/dcom.toml", "generated"));
    let count = findings.len();
    let mut reviewed = [Reviewed {
        file: "tables/d com.toml".to_owned(),
        text: own,
        findings,
    }];
    reviewed[0].deny(&["unverified".to_owned()]);
    let json: serde_json::Value =
        serde_json::from_str(&ahv_review::json(&reviewed).expect("JSON")).expect("JSON");
    let sarif: serde_json::Value =
        serde_json::from_str(&ahv_review::sarif(&reviewed).expect("JSON")).expect("JSON");
    assert_eq!(json["errors"], 1);
    let found = json["files"][0]["findings"].as_array().expect("findings");
    let results = sarif["runs"][0]["results"].as_array().expect("results");
    assert_eq!((found.len(), results.len()), (count, count));
    for (one, other) in found.iter().zip(results) {
        assert_eq!(one["rule"], other["ruleId"]);
        assert_eq!(one["severity"], other["level"]);
        let place = &other["locations"][0]["physicalLocation"];
        assert_eq!(one["line"], place["region"]["startLine"]);
        assert_eq!(one["column"], place["region"]["startColumn"]);
        assert_eq!(place["artifactLocation"]["uri"], "tables/d%20com.toml");
    }
    let text = ahv_review::rendered(&reviewed, false);
    assert!(
        text.contains("error: 2 numbers are unverified; this is the first [unverified]"),
        "{text}"
    );
    assert!(
        text.ends_with("1 table: 1 error, 0 warnings, 3 notes\n"),
        "{text}"
    );
}

/// A generator of numbers for changes of tables.
struct Random(u64);

impl Random {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        usize::try_from(self.0 >> 33).unwrap_or(0) % most
    }
}

/// The text with other spaces, comments and line ends, and lines that move or are lost.
fn shaken(text: &str, random: &mut Random) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for line in &mut lines {
        *line = match random.below(8) {
            0 => line.replace(" = ", "="),
            1 => line.replace(", ", " ,   "),
            2 if !line.is_empty() => format!("  {line}"),
            3 => format!("{line}   # a comment, é\u{301}"),
            4 if line.starts_with('"') => format!("\n# above\n{line}"),
            5 => line.replace("{ ", "{"),
            _ => continue,
        };
    }
    let (one, other) = (random.below(lines.len()), random.below(lines.len()));
    lines.swap(one, other);
    lines.join(["\n", "\r\n"][random.below(2)])
}

#[test]
fn the_layout_says_the_same_and_is_its_own() {
    let mut laid = 0;
    for (path, _) in TABLES {
        let own = text(path);
        for seed in 0..60 {
            let shaken = shaken(&own, &mut Random(seed));
            let Ok(table) = Text::parse(shaken.clone()) else {
                continue;
            };
            let once = laid_out(&table).expect("the same");
            let twice = laid_out(&Text::parse(once.clone()).expect("TOML")).expect("the same");
            assert_eq!(once, twice, "{path}, seed {seed}");
            // Nothing but spaces changes.
            let letters = |text: &str| text.chars().filter(|c| *c != ' ').collect::<String>();
            assert_eq!(letters(&once), letters(&shaken), "{path}, seed {seed}");
            laid += 1;
        }
    }
    assert!(laid > 150, "{laid}");
}

#[test]
fn columns_stand_below_one_another() {
    let text = "[C_L] # lift\n\"alpha^2\" = { value = 4.6773, unit = \"1/rad^2\" }\n\
        \"1\"={value=-0.01, unit=\"1\", source = \"a # b\"} # constant\n\n\"eta\" = { value = 1e3 , unit = \"1\" }\n\
        \"x\".value = 3\n[validity]\nv = { min = 7000, max = 11000.0, unit = \"ft/s\" }\nalpha = { min = -5.0, max = 10.0, unit = \"deg\" }\n";
    let expected = "[C_L] # lift\n\"alpha^2\" = { value =  4.6773, unit = \"1/rad^2\" }\n\
        \"1\"       = { value = -0.01,   unit = \"1\",       source = \"a # b\" } # constant\n\n\"eta\" = { value = 1e3, unit = \"1\" }\n\
        \"x\".value = 3\n[validity]\nv     = { min = 7000,   max = 11000.0, unit = \"ft/s\" }\nalpha = { min =   -5.0, max =    10.0, unit = \"deg\" }\n";
    let table = Text::parse(text.to_owned()).expect("TOML");
    assert_eq!(laid_out(&table).expect("the same"), expected);
}

#[test]
fn shares_add_up_and_are_those_of_the_box() {
    let own = text("generator/tables/dcom.toml");
    let table = Text::parse(own).expect("TOML");
    let overview = Overview::new(&table, &subject("generator/tables/dcom.toml", "generated"));
    let fits = overview
        .groups
        .iter()
        .filter(|it| it.unit.is_some() && it.set.is_none());
    for group in fits {
        let sum: f64 = group.entries.iter().filter_map(|it| it.share).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{}: {sum}", group.section);
    }
    let lift = overview
        .groups
        .iter()
        .find(|it| it.section == "C_L")
        .expect("lift");
    // 4.6773 per rad at 10 deg, which is the larger end.
    let slope = lift.entries[0].largest.expect("a box");
    assert!(
        (slope - 4.6773 * 10.0_f64.to_radians()).abs() < 1e-12,
        "{slope}"
    );
    let shown = overview.to_string();
    assert!(
        shown.contains("[C_L] lift coefficient, dimensionless"),
        "{shown}"
    );
    assert!(shown.contains("█"), "{shown}");
}

#[test]
fn a_page_holds_no_text_of_the_table_as_markup() {
    let own = text("generator/tables/dcom.toml");
    let hostile = own.replacen(
        "plate = \"",
        "plate = \"<script>alert('x')</script>\\u202e\\u0000",
        1,
    );
    let table = Text::parse(hostile).expect("TOML");
    let overview = Overview::new(&table, &subject("generator/tables/dcom.toml", "generated"));
    let page = ahv_review::page(&overview);
    assert!(
        !page.contains("<script") && page.contains("&lt;script&gt;"),
        "{page}"
    );
    assert!(!page.contains(['\u{202e}', '\0']) && !overview.to_string().contains('\u{202e}'));
    assert!(!page.contains("http"), "the page needs no network");
}

/// Every value of a table by its path.
fn values(text: &Text) -> Vec<String> {
    fn collect(table: &dyn toml_edit::TableLike, path: &str, found: &mut Vec<String>) {
        for (key, item) in table.iter() {
            // `" alpha"` is another spelling of `"alpha"`.
            let factors: Vec<&str> = key.split('*').map(|it| it.trim_matches(' ')).collect();
            let path = format!("{path}\0{}", factors.join("*"));
            match item.as_table_like() {
                Some(inner) if inner.is_empty() => found.push(path),
                Some(inner) => collect(inner, &path, found),
                None => found.push(format!("{path}\0{}", item.to_string().trim())),
            }
        }
    }
    let mut found = Vec::new();
    collect(text.root(), "", &mut found);
    found.sort();
    found
}

#[test]
fn a_changed_letter_is_a_fault_or_a_difference_or_nothing() {
    const LETTERS: &[u8] = b"0159.-+eaz_\"=,{}[]# \n^*/";
    let mut counts = [0; 4];
    for (path, package) in TABLES {
        let own = text(path);
        let subject = subject(path, package);
        let before = Text::parse(own.clone()).expect("TOML");
        let known = values(&before);
        let mut random = Random(7);
        for _ in 0..500 {
            let mut bytes = own.clone().into_bytes();
            let (at, letter) = (
                random.below(bytes.len()),
                LETTERS[random.below(LETTERS.len())],
            );
            match random.below(3) {
                0 => bytes[at] = letter,
                1 => bytes.insert(at, letter),
                _ => drop(bytes.remove(at)),
            }
            let Ok(changed) = String::from_utf8(bytes) else {
                continue;
            };
            let Ok(after) = Text::parse(changed.clone()) else {
                counts[0] += 1;
                continue;
            };
            let is_same = values(&after) == known;
            let faults = faults(&after, &subject);
            if !faults.is_empty() {
                assert!(!is_same, "{path}: {faults:#?}");
                counts[1] += 1;
                continue;
            }
            let difference = Difference::new(&before, &after, &subject);
            let other: Vec<String> = values(&after)
                .into_iter()
                .filter(|it| !known.contains(it))
                .collect();
            assert_eq!(
                difference.is_empty(),
                is_same,
                "{path}: {other:?}, {difference:#?}"
            );
            counts[if is_same { 2 } else { 3 }] += 1;
        }
    }
    println!("{counts:?}: not TOML, refused, the same, different");
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
}

#[test]
fn differences_are_those_of_the_numbers() {
    let path = "generator/tables/dcom.toml";
    let own = text(path);
    let subject = subject(path, "generated");
    let before = Text::parse(own.clone()).expect("TOML");
    let other = own
        .replacen(
            "\"alpha\" = { value = 4.6773, unit = \"1/rad\" }",
            "\"alpha\" = { value = 0.0834, unit = \"1/deg\" }",
            1,
        )
        .replacen("\"1\" = { value = 0.010131, unit = \"1\" }\n", "", 1)
        .replacen("omega_1 = { value = 20.5", "omega_1 = { value = 20.6", 1)
        .replacen("earth = \"flat\"", "earth = \"spherical\"", 1);
    let after = Text::parse(other).expect("TOML");
    let found = Difference::new(&before, &after, &subject);
    let paths: Vec<&str> = found.changes.iter().map(|it| it.path.as_str()).collect();
    assert_eq!(
        paths,
        ["C_L.alpha", "sets.\"section5.3\".modes.omega_1", "C_D.1"]
    );
    // 0.0834 per degree, beside 4.6773 per radian and its 40 %.
    let change = 0.0834 * 57.295_779_513_082_32 - 4.6773;
    let close = |a: Option<f64>, b: f64| a.is_some_and(|a| (a / b - 1.0).abs() < 1e-12);
    assert!(
        close(found.changes[0].relative, change / 4.6773),
        "{found:#?}"
    );
    assert!(close(
        found.changes[0].uncertainties,
        change / (4.6773 * 0.4)
    ));
    assert!(found.changes[2].new.is_none() && found.changes[2].relative.is_none());
    let [lift, drag] = found.quantities.as_slice() else {
        panic!("{found:#?}")
    };
    assert!(close(lift.at_most, change * 10.0_f64.to_radians()));
    assert!(close(drag.at_most, 0.010131));
    let flat = Some("\"flat\"".to_owned());
    let spherical = Some("\"spherical\"".to_owned());
    assert_eq!(
        found.others,
        [("choices.earth".to_owned(), flat, spherical)]
    );
}
