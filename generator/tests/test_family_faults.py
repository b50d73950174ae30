"""Faults of a family file: each one message with file and line, and nothing written."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from ahv_generator.diagnostics import Diagnostic, TableError
from ahv_generator.table import load

EXAMPLE = Path(__file__).parents[2] / "examples" / "van-der-pol"
FAMILY = (EXAMPLE / "van_der_pol.py").read_text(encoding="utf-8").replace("Family, Model", "Family, Given, Model")
TABLE = (EXAMPLE / "van_der_pol.toml").read_text(encoding="utf-8")

ENERGY = '        energy = model.define("energy", (v**2 + (w * x) ** 2) / 2, "E", "m^2/s^2", "energy per mass")'
BOUNDS = "family.bounds(position, rate, drive)"
MODEL = '@family.model("van_der_pol",'
OMEGA = 'omega = Parameter("omega",'
PARAMETERS = 'family.parameters("oscillator", omega)'
FIT = "model.fit(damping)"
TRIM = "sought=[Sought(position), Sought(rate)]"
RATES = "{position: v, rate: u - model.fit(damping) * v - w**2 * x}"
OUTPUTS = "model.outputs(energy)"
QUANTITIES = "family.quantities(damping)"


def write(folder: Path, family: str, table: str = TABLE) -> Path:
    (folder / "van_der_pol.py").write_text(family, encoding="utf-8")
    path = folder / "van_der_pol.toml"
    path.write_text(table, encoding="utf-8")
    return path


def faults(path: Path) -> list[Diagnostic]:
    with pytest.raises(TableError) as caught:
        load(path).build()
    return caught.value.diagnostics


def after(line: str, *more: str) -> str:
    """A line, and further ones below it with the same indentation."""
    indent = line[: len(line) - len(line.lstrip())]
    return "\n".join([line, *(indent + one for one in more)])


def rule(terms: str) -> str:
    return f'{QUANTITIES}\nfrom ahv_generator.modelling import Rule\nfamily.rules(Rule("r", {terms}, POSITIVE, "z"))'


def evaluations(name: str) -> str:
    return after(OUTPUTS, f"    model.evaluations(model.define('{name}', x * 2, 'q', 'm', 'it'))")


NOISE = 'Variable("w", "w", "s^0.5", "Wiener increment")'

CASES = [
    # what is replaced, by what, the line at fault begins with, part of the message, part of the help
    # the file itself
    (OUTPUTS, "model.outputs(energy, energy)", "model.outputs", "`energy` is used twice", None),
    (ENERGY, after(ENERGY, "__import__('math').sin(x)"), "__import__", "a number is needed where `x.position`", None),
    (ENERGY, after(ENERGY, "model.define('far', x / 0, 'E', 'm', 'far')"), "model.define", "is not finite", None),
    (ENERGY, after(ENERGY, "Given(position, 1.0, 3.0, 0.5)"), "Given", "`default` of `position` is 1.0", None),
    (TRIM, 'sought=[Sought(position, float("nan")), Sought(rate)]', "model.trim", "`start` of `position` is nan", None),
    (TRIM, "sought=[Sought(position, 0.0, -1.0), Sought(rate)]", "model.trim", "`scale` of `position` is -1.0", None),
    (OMEGA, "1 / 0\n" + OMEGA, "1 / 0", "ZeroDivisionError: division by zero", None),
    (ENERGY, after(ENERGY, "raise ValueError('no such vehicle')"), "raise", "ValueError: no such vehicle", None),
    (OMEGA, "raise SystemExit(3)\n" + OMEGA, "raise", "SystemExit: 3", None),
    (OMEGA, "raise KeyboardInterrupt\n" + OMEGA, "raise", "KeyboardInterrupt", None),
    (OMEGA, "class Other(BaseException):\n    pass\nraise Other('no')\n" + OMEGA, "raise", "Other: no", None),
    (OMEGA, "import os\nos._exit(3)\n" + OMEGA, "os._exit", "`os._exit(3)` would end the derivation", None),
    (OMEGA, "omega == (\n" + OMEGA, "omega == (", "SyntaxError: '(' was never closed", None),
    (OMEGA, "import sibling\n" + OMEGA, "import sibling", "No module named 'sibling'", "a family is one file"),
    (OMEGA, "from .sibling import x\n" + OMEGA, "from .sibling", "relative import", None),
    ("family = Family()", "Family = 3\nfamily = Family()", "family = Family", "TypeError", None),
    # names
    ("states=(position, rate)", "states=(position, position)", MODEL, "`position` is used twice in the model", None),
    (PARAMETERS, PARAMETERS + "\n" + PARAMETERS, PARAMETERS, "the name `omega` is used twice", None),
    (QUANTITIES, QUANTITIES + "\n" + QUANTITIES, QUANTITIES, "the name `c` is used twice", None),
    (BOUNDS, BOUNDS + "\n" + BOUNDS, BOUNDS, "the interval `position` is used twice", None),
    (ENERGY, ENERGY + "\n" + ENERGY, "energy = ", "the name `energy` is used twice in `van_der_pol`", None),
    ('"energy",', '"rate",', "energy = ", "the name `rate` is used twice in `van_der_pol`", None),
    ('"energy",', '"d_energy",', "energy = ", "`d_energy` would be taken for a derivative", None),
    ('"energy",', '"x",', "energy = ", "`x` is the name of a vector", None),
    ('"energy",', '"Energy",', "energy = ", "`Energy` is not a lower-case identifier", None),
    ('Parameter("omega"', 'Parameter("loop"', OMEGA.replace('"omega",', '"loop",'), "keyword of Rust", None),
    ("model.fit(damping)", 'model.fit("E")', "model.motion", "no table of `van_der_pol` has the quantity `E`", "`C`"),
    ("x, v, u, w =", 'model["mass"]\n    x, v, u, w =', 'model["mass"]', "`mass` is not defined", None),
    (OUTPUTS, 'model.outputs("enrgy")', "model.outputs", "`enrgy` is not a quantity", "`energy`"),
    (OUTPUTS, "model.outputs(x + 1)", "model.outputs", "has no name", None),
    (PARAMETERS, 'family.parameters("sets", omega)', "family.parameters", "`[sets]` has a meaning of its own", None),
    ('r"\\dot x"', '"\\adot x"', "rate = ", "'\\x07dot x' has a control character; write LaTeX as a raw string", None),
    ('"energy per mass"', '""', "energy = ", "`energy` has no text", None),
    ('"natural frequency"', '""', OMEGA, "`omega` has no text", None),
    # units
    ('"m^2/s^2"', '"m/s"', "energy = ", "energy is declared in `m/s`, but its expression has the dimensions"
     " length^2/time^2", None),
    ("(v**2 + ", "(v + ", "energy = ", "a sum of unlike dimensions, length/time and length^2/time^2", None),
    (RATES, RATES.replace("* v -", "* x -"), "model.motion", "a sum of unlike dimensions", None),
    (RATES, RATES.replace("{position: v", "{position: x"), "model.motion",
     "the rate of `position` is declared in", None),
    ('"rad/s", "natural', '"furlong", "natural', OMEGA, "the unit of `omega`: `furlong` is not a unit", None),
    ('"1/s", "damping', '"", "damping', "damping = ", "the unit of `c`: the unit is empty", None),
    # the model
    (RATES, "{rate: u}", "model.motion", "the rate of `position` is missing in `van_der_pol`", None),
    (RATES, RATES.replace("{", "{drive: u, "), "model.motion", "states of `van_der_pol`: there is no `drive`", None),
    ("        model.motion(", "        dict(", MODEL, "`van_der_pol` has no equations of motion", None),
    ("    model.outputs(energy)\n", "", MODEL, "`van_der_pol` has no outputs", None),
    ("family.bounds(position, rate", 'family.bounds(position, Variable("rate", "v", "m", "?")', MODEL,
     "`rate` is in `m/s`, but its bounds are in `m`", None),
    ("inputs=(drive,)", "inputs=()", MODEL, "the model `van_der_pol` has no input", None),
    (BOUNDS, "family.bounds(position, drive)", MODEL, "the state `rate` of `van_der_pol` has no bounds",
     "family.bounds"),
    (BOUNDS, "family.bounds(position, rate)", MODEL, "the input `drive` of `van_der_pol` has no bounds", None),
    (TRIM, "sought=[Sought(position)]", "model.trim",
     "the trim of `van_der_pol` has 2 equations (position, rate) for 1 unknowns (position)", None),
    (TRIM, 'sought=[Sought("speed"), Sought(rate)]', "model.trim", "there is no `speed`", None),
    (TRIM, TRIM + ", given=[Given(energy, 1.0)]", "model.trim",
     "has 3 equations (position, rate, energy) for 2 unknowns", None),
    (TRIM, TRIM + ', given=[Given("speed", 1.0)]', "model.trim",
     "that a trim is given of `van_der_pol`: there is no `speed`", None),
    ("equations=[Equation(position), Equation(rate)]", "given=[Given(energy, 1.0)], equations=[Equation(energy)]",
     "model.trim", "equations of the trim of `van_der_pol`: `energy` is used twice", None),
    (TRIM, TRIM + ', shown=["speed"]', MODEL, "that a trim shows of `van_der_pol`: there is no `speed`",
     None),
    (OUTPUTS, after(OUTPUTS, '    model.mode("one", rate)', '    model.mode("two", rate)'), 'model.mode("two"',
     "`rate` is used twice", None),
    (OUTPUTS, after(OUTPUTS, '    model.diffusion({("rate", "w"): w}, "")'), "model.diffusion", "there is no `w`",
     None),
    ("w**2 * x", "w**2.5 * x", "model.motion", "a sum of unlike dimensions", None),
    # derived variables
    ("depends_on=(position,)", 'depends_on=(position, Variable("speed", "s", "1", "speed over sound"))', "model.motion",
     "`speed` is not defined in `van_der_pol` before this line", None),
    ("depends_on=(position,)", "depends_on=[position, position]", "damping = ", "`C` depends twice on one of", None),
    ("depends_on=(position,)", 'depends_on=(position,), required=("rate",)', "damping = ",
     "`C` does not depend on `rate`", None),
    # the family
    (QUANTITIES, QUANTITIES + '\nfrom ahv_generator.modelling import Rule\n'
     'family.rules(Rule("r", ((1.0, ("zeta",)),), POSITIVE, "z"))', "family.rules", "names `zeta`", None),
    (BOUNDS, BOUNDS + '\nwith family.only_for("pendulum"):\n    pass', "with family.only_for",
     "`pendulum` is not a model of the family", "`van_der_pol`"),
    ("POSITIVE)", '"large")', OMEGA, "`large` is not a range", None),
    (PARAMETERS, 'other = Parameter("o", "o", "rad/s", "other", above=omega)\nfamily.parameters("more", other)',
     "family.parameters", "`o` must exceed `omega`, which is not declared before it", None),
    (PARAMETERS, 'other = Parameter("o", "o", "s", "other", above=omega)', "other = ",
     "`o` is in `s`; it cannot exceed",
     None),
    (OUTPUTS, evaluations("slopes"), "model.evaluations", "`slopes` is a function of the generated code", None),
    (OUTPUTS, evaluations("drift_from"), "model.evaluations", "`drift_from` is a function of the generated", None),
    # rules
    (QUANTITIES, rule('((1.0, ("c_positon_2",)),)'), "family.rules", "names `c_positon_2`", "`c_position_2`"),
    (QUANTITIES, rule('((1.0, ("c_rate",)),)'), "family.rules", "names `c_rate`", "like `c_l_alpha_2`"),
    (QUANTITIES, rule('((1.0, ("drag_0",)),)'), "family.rules", "names `drag_0`", "like `c_l_alpha_2`"),
    (QUANTITIES, rule('((1.0, ("omga",)),)'), "family.rules", "names `omga`", "`omega`"),
    (QUANTITIES, rule('((1.0, ("c_0",)), (-1.0, ("c_position_2",)))'), "family.rules",
     "the terms of the rule `r` have unlike dimensions, 1/time and 1/time/length^2", None),
    (QUANTITIES, rule('((1.0, ("omega",)), (-1.0, ()))'), "family.rules", "unlike dimensions, 1/time and 1", None),
    (QUANTITIES, rule('((float("nan"), ("omega",)),)'), "family.rules", "a factor of the rule `r` is nan", None),
    (QUANTITIES, rule('(("2", ("omega",)),)'), "family.rules", "`Rule`: `terms[0][0]` is the text '2'; expected is a"
     " number", None),
    # what is stated once
    (OUTPUTS, after(OUTPUTS, "    model.outputs(energy)"), "model.outputs", "`model.outputs` is called twice", None),
    ("        model.motion(" + RATES + ")", after("        model.motion(" + RATES + ")", "model.motion({position: v})"),
     "model.motion({position: v})", "`model.motion` is called twice, on line 23 and on line 24; call it once", None),
    (OUTPUTS, after(OUTPUTS, "    model.trim(sought=[], equations=[])"), "model.trim(sought=[Sought",
     "`model.trim` is called twice, on line 25 and on line 26", None),
    (OUTPUTS, after(OUTPUTS, '    model.note("a")', '    model.note("b")'), 'model.note("b")', "`model.note`", None),
    (OUTPUTS, after(OUTPUTS, "    model.defaults()", "    model.defaults(inputs=[])"), "model.defaults(inputs", "twice",
     None),
    (OUTPUTS, after(OUTPUTS, "    model.deviations({})", "    model.deviations({position: 1})"),
     "model.deviations({position", "twice", None),
    ("inputs=(drive,))", f"inputs=(drive,), noise=({NOISE},))", MODEL,
     "the model `van_der_pol` has the noise `w`, but no diffusion", "leave out `noise=`"),
    ("inputs=(drive,))", f"inputs=(drive,), noise=({NOISE},))  # w", MODEL, "the noise `w`", "`model.diffusion(...)`"),
    # what is of another type, or of another model
    (PARAMETERS, PARAMETERS.replace("omega)", '"omega")'), "family.parameters",
     "`Family.parameters`: `parameters[0]` is the text 'omega'; expected is a Parameter", None),
    (BOUNDS, BOUNDS.replace("rate,", "omega,"), BOUNDS.replace("rate,", "omega,"),
     "`Family.bounds`: `variables[1]` is the Parameter `omega`; expected is a Variable", None),
    ("states=(position, rate)", "states=position", MODEL,
     "`Family.model`: `states` is the Variable `position`; expected"
     " is a list, each of it a Variable", None),
    ("depends_on=(position,)", "depends_on=position", "damping = ",
     "`Quantity`: `depends_on` is the Variable `position`",
     None),
    ('"x", "m", "displacement"', '"x", 1, "displacement"', "position = ",
     "`Variable`: `unit` is `1`; expected is a text",
     None),
    (TRIM, "sought=[position, rate]", "model.trim",
     "`Model.trim`: `sought[0]` is the Variable `position`; expected is a"
     " Sought", None),
    (TRIM, "sought=[Sought(3.0)]", "model.trim", "`Sought`: `unknown` is `3.0`; expected is a Variable, a text or an"
     " expression", None),
    (TRIM, TRIM + ', shown="energy"', "model.trim", "`Model.trim`: `shown` is the text 'energy'; expected is a list",
     None),
    (ENERGY, after(ENERGY, "from ahv_generator.modelling import sin", "sin(rate)"), "sin(rate)", "`sin`: `x` is the"
     " Variable `rate`; expected is an expression or a number", "`model[...]`"),
    (ENERGY, after(ENERGY, "2 * omega"), "2 * omega", "unsupported operand type(s) for *", "`model[...]`"),
    (FIT, "model.fit(position)", "model.motion", "`Model.fit`: `quantity` is the Variable `position`; expected is a"
     " Quantity or a text", None),
    (RATES, "{position: None, rate: u}", "model.motion", "`Model.motion`: `rates[the Variable `position`]` is `None`;"
     " expected is an expression or a number", None),
    (RATES, "{position: v, 3: u}", "model.motion", "`Model.motion`: `rates (a key)` is `3`; expected is a Variable or a"
     " text", None),
    (RATES, "[v, u]", "model.motion", "`Model.motion`: `rates` is of the type `list`; expected is a dictionary", None),
    (ENERGY, after(ENERGY, "import casadi", 'model.define("e", casadi.SX(2, 2), "e", "1", "e")'), "model.define",
     "`Model.define`: `expr` is the expression of 2 by 2", None),
    (ENERGY, after(ENERGY, "import casadi", 'model.define("e", casadi.SX.sym("y"), "e", "1", "e")'), "model.define",
     "`y` is not a symbol of this model", None),
    (ENERGY, after(ENERGY, "import casadi", 'model.define("e", casadi.SX.sym("x.position"), "e", "m", "e")'),
     "model.define", "`x.position` is not a symbol of this model", None),
    (OUTPUTS, after(OUTPUTS, "    model.variable('speed')"), "model.variable", "`van_der_pol` has no variable `speed`",
     "known here"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "line", "message", "help"), CASES, ids=lambda part: str(part)[:30])
def test_a_fault_of_a_family_is_reported_at_its_line(
    tmp_path: Path, old: str, new: str, line: str, message: str, help: str | None
) -> None:
    assert old in FAMILY
    text = FAMILY.replace(old, new, 1)
    path = write(tmp_path, text)
    (fault,) = faults(path)
    assert (fault.rule, fault.file) == ("family", "van_der_pol.py")
    assert message in fault.message
    assert "Traceback" not in fault.message
    assert help is None or help in (fault.help or "")
    assert fault.line is not None
    assert text.splitlines()[fault.line - 1].strip().startswith(line.strip())
    assert sorted(p.name for p in tmp_path.iterdir()) == ["van_der_pol.py", "van_der_pol.toml"]


@pytest.mark.parametrize(
    ("family", "message"),
    [
        ("", "the file has no family"),
        ("family = 3\n", "the file has no family"),
        ("def family(outline):\n    return None\n", "the file has no family"),
        ("from ahv_generator.modelling import Family\nfamily = Family()\n", "the family has no model"),
    ],
)
def test_a_file_without_a_family_is_refused(tmp_path: Path, family: str, message: str) -> None:
    (fault,) = faults(write(tmp_path, family))
    assert message in fault.message


def test_an_operation_that_no_model_has_is_named(tmp_path: Path) -> None:
    text = FAMILY.replace("(v**2 + (w * x) ** 2) / 2", "casadi.floor(w * x / v) * v**2", 1)
    (fault,) = faults(write(tmp_path, "import casadi\n" + text))
    assert "`floor` is not available in a model; available: +, -, *, /, **, sin, cos, tan, asin" in fault.message
    assert fault.line == text.splitlines().index(next(x for x in text.splitlines() if "floor(" in x)) + 2


def test_an_unknown_variable_in_a_monomial_stands_at_its_key(tmp_path: Path) -> None:
    (fault,) = faults(write(tmp_path, FAMILY, TABLE.replace('"position^2"', '"positon^2"')))
    assert (fault.rule, fault.file, fault.path) == ("monomial", "van_der_pol.toml", ("C", "positon^2"))
    assert fault.help == "did you mean `position`?"


def test_a_family_that_is_not_utf8_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path, FAMILY)
    (tmp_path / "van_der_pol.py").write_bytes(b"\xff\xfe")
    (fault,) = faults(path)
    assert "SyntaxError" in fault.message


def run(table: Path, out: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """The derivation as `ahv generate` starts it: the current folder is not searched for modules."""
    command = [sys.executable, "-P", "-m", "ahv_generator", "derive", "--out", str(out), str(table)]
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def test_a_fault_ends_with_2_and_json(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    path = write(tmp_path, "print('hello')\n" + FAMILY.replace(RATES, "{rate: u}"))
    done = run(path, out, tmp_path)
    assert (done.returncode, done.stderr) == (2, "hello\n")
    (fault,) = json.loads(done.stdout)["diagnostics"]
    assert (fault["file"], fault["rule"], fault["path"]) == ("van_der_pol.py", "family", [])
    assert isinstance(fault["line"], int)
    assert not list(out.iterdir())


def test_nothing_is_imported_from_the_current_folder_or_beside_the_table(tmp_path: Path) -> None:
    (tmp_path / "sibling.py").write_text("raise SystemExit('imported')\n", encoding="utf-8")
    (tmp_path / "casadi.py").write_text("raise SystemExit('imported')\n", encoding="utf-8")
    out = tmp_path / "out"
    out.mkdir()
    done = run(write(tmp_path, FAMILY), out, tmp_path)
    assert (done.returncode, [p.name for p in out.iterdir()]) == (0, ["van_der_pol.json"]), done.stderr
    done = run(write(tmp_path, "import sibling\n" + FAMILY), out, tmp_path)
    assert done.returncode == 2
    assert "No module named 'sibling'" in done.stdout


def test_a_family_may_lie_below_the_table(tmp_path: Path) -> None:
    path = write(tmp_path, FAMILY, TABLE.replace('"van_der_pol.py"', '"families/oscillator.py"'))
    (tmp_path / "families").mkdir()
    (tmp_path / "van_der_pol.py").rename(tmp_path / "families" / "oscillator.py")
    assert [m.name for m in load(path).build()] == ["van_der_pol"]
