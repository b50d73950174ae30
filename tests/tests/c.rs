//! The C library has the bits of the Rust: every function at every reference point, and flights by both steppers.
//!
//! The C is emitted here, compiled by the system's compiler with warnings denied, and driven by a program that is made from
//! the IR, so that no function can be left out.
#![forbid(unsafe_code)]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use ahv_core::{GeneratedModel, ModelList as _, ModelVisitor, Vector};
use ahv_integrate::{ItoEulerMaruyama, Rk4, StepError};
use ahv_tests::c::{compile, write_library};
use ahv_tests::evaluate::{MODELS, evaluate, vector};
use ahv_tests::vectors::read_oracle;
use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

/// A model of the IR with what its bases are called.
struct Described {
    table: String,
    document: Value,
    model: Value,
}

impl Described {
    fn of(model: &str, table: &str) -> Self {
        let ir = fs::read_to_string(root().join(format!("generated/ir/{table}.json")));
        let document: Value = serde_json::from_str(&ir.expect("an IR")).expect("JSON");
        let models = list(&document["models"]).iter();
        let found = models.clone().find(|it| text(it, "name") == model);
        let model = found.expect("the model").clone();
        Self {
            table: table.to_owned(),
            document,
            model,
        }
    }

    fn names(&self, basis: &str) -> Vec<String> {
        let of = match basis {
            "parameter" => &self.document["parameters"],
            basis => &self.model["bases"][basis],
        };
        let names = list(of).iter().map(|it| text(it, "name").to_owned());
        names.collect()
    }

    /// A type of the C library.
    fn of_type(&self, basis: &[&str]) -> String {
        let camel = |name: &str| -> String {
            let words = name.split('_').map(|word| {
                let (first, rest) = word.split_at(1);
                first.to_uppercase() + rest
            });
            words.collect()
        };
        let own = camel(text(&self.model, "name"));
        match basis {
            [] => "double".to_owned(),
            ["parameter"] => format!("{}Parameters", camel(&self.table)),
            ["output"] => format!("{own}Outputs"),
            [one] => format!("{own}{}", camel(one)),
            ["state", "state"] => format!("{own}StateJacobian"),
            ["state", "input"] => format!("{own}InputJacobian"),
            ["state", "parameter"] => format!("{own}ParameterJacobian"),
            ["state", "noise"] => format!("{own}Diffusion"),
            ["state", "state", "state"] => format!("{own}Hessian"),
            ["state", "noise", "noise"] => format!("{own}NoiseDerivatives"),
            other => panic!("{other:?}"),
        }
    }

    /// What the numbers of an output are called.
    fn labels(&self, prefix: &str, basis: &[&str]) -> Vec<String> {
        let mut labels = vec![prefix.to_owned()];
        for basis in basis {
            let names: Vec<String> = match *basis {
                "mode" => (0..self.names("mode").len())
                    .map(|k| k.to_string())
                    .collect(),
                basis => self.names(basis),
            };
            labels = labels
                .iter()
                .flat_map(|label| names.iter().map(move |name| format!("{label}.{name}")))
                .collect();
        }
        labels
    }

    /// Whether a function's derivation mentions a leaf that begins so.
    fn mentions(&self, function: &Value, prefix: &str) -> bool {
        let quantities = list(&self.model["quantities"]).iter();
        let quantities: BTreeMap<&str, &Value> = quantities
            .map(|it| (text(it, "name"), &it["expr"]))
            .collect();
        let outputs = list(&function["outputs"]).iter();
        let entries = outputs.flat_map(|it| list(&it["entries"]));
        let mut open: Vec<&Value> = entries.map(|it| &it["expr"]).collect();
        let mut seen = Vec::new();
        while let Some(expr) = open.pop() {
            if let Some(name) = expr.as_str() {
                if name.starts_with(prefix) {
                    return true;
                }
                if !seen.contains(&name) {
                    seen.push(name);
                    open.extend(quantities.get(name));
                }
            }
            open.extend(list(expr).iter().skip(1));
        }
        false
    }

    /// A program that prints the results of all functions at each point of its input, and what they are called.
    fn driver(&self) -> (String, Vec<String>) {
        let name = text(&self.model, "name");
        let is_stochastic = self.model["noise"].is_object();
        let (mut calls, mut labels) = (String::new(), Vec::new());
        for function in list(&self.model["functions"]) {
            let function_name = text(function, "name");
            let mut arguments = vec!["&x".to_owned(), "&u".to_owned(), "&p".to_owned()];
            if self.mentions(function, "w.") {
                arguments.push("&dw".to_owned());
            }
            for scalar in ["frequency", "time"] {
                if self.mentions(function, &format!("t.{scalar}")) {
                    arguments.push(scalar.to_owned());
                }
            }
            let outputs = list(&function["outputs"]);
            let mut block = String::new();
            let mut shown = String::new();
            for (k, output) in outputs.iter().enumerate() {
                let basis: Vec<&str> = list(&output["basis"])
                    .iter()
                    .filter_map(Value::as_str)
                    .collect();
                let prefix = match (function_name, text(output, "name")) {
                    ("outputs", _) => String::new(),
                    (joint, "drift") if joint.starts_with("drift_and_") => "drift".to_owned(),
                    (joint, inner) => {
                        let own = joint.strip_prefix("drift_and_").unwrap_or(joint);
                        let is_named = !inner.is_empty() && own != inner && outputs.len() > 1;
                        let is_single = joint != own && outputs.len() == 2;
                        if is_named && !is_single {
                            format!("{own}.{inner}")
                        } else {
                            own.to_owned()
                        }
                    }
                };
                let names = self.labels(&prefix, &basis);
                labels.extend(names.iter().map(|it| it.trim_start_matches('.').to_owned()));
                if basis.is_empty() && outputs.len() == 1 {
                    let list = arguments.join(", ");
                    let _ = writeln!(
                        block,
                        "        const double y = {name}_{function_name}({list});"
                    );
                    shown += "        show(&y, 1);\n";
                    continue;
                }
                let count = names.len();
                if basis == ["mode"] {
                    let _ = writeln!(block, "        double y{k}[{count}];");
                    arguments.push(format!("y{k}"));
                    let _ = writeln!(shown, "        show(y{k}, {count});");
                } else {
                    let of = self.of_type(&basis);
                    let _ = writeln!(block, "        {of} y{k};");
                    arguments.push(format!("&y{k}"));
                    let _ = writeln!(shown, "        show((const double *)&y{k}, {count});");
                }
            }
            if !block.contains("const double y =") {
                let _ = writeln!(
                    block,
                    "        {name}_{function_name}({});",
                    arguments.join(", ")
                );
            }
            let _ = write!(calls, "        {{\n{block}{shown}        }}\n");
        }
        let (state, input) = (self.of_type(&["state"]), self.of_type(&["input"]));
        let parameters = self.of_type(&["parameter"]);
        let count = |basis: &str| self.names(basis).len();
        let (noise, read_noise) = if is_stochastic {
            let of = self.of_type(&["noise"]);
            (
                format!("    {of} dw;\n"),
                format!("        read((double *)&dw, {});\n", count("noise")),
            )
        } else {
            (String::new(), String::new())
        };
        let scalars = self.names("argument");
        let declared: String = scalars
            .iter()
            .map(|it| format!("    double {it};\n"))
            .collect();
        let read: String = scalars
            .iter()
            .map(|it| format!("        read(&{it}, 1);\n"))
            .collect();
        let steps = if is_stochastic {
            format!(
                "        fly = {name}_euler_maruyama_step(&p, &u, &dw, 0.0037, &x);\n        \
                 end = (double)fly;\n        show(&end, 1);\n        show((const double *)&x, {});\n",
                count("state")
            )
        } else {
            String::new()
        };
        let program = format!(
            "#include <stdint.h>\n#include <stdio.h>\n#include <stdlib.h>\n#include <string.h>\n#include \"{name}.h\"\n\n\
             static int read(double *to, int count)\n{{\n    int k;\n    for (k = 0; k < count; k++) {{\n        \
             char text[32];\n        uint64_t bits;\n        if (scanf(\"%31s\", text) != 1) {{ return 0; }}\n        \
             bits = (uint64_t)strtoull(text, NULL, 16);\n        (void)memcpy(&to[k], &bits, sizeof bits);\n    }}\n    \
             return 1;\n}}\n\n\
             static void show(const double *of, int count)\n{{\n    int k;\n    for (k = 0; k < count; k++) {{\n        \
             uint64_t bits;\n        (void)memcpy(&bits, &of[k], sizeof bits);\n        \
             (void)printf(\"%016llx\\n\", (unsigned long long)bits);\n    }}\n}}\n\n\
             int main(void)\n{{\n    {state} x;\n    {input} u;\n    {parameters} parameters;\n    \
             {own}Prepared p;\n    int fly;\n    double end;\n{noise}{declared}\n    \
             while (read((double *)&x, {states}) != 0) {{\n        read((double *)&u, {inputs});\n        \
             read((double *)&parameters, {count});\n{read_noise}{read}        {name}_prepare(&parameters, &p);\n{calls}        \
             fly = {name}_rk4_step(&p, &u, 0.0037, &x);\n        end = (double)fly;\n        show(&end, 1);\n        \
             show((const double *)&x, {states});\n{steps}    }}\n    return 0;\n}}\n",
            own = state.trim_end_matches("State"),
            states = count("state"),
            inputs = count("input"),
            count = count("parameter"),
        );
        (program, labels)
    }
}

/// How the library is compiled: for this very processor too, which may have a fused multiply-add.
const FLAGS: [&[&str]; 3] = [
    &["-O2"],
    &["-O0"],
    if cfg!(target_arch = "x86_64") {
        &["-O3", "-march=native"]
    } else {
        &["-O3"]
    },
];

/// What a driver prints, compiled in each of these ways: the same numbers.
fn driven(folder: &Path, name: &str, table: &str, program: &str, input: &str) -> Vec<f64> {
    fs::write(folder.join(format!("drive_{name}.c")), program).expect("a file");
    let [first, others @ ..] = FLAGS.map(|flags| run(folder, flags, name, table, input));
    for (flags, other) in FLAGS[1..].iter().zip(others) {
        let mut pairs = first.iter().zip(&other);
        assert_eq!(first.len(), other.len(), "{name} {flags:?}");
        assert!(pairs.all(|(a, b)| same(*a, *b)), "{name} {flags:?}");
    }
    first
}

/// Compiles a driver with the library and feeds it.
fn run(folder: &Path, flags: &[&str], name: &str, table: &str, input: &str) -> Vec<f64> {
    let binary = folder.join(format!("drive_{name}"));
    let sources = [
        format!("drive_{name}.c"),
        format!("src/{name}.c"),
        format!("src/{table}_parameters.c"),
        "src/ahv_elementary.c".to_owned(),
    ];
    compile(folder, flags, &sources, &binary);
    let mut child = Command::new(&binary)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the driver runs");
    let mut pipe = child.stdin.take().expect("a pipe");
    let input = input.to_owned();
    let writer = std::thread::spawn(move || pipe.write_all(input.as_bytes()));
    let output = child.wait_with_output().expect("the driver ends");
    writer.join().expect("a thread").expect("the driver reads");
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).expect("text");
    let bits = text
        .lines()
        .map(|line| u64::from_str_radix(line, 16).expect("bits"));
    bits.map(f64::from_bits).collect()
}

fn same(ours: f64, theirs: f64) -> bool {
    ours.to_bits() == theirs.to_bits() || (ours.is_nan() && theirs.is_nan())
}

/// One step of RK4 and, of a stochastic model, one of Euler-Maruyama behind it: how each ended, and the state.
struct Steps<'a> {
    model: &'a str,
    inputs: &'a BTreeMap<String, f64>,
    found: Vec<f64>,
}

impl ModelVisitor for Steps<'_> {
    fn visit<M: GeneratedModel>(&mut self) {
        if M::NAME != self.model {
            return;
        }
        let parameters: M::ParametersOf<f64> = vector("parameter", self.inputs);
        let model = M::with_parameters(&parameters);
        let mut x: M::StateOf<f64> = vector("state", self.inputs);
        let u: M::InputOf<f64> = vector("input", self.inputs);
        let names = <M::StateOf<f64> as Vector<f64>>::NAMES;
        let ended = |result: Result<(), StepError<f64>>| match result {
            Ok(()) => 0.0,
            Err(StepError::StepSize { .. }) => -1.0,
            Err(StepError::NonFinite { name, .. }) => {
                let place = names.iter().position(|it| *it == name);
                place.map_or(f64::NAN, |it| it as f64 + 1.0)
            }
        };
        let components = |x: &M::StateOf<f64>| -> Vec<f64> {
            (0..names.len()).filter_map(|k| x.get(k)).collect()
        };
        self.found
            .push(ended(Rk4::new(DT).step(&model, &mut x, &u)));
        self.found.extend(components(&x));
        if <M::NoiseOf<f64> as Vector<f64>>::LEN > 0 {
            let dw: M::NoiseOf<f64> = vector("noise", self.inputs);
            let step = ItoEulerMaruyama::new(DT).step(&model, &mut x, &u, &dw);
            self.found.push(ended(step));
            self.found.extend(components(&x));
        }
    }
}

/// A step whose sixth is not a sixth of the step in the last bit.
const DT: f64 = 0.0037;

#[test]
fn every_function_and_step_has_the_bits_of_rust() {
    let folder = tempfile::tempdir().expect("a folder");
    write_library(folder.path());
    for (model, table) in MODELS {
        let described = Described::of(model, table);
        let (program, labels) = described.driver();
        let points = read_oracle(&root().join(format!("tests/vectors/{model}.sympy.txt")));
        let mut input = String::new();
        for point in &points {
            let noise: &[&str] = if described.model["noise"].is_object() {
                &["noise"]
            } else {
                &[]
            };
            let bases = ["state", "input", "parameter"].iter().chain(noise);
            for basis in bases.chain(&["argument"]) {
                for name in described.names(basis) {
                    let bits = point.inputs[&format!("{basis}.{name}")].to_bits();
                    let _ = writeln!(input, "{bits:016x}");
                }
            }
        }
        let mut found = driven(folder.path(), model, table, &program, &input).into_iter();
        let mut compared = 0;
        for point in &points {
            let ours = evaluate::<f64>(model, &point.inputs);
            for label in &labels {
                let theirs = found.next().expect("a number");
                // A mirrored entry stands under its other name; a composed output that has no function of its own is left out.
                if let Some(ours) = ours.get(label) {
                    assert!(
                        same(*ours, theirs),
                        "{model} {label}: {ours:e} and {theirs:e}"
                    );
                    compared += 1;
                }
            }
            let mut steps = Steps {
                model,
                inputs: &point.inputs,
                found: Vec::new(),
            };
            ahv_models::Models::visit(&mut steps);
            for ours in steps.found {
                let theirs = found.next().expect("a number");
                assert!(same(ours, theirs), "{model} step: {ours:e} and {theirs:e}");
            }
        }
        assert_eq!(found.next(), None);
        println!("{model}: {compared} values of {} points", points.len());
        assert!(compared > 30 * points.len(), "{model}: only {compared}");
    }
}
