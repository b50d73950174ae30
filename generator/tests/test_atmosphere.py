"""The US Standard Atmosphere 1976 against its printed tables, by the example of the page on families."""

from __future__ import annotations

import math
import tomllib

import casadi as ca
import pytest
from test_families_page import ALONE

from ahv_generator.model import Model
from ahv_generator.table import Table, load

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

# Geopotential altitude in m; temperature in K, pressure in Pa, density in kg/m^3, speed of sound in m/s, as printed.
PRINTED = [
    (0, 288.150, 1.01325e5, 1.2250, 340.294),
    (5000, 255.650, 5.40199e4, 7.36116e-1, 320.529),
    (11000, 216.650, 2.26321e4, 3.63918e-1, 295.069),
    (15000, 216.650, 1.20446e4, 1.93674e-1, 295.069),
    (20000, 216.650, 5.47489e3, 8.80349e-2, 295.069),
    (25000, 221.650, 2.51102e3, 3.94658e-2, 298.455),
    (32000, 228.650, 8.68019e2, 1.32250e-2, 303.131),
    (40000, 251.050, 2.77522e2, 3.85101e-3, 317.633),
    (47000, 270.650, 1.10906e2, 1.42753e-3, 329.799),
    (50000, 270.650, 7.59448e1, 9.77525e-4, 329.799),
    (51000, 270.650, 6.69389e1, 8.61606e-4, 329.799),
    (60000, 245.450, 2.03143e1, 2.88321e-4, 314.070),
    (71000, 214.650, 3.95642e0, 6.42110e-5, 293.704),
    (80000, 196.650, 8.86280e-1, 1.57005e-5, 281.120),
    (84852, 186.946, 3.73384e-1, 6.95788e-6, 274.10),
]


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
    """The quantities of the capsule at each printed altitude, and 1 m above it."""
    document = tomllib.loads(TABLE + ALONE["air.toml"])
    leaves = {f"p.{p.name}": document[p.path[0]][p.path[1]]["value"] for p in capsule_table.parameters}
    found = {}
    for height, *_ in PRINTED:
        geometric = 6356766.0 * height / (6356766.0 - height)
        for extra in (0.0, 1.0):
            at = leaves | {"x.velocity": 100.0, "x.altitude": geometric + extra, "u.thrust": 3000.0}
            found[height + extra] = quantities(capsule_model, at)
    return found


@pytest.mark.parametrize("row", PRINTED, ids=lambda row: str(row[0]))
def test_the_standard_atmosphere_is_the_printed_one(
    capsule: dict[float, dict[str, float]], row: tuple[float, float, float, float, float]
) -> None:
    height, *printed = row
    found = capsule[height]
    names = ("temperature", "pressure", "density", "speed_of_sound")
    # About half a unit of the last printed digit; the last speed of sound has one less.
    for name, value in zip(names, printed, strict=True):
        assert found[name] == pytest.approx(value, rel=1.4e-5 if value == 274.10 else 5e-6), name


@pytest.mark.parametrize("height", [row[0] for row in PRINTED[1:-1]])
def test_the_slope_of_the_pressure_is_hydrostatic(capsule: dict[float, dict[str, float]], height: float) -> None:
    here, above = capsule[height], capsule[height + 1.0]
    difference = math.log(above["pressure"] / here["pressure"])
    ratio = 6356766.0 / (6356766.0 + 6356766.0 * height / (6356766.0 - height))
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
    assert [v.unit for v in model.bases["boundary"]] == ["m"] * 6 + ["1", "kg*m/s^2"]
    (function,) = [f for f in model.functions if f.name == "boundaries"]
    texts = [str(entry.expr) for entry in function.outputs[0].entries]
    assert texts[0] == "(geopotential_altitude-p.h_1)"
    assert texts[6:] == ["(mach-1)", "u.thrust"]
