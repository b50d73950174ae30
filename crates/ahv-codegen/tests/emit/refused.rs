//! What is refused, and in which words.

use ahv_codegen::{Options, emit};

use crate::{irs, parsed, table, text_of};

/// File, what is edited there into what, and words of the message; `\n` is an end of a line.
const REFUSED: &str = r#"
dcom.toml | canard = "none" | canard = "fixed" | `fixed` at `choices.canard`
com.toml | m = { value = 300.0 | mm = { value = 300.0 | vehicle.m.value | com.toml
com.json | "slug/ft": [ | "slug/foot": [ | `slug/ft` | derive it again
dcom.json | "schema_version": 5 | "schema_version": 1 | schema version 1 | reads 5
dcom.json | "input": [ | "inputs": [ | unknown variant `inputs`
dcom.json | "class": "constant" | "class": "konstant" | unknown variant `konstant`
dcom.json | "status": "derived" | "status": "guessed" | unknown variant `guessed`
dcom.json | "system": "ft-slug-s-rad" | "system": "cgs" | unknown variant `cgs`
dcom.json | {"at": ["velocity", "phi"] | {"at": ["velocity", "phy"] | bases do not hold
dcom.json | "x.velocity", 2] | "x.velocity", 2.5] | the exponent 2.5
dcom.json | ["state", "noise", "noise"],\n              "unit": null,\n              "symmetric": false,\n              "entries": [] | ["state", "noise", "mode"], "unit": null, "entries": [] | an output over [State, Noise, Mode], which the emitter has no form for
"#;

#[test]
fn tables_and_irs_that_do_not_fit_are_refused() {
    for line in REFUSED.trim().lines() {
        let line = line.replace("\\n", "\n");
        let mut parts = line.split(" | ");
        let mut part = || parts.next().unwrap();
        let ((name, kind), from, to) = (part().split_once('.').unwrap(), part(), part());
        let (mut irs, mut text) = (irs(), text_of(name));
        let edited = match kind {
            "toml" => &mut text,
            _ => irs.get_mut(name).unwrap(),
        };
        assert!(edited.contains(from), "no {from}");
        *edited = edited.replacen(from, to, 1);
        let emitted = emit(&[parsed(name, &text)], &irs, &Options::default());
        let message = emitted.unwrap_err().to_string();
        for words in parts {
            assert!(message.contains(words), "{words} is not in: {message}");
        }
    }
}

#[test]
fn a_model_that_two_tables_make_is_refused() {
    let text = text_of("dcom").replacen("\"dcom\"", "\"other\"", 1);
    let mut irs = irs();
    irs.insert("other".to_owned(), irs["dcom"].clone());
    let error = emit(
        &[table("dcom"), parsed("other", &text)],
        &irs,
        &Options::default(),
    )
    .unwrap_err()
    .to_string();
    assert!(
        error.contains("dcom.toml") && error.contains("other.toml"),
        "{error}"
    );
}

/// A name is refused by what it is in Rust or in the package, whichever name that is.
#[test]
fn names_that_would_not_compile_are_refused() {
    let packaged = |package: &str| {
        let options = Options {
            package: package.to_owned(),
            ..Options::default()
        };
        emit(&[table("flexible_mode")], &irs(), &options)
    };
    for (package, why) in [
        ("fn", "Rust has a word of its own"),
        ("self", "Rust has a word of its own"),
        ("ahv-core", "it needs a package of that name itself"),
        ("ahv_core", "it needs a package of that name itself"),
        ("nalgebra", "it needs a package of that name itself"),
        ("std", "Rust has a crate of that name"),
    ] {
        let message = packaged(package).unwrap_err().to_string();
        assert!(
            message.contains(why) && message.contains(&format!("`{package}`")),
            "{message}"
        );
    }
    assert!(packaged("my-models2").is_ok());
}

#[test]
fn a_set_does_not_take_the_name_of_what_the_models_have() {
    let renamed = |name: &str| {
        let mut irs = irs();
        let quoted = |name: &str| format!("\"{name}\"");
        let ir = irs["dcom"].replace(&quoted("section5.3"), &quoted(name));
        irs.insert("dcom".to_owned(), ir);
        let text = text_of("dcom").replace("[sets.\"section5.3\"", &format!("[sets.\"{name}\""));
        emit(&[parsed("dcom", &text)], &irs, &Options::default())
    };
    for name in ["hessian-pattern", "diffusion.pattern", "noise_class"] {
        let message = renamed(name).unwrap_err().to_string();
        let words = "which the models have already; choose another name";
        assert!(
            message.contains(name) && message.contains(words),
            "{message}"
        );
    }
    assert!(renamed("heavy").is_ok());
}
