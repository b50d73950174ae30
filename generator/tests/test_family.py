"""Families: one Python file and one table make a model; what a family says is what its models do."""

from __future__ import annotations

import itertools
import json
import re
import shutil
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from ahv_generator import family_file, ir, models, units
from ahv_generator.__main__ import main
from ahv_generator.diagnostics import TableError
from ahv_generator.family import Outline
from ahv_generator.graph import Graph
from ahv_generator.modelling import NOT_NEGATIVE, NOT_ZERO, POSITIVE, Model, Rule
from ahv_generator.schema import Schema
from ahv_generator.table import Table, load

TABLES = Path(__file__).parents[1] / "tables"
NAMES = ("com", "dcom", "flexible_mode")


PENDULUM = Path(__file__).parent / "pendulum" / "pendulum.toml"


def derived(table: Path, out: Path, monkeypatch: pytest.MonkeyPatch) -> int:
    monkeypatch.setattr(sys, "argv", ["ahv_generator", "derive", "--out", str(out), str(table)])
    return main()


def test_a_family_is_one_file_and_one_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert derived(PENDULUM, tmp_path, monkeypatch) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["pendulum.json"]  # no audit of a paper
    document = json.loads((tmp_path / "pendulum.json").read_text(encoding="utf-8"))
    assert [p["name"] for p in document["parameters"]] == ["mass", "length", "gravity", "c_f_rate", "c_f_rate_3"]
    assert document["choices"] == []
    assert [r["name"] for r in document["rules"]] == ["positive", "positive", "positive", "swings"]
    (model,) = document["models"]
    assert model["trim"] == {
        "given": [{"name": "angle", "default": 0, "above": -1.5, "below": 1.5}],
        "sought": [{"name": "torque", "start": 0, "scale": 1}],
        "equations": [{"name": "rate", "weight": 1, "like": None}],
        "moving": [],
        "shown": [],
    }
    assert model["modes"] == [{"name": "swing", "states": ["angle", "rate"], "slowest": None}]
    assert model["defaults"] == {"inputs": ["torque"], "outputs": ["angle"]}
    assert model["deviations"] == {"angle": 0.1, "torque": 1}
    assert [v["name"] for v in model["bases"]["output"]] == ["height"]
    jacobians = next(f for f in model["functions"] if f["name"] == "jacobians")
    assert ["rate", "angle"] in [e["at"] for e in jacobians["outputs"][0]["entries"]]


def test_units_of_a_family_may_be_of_either_system(tmp_path: Path) -> None:
    example = Path(__file__).parents[2] / "examples" / "van-der-pol"
    shutil.copy(example / "van_der_pol.py", tmp_path)  # in SI
    text = (example / "van_der_pol.toml").read_text(encoding="utf-8").replace('"si"', '"ft-slug-s-rad"')
    table = load_text(tmp_path / "van_der_pol.toml", re.sub(r'"(1/s/)?m(\W)', r'"\1ft\2', text))
    (model,) = table.build()
    assert (model.unit("rate"), model.graph.units["energy"]) == ("ft/s", "ft^2/s^2")
    assert [p.unit for p in table.parameters] == ["rad/s", "1/s", "1/s/ft^2"]


def test_a_trim_may_be_given_an_output_and_have_one_as_an_equation(tmp_path: Path) -> None:
    example = Path(__file__).parents[2] / "examples" / "van-der-pol"
    family = (example / "van_der_pol.py").read_text(encoding="utf-8")
    family = family.replace("Family, Model", "Family, Given, Model").replace(
        "equations=[Equation(position), Equation(rate)]",
        "given=[Given(energy, 2.0, above=0.0)], equations=[Equation(position)]",
    )
    (tmp_path / "van_der_pol.py").write_text(family, encoding="utf-8")  # in SI
    text = (example / "van_der_pol.toml").read_text(encoding="utf-8").replace('"si"', '"ft-slug-s-rad"')
    table = load_text(tmp_path / "van_der_pol.toml", re.sub(r'"(1/s/)?m(\W)', r'"\1ft\2', text))
    (model,) = json.loads(ir.render(table, table.build()))["models"]
    (given,) = model["trim"]["given"]
    assert given["default"] == pytest.approx(2.0 / 0.3048**2, rel=1e-15)
    assert (given["name"], given["above"]) == ("energy", 0)
    assert model["bases"]["output"][0]["unit"] == "ft^2/s^2"


FAULTS = [
    ("mass = { value = 2.0", "mass = { value = -2.0", "positive", ("pendulum", "mass", "value")),
    ("rate^3", "rate^9*rate", "monomial", ("C_F", "rate^9*rate")),
    ("mass = { value = 0.5", "mass = { value = 1e-4", "swings", ("sets", "light", "pendulum", "mass", "value")),
    ('"rate" = { value = 0.4', '"rate" = { value = 400.0', "swings", ("pendulum", "mass", "value")),
    ('[sets."light".pendulum]', "[choices]\n[sets.light.pendulum]", "unknown-section", ("choices",)),
]


@pytest.mark.parametrize(("old", "new", "rule", "path"), FAULTS)
def test_the_rules_of_a_family_are_checked_in_table_and_sets(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    old: str,
    new: str,
    rule: str,
    path: tuple[str, ...],
) -> None:
    text = PENDULUM.read_text(encoding="utf-8")
    assert old in text
    table = tmp_path / "pendulum.toml"
    table.write_text(text.replace(old, new), encoding="utf-8")
    shutil.copy(PENDULUM.with_suffix(".py"), tmp_path)
    assert derived(table, tmp_path, monkeypatch) == 2
    found = json.loads(capsys.readouterr().out)["diagnostics"]
    assert (rule, list(path)) in [(d["rule"], d["path"]) for d in found]


def test_no_other_file_lists_the_families() -> None:
    families = {
        name: family_file.find_family(name, Path()).family(Outline()) for name in family_file.built_in("families")
    }
    assert {name: tuple(family.models) for name, family in families.items()} == {
        "com": ("com", "com_rigid"),
        "dcom": ("dcom", "sdcom", "sdcom_printed", "sdcom_gust"),
        "flexible_mode": ("flexible_mode",),
    }
    package = Path(models.__file__).parents[1]
    general = [path for path in package.glob("*.py") if path.name != "units.py"]
    words = re.compile(r"canard|psi_|eta_\b|C_N_|sdcom|com_rigid|flexible_mode|section 5\.3", re.IGNORECASE)
    for path in general:
        text = re.sub(r'(?s)""".*?"""', "", path.read_text(encoding="utf-8"))  # examples may be of any vehicle
        code = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
        assert not [line for line in code if words.search(line)], path.name


def with_modes(count: int, listed: tuple[str, ...]) -> str:
    """The DCOM's table with so many flexible modes; those beyond three are like the third."""
    lines, section = [], ""
    text = (TABLES / "dcom.toml").read_text(encoding="utf-8").partition("[sets.")[0]
    text = re.sub(r"models = \[.*\]", f"models = {json.dumps(listed)}", text)
    if "sdcom_gust" not in listed:
        text = re.sub(r"(?m)^(gust_rms|gust_time|alpha_gust) = .*\n", "", text)
    blocks = re.split(r"(?m)^(?=\[)", text)
    third = next(block for block in blocks if block.startswith("[C_N_3]"))
    blocks = [b for b in blocks if not (b.startswith("[C_N_") and int(b[5 : b.index("]")]) > count)]
    blocks += [third.replace("C_N_3", f"C_N_{i}") for i in range(4, count + 1)]
    for line in "".join(blocks).splitlines():
        section = line if line.startswith("[") else section
        numbered = re.match(r'"?(omega|zeta|sigma|eta)_(\d)"? =', line)
        if numbered is None or section.startswith("[C_N_"):
            lines.append(line)
            continue
        name, number = numbered[1], int(numbered[2])
        of_last = range(4, count + 1) if number == 3 else ()
        lines += [line] if number <= count else []
        lines += [line.replace(f"{name}_3", f"{name}_{i}") for i in of_last]
    return "\n".join(lines) + "\n"


def load_text(path: Path, text: str) -> Table:
    path.write_text(text, encoding="utf-8")
    return load(path)


@pytest.mark.parametrize("listed", [("dcom",), ("sdcom",), ("sdcom_printed",), ("sdcom_gust",), ("dcom", "sdcom_gust")])
def test_some_models_of_a_family_derive_with_two_modes(tmp_path: Path, listed: tuple[str, ...]) -> None:
    table = load_text(tmp_path / "dcom.toml", with_modes(2, listed))
    document = json.loads(ir.render(table, table.build()))
    assert tuple(m["name"] for m in document["models"]) == listed
    for model in document["models"]:
        modes = [m["name"] for m in model["modes"]]
        kind = "flexible" if model["name"] == "dcom" else "coloured noise"
        assert modes[:4] == ["phugoid", "short period", f"{kind} 1", f"{kind} 2"]
        assert modes[4:] == (["gust"] if model["name"] == "sdcom_gust" else [])


@pytest.mark.parametrize("listed", [("com",), ("com_rigid",)])
def test_one_model_of_the_com_derives(tmp_path: Path, listed: tuple[str, ...]) -> None:
    text = (TABLES / "com.toml").read_text(encoding="utf-8")
    if "com" not in listed:
        parts = re.split(r"(?m)^(?=\[)", text)
        text = "".join(p for p in parts if not p.startswith(("[modes]", "[N_")))
        text = re.sub(r"(?m)^eta(_dot)? = .*\n", "", text)
    text = text.replace('models = ["com", "com_rigid"]', f"models = {json.dumps(listed)}")
    table = load_text(tmp_path / "com.toml", text)
    assert [m.name for m in table.build()] == list(listed)


def test_there_may_be_ten_modes(tmp_path: Path) -> None:
    table = load_text(tmp_path / "dcom.toml", with_modes(10, ("dcom", "sdcom")))
    names = [p.name for p in table.parameters]
    assert {"omega_10", "zeta_10", "sigma_10", "c_n_10_alpha", "c_l_eta_10"} <= set(names)
    text = ir.render(table, table.build())
    document = json.loads(text)
    states = [v["name"] for v in document["models"][0]["bases"]["state"]]
    assert states[-2:] == ["eta_10", "eta_dot_10"]
    # A subscript of two digits needs brackets.
    symbols = re.findall(r'"symbol": "([^"]*)"', text)
    assert not [symbol for symbol in symbols if re.search(r"_\d\d", symbol)]
    assert r"C_{N_{10}}" in [symbol.replace("\\\\", "\\") for symbol in symbols]


def test_a_number_of_modes_does_not_run_away(tmp_path: Path) -> None:
    text = (TABLES / "dcom.toml").read_text(encoding="utf-8")
    for number in ("0", "01", "99999999999", "9" * 5000):
        with pytest.raises(TableError) as caught:
            load_text(tmp_path / "dcom.toml", text.replace("[C_N_3]", f"[C_N_{number}]"))
        assert ("unknown-section", (f"C_N_{number}",)) in [(d.rule, d.path) for d in caught.value.diagnostics]


@pytest.mark.parametrize("name", NAMES)
def test_every_rule_is_of_one_dimension_and_about_parameters(name: str) -> None:
    table = load(TABLES / f"{name}.toml")
    graph = Graph()
    for parameter in table.parameters:
        graph.leaf(parameter.name, parameter.unit)
    for rule in table.schema.rules():
        assert rule.parameters()
        found = []
        for _, factors in rule.terms:
            unit = "1"
            for factor in factors:
                unit = units.quotient(unit, units.quotient("1", graph.units[factor]))
            found.append(units.dimensions(unit))
        assert all(one == found[0] for one in found), rule.name


RULES = [  # of 2 a b - c^2
    (POSITIVE, (1.0, 5.0, 3.0), True),
    (POSITIVE, (1.0, 4.5, 3.0), False),
    (NOT_NEGATIVE, (1.0, 4.5, 3.0), True),
    (NOT_NEGATIVE, (1.0, 4.0, 3.0), False),
    (NOT_ZERO, (1.0, 4.0, 3.0), True),
    (NOT_ZERO, (1.0, 4.5, 3.0), False),
]


@pytest.mark.parametrize(("must", "values", "holds"), RULES)
def test_a_rule_compares_its_polynomial_with_zero(must: str, values: tuple[float, ...], holds: bool) -> None:
    rule = Rule("rule", ((2.0, ("a", "b")), (-1.0, ("c", "c"))), must, "")
    assert rule.parameters() == ("a", "b", "c")
    assert rule.holds(dict(zip("abc", values, strict=True))) is holds


@pytest.mark.parametrize("must", [POSITIVE, NOT_NEGATIVE])
def test_a_rule_is_not_kept_by_what_overflows(must: str) -> None:
    rule = Rule("rule", ((1.0, ("a", "a")), (-1.0, ("b", "b"))), must, "")
    assert not rule.holds({"a": 1.0, "b": 1e200})
    assert not rule.holds({"a": 1e200, "b": 1e200})  # infinity less infinity


def outputs_of(model: Model) -> list[str]:
    return [v.name for v in model.bases["output"]]


@pytest.mark.parametrize("name", NAMES)
def test_outputs_are_the_quantities_that_are_offered_one_by_one(name: str) -> None:
    table = load(TABLES / f"{name}.toml")
    for model in table.build():
        single = [f.name for f in model.functions if f.group == "evaluations"]
        (function,) = [f for f in model.functions if f.group == "outputs"]
        (output,) = function.outputs
        assert outputs_of(model) == [e.at[0] for e in output.entries]
        assert outputs_of(model) == (["theta", *single] if single else ["eta_static"])
        for entry, variable in zip(output.entries, model.bases["output"], strict=True):
            assert entry.expr.name() == variable.name
            assert variable.unit == model.graph.units[variable.name]


def test_the_pitch_angle_is_flight_path_and_incidence() -> None:
    document: dict[str, Any] = json.loads(ir.render(table := load(TABLES / "com.toml"), table.build()))
    quantity = next(q for q in document["models"][0]["quantities"] if q["name"] == "theta")
    assert quantity["expr"] == ["+", "x.gamma", "x.alpha"]


def test_only_the_truncated_form_warns_of_itself() -> None:
    notes = {m.name: m.traits.note for m in load(TABLES / "dcom.toml").build()}
    assert [name for name, note in notes.items() if note] == ["sdcom_printed"]
    assert "exact is --model sdcom" in str(notes["sdcom_printed"])


def test_two_coefficients_of_one_name_are_reported(tmp_path: Path) -> None:
    """A family of variables such as `rate` and `rate_3` has tables in which names in the code meet."""
    family = PENDULUM.with_suffix(".py").read_text(encoding="utf-8")
    family = family.replace("(rate,), required", '(rate, Variable("rate_3", "r", "rad/s", "another")), required')
    (tmp_path / "pendulum.py").write_text(family, encoding="utf-8")
    text = PENDULUM.read_text(encoding="utf-8") + '[C_F."rate_3"]\nvalue = 1.0\nunit = "slug*ft^2/s/rad"\n'
    with pytest.raises(TableError) as caught:
        load_text(tmp_path / "pendulum.toml", text)
    (fault,) = caught.value.diagnostics
    assert (fault.rule, fault.path) == ("duplicate-name", ("C_F", "rate_3"))
    assert "`rate_3` in `C_F` and `rate^3` in `C_F` would both be called `c_f_rate_3`" in fault.message


def entries_of(schema: Schema, document: dict[str, Any]) -> set[tuple[str, str]]:
    """What a table of this schema holds, of all that the document does."""
    every = {(section, key) for section, content in document.items() for key in content}
    return {(section, key) for section, key in every if schema.holds(section, key)}


@pytest.mark.parametrize("name", NAMES)
def test_models_together_need_what_each_needs(name: str) -> None:
    """The generated table says of each entry which models need it; a table at run time may list any of them."""
    table = load(TABLES / f"{name}.toml")
    document = tomllib.loads((TABLES / f"{name}.toml").read_text(encoding="utf-8"))
    whole = entries_of(table.schema, document)
    assert len(whole) == len([p for p in table.parameters if p.kind != "switch"]) + len(table.schema.validity) + len(
        table.schema.choices
    )
    for count in range(1, len(table.models) + 1):
        for chosen in itertools.combinations(table.models, count):
            needed = [entries_of(table.schemas[model], document) for model in chosen]
            assert entries_of(table.family.schema(chosen), document) == set().union(*needed)
