"""Deterministic sample points: a draw depends on seed, point index and name, on nothing else.

So neither a table's coefficient values nor a coefficient added to it move any other number. Two things
are drawn with a view to another: an inertial coupling to the inertia, a reduction's switches to each other.
"""

import hashlib
import math
import re

from .model import Model
from .table import TableError

Point = dict[str, float]
"""Doubles of at most seven significant digits, by qualified name (``state.velocity``)."""

RANGES = {
    "m": (50.0, 500.0),
    "i_yy": (5e4, 1e6),
    "s": (5.0, 30.0),
    "c_bar": (5.0, 30.0),
    "z_t": (1.0, 15.0),
    "rho_0": (1e-5, 2e-4),
    "h_0": (7e4, 1e5),
    "h_s": (1.5e4, 3e4),
    "g": (30.0, 34.0),
    "r_e": (2.0e7, 2.2e7),
    "omega": (5.0, 150.0),
    "zeta": (0.01, 1.5),
    "sigma": (1.0, 100.0),
    "w_gamma": (1e-4, 1e-2),
    "w_alpha": (1e-4, 1e-2),
    "w_q": (1e-4, 1e-2),
    "gust_rms": (1e-4, 1e-2),
    "gust_time": (0.02, 1.0),
}
"""Ranges of the parameters that are not coefficients; ``omega`` is for ``omega_1`` and so on."""

SWITCHES = ("canard_command", "canard_slaving", "spherical_earth", "shared_noise")
"""Parameters that are 0, 1 or in between, a third of the points each."""

REDUCTIONS = ("", "variance_matching", "moment_matching")
"""One of these is on (wholly or in part, half of the points each), the others are off; "" is the printed one."""

COUPLING = (0.05, 0.75)
"""Size of an inertial coupling in units of sqrt(i_yy / number of modes): the mass matrix stays positive."""

LOGARITHMIC = {"time": (1e-3, 2.0), "frequency": (0.1, 300.0)}
"""Ranges of the arguments that are not states, drawn log-uniform."""

COEFFICIENT_MAGNITUDE = (1e-3, 1e1)
"""Coefficients have random sign and a log-uniform magnitude in this range."""

WIENER_LIMIT = 0.3
"""Bound of the bell-shaped Wiener increments."""

ZERO_PROBABILITY = 0.05
"""How often a coefficient, increment or time is exactly zero, and a state or input whose box contains zero."""

_NEVER_ZERO = ("parameter.c_l_delta_c", "argument.frequency")
_EDGE = 1e-5  # keeps a number inside its range after rounding to seven digits


def sample(model: Model, seed: int, index: int) -> Point:
    """Point number `index` of the sequence `seed`."""
    return {name: float(f"{_number(model, name, (seed, index)):.7g}") for name in model.arguments()}


def _number(model: Model, name: str, key: tuple[int, int]) -> float:
    kind, _, short = name.partition(".")
    if kind == "parameter" and short not in model.table.coefficients:
        return _parameter(model, short, key)
    if name not in _NEVER_ZERO and _uniform(name, key, "zero") < ZERO_PROBABILITY and _may_be_zero(model, kind, short):
        return 0.0
    if kind == "parameter":
        return _sign(name, key) * _logarithmic(COEFFICIENT_MAGNITUDE, _uniform(name, key, "value"))
    if kind == "noise":
        total = sum(_uniform(name, key, f"increment {i}") for i in range(4))
        return WIENER_LIMIT * (total / 2.0 - 1.0)
    if kind == "argument":
        return _logarithmic(LOGARITHMIC[short], _uniform(name, key, "value"))
    return _between(_box(model, short), _uniform(name, key, "value"))


def _may_be_zero(model: Model, kind: str, short: str) -> bool:
    if kind not in ("state", "input"):
        return True
    low, high = _box(model, short)
    return low <= 0.0 <= high


def _box(model: Model, short: str) -> tuple[float, float]:
    limits = model.table.validity.get(short) or model.table.validity.get(_family(short))
    if limits is None:
        raise TableError(f"{model.table.name}: validity.{short} is missing")
    return limits


def _parameter(model: Model, short: str, key: tuple[int, int]) -> float:
    name = f"parameter.{short}"
    if short in SWITCHES:
        return _switch(name, key)
    if short in REDUCTIONS:
        return _reduction(short, key)
    if _family(short) == "psi":
        inertia = _between(RANGES["i_yy"], _uniform("parameter.i_yy", key, "value"))
        size = _between(COUPLING, _uniform(name, key, "value"))
        return _sign(name, key) * size * math.sqrt(inertia / len(model.table.modes))
    limits = RANGES.get(short) or RANGES.get(_family(short))
    if limits is None:
        raise TableError(f"{short}: no range to sample this parameter from")
    return _between(limits, _uniform(name, key, "value"))


def _switch(name: str, key: tuple[int, int]) -> float:
    choice = _uniform(name, key, "choice")
    if choice < 1.0 / 3.0:
        return 0.0
    return 1.0 if choice < 2.0 / 3.0 else _uniform(name, key, "value")


def _reduction(short: str, key: tuple[int, int]) -> float:
    if REDUCTIONS[int(3.0 * _uniform("reduction", key, "choice"))] != short:
        return 0.0
    return 1.0 if _uniform("reduction", key, "whole") < 0.5 else _uniform("reduction", key, "value")


def _family(name: str) -> str:
    return re.sub(r"_\d+$", "", name)


def _sign(name: str, key: tuple[int, int]) -> float:
    return 1.0 if _uniform(name, key, "sign") < 0.5 else -1.0


def _logarithmic(limits: tuple[float, float], fraction: float) -> float:
    low, high = (math.log(limit) for limit in limits)
    return math.exp(_between((low, high), fraction))


def _between(limits: tuple[float, float], fraction: float) -> float:
    low, high = limits
    return low + (high - low) * (_EDGE + (1.0 - 2.0 * _EDGE) * fraction)


def _uniform(name: str, key: tuple[int, int], purpose: str) -> float:
    seed, index = key
    digest = hashlib.blake2b(f"{seed}/{index}/{name}/{purpose}".encode(), digest_size=8).digest()
    return (int.from_bytes(digest, "little") >> 11) / 2.0**53
