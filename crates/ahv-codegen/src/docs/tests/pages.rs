//! Pages, pictures and magnitudes.

use super::super::differences::three_digits;
use super::super::search::largest;
use super::super::{Costs, Page, Subject, emit_index, emit_model, emit_table};
use super::{TABLE, document, read};
use crate::Tree;
use crate::evaluate::Tape;
use crate::ir::{Expr, UnitSystem};

fn pages(text: &str, system: Option<UnitSystem>) -> Tree {
    let (table, document, values) = read(text, system);
    let costs = Costs::from([("drift".to_owned(), "7 operations".to_owned())]);
    let subject = Subject {
        table: &table,
        document: &document,
        values: &values,
    };
    let mut tree = emit_table(&subject).expect("a page");
    tree.extend(emit_model(&subject, &document.models[0], &costs).expect("pages"));
    tree
}

#[test]
fn a_model_page_holds_what_the_ir_and_the_table_say() {
    let tree = pages(TABLE, None);
    let page = &tree["docs/small.md"];
    for part in [
        "# small: a small model",
        "| $V$ | `speed` | ft/s | speed | 1 to 3 ft/s |",
        r"\dot{V} = \phi \sin \alpha \tag{1}",
        r"\dot{\alpha} = -\frac{C_L}{m V} \tag{1}",
        r"C_L = C_L^{\alpha} \alpha + C_L^{0} \tag{2}",
        "C_L = 4.5\\, \\alpha\n  - 2.5\\cdot 10^{-5}\n",
        r"H_{V} = V C_L^{\alpha} \tag{2}",
        "1 pair of columns does not commute: $w_1$ and $w_2$.",
        "G_{V,w_1} = V",
        "| `drift` | Time derivative | (1) | 2 state | 2 of 2 |  | 7 operations |",
        "images/small-structure.svg",
    ] {
        assert!(page.contains(part), "{part} is missing from\n{page}");
    }
    // A derivative that only the code names is not an equation of the model.
    assert!(!page.contains("`d_c_l_d_angle`"), "{page}");
    assert!(tree["docs/images/small-structure.svg"].starts_with("<svg "));
}

#[test]
fn a_table_page_shows_sets_side_by_side() {
    let tree = pages(TABLE, None);
    let page = &tree["docs/small-table.md"];
    for part in [
        "| $m$ | `m` | mass | 2 | 3 (unverified, book) | slug | published | ±40 % | book |",
        "The table has `canard = \"slaved\"`.",
        "| `slaved` | follows the elevator | 1 |",
        "| book | A book \\| with a bar |",
        "| `angle` | angle | -90 | 90 | deg |",
        "| ft/s | 0.3048 | m/s |",
    ] {
        assert!(page.contains(part), "{part} is missing from\n{page}");
    }
}

#[test]
fn a_changed_value_changes_the_lines_that_print_it() {
    let before = pages(TABLE, None);
    let changed = TABLE.replace("value = 4.5", "value = 4.625");
    let after = pages(&changed, None);
    let mut different = 0;
    for (path, text) in &before {
        assert_eq!(text.lines().count(), after[path].lines().count(), "{path}");
        for (old, new) in text
            .lines()
            .zip(after[path].lines())
            .filter(|(old, new)| old != new)
        {
            assert_eq!(old.replace("4.5", "4.625"), new, "{path}");
            different += 1;
        }
    }
    assert_eq!(different, 2);
}

#[test]
fn differences_are_largest_where_the_box_says() {
    let tree = pages(TABLE, None);
    let page = &tree["docs/small.md"];
    // s V sin(alpha) with s = 1, V up to 3 and alpha up to 90 deg; the canard is free nowhere here.
    assert!(
        page.contains("| $\\Delta f_{V}$ | ft/s^2 | 3.00 |"),
        "{page}"
    );
    assert!(
        page.contains("$V$ 3.00 ft/s, $\\alpha$ -90.0 deg"),
        "{page}"
    );
    assert!(page.contains("canard = \"slaved\""), "{page}");
    assert!(!page.contains("canard = \"free\""), "{page}");
}

#[test]
fn the_search_finds_a_maximum_inside_the_box() {
    // x (1 − x) y at x = 1/2, y = 3, and its negative elsewhere.
    let expr: Expr =
        serde_json::from_str(r#"["*", "x.a", ["-", 1, "x.a"], "x.b"]"#).expect("an expression");
    let document = document();
    let tape = Tape::compile(&document.models[0], [&expr]).expect("a tape");
    let found = largest(&tape, 1, &[(0.0, 1.0), (-1.0, 3.0)]);
    assert!((found[0].value - 0.75).abs() < 1e-6, "{found:?}");
    assert!((found[0].point[0] - 0.5).abs() < 1e-3, "{found:?}");
    assert_eq!(found, largest(&tape, 1, &[(0.0, 1.0), (-1.0, 3.0)]));
}

#[test]
fn numbers_have_three_digits() {
    for (value, text) in [
        (0.0, "0"),
        (1.2345, "1.23"),
        (-12.345, "-12.3"),
        (9.999, "10.0"),
        (0.012345, "0.0123"),
        (123456.0, "123000"),
        (-999.9, "-1000"),
        (1.2345e-7, "1.23e-7"),
        (1.2345e9, "1.23e9"),
    ] {
        assert_eq!(three_digits(value), text);
    }
}

#[test]
fn the_index_lists_models_tables_and_further_pages() {
    let (table, document, values) = read(TABLE, None);
    let further = [Page {
        path: "audit.md".into(),
        title: "Audit".into(),
        about: "what was found".into(),
    }];
    let tree = emit_index(
        &[Subject {
            table: &table,
            document: &document,
            values: &values,
        }],
        &further,
    )
    .expect("a page");
    let page = &tree["docs/README.md"];
    for part in [
        "| [small](small.md) | a small model | (1)-(2) | 2 | 1 | 2 | 5 | [small](small-table.md) |",
        "| canard = slaved | nominal, heavy |",
        "* [Audit](audit.md): what was found",
    ] {
        assert!(page.contains(part), "{part} is missing from\n{page}");
    }
}

#[test]
fn other_units_reach_every_page() {
    let tree = pages(TABLE, Some(UnitSystem::Si));
    for (path, part) in [
        (
            "docs/small.md",
            "| $V$ | `speed` | m/s | speed | 0.3048 to 0.9144",
        ),
        ("docs/small.md", "in the units si"),
        ("docs/small-table.md", "| mass | 29.1878 | 43.7817"),
        ("docs/small-table.md", "| kg | "),
    ] {
        assert!(
            tree[path].contains(part),
            "{part} is missing from\n{}",
            tree[path]
        );
    }
}
