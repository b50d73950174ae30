//! How tables are laid out and shown.

use ahv_review::{Overview, laid_out};
use ahv_table::Text;

use crate::common::{Random, TABLES, subject, text};

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
