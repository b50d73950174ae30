//! Changes of tables: of letters, and of numbers.

use ahv_review::{Difference, faults};
use ahv_table::Text;

use crate::common::{Random, TABLES, subject, text};

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
            let after = match Text::parse(changed.clone()) {
                Ok(after) => after,
                Err(error) => {
                    assert!(error.span.is_some(), "{path}: no place: {error}");
                    counts[0] += 1;
                    continue;
                }
            };
            let is_same = values(&after) == known;
            let faults = faults(&after, &subject);
            if !faults.is_empty() {
                assert!(!is_same, "{path}: {faults:#?}");
                // Of each the line can be shown.
                let is_placed = |it: &ahv_review::Finding| changed.get(it.span.clone()).is_some();
                assert!(faults.iter().all(is_placed), "{path}: {faults:#?}");
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
