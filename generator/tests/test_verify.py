"""The check of a model at points: what it finds is so, and a planted fault is found."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import casadi as ca
import mpmath
import pytest

from ahv_generator.drawing import draw
from ahv_generator.exact import DIGITS, Exact
from ahv_generator.function import Entry, Function
from ahv_generator.model import Model
from ahv_generator.table import load
from ahv_generator.verify import verify

EXAMPLES = Path(__file__).parents[2] / "examples"
TABLES = Path(__file__).parents[1] / "tables"


def model(name: str) -> Model:
    path = next(EXAMPLES.glob(f"*/{name}.toml"))
    return load(path).model(name)


@pytest.mark.parametrize("name", ["winged_cone", "van_der_pol"])
def test_models_are_within_the_bar(tmp_path: Path, name: str) -> None:
    found = verify(model(name), 20, tmp_path / "vectors.txt")
    assert {"drift", "jacobians", "parameter_jacobian", "hessian", "outputs"} <= set(found.casadi)
    assert max(one.error for one in found.casadi.values()) < 8.0
    assert set(found.differences) == {"jacobians", "parameter_jacobian"}
    # At 50 digits differences are nearly exact.
    assert max(one.error for one in found.differences.values()) < 1e-9
    header, columns, *rows = (tmp_path / "vectors.txt").read_text(encoding="utf-8").splitlines()
    assert header.startswith(f"# ahv vectors, model {name}")
    assert len(rows) == 20
    assert all(row.count(",") == columns.count(",") for row in rows)


def test_the_vectors_hold_the_values_and_the_same_bytes_each_time(tmp_path: Path) -> None:
    for name in ("a.txt", "b.txt"):
        verify(model("van_der_pol"), 3, tmp_path / name)
    text = (tmp_path / "a.txt").read_text(encoding="utf-8")
    assert text == (tmp_path / "b.txt").read_text(encoding="utf-8")
    columns, *rows = text.splitlines()[1:]
    names, labels = (part.split(",") for part in columns.split("|"))
    for row in rows:
        inputs, outputs = row.split("|")
        point = dict(zip(names, map(float, inputs.split(",")), strict=True))
        values = dict(zip(labels, outputs.split(","), strict=True))
        x, v, u = point["state.position"], point["state.rate"], point["input.drive"]
        p = [point[f"parameter.{name}"] for name in ("omega", "c_0", "c_position_2")]
        expected = u - (p[1] + p[2] * x**2) * v - p[0] ** 2 * x
        assert float(values["drift.rate"].split(";")[0]) == pytest.approx(expected, rel=1e-13)


def changed(function: Function, at: tuple[str, ...], factor: float) -> Function:
    """A function with one of its entries multiplied."""
    outputs = tuple(
        type(output)(
            output.name,
            output.basis,
            tuple(Entry(e.at, e.expr * factor if e.at == at else e.expr) for e in output.entries),
            output.unit,
            output.symmetric,
        )
        for output in function.outputs
    )
    return Function(function.name, function.group, function.doc, function.equation, outputs, function.compressed)


def test_a_wrong_derivative_is_found_by_differences(tmp_path: Path) -> None:
    broken = model("van_der_pol")
    position = next(i for i, function in enumerate(broken.functions) if function.name == "jacobians")
    broken.functions[position] = changed(broken.functions[position], ("rate", "position"), 1 + 1e-12)
    found = verify(broken, 3, tmp_path / "vectors.txt").differences["jacobians"]
    assert found.label == "jacobians.state.rate.position"
    assert found.error > 100


def test_a_derivative_that_is_left_out_is_found_by_differences(tmp_path: Path) -> None:
    broken = model("van_der_pol")
    position = next(i for i, function in enumerate(broken.functions) if function.name == "jacobians")
    function = broken.functions[position]
    left = tuple(
        type(o)(o.name, o.basis, tuple(e for e in o.entries if e.at != ("rate", "drive")), o.unit, o.symmetric)
        for o in function.outputs
    )
    broken.functions[position] = Function("jacobians", function.group, function.doc, "", left, True)
    found = verify(broken, 3, tmp_path / "vectors.txt").differences["jacobians"]
    assert (found.label, found.error > 100) == ("jacobians.input.rate.drive", True)


def test_points_lie_in_the_box_and_keep_the_rules() -> None:
    dcom = load(TABLES / "dcom.toml").model("dcom")
    box, rules = dcom.table.box, dcom.table.schema.rules()
    assert box["alpha"] == pytest.approx(tuple(math.radians(x) for x in degrees("alpha")))
    seen = set()
    for index in range(30):
        point = draw(dcom, 1, index)
        for kind, prefix in (("state", "x"), ("input", "u")):
            for variable in dcom.bases[kind]:
                low, high = box[variable.interval]
                # Points have seven digits.
                margin = 1e-6 * max(abs(low), abs(high))
                assert low - margin <= point[f"{prefix}.{variable.name}"] <= high + margin
        values = {name.removeprefix("p."): value for name, value in point.items() if name.startswith("p.")}
        assert all(rule.holds(values) for rule in rules if set(rule.parameters()) <= set(values))
        seen.add(values["spherical_earth"])
    assert seen == {0.0, 1.0}


def degrees(name: str) -> tuple[float, float]:
    interval = tomllib.loads((TABLES / "dcom.toml").read_text(encoding="utf-8"))["validity"][name]
    assert interval["unit"] == "deg"
    return interval["min"], interval["max"]


def test_the_measure_has_every_summand_with_its_absolute_value() -> None:
    oscillator = model("van_der_pol")
    x, v = oscillator["position"], oscillator["rate"]
    sine, root = math.sin(0.5) + math.cos(0.5) * 3.5, math.sqrt(3.0)
    cases = {
        # expression: value, measure at x = 2, v = 1.5
        x - v: (0.5, 3.5),
        (x - v) ** 2: (0.25, 12.25),
        3 / (x - v): (6.0, 6.0),
        ca.sin(x - v): (math.sin(0.5), sine),
        ca.sqrt(x * v) - 1: (root - 1, root + 3 / (2 * root) + 1),
        -(x + v): (-3.5, 3.5),
        ca.fmin(x - v, 1): (0.5, 3.5),
        ca.fmax(x - v, 1): (1.0, 1.0),
        ca.if_else(x < v, x + v, x - v): (0.5, 3.5),
        ca.log(x): (math.log(2.0), math.log(2.0) + 1.0),
        ca.atan2(x, v): (math.atan2(2.0, 1.5), math.atan2(2.0, 1.5) + 6.0 / 6.25),
        ca.tanh(v): (math.tanh(1.5), math.tanh(1.5) + 1.5 / math.cosh(1.5) ** 2),
        x**0.3: (2.0**0.3, 2.0**0.3 * (1 + 0.3 + 0.3 * math.log(2.0))),
        ca.fabs(v - x): (0.5, 3.5),
    }
    found = Exact(oscillator, cases).at({"x.position": 2.0, "x.rate": 1.5})
    for (value, size), (expected, measure) in zip(found, cases.values(), strict=True):
        assert float(value) == pytest.approx(expected, rel=1e-15)
        assert size == pytest.approx(measure, rel=1e-15)
    with mpmath.workdps(DIGITS):
        assert abs(found[3][0] - mpmath.sin(mpmath.mpf("0.5"))) < mpmath.mpf(10) ** -49


def test_outside_its_domain_a_function_has_no_value() -> None:
    oscillator = model("van_der_pol")
    x = oscillator["position"]
    exprs = [ca.sqrt(x) + 1, ca.log(x), 1 / (x + 2), ca.asin(x), x**0.5 * 2, ca.sin(x)]
    values = [value for value, _ in Exact(oscillator, exprs).at({"x.position": -2.0})]
    assert [bool(mpmath.isnan(value)) for value in values] == [True, True, True, True, True, False]
