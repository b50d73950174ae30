//! Units of tables and packages.

use ahv_codegen::ir::UnitSystem;
use ahv_codegen::{Options, emit};

use crate::{PACKAGE, emitted, irs, parsed, table, text_of};

/// The first line in which two texts differ.
fn first_difference(ours: &str, theirs: &str) -> String {
    let mut pairs = ours.lines().zip(theirs.lines());
    let found = pairs.find(|(a, b)| a != b);
    format!("{found:?}")
}

#[test]
fn si_is_another_package_in_numbers_and_units_alone() {
    let options = |units: UnitSystem| Options {
        units: Some(units),
        ..Options::default()
    };
    let same = emitted(&options(UnitSystem::FootSlug));
    for (path, text) in PACKAGE.iter() {
        assert!(
            *text == same[path],
            "{path}: {}",
            first_difference(text, &same[path])
        );
    }
    let si = emitted(&options(UnitSystem::Si));
    assert!(PACKAGE.keys().eq(si.keys()));
    // Without comments, the functions are the same: a unit of length does not change an equation.
    let code = |text: &str| -> Vec<String> {
        // Where a comment breaks depends on its units.
        let lines = text.lines().filter(|line| !line.trim().starts_with("//"));
        let lines = lines.map(|line| line.split("//").next().unwrap_or_default());
        lines.map(|line| line.trim_end().to_owned()).collect()
    };
    for (path, text) in PACKAGE.iter() {
        let numbers = [
            "nominal.rs",
            "parameters.rs",
            "mod.rs",
            "description.rs",
            "table.rs",
        ];
        if path.ends_with(".rs") && !numbers.iter().any(|name| path.ends_with(name)) {
            let (ours, theirs) = (code(text).join("\n"), code(&si[path]).join("\n"));
            assert!(
                ours == theirs,
                "{path}: {}",
                first_difference(&ours, &theirs)
            );
        }
    }
    for (path, text) in si.iter().filter(|(path, _)| path.ends_with("nominal.rs")) {
        assert!(text.contains("UNIT_SYSTEM: &str = \"si\""), "{path}");
        assert!(!text.contains("ft-slug-s-rad\";"), "{path}");
    }
    let nominal = &si["src/dcom/nominal.rs"];
    // 300 slug/ft, 17 ft, and of the set section5.3 191.3 slug/ft; rad/s stay.
    for line in [
        "    s: 5.1816",
        "    m: 14364.07769",
        "    m: 9159.4935",
        "    omega_1: 20.5,",
    ] {
        assert!(nominal.contains(line), "no {line} in {nominal}");
    }
    assert!(si["src/lib.rs"].contains("metre, kilogram, second and radian"));
}

/// The printed number stands in the code.
#[test]
fn a_value_per_degree_is_written_as_it_is_printed() {
    let text = text_of("com")
        .replacen(
            r#""alpha" = { value = 4.6773, unit = "1/rad" }"#,
            r#""alpha" = { value = 0.0816, unit = "1/deg" }"#,
            1,
        )
        .replacen(
            r#""alpha^2" = { value = 5.8224, unit = "1/rad^2" }"#,
            r#""alpha^2" = { value = 0.0018, unit = "1/deg^2" }"#,
            1,
        );
    let tree = emit(&[parsed("com", &text)], &irs(), &Options::default()).unwrap();
    let nominal = &tree["src/com/nominal.rs"];
    for line in [
        "const DEGREE: f64 = core::f64::consts::PI / 180.0;",
        "    c_l_alpha: 0.0816 / DEGREE,",
        "    c_d_alpha_2: 0.0018 / DEGREE / DEGREE,",
    ] {
        assert!(nominal.contains(line), "{line} is not in {nominal}");
    }
    assert!(!PACKAGE["src/com/nominal.rs"].contains("DEGREE"));
}

#[test]
fn tables_in_two_unit_systems_need_a_choice() {
    let mut irs = irs();
    let text = irs.get_mut("flexible_mode").unwrap();
    let system = "\"system\": \"ft-slug-s-rad\",\n    \"other\": \"si\"";
    assert!(text.contains(system));
    *text = text.replacen(
        system,
        "\"system\": \"si\",\n    \"other\": \"ft-slug-s-rad\"",
        1,
    );
    let tables = [table("com"), table("flexible_mode")];
    let error = emit(&tables, &irs, &Options::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("different unit systems") && error.contains("--units"),
        "{error}"
    );
    let units = Some(UnitSystem::Si);
    let options = Options {
        units,
        ..Options::default()
    };
    let tree = emit(&tables, &irs, &options).unwrap();
    // What is in SI already is left alone.
    assert!(tree["src/flexible_mode/nominal.rs"].contains("    sigma: 100.0,"));
    assert!(tree["src/com/nominal.rs"].contains("    s: 5.1816"));
}
