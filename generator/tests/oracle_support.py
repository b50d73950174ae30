"""What the tests of the oracle share."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import mpmath

from ahv_oracle import MODELS, Number, Oracle
from ahv_oracle.evaluate import DIGITS

GENERATOR = Path(__file__).resolve().parents[1]
TABLES = {name: GENERATOR / "tables" / f"{name}.toml" for name in ("com", "dcom", "flexible_mode")}
TABLE_OF = {"com_rigid": "com", "com": "com", "dcom": "dcom", "sdcom": "dcom", "sdcom_printed": "dcom"}
TABLE_OF |= {"sdcom_gust": "dcom", "flexible_mode": "flexible_mode"}
NOISY = [model for model in MODELS if model not in ("com_rigid", "com")]
REDUCED = ("sdcom", "sdcom_printed", "sdcom_gust")
ROW_OF = {"V": "velocity", "gamma": "gamma", "alpha": "alpha", "Q": "pitch_rate"}

Values = dict[str, Number]


@cache
def oracle_of(model: str, *functions: str) -> Oracle:
    """All functions of a model of its table, or only some."""
    return Oracle(TABLES[TABLE_OF[model]], model, functions or None)


def values(oracle: Oracle, point: Values) -> Values:
    return {label: pair[0] for label, pair in oracle.evaluate(point).items()}


def central(function: Callable[[Number], Values], at: Number) -> Values:
    """Fourth-order central difference of every entry."""
    step = mpmath.mpf("1e-9") * (abs(at) or 1)
    far, near, after, last = (function(mpmath.mpf(at) + k * step) for k in (-2, -1, 1, 2))
    return {k: (8 * (after[k] - near[k]) - (last[k] - far[k])) / (12 * step) for k in near}


def assert_close(expected: Number, result: tuple[Number, Number], what: str, tolerance: str = "1e-20") -> None:
    assert abs(expected - result[0]) <= mpmath.mpf(tolerance) * (result[1] + abs(expected)), what


def level_flight(oracle: Oracle, **changes: float) -> Values:
    point: Values = dict.fromkeys(oracle.names, 0) | oracle.nominal()
    point |= {"state.velocity": 7702.0808, "state.altitude": 85000}
    return point | {f"parameter.{name}": value for name, value in changes.items()}


def trim(oracle: Oracle, point: Values) -> Values:
    """Level trim at 50 digits: alpha, phi, delta_e and, where there are modes, the deflections."""
    free = ["state.alpha", "input.phi", "input.delta_e"]
    oracle = oracle_of(oracle.model.name, "drift")
    rows = ["drift.velocity", "drift.gamma", "drift.pitch_rate"]
    modes = [name for name in oracle.model.states if name.startswith("eta_dot_")]
    free += [f"state.{name.replace('_dot', '')}" for name in modes]
    rows += [f"drift.{name}" for name in modes]

    def residual(*unknowns: Number) -> list[Number]:
        result = values(oracle, point | dict(zip(free, unknowns, strict=True)))
        return [result[row] for row in rows]

    with mpmath.workdps(DIGITS):
        start = [0.03, 0.28, 0.2, 0.5, 0.0, 0.0][: len(free)]
        solution = mpmath.findroot(residual, start, tol=1e-60, maxsteps=30)
        return point | dict(zip(free, solution, strict=True))
