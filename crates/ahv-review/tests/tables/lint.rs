//! Each rule and what it finds.

use std::path::Path;

use ahv_review::{Finding, LINTS, Reviewed, Severity};

use crate::common::{TABLES, found, of_ir, subject, text};

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
