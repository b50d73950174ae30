//! The documentation of small documents, formulas and magnitudes.

mod formulas;
mod pages;

use crate::Table;
use crate::ir::{Document, UnitSystem};
use crate::values::Values;

/// The table of a model with two states, an input and a curve fit.
const TABLE: &str = r#"
[table]
name = "small"
models = ["small"]

[sources]
book = "A book | with a bar"

[choices]
canard = "slaved"

[validity]
speed = { min = 1.0, max = 3.0, unit = "ft/s" }
angle = { min = -90.0, max = 90.0, unit = "deg" }

[vehicle]
m = { value = 2.0, unit = "slug" }

[C_L]
"angle" = { value = 4.5, unit = "1/rad" }
"1" = { value = -2.5e-5, unit = "1" }

[sets.heavy.vehicle]
m = { value = 3.0, unit = "slug" }
"#;

/// Its IR.
const IR: &str = r#"{
  "schema_version": 5,
  "provenance": {"table": "small", "generator": "0", "casadi": "0"},
  "units": {"system": "ft-slug-s-rad", "other": "si", "factors": {"1": ["1", 1.0], "1/rad": ["1/rad", 1.0], "ft/s": ["m/s", 0.3048],
    "ft/s^2": ["m/s^2", 0.3048], "rad": ["rad", 1.0], "rad/s": ["rad/s", 1.0], "s^0.5": ["s^0.5", 1.0], "slug": ["kg", 14.5939]}},
  "joins": [],
  "fits": [],
  "choices": [{"name": "canard", "type": "Canard", "doc": "canard", "options": [
    {"name": "free", "doc": "an input", "values": {"slaving": 0.0}},
    {"name": "slaved", "doc": "follows the elevator", "values": {"slaving": 1.0}}]}],
  "sets": [{"name": "nominal", "parameters": []},
    {"name": "heavy", "parameters": [{"name": "m", "path": ["sets", "heavy", "vehicle", "m"],
      "source": "book", "status": "unverified", "uncertainty": 0.1}]}],
  "parameters": [
    {"name": "m", "path": ["vehicle", "m"], "symbol": "m", "unit": "slug", "doc": "mass", "kind": "parameter", "models": [], "source": "book", "status": "published", "uncertainty": 0.4},
    {"name": "slaving", "path": ["choices", "canard"], "symbol": "s_c", "unit": "1", "doc": "share", "kind": "switch", "models": [], "source": "book", "status": "assumed", "uncertainty": 0.0},
    {"name": "c_l_angle", "path": ["C_L", "angle"], "symbol": "C_L^{\\alpha}", "unit": "1/rad", "doc": "slope", "kind": "coefficient", "models": [], "source": "book", "status": "published", "uncertainty": 0.4},
    {"name": "c_l_0", "path": ["C_L", "1"], "symbol": "C_L^{0}", "unit": "1", "doc": "constant", "kind": "coefficient", "models": [], "source": "book", "status": "published", "uncertainty": 0.4}],
  "validity": [{"name": "speed", "unit": "ft/s", "doc": "speed"}, {"name": "angle", "unit": "rad", "doc": "angle"}],
  "models": [{
    "name": "small", "title": "a small model", "equations": "(1)-(2)",
    "bases": {
      "state": [{"name": "speed", "symbol": "V", "unit": "ft/s", "doc": "speed", "validity": "speed"},
                {"name": "angle", "symbol": "\\alpha", "unit": "rad", "doc": "angle", "validity": "angle"}],
      "input": [{"name": "push", "symbol": "\\phi", "unit": "1", "doc": "push"}],
      "noise": [{"name": "w_1", "symbol": "w_1", "unit": "s^0.5", "doc": "noise"}, {"name": "w_2", "symbol": "w_2", "unit": "s^0.5", "doc": "noise"}]},
    "quantities": [
      {"name": "sin_angle", "symbol": "\\sin\\alpha", "unit": "1", "doc": "sine", "equation": "(1)", "section": "Angles", "expr": ["sin", "x.angle"]},
      {"name": "inverse", "symbol": "1/(mV)", "unit": "1", "doc": "reciprocal", "equation": "(1)", "section": "Motion", "expr": ["/", 1, ["*", "p.m", "x.speed"]]},
      {"name": "c_l", "symbol": "C_L", "unit": "1", "doc": "lift coefficient", "equation": "(2)", "section": "Curve fits", "expr": ["+", ["*", "p.c_l_angle", "x.angle"], "p.c_l_0"]},
      {"name": "speed_rate", "symbol": "\\dot V", "unit": "ft/s^2", "doc": "rate", "equation": "(1)", "section": "Motion", "expr": ["*", "u.push", "sin_angle"]},
      {"name": "angle_rate", "symbol": "\\dot\\alpha", "unit": "rad/s", "doc": "rate", "equation": "(1)", "section": "Motion", "expr": ["neg", ["*", "c_l", "inverse"]]},
      {"name": "d_c_l_d_angle", "symbol": "\\frac{\\partial C_L}{\\partial \\alpha}", "unit": "1", "doc": "slope", "equation": "", "section": "Derivatives with respect to angle", "expr": "p.c_l_angle"}],
    "functions": [
      {"name": "drift", "group": "drift", "doc": "Time derivative", "equation": "(1)", "outputs": [{"name": "drift", "basis": ["state"], "unit": null,
        "entries": [{"at": ["speed"], "expr": "speed_rate"}, {"at": ["angle"], "expr": "angle_rate"}]}]},
      {"name": "jacobians", "group": "jacobians", "doc": "Derivatives", "equation": "(1)", "outputs": [{"name": "state", "basis": ["state", "state"], "unit": null,
        "entries": [{"at": ["speed", "angle"], "expr": ["*", "u.push", ["cos", "x.angle"]]}, {"at": ["angle", "angle"], "expr": ["neg", ["*", "d_c_l_d_angle", "inverse"]]}]}]},
      {"name": "parameter_jacobian", "group": "parameter_jacobian", "doc": "Derivatives", "equation": "(1)", "outputs": [{"name": "parameter", "basis": ["state", "parameter"], "unit": null,
        "entries": [{"at": ["angle", "m"], "expr": ["*", "c_l", "inverse"]}, {"at": ["angle", "c_l_angle"], "expr": ["*", "x.angle", "inverse"]}, {"at": ["angle", "c_l_0"], "expr": "p.m"}]}]},
      {"name": "diffusion", "group": "diffusion", "doc": "Diffusion", "equation": "(2)", "outputs": [{"name": "diffusion", "basis": ["state", "noise"], "unit": null,
        "entries": [{"at": ["speed", "w_1"], "expr": "x.speed"}, {"at": ["angle", "w_2"], "expr": 1}]}]},
      {"name": "H_V", "group": "strict_feedback", "doc": "Total derivative", "equation": "(2)", "outputs": [{"name": "", "basis": [], "unit": "1", "entries": [{"at": [], "expr": ["*", "x.speed", "d_c_l_d_angle"]}]}]},
      {"name": "delta_f_V", "group": "strict_feedback", "doc": "Difference", "equation": "(2)", "outputs": [{"name": "", "basis": [], "unit": "ft/s^2", "entries": [{"at": [], "expr": ["*", "p.slaving", "x.speed", ["sin", "x.angle"]]}]}]}],
    "noise": {"columns": [{"name": "w_1", "class": "diagonal"}, {"name": "w_2", "class": "constant"}], "commuting": []},
    "note": null, "trim": {"given": [], "sought": [], "equations": [], "moving": [], "shown": []}, "modes": [],
    "defaults": {"inputs": [], "outputs": []}, "deviations": {}
  }],
  "rules": []
}"#;

fn document() -> Document {
    Document::parse("small", IR).expect("a document")
}

/// Table, IR and numbers, in the units of the table or in others.
fn read(text: &str, system: Option<UnitSystem>) -> (Table, Document, Values) {
    let (table, mut document) = (
        Table::parse("small.toml", text).expect("a table"),
        document(),
    );
    let values = Values::read(&table, &mut document, system).expect("numbers");
    (table, document, values)
}
