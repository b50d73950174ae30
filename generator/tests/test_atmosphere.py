"""The US Standard Atmosphere 1976 against its definition, which the oracle integrates, by the example of the page."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path

import casadi as ca
import pytest
from test_families_page import ALONE

from ahv_generator.diagnostics import TableError
from ahv_generator.model import Model
from ahv_generator.table import Table, load
from ahv_oracle import standard_atmosphere

TABLE = """
[table]
name = "capsule"
family = "capsule.py"
models = ["capsule"]
units = "si"
set = "own"
source = "assumed"
status = "assumed"
uncertainty = 0.1

[sources]
assumed = "numbers of no capsule in particular"

[validity]
velocity = { min = 1.0, max = 1000.0, unit = "m/s" }
altitude = { min = 0.0, max = 86000.0, unit = "m" }
thrust = { min = -1000.0, max = 20000.0, unit = "N" }

[vehicle]
m = { value = 1000.0, unit = "kg" }
S = { value = 4.0, unit = "m^2" }

[C_slow]
"1" = { value = 0.9, unit = "1" }

[C_fast]
"1" = { value = 1.5, unit = "1" }
"mach" = { value = -0.1, unit = "1" }

"""

# Geopotential altitudes in m: the bases of layers, where the standard is defined to end, and between.
HEIGHTS = (0, 5000, 11000, 15000, 20000, 25000, 32000, 40000, 47000, 50000, 51000, 60000, 71000, 80000, 84852)
RADIUS = float(standard_atmosphere.RADIUS)


def quantities(model: Model, leaves: dict[str, float]) -> dict[str, float]:
    """The quantities of a model, one after the other."""
    found = dict(leaves)
    for name, quantity in model.graph.quantities.items():
        symbols = ca.symvar(quantity.expr)
        numbers = ca.vertcat(*(found[symbol.name()] for symbol in symbols))
        value = ca.substitute(quantity.expr, ca.vertcat(*symbols), numbers) if symbols else quantity.expr
        found[name] = float(ca.evalf(value))
    return found


@pytest.fixture(name="capsule_table", scope="module")
def _capsule_table(tmp_path_factory: pytest.TempPathFactory) -> Table:
    """The table of the capsule on the page."""
    folder = tmp_path_factory.mktemp("capsule")
    (folder / "capsule.py").write_text(ALONE["capsule.py"], encoding="utf-8")
    path = folder / "capsule.toml"
    path.write_text(TABLE + ALONE["air.toml"], encoding="utf-8")
    return load(path)


@pytest.fixture(name="capsule_model", scope="module")
def _capsule_model(capsule_table: Table) -> Model:
    return capsule_table.model("capsule")


@pytest.fixture(name="capsule", scope="module")
def _capsule(capsule_table: Table, capsule_model: Model) -> dict[float, dict[str, float]]:
    """The quantities of the capsule at each altitude, and 1 m above it."""
    document = tomllib.loads(TABLE + ALONE["air.toml"])
    leaves = {f"p.{p.name}": document[p.path[0]][p.path[1]]["value"] for p in capsule_table.parameters}
    found = {}
    for height in HEIGHTS:
        geometric = RADIUS * height / (RADIUS - height)
        for extra in (0.0, 1.0):
            at = leaves | {"x.velocity": 100.0, "x.altitude": geometric + extra, "u.thrust": 3000.0}
            found[height + extra] = quantities(capsule_model, at)
    return found


@pytest.mark.parametrize("height", HEIGHTS)
def test_the_standard_atmosphere_is_that_of_its_definition(
    capsule: dict[float, dict[str, float]], height: float
) -> None:
    found = capsule[height]
    names = ("temperature", "pressure", "density", "speed_of_sound")
    # The table has the gas constant to eight digits; at the top the pressure is e^-12.5 of that at sea level.
    for name, value in zip(names, standard_atmosphere.air(height), strict=True):
        assert found[name] == pytest.approx(value, rel=2e-7), name


def test_the_oracle_gives_the_pressures_that_everybody_knows() -> None:
    """Sea level and the tropopause, to the digits that pocket tables have."""
    assert standard_atmosphere.air(0)[:3] == pytest.approx((288.15, 101325, 1.225), rel=1e-5)
    assert standard_atmosphere.air(11000)[:2] == pytest.approx((216.65, 22632), rel=1e-5)


@pytest.mark.parametrize("number", range(2, 7))
def test_layers_that_are_out_of_order_are_refused(tmp_path: Path, number: int) -> None:
    (tmp_path / "capsule.py").write_text(ALONE["capsule.py"], encoding="utf-8")
    path = tmp_path / "capsule.toml"
    below = re.findall(rf"H_{number - 1} = {{ value = ([0-9.]+)", ALONE["air.toml"])[0]
    air = re.sub(rf"H_{number} = {{ value = [0-9.]+", f"H_{number} = {{ value = {below}", ALONE["air.toml"])
    path.write_text(TABLE + air, encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load(path)
    (fault,) = caught.value.diagnostics
    assert (fault.file, fault.path) == ("capsule.toml", ("air", f"H_{number}", "value"))
    assert f"`H_{number}` (geopotential altitude of the base of layer {number}) must exceed" in fault.message


@pytest.mark.parametrize("height", HEIGHTS[1:-1])
def test_the_slope_of_the_pressure_is_hydrostatic(capsule: dict[float, dict[str, float]], height: float) -> None:
    here, above = capsule[height], capsule[height + 1.0]
    difference = math.log(above["pressure"] / here["pressure"])
    ratio = RADIUS / (RADIUS + RADIUS * height / (RADIUS - height))
    hydrostatic = -here["density"] * 9.80665 * ratio**2 / here["pressure"]
    assert difference == pytest.approx(hydrostatic, rel=1e-3)


def test_what_the_capsule_chooses_is_its_own(capsule: dict[float, dict[str, float]]) -> None:
    found = capsule[0.0]
    drag = 1.2250 * 100.0**2 / 2 * 4.0 * 0.9
    assert found["drag"] == pytest.approx(drag, rel=1e-5)
    assert found["brake"] == pytest.approx(9806.65 * math.tanh(3000.0 / 9806.65), rel=1e-12)


def test_the_boundaries_are_those_of_the_drift_each_once(capsule_model: Model) -> None:
    model = capsule_model
    assert model.names("boundary") == (
        *(f"layer_floor_boundary_{k}" for k in range(1, 7)),
        "drag_boundary",
        "brake_boundary",
    )
    assert [v.unit for v in model.bases["boundary"]] == ["m"] * 6 + ["1", "N"]
    (function,) = [f for f in model.functions if f.name == "boundaries"]
    texts = [str(entry.expr) for entry in function.outputs[0].entries]
    assert texts[0] == "(geopotential_altitude-p.h_1)"
    assert texts[6:] == ["(mach-1)", "u.thrust"]
