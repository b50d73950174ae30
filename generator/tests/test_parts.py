"""Parts that join a model, beside compositions by hand, closed forms, and a model that has its part inside."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from evaluated import Evaluated
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import solve_continuous_lyapunov

from ahv_generator.diagnostics import Diagnostic, TableError
from ahv_generator.family_file import built_in
from ahv_generator.table import load

DCOM = (Path(__file__).parents[1] / "tables" / "dcom.toml").read_text(encoding="utf-8")
MODELS = 'models = ["dcom", "sdcom", "sdcom_printed", "sdcom_gust"]'

# Every part that comes along. The shaper drives what drives the elevator.
PARTS = """
[parts]
elevator = { part = "second_order_actuator", input = "delta_e" }
engine = { part = "engine", input = "phi" }
shaper = { part = "first_order_actuator", input = "elevator_command" }
gust = { part = "band_limited_gust", state = "alpha" }
turbulence = { part = "dryden", state = "alpha", speed = "velocity" }
gyro = { part = "coloured_sensor", state = "pitch_rate" }
vane = { part = "white_sensor", state = "alpha" }

canard = { part = "limited_second_order_actuator", input = "delta_c" }
slow = { part = "limited_first_order_actuator", input = "delta_e" }

[joined.servoed]
model = "dcom"
title = "DCOM with parts"
parts = ["elevator", "engine", "shaper", "turbulence", "gyro", "vane"]

[joined.limited]
model = "dcom"
title = "DCOM, limited"
parts = ["slow", "canard"]

[joined.gusty]
model = "dcom"
title = "DCOM in gusts"
parts = ["gust"]

[joined.gusty_sdcom]
model = "sdcom"
title = "SDCOM in gusts"
parts = ["gust"]

[elevator]
omega = { value = 20.0, unit = "rad/s" }
zeta = { value = 0.7, unit = "1" }
[engine]
tau_valve = { value = 0.1, unit = "s" }
tau_combustor = { value = 0.05, unit = "s" }
[shaper]
tau = { value = 0.3, unit = "s" }
[gust]
sigma = { value = 0.005, unit = "rad" }
tau = { value = 0.5, unit = "s" }
[turbulence]
sigma = { value = 5.0, unit = "ft/s" }
length = { value = 1000.0, unit = "ft" }
[gyro]
sigma = { value = 0.002, unit = "rad/s" }
tau = { value = 0.2, unit = "s" }
[canard]
omega = { value = 30.0, unit = "rad/s" }
zeta = { value = 0.5, unit = "1" }
lowest = { value = -0.3, unit = "rad" }
highest = { value = 0.2, unit = "rad" }
fastest = { value = 2.0, unit = "rad/s" }
[slow]
tau = { value = 0.1, unit = "s" }
lowest = { value = -0.35, unit = "rad" }
highest = { value = 0.35, unit = "rad" }
fastest = { value = 1.5, unit = "rad/s" }
[vane]
sigma = { value = 0.001, unit = "rad/s^0.5" }
tau = { value = 0.4, unit = "s" }

[validity]
elevator_rate = { min = -10.0, max = 10.0, unit = "rad/s" }
gust_level = { min = -0.1, max = 0.1, unit = "rad" }
turbulence_first = { min = -50.0, max = 50.0, unit = "ft/s" }
turbulence_second = { min = -50.0, max = 50.0, unit = "ft/s" }
canard_rate = { min = -10.0, max = 10.0, unit = "rad/s" }
gyro_error = { min = -0.1, max = 0.1, unit = "rad/s" }
"""
LISTED = 'models = ["dcom", "sdcom", "sdcom_gust", "servoed", "limited", "gusty", "gusty_sdcom"]'
TABLE = DCOM.replace(MODELS, LISTED).replace("[validity]", PARTS, 1)

RIGID = {"velocity": 7800.0, "altitude": 86000.0, "gamma": 0.01, "alpha": 0.02, "pitch_rate": -0.03}
MODAL = {"eta_1": 0.3, "eta_dot_1": -0.2, "eta_2": 0.1, "eta_dot_2": 0.4, "eta_3": -0.1, "eta_dot_3": 0.2}
OF_PARTS = {
    "elevator_position": 0.15, "elevator_rate": -0.7, "engine_combustor": 0.31, "engine_valve": 0.28,
    "shaper_position": 0.22, "turbulence_first": 3.0, "turbulence_second": -2.0, "gyro_error": 0.01,
    "vane_measured": 0.03,
}  # fmt: skip
INPUT = {"engine_command": 0.4, "shaper_command": 0.1, "delta_c": 0.02}
WIND = math.sqrt(3) * 3.0 - (1 - math.sqrt(3)) * 2.0
POINT = RIGID | MODAL | OF_PARTS | INPUT


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("parts") / "dcom.toml"
    path.write_text(TABLE, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def servoed(table: Path) -> Evaluated:
    return Evaluated(table, "servoed")


@pytest.fixture(scope="module")
def by_hand(table: Path) -> Callable[[Mapping[str, float]], dict[str, float]]:
    """The drift of the joined model, composed of that of DCOM in a gust and parts that are written down again here."""
    dcom = Evaluated(table, "gusty")
    omega, zeta = 20.0, 0.7

    def drift(at: Mapping[str, float]) -> dict[str, float]:
        lag = 1000.0 / at["velocity"]
        wind = math.sqrt(3) * at["turbulence_first"] + (1 - math.sqrt(3)) * at["turbulence_second"]
        known = {name: at[name] for name in (*RIGID, *MODAL, "delta_c")}
        driven = {"delta_e": at["elevator_position"], "phi": at["engine_combustor"]}
        rates = dcom.drift(known | driven | {"gust_level": wind / at["velocity"]})
        del rates["gust_level"]
        return rates | {
            "elevator_position": at["elevator_rate"],
            "elevator_rate": omega**2 * (at["shaper_position"] - at["elevator_position"])
            - 2 * zeta * omega * at["elevator_rate"],
            "engine_combustor": (at["engine_valve"] - at["engine_combustor"]) / 0.05,
            "engine_valve": (at["engine_command"] - at["engine_valve"]) / 0.1,
            "shaper_position": (at["shaper_command"] - at["shaper_position"]) / 0.3,
            "turbulence_first": -at["turbulence_first"] / lag,
            "turbulence_second": (at["turbulence_first"] - at["turbulence_second"]) / lag,
            "gyro_error": -at["gyro_error"] / 0.2,
            "vane_measured": (at["alpha"] - at["vane_measured"]) / 0.4,
        }

    return drift


def test_every_part_that_comes_along_is_tested() -> None:
    assert built_in("parts") == sorted({entry.split('"')[1] for entry in PARTS.splitlines() if "{ part = " in entry})


def test_states_and_inputs_of_parts_stand_where_they_join(servoed: Evaluated) -> None:
    model = servoed.model
    assert model.names("state") == (*RIGID, *MODAL, *OF_PARTS)
    assert model.names("input") == ("engine_command", "shaper_command", "delta_c")
    assert model.names("noise")[-3:] == ("turbulence_wiener", "gyro_wiener", "vane_wiener")
    assert model.names("output")[-5:] == ("delta_e", "phi", "elevator_command", "turbulence_velocity", "gyro_measured")
    assert [(mode.name, mode.states) for mode in model.traits.modes][-4] == ("shaper", ("shaper_position",))
    assert model.traits.inputs == ("engine_command", "shaper_command")
    assert {"engine_command", "shaper_command"} < set(model.traits.deviations)


def test_the_drift_is_the_composition(
    servoed: Evaluated, by_hand: Callable[[Mapping[str, float]], dict[str, float]]
) -> None:
    assert servoed.drift(POINT) == pytest.approx(by_hand(POINT), rel=1e-13, abs=1e-13)


def test_the_jacobians_are_differences_of_the_composition(
    servoed: Evaluated, by_hand: Callable[[Mapping[str, float]], dict[str, float]]
) -> None:
    found = servoed.at(POINT)
    for basis in ("state", "input"):
        for column in servoed.model.names(basis):
            slope = difference(by_hand, POINT, column)
            for row, value in slope.items():
                known = found.get(f"jacobians.{basis}.{row}.{column}", 0.0)
                assert known == pytest.approx(value, rel=1e-7, abs=1e-7 * max(1.0, abs(value))), (row, column)


def difference(
    function: Callable[[Mapping[str, float]], dict[str, float]], at: Mapping[str, float], name: str
) -> dict[str, float]:
    """A derivative by sixth-order central differences."""
    step = 1e-3 * max(1e-1, abs(at[name]))
    weights = {1: 45.0, 2: -9.0, 3: 1.0}
    total: dict[str, float] = {}
    for k, weight in weights.items():
        after, before = (function({**at, name: at[name] + sign * k * step}) for sign in (1, -1))
        for row in after:
            total[row] = total.get(row, 0.0) + weight * (after[row] - before[row]) / (60 * step)
    return total


def test_the_noise_of_parts_has_columns_of_its_own(servoed: Evaluated, table: Path) -> None:
    driven = {"phi": 0.31, "delta_e": 0.15, "delta_c": 0.02, "gust_level": WIND / RIGID["velocity"]}
    found, own = servoed.at(POINT), Evaluated(table, "gusty").at({**RIGID, **MODAL, **driven})
    gains = {label: value for label, value in found.items() if label.startswith("diffusion.")}
    of_dcom = {label: value for label, value in own.items() if label.startswith("diffusion.")}
    del of_dcom["diffusion.gust_level.gust_wiener"]
    time = 1000.0 / RIGID["velocity"]
    assert gains == pytest.approx(
        of_dcom
        | {
            "diffusion.turbulence_first.turbulence_wiener": 5.0 / math.sqrt(time),
            "diffusion.gyro_error.gyro_wiener": 0.002 * math.sqrt(2 / 0.2),
            "diffusion.vane_measured.vane_wiener": 0.001,
        },
        rel=1e-13,
    )


def test_outputs_of_parts(servoed: Evaluated) -> None:
    graph = servoed.model.graph
    for name, value in {"delta_e": 0.15, "phi": 0.31, "gyro_measured": -0.02, "turbulence_velocity": WIND}.items():
        expr = graph.quantities[name].expr
        leaves = ca.symvar(expr)
        found = ca.Function("f", leaves, [expr])(*(POINT[leaf.name().partition(".")[2]] for leaf in leaves))
        assert float(found) == pytest.approx(value, rel=1e-14)


def test_the_trim_of_the_model_is_that_of_its_parts_at_rest(servoed: Evaluated, table: Path) -> None:
    given = {"velocity": 7702.0808, "altitude": 85000.0}
    own, joined = Evaluated(table, "dcom").trim(given), servoed.trim(given)
    for name in ("alpha", *MODAL):
        assert joined[name] == pytest.approx(own[name], rel=1e-9, abs=1e-9)
    for name in ("elevator_position", "shaper_position", "shaper_command"):
        assert joined[name] == pytest.approx(own["delta_e"], rel=1e-9)
    for name in ("engine_combustor", "engine_valve", "engine_command"):
        assert joined[name] == pytest.approx(own["phi"], rel=1e-9)
    assert joined["vane_measured"] == pytest.approx(own["alpha"], rel=1e-9)
    at_rest = [joined[name] for name in ("elevator_rate", "turbulence_first", "turbulence_second", "gyro_error")]
    assert at_rest == pytest.approx([0.0] * 4, abs=1e-12)


def test_a_gust_that_joins_is_the_gust_that_a_model_has_inside(table: Path) -> None:
    joined, inside = Evaluated(table, "gusty_sdcom"), Evaluated(table, "sdcom_gust")
    renamed = {"gust_rms": 0.005, "gust_time": 0.5}
    inside.parameters |= {f"parameter.{name}": value for name, value in renamed.items()}
    point = RIGID | {"chi_1": 0.2, "chi_2": -0.1, "chi_3": 0.3, "phi": 0.3, "delta_e": 0.15, "delta_c": 0.0}
    ours, theirs = joined.at(point | {"gust_level": 0.007}), inside.at(point | {"alpha_gust": 0.007})
    for label, value in ours.items():
        other = label.replace("gust_level", "alpha_gust").replace("gust_wiener", "w_gust")
        if label.startswith(("drift.", "jacobians.", "hessian.")) or label.endswith(".gust_wiener"):
            assert value == pytest.approx(theirs[other], rel=1e-12, abs=1e-12), label
    assert ours["diffusion.gust_level.gust_wiener"] == pytest.approx(0.005 * 2, rel=1e-14)


def test_the_gust_of_dryden_has_his_spectrum_and_its_root_mean_square(servoed: Evaluated) -> None:
    found = servoed.at(POINT)
    names = ("turbulence_first", "turbulence_second")
    drift = np.array([[found.get(f"jacobians.state.{row}.{column}", 0.0) for column in names] for row in names])
    gain = np.array([[found["diffusion.turbulence_first.turbulence_wiener"]], [0.0]])
    out = np.array([[math.sqrt(3), 1 - math.sqrt(3)]])
    covariance = solve_continuous_lyapunov(drift, -gain @ gain.T)
    assert float((out @ covariance @ out.T).item()) == pytest.approx(25.0, rel=1e-12)
    time = 1000.0 / RIGID["velocity"]
    for omega in (0.1, 3.0, 8.0, 50.0):
        response: NDArray[np.complex128] = out @ np.linalg.solve(1j * omega * np.eye(2) - drift, gain)
        wt = omega * time
        spectrum = 25.0 * time * (1 + 3 * wt**2) / (1 + wt**2) ** 2
        assert abs(response.item()) ** 2 == pytest.approx(spectrum, rel=1e-12)


def faults(folder: Path, old: str, new: str, files: Mapping[str, str] | None = None) -> list[Diagnostic]:
    assert TABLE.count(old) == 1, old
    path = folder / "dcom.toml"
    path.write_text(TABLE.replace(old, new), encoding="utf-8")
    for name, text in (files or {}).items():
        (folder / name).write_text(text, encoding="utf-8")
    with pytest.raises(TableError) as caught:
        table = load(path)
        table.model("servoed")
    return caught.value.diagnostics


ELEVATOR = 'elevator = { part = "second_order_actuator", input = "delta_e" }'
SERVOED = 'parts = ["elevator", "engine", "shaper", "turbulence", "gyro", "vane"]'
SECOND = '"second_order_actuator"'
CASES = [
    # what is replaced, by what, rule, path, part of the message, part of the help
    (f'{SECOND}, input = "delta_e"', f'{SECOND}, input = "delta_f"', "unknown-join", ("parts", "elevator", "input"),
     "`delta_f` is neither a state nor an input of `dcom`", "`delta_e`"),
    (f'{SECOND}, input = "delta_e"', f'{SECOND}, inptu = "delta_e"', "missing", ("parts", "elevator"),
     "`input` is missing", None),
    (f'{SECOND}, input = "delta_e"', f'{SECOND}, input = "alpha"', "unknown-join", ("parts", "elevator", "input"),
     "`alpha` is a state in `rad`; `input` of `second_order_actuator` is an input", "known here: `phi`, `delta_e`"),
    ('state = "alpha", speed = "velocity"', 'state = "alpha", speed = "pitch_rate"', "unknown-join",
     ("parts", "turbulence", "speed"), "`pitch_rate` is a state in `rad/s`; `speed` of `dryden` is a state in `ft/s`",
     "known here: `velocity`"),
    ('state = "alpha", speed = "velocity"', 'state = "altitude", speed = "velocity"', "unknown-join",
     ("parts", "turbulence", "state"), "`altitude` is a state in `ft`; `state` of `dryden` is a state in `rad`",
     "`gamma`, `alpha`"),
    ('part = "white_sensor", state = "alpha"', 'part = "white_sensor", state = "delta_c"', "unknown-join",
     ("parts", "vane", "state"), "`delta_c` is an input in `rad`; `state` of `white_sensor` is a state", "`alpha`"),
    (SERVOED, SERVOED.replace("parts =", "prts ="), "missing", ("joined", "servoed"), "`parts` is missing", None),
    ('input = "phi"', 'input = "delta_e"', "unknown-join", ("parts", "engine", "input"),
     "`delta_e` is driven by `elevator` already", "`elevator_command`"),
    ('input = "elevator_command"', 'input = "elevator_comand"', "unknown-join", ("parts", "shaper", "input"),
     "neither a state nor an input", "`elevator_command`"),
    (SECOND, '"second_order_servo"', "unknown-part", ("parts", "elevator", "part"),
     "unknown part `second_order_servo`", "second_order_actuator"),
    (SECOND, '"servo.py"', "unknown-part", ("parts", "elevator", "part"), "there is no file", None),
    (ELEVATOR, 'elevator = "second_order_actuator"', "shape", ("parts", "elevator"), "a part is a table", None),
    (ELEVATOR, ELEVATOR.replace("elevator", "Elevator", 1), "part", ("parts", "Elevator"), "lower-case", None),
    (ELEVATOR, ELEVATOR.replace('part = "second_order_actuator", ', ""), "missing", ("parts", "elevator"),
     "`part` is missing", "second_order_actuator"),
    (SERVOED, SERVOED.replace('"vane"', '"wane"'), "unknown-part", ("joined", "servoed", "parts"),
     "`parts` lists parts of `[parts]`", "`vane`"),
    (SERVOED, SERVOED.replace('"vane"', '"gyro"'), "unknown-part", ("joined", "servoed", "parts"), "each once", None),
    (SERVOED, SERVOED.replace(', "vane"', ""), "unused-part", ("parts", "vane"), "no model of `[joined]`", None),
    ('title = "DCOM with parts"\n', "", "missing", ("joined", "servoed"), "`title` is missing", None),
    ('model = "dcom"\ntitle = "DCOM with', 'model = "dkom"\ntitle = "DCOM with', "unknown-model",
     ("joined", "servoed", "model"), "`dkom` is not a model of the family", "`dcom`"),
    ("[joined.servoed]", "[joined.sdcom_gust]", "joined", ("joined", "sdcom_gust"), "used twice", None),
    ("omega = { value = 20.0, unit = \"rad/s\" }\n", "", "missing", ("elevator",), "`omega` (natural frequency", None),
    ("highest = { value = 0.2,", "highest = { value = -0.4,", "above", ("canard", "highest", "value"),
     "must exceed `lowest` (lowest ", None),
    ("zeta = { value = 0.7", "zeta = { value = -0.7", "not-negative", ("elevator", "zeta", "value"),
     "must not be negative", None),
    ('elevator_rate = { min = -10.0, max = 10.0, unit = "rad/s" }\n', "", "missing", ("validity",),
     "`elevator_rate`", None),
    (ELEVATOR, ELEVATOR + '\nvehicle = { part = "first_order_actuator", input = "delta_c" }', "unused-part",
     ("parts", "vehicle"), "no model", None),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "rule", "path", "message", "help"), CASES, ids=lambda part: str(part)[:40])
def test_a_fault_of_a_join_is_reported_at_its_place(
    tmp_path: Path, old: str, new: str, rule: str, path: tuple[str, ...], message: str, help: str | None
) -> None:
    # A key that is unknown is a fault beside the one that is missing; what follows from a fault is not reported.
    (found,) = [fault for fault in faults(tmp_path, old, new) if fault.rule != "unknown-key"]
    assert (found.rule, found.path) == (rule, path)
    assert message in found.message
    assert help is None or help in (found.help or "")


def test_a_name_that_is_taken_is_no_name_of_a_part(tmp_path: Path) -> None:
    for name in ("vehicle", "sets"):
        text = SERVOED.replace("]", f', "{name}"]')
        part = f'{ELEVATOR}\n{name} = {{ part = "first_order_actuator", input = "delta_c" }}'
        both = f"{part}\n{TABLE.split(ELEVATOR)[1].split(SERVOED)[0]}{text}"
        found = faults(tmp_path, TABLE[TABLE.index(ELEVATOR) : TABLE.index(SERVOED) + len(SERVOED)], both)
        assert [fault.rule for fault in found if "has a meaning of its own" in fault.message] == ["joined"], name


@pytest.mark.parametrize(
    ("where", "command", "rate"),
    [(0.1, 0.15, 0.5), (0.1, 0.34, 1.5), (0.3, 9.0, 0.5), (0.0, -0.2, -1.5), (-0.33, -0.9, -0.2)],
)
def test_limits_of_first_order(table: Path, where: float, command: float, rate: float) -> None:
    at = RIGID | MODAL | {"phi": 0.3, "slow_position": where, "slow_command": command}
    found = Evaluated(table, "limited").at(at)
    assert found["drift.slow_position"] == pytest.approx(rate, rel=1e-12)
    held = rate in (1.5, -1.5)
    slope = found["jacobians.state.slow_position.slow_position"]
    assert slope == pytest.approx(0.0 if held else -10.0, rel=1e-12)
    of_command = found["jacobians.input.slow_position.slow_command"]
    assert of_command == pytest.approx(0.0 if held or abs(command) > 0.35 else 10.0, rel=1e-12)


def test_an_actuator_with_limits_flies_as_one_that_is_written_down_again(table: Path) -> None:
    limited = Evaluated(table, "limited")
    names = ("canard_position", "canard_rate")

    def joined(time: float, state: NDArray[np.float64]) -> list[float]:
        at = RIGID | {"canard_command": 0.5 * math.cos(4 * time), **dict(zip(names, map(float, state), strict=True))}
        rates = limited.drift(at)
        return [rates[name] for name in names]

    def again(time: float, state: NDArray[np.float64]) -> list[float]:
        command = float(np.clip(0.5 * math.cos(4 * time), -0.3, 0.2))
        return [float(np.clip(state[1], -2.0, 2.0)), 900.0 * (command - state[0]) - 30.0 * state[1]]

    flights = [solve_ivp(f, (0.0, 1.5), [0.0, 0.0], rtol=1e-6, atol=1e-8, max_step=0.02) for f in (joined, again)]
    assert flights[0].y[:, -1] == pytest.approx(flights[1].y[:, -1], rel=1e-6, abs=1e-9)
    # Without limits it would pass both.
    assert np.max(np.abs(np.diff(flights[0].y[0]) / np.diff(flights[0].t))) <= 2.0 + 1e-9


SERVO = (Path(__file__).parents[1] / "ahv_generator" / "parts" / "first_order_actuator.py").read_text(encoding="utf-8")
SHAPER = 'shaper = { part = "first_order_actuator", input = "elevator_command" }'


def test_a_part_may_lie_beside_the_table(tmp_path: Path, servoed: Evaluated) -> None:
    path = tmp_path / "dcom.toml"
    path.write_text(TABLE.replace(SHAPER, SHAPER.replace("first_order_actuator", "servo.py")), encoding="utf-8")
    (tmp_path / "servo.py").write_text(SERVO, encoding="utf-8")
    assert Evaluated(path, "servoed").drift(POINT) == servoed.drift(POINT)


RATE = "model.motion({position: (wanted - where) / lag})"


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        (RATE, "model.motion({})", "model.motion", "the rate of `position` is missing in the part"),
        (RATE, RATE.replace(" / lag", ""), "model.motion", "the rate of `shaper_position` is declared in"),
        (RATE, "1 / 0", "1 / 0", "ZeroDivisionError"),
        (RATE, "pass", '"""An actuator whose', "the part has no equations of motion"),
        ("model.drive(input, where)", "pass", '"""An actuator whose', "does not say what drives `elevator_command`"),
        (
            "model.drive(input, where)",
            "model.drive(input, where * lag)",
            "model.drive",
            "what drives `elevator_command`",
        ),
        ("model.drive(input, where)", "model.drive(position, where)", "model.drive", "there is no `position`"),
        (
            "model.drive(input, where)",
            "model.drive(input, where); model.drive(input, where)",
            "model.drive",
            "`model.drive(elevator_command, ...)` is called twice, on line 18 and on line 18",
        ),
        ("model.drive(input, where)", "model.drive(input, where); model.add(LAG, 1)", "model.drive", "`PartModel.add`"),
        (
            "model.drive(input, where)",
            "model.drive(input, where); model.add(Variable('phi', 'x', 'rad', 'y'), 1)",
            "model.drive",
            "a part adds to a state; `phi` is not a state of the model that it joins",
        ),
        (
            "(position,), (command,)",
            "(position,), (command,), noise=(Variable('w', 'w', 's^0.5', 'noise'),)",
            '"""An actuator whose',
            "the Wiener increment `w` of the part has no gain",
        ),
        ("return made", "return 3", '"""An actuator whose', "the function `part` returns no part"),
        ("def part(", "def parts(", '"""An actuator whose', "the file has no part"),
        ('Variable("command"', 'Variable("position"', "made = Part", "the name `position` is used twice in the part"),
        ("(position,), (command,)", "(), (command,)", "made = Part", "a part has one state at least"),
    ],
)
def test_a_fault_of_a_part_is_reported_at_its_line(tmp_path: Path, old: str, new: str, line: str, message: str) -> None:
    assert old in SERVO
    text = SERVO.replace(old, new, 1)
    new_shaper = SHAPER.replace("first_order_actuator", "servo.py")
    (fault,) = [f for f in faults(tmp_path, SHAPER, new_shaper, {"servo.py": text}) if f.rule == "family"]
    assert (fault.file, message in fault.message) == ("servo.py", True), fault.message
    assert fault.line is not None
    assert text.splitlines()[fault.line - 1].strip().startswith(line)


def join(folder: Path, old: str, new: str) -> Diagnostic:
    """The one fault of the joined models of a table, which is found when they are derived."""
    assert TABLE.count(old) == 1, old
    path = folder / "dcom.toml"
    path.write_text(TABLE.replace(old, new), encoding="utf-8")
    table = load(path)
    with pytest.raises(TableError) as caught:
        table.model("gusty_sdcom")
    (fault,) = caught.value.diagnostics
    assert (fault.file, fault.line) == ("dcom.toml", None)
    return fault


GUST = 'gust = { part = "band_limited_gust", state = "alpha" }'
GUSTY = 'model = "sdcom"\ntitle = "SDCOM in gusts"\nparts = ["gust"]'


def test_a_model_that_asks_for_slopes_in_a_driven_input_is_refused(tmp_path: Path) -> None:
    fault = join(tmp_path, GUSTY, GUSTY.replace('"gust"]', '"gust", "elevator"]'))
    assert fault.path == ("joined", "gusty_sdcom")
    assert "`delta_e` is driven by a part" in fault.message


def test_a_gust_that_no_curve_fit_sees_is_refused(tmp_path: Path) -> None:
    fault = join(tmp_path, GUST, GUST.replace("alpha", "gamma"))
    assert fault.path == ("parts", "gust")
    assert "no curve fit of `gusty_sdcom` sees `gamma`" in fault.message
    assert fault.help == "states that curve fits see: `alpha`"


def test_what_a_part_that_comes_along_refuses_is_a_fault_of_the_table(tmp_path: Path) -> None:
    """Its quantities are named after it; so long or odd a name the generated code cannot have."""
    part = 'd_sensor = { part = "coloured_sensor", state = "alpha" }'
    text = TABLE.replace(GUST, f"{GUST}\n{part}").replace(GUSTY, GUSTY.replace('"gust"]', '"gust", "d_sensor"]'))
    text = text.replace("gyro_error =", 'd_sensor_error = { min = -0.1, max = 0.1, unit = "rad" }\ngyro_error =')
    text += '[d_sensor]\nsigma = { value = 0.002, unit = "rad" }\ntau = { value = 0.2, unit = "s" }\n'
    path = tmp_path / "dcom.toml"
    path.write_text(text, encoding="utf-8")
    table = load(path)
    with pytest.raises(TableError) as caught:
        table.model("gusty_sdcom")
    (fault,) = caught.value.diagnostics
    assert (fault.file, fault.path) == ("dcom.toml", ("parts", "d_sensor"))
    assert "`coloured_sensor` does not fit here: `d_sensor_measured` would be taken for a derivative" in fault.message


def test_boundaries_of_a_rate_are_named_after_it_and_have_the_units_that_are_compared(table: Path) -> None:
    found = {v.name: (v.unit, v.doc) for v in load(table).model("limited").bases["boundary"]}
    text = "0 where the rate of {} goes over to another formula"
    of_slow = {f"slow_position_rate_boundary_{k}": (unit, text.format("slow_position")) for k, unit in SLOW.items()}
    of_rate, of_position = "canard_rate_rate", "canard_position_rate"
    assert {name: found[name] for name in found if name.startswith("slow")} == of_slow
    assert {name: unit for name, (unit, _) in found.items() if name.startswith("canard")} == {
        f"{of_position}_boundary_1": "rad/s",
        f"{of_position}_boundary_2": "rad/s",
        f"{of_rate}_boundary_1": "rad",
        f"{of_rate}_boundary_2": "rad",
    }


# The command meets a limit of the position, then the position one of its rate.
SLOW = {1: "rad", 2: "rad", 3: "rad/s", 4: "rad/s"}
