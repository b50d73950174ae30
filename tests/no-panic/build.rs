//! Writes the calls of every public function of the generated package, as its source declares them, so that none can
//! be forgotten.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

const SOURCE: &str = "../../generated/src";

fn main() {
    println!("cargo::rerun-if-changed={SOURCE}");
    let modules: Vec<PathBuf> = entries(Path::new(SOURCE))
        .into_iter()
        .filter(|path| path.is_dir())
        .collect();
    assert!(!modules.is_empty(), "no model in {SOURCE}");
    let mut text = String::from("fn every_model<R: Real>() {\n");
    for module in &modules {
        writeln!(text, "    {}::<R>();", name(module)).expect("a String can be written to");
    }
    text.push_str("}\n");
    for module in &modules {
        text.push_str(&calls(module));
    }
    let out = env::var_os("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&out).join("calls.rs"), text).expect("OUT_DIR is writable");
}

/// A function that calls every function of a module.
fn calls(module: &Path) -> String {
    let model = name(module);
    let sources: Vec<String> = entries(module).iter().map(|path| read(path)).collect();
    let source = sources.join("\n");
    let functions: Vec<String> = source
        .match_indices("\npub fn ")
        .map(|(at, _)| call(&model, &source[at + 8..]))
        .collect();
    assert!(
        functions.len() > 10,
        "{SOURCE}/{model} has but {} functions",
        functions.len()
    );
    let stochastic = source.contains("ahv_core::StochasticModel for Model<R>");
    let noise = if stochastic {
        "    stochastic(&model);\n"
    } else {
        ""
    };
    format!(
        "fn {model}<R: Real>() {{
    let nominal = black_box({model}::NOMINAL.map_into(R::from_f64));
    let (x, u, p): ({model}::State<R>, {model}::Input<R>, _) = (unknown(), unknown(), {model}::prepare(&nominal));
{}{}    let model = black_box({model}::Model::new(&nominal)).map_ref(|&value| black_box(value));
    differentiable(&model, &{model}::STATE_BOUNDS, &{model}::INPUT_BOUNDS);
{noise}    vector::<R, {model}::Parameters<R>>();
}}
",
        functions.concat(),
        choices(&model, &source),
    )
}

/// The call of a function whose declaration `text` begins with.
fn call(model: &str, text: &str) -> String {
    let (head, rest) = text.split_once('(').expect("a list of arguments");
    let (arguments, _) = rest.split_once(')').expect("its end");
    let (function, _) = head
        .split_once('<')
        .expect("functions are generic over the scalar");
    let argument = |declared: &str| match declared.split_once(": ").expect("name: Type").1 {
        "&State<R>" => "&x".to_owned(),
        "&Input<R>" => "&u".to_owned(),
        "&Prepared<R>" => "&p".to_owned(),
        "&Parameters<R>" => "&nominal".to_owned(),
        "&Noise<R>" => "&unknown()".to_owned(),
        "R" => "black_box(R::ONE)".to_owned(),
        // What several functions share.
        other => {
            let stage = other
                .strip_prefix('&')
                .and_then(|it| it.strip_suffix("<R>"));
            let stage = stage.unwrap_or_else(|| {
                panic!(
                    "{model}::{function} has an argument of type {other}: say here how it is called"
                )
            });
            format!("&black_box({model}::{stage}::splat(R::ONE))")
        }
    };
    let declared = arguments
        .split(',')
        .map(str::trim)
        .filter(|declared| !declared.is_empty());
    let given: Vec<String> = declared.map(argument).collect();
    format!(
        "    black_box({model}::{function}::<R>({}));\n",
        given.join(", ")
    )
}

/// The calls that make every choice, by a name of which the optimiser knows nothing.
fn choices(model: &str, source: &str) -> String {
    let mut text = String::new();
    for (at, found) in source.match_indices("    pub fn with_") {
        let (method, rest) = source[at + found.len()..]
            .split_once("(self, choice: ")
            .expect("a choice");
        let (choice, _) = rest.split_once(')').expect("its end");
        writeln!(
            text,
            "    black_box({model}::{choice}::from_name(black_box(\"none\")).map(|choice| (choice.name(), nominal.with_{method}(choice))));"
        )
        .expect("a String can be written to");
    }
    text
}

fn name(path: &Path) -> String {
    path.file_name()
        .expect("an entry of a folder has one")
        .to_string_lossy()
        .into_owned()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("cannot read {}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("a readable folder").path())
        .collect();
    paths.sort();
    paths
}

fn read(path: &Path) -> String {
    fs::read_to_string(path)
        .unwrap_or_else(|error| panic!("cannot read {}: {error}", path.display()))
}
