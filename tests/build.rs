//! Writes a function for each model that evaluates all its generated functions, from the IR: none can be left out.

use serde_json::Value;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs, io};

const IR: &str = "../generated/ir";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed={IR}");
    let mut paths: Vec<_> = fs::read_dir(IR)?
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<_, _>>()?;
    paths.sort();
    let (mut text, mut models) = (String::new(), Vec::new());
    for path in paths {
        let document: Value = serde_json::from_str(&fs::read_to_string(&path)?)?;
        let table = document["provenance"]["table"].as_str().unwrap_or_default();
        for model in list(&document["models"]) {
            models.push((name(model), table.to_owned()));
            text += &evaluation(model);
        }
    }
    let listed: Vec<String> = models
        .iter()
        .map(|(model, table)| format!("({model:?}, {table:?})"))
        .collect();
    text += &format!(
        "/// The models, each with its table.\npub const MODELS: [(&str, &str); {}] = [{}];\n\n",
        models.len(),
        listed.join(", ")
    );
    let arms: String = models
        .iter()
        .map(|(model, _)| format!("        {model:?} => {model}::<R>(inputs),\n"))
        .collect();
    text += &format!(
        "fn dispatch<R: Real + PartialEq>(model: &str, inputs: &Inputs) -> Values {{\n    match model {{\n{arms}        \
         other => panic!(\"unknown model {{other}}\"),\n    }}\n}}\n"
    );
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets no OUT_DIR"))?;
    fs::write(Path::new(&out).join("evaluate.rs"), text)
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn name(value: &Value) -> String {
    value["name"].as_str().unwrap_or_default().to_owned()
}

/// The function that evaluates one model.
fn evaluation(model: &Value) -> String {
    let module = name(model);
    let mut body = String::new();
    let quantities = list(&model["quantities"])
        .iter()
        .map(|q| (name(q), &q["expr"]))
        .collect();
    for function in list(&model["functions"]) {
        let arguments = arguments(function, &quantities);
        let function_name = name(function);
        let call = format!("model::{function_name}({arguments})");
        let outputs = list(&function["outputs"]);
        if function_name == "outputs" {
            body += &together(model, function, &quantities);
            continue;
        }
        if function_name.starts_with("drift_and_") {
            let parts = function_name.trim_start_matches("drift_and_");
            let tuple = if parts == "jacobians" {
                "(drift, a, b)"
            } else {
                "(drift, a)"
            };
            let pattern = if parts == "jacobians" { "(a, b)" } else { "a" };
            // Computed at one go, they are the same numbers: the oracle needs no second look at them.
            let _ = writeln!(
                body,
                "    let (drift, {pattern}) = (model::drift(&x, &u, &p), model::{parts}({arguments}));\n    \
                 assert_eq!({call}, {tuple});"
            );
            if function["compressed"] == true {
                let _ = writeln!(
                    body,
                    "    let {pattern} = model::{parts}_values({arguments});\n    \
                     assert_eq!(model::{function_name}_values({arguments}), {tuple});"
                );
            }
            continue;
        }
        let names: Vec<String> = (0..outputs.len()).map(|k| format!("y{k}")).collect();
        let pattern = if names.len() == 1 {
            names[0].clone()
        } else {
            format!("({})", names.join(", "))
        };
        let _ = writeln!(body, "    let {pattern} = {call};");
        for (output, variable) in outputs.iter().zip(&names) {
            let inner = if outputs.len() > 1 {
                format!(".{}", name(output))
            } else {
                String::new()
            };
            let _ = writeln!(
                body,
                "    {}",
                put(output, &format!("{function_name}{inner}"), variable)
            );
        }
        if function["compressed"] == true {
            let tuple = if names.len() == 1 {
                names[0].clone()
            } else {
                format!("({})", names.join(", "))
            };
            let values: Vec<String> = (0..outputs.len()).map(|k| format!("v{k}")).collect();
            let pattern = if values.len() == 1 {
                values[0].clone()
            } else {
                format!("({})", values.join(", "))
            };
            let _ = writeln!(
                body,
                "    let {pattern} = model::{function_name}_values({arguments});"
            );
            for (output, (dense, value)) in outputs.iter().zip(names.iter().zip(&values)) {
                let constant = pattern_name(output);
                let depth = list(&output["basis"]).len();
                let _ = writeln!(
                    body,
                    "    held{depth}(&model::{constant}_PATTERN, &{value}.to_array(), &{dense});\n    assert!({value}.dense() == {dense});"
                );
            }
            let _ = writeln!(body, "    let _ = {tuple};");
        }
    }
    let noise = if model["noise"].is_object() {
        "    let dw: model::Noise<R> = vector(\"noise\", inputs);\n"
    } else {
        ""
    };
    let scalars: String = list(&model["bases"]["argument"])
        .iter()
        .map(|argument| {
            let argument = name(argument);
            format!("    let {argument} = R::from_f64(inputs[\"argument.{argument}\"]);\n")
        })
        .collect();
    format!(
        "fn {module}<R: Real + PartialEq>(inputs: &Inputs) -> Values {{\n    \
         use ahv_models::{module} as model;\n    \
         let x: model::State<R> = vector(\"state\", inputs);\n    \
         let u: model::Input<R> = vector(\"input\", inputs);\n\
         {noise}{scalars}    \
         let p = model::prepare(&vector::<R, model::Parameters<R>>(\"parameter\", inputs));\n    \
         let mut values = Values::new();\n{body}    values\n}}\n\n"
    )
}

/// The outputs together are the same numbers as those of the functions that have one alone, which the oracle knows.
fn together(model: &Value, function: &Value, quantities: &HashMap<String, &Value>) -> String {
    let alone: HashMap<String, &Value> = list(&model["functions"])
        .iter()
        .map(|function| (name(function), function))
        .collect();
    let entries = list(&function["outputs"])
        .iter()
        .flat_map(|output| list(&output["entries"]));
    let mut body = format!(
        "    let all = model::outputs({});\n",
        arguments(function, quantities)
    );
    for output in entries.filter_map(|entry| entry["at"][0].as_str()) {
        if let Some(alone) = alone.get(output) {
            let arguments = arguments(alone, quantities);
            let _ = writeln!(
                body,
                "    assert_eq!(all.{output}, model::{output}({arguments}), \"{output}\");"
            );
        }
    }
    body + "    let _ = all;\n"
}

/// The statement that notes the values of an output.
fn put(output: &Value, label: &str, variable: &str) -> String {
    let basis: Vec<&str> = list(&output["basis"])
        .iter()
        .filter_map(Value::as_str)
        .collect();
    let call = match basis.as_slice() {
        [] => return format!("values.insert({label:?}.to_owned(), {variable}.to_f64());"),
        ["mode"] => "put_array",
        [_] => "put",
        [_, _] => "put_rows",
        _ if output["symmetric"] == true => "put_symmetric",
        _ => "put_cube",
    };
    format!("{call}(&mut values, {label:?}, &{variable});")
}

/// The constant that says where the entries of a compressed output stand, without its ending.
fn pattern_name(output: &Value) -> &'static str {
    let basis: Vec<&str> = list(&output["basis"])
        .iter()
        .filter_map(Value::as_str)
        .collect();
    match basis.as_slice() {
        ["state", "state"] => "STATE_JACOBIAN",
        ["state", "input"] => "INPUT_JACOBIAN",
        ["state", "parameter"] => "PARAMETER_JACOBIAN",
        ["state", "noise"] => "DIFFUSION",
        ["state", "state", "state"] => "HESSIAN",
        _ => "NOISE_DERIVATIVES",
    }
}

/// The arguments of a function: state, input and parameters always, others where it mentions them.
fn arguments(function: &Value, quantities: &HashMap<String, &Value>) -> String {
    let mut found = Vec::new();
    for output in list(&function["outputs"]) {
        for entry in list(&output["entries"]) {
            mentioned(&entry["expr"], quantities, &mut found);
        }
    }
    let mut arguments = "&x, &u, &p".to_owned();
    if found.iter().any(|leaf| leaf.starts_with("w.")) {
        arguments += ", &dw";
    }
    for scalar in ["frequency", "time"] {
        if found.contains(&format!("t.{scalar}")) {
            let _ = write!(arguments, ", {scalar}");
        }
    }
    arguments
}

/// Names that an expression mentions, directly or through quantities, each once.
fn mentioned(expr: &Value, quantities: &HashMap<String, &Value>, found: &mut Vec<String>) {
    if let Some(name) = expr.as_str()
        && !found.iter().any(|known| known == name)
    {
        found.push(name.to_owned());
        if let Some(inner) = quantities.get(name) {
            mentioned(inner, quantities, found);
        }
    }
    for argument in list(expr).iter().skip(1) {
        mentioned(argument, quantities, found);
    }
}
