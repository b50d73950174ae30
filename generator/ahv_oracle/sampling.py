"""Deterministic sample points: a draw depends on seed, point index and name, on nothing else.

So neither a table's coefficient values nor a coefficient added to it move any other number.
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
}
"""Ranges of the parameters that are not coefficients; ``omega`` is for ``omega_1`` and so on."""

SWITCHES = ("canard_slaving", "spherical_earth")
"""Parameters that are 0, 1 or in between, a third of the points each."""

COEFFICIENT_MAGNITUDE = (1e-3, 1e1)
"""Coefficients have random sign and a log-uniform magnitude in this range."""

WIENER_LIMIT = 0.3
"""Bound of the bell-shaped Wiener increments."""

ZERO_PROBABILITY = 0.05
"""How often a coefficient or increment is exactly zero, and a state or input whose box contains zero."""

_NEVER_ZERO = ("parameter.c_l_delta_c",)
_EDGE = 1e-5  # keeps a number inside its range after rounding to seven digits


def sample(model: Model, seed: int, index: int) -> Point:
    """Point number `index` of the sequence `seed`."""
    return {name: float(f"{_number(model, name, (seed, index)):.7g}") for name in model.arguments()}


def _number(model: Model, name: str, key: tuple[int, int]) -> float:
    kind, _, short = name.partition(".")
    if kind == "parameter" and short not in model.table.coefficients:
        return _switch(name, key) if short in SWITCHES else _parameter(name, short, key)
    zero = name not in _NEVER_ZERO and _uniform(name, key, "zero") < ZERO_PROBABILITY
    if kind == "parameter":
        return 0.0 if zero else _coefficient(name, key)
    if kind == "noise":
        total = sum(_uniform(name, key, f"increment {i}") for i in range(4))
        return 0.0 if zero else WIENER_LIMIT * (total / 2.0 - 1.0)
    limits = model.table.validity.get(short) or model.table.validity.get(_family(short))
    if limits is None:
        raise TableError(f"{model.table.name}: validity.{short} is missing")
    inside = limits[0] <= 0.0 <= limits[1]
    return 0.0 if zero and inside else _between(limits, _uniform(name, key, "value"))


def _coefficient(name: str, key: tuple[int, int]) -> float:
    low, high = (math.log(limit) for limit in COEFFICIENT_MAGNITUDE)
    sign = 1.0 if _uniform(name, key, "sign") < 0.5 else -1.0
    return sign * math.exp(_between((low, high), _uniform(name, key, "value")))


def _parameter(name: str, short: str, key: tuple[int, int]) -> float:
    limits = RANGES.get(short) or RANGES.get(_family(short))
    if limits is None:
        raise TableError(f"{short}: no range to sample this parameter from")
    return _between(limits, _uniform(name, key, "value"))


def _switch(name: str, key: tuple[int, int]) -> float:
    choice = _uniform(name, key, "choice")
    if choice < 1.0 / 3.0:
        return 0.0
    return 1.0 if choice < 2.0 / 3.0 else _uniform(name, key, "value")


def _family(name: str) -> str:
    return re.sub(r"_\d+$", "", name)


def _between(limits: tuple[float, float], fraction: float) -> float:
    low, high = limits
    return low + (high - low) * (_EDGE + (1.0 - 2.0 * _EDGE) * fraction)


def _uniform(name: str, key: tuple[int, int], purpose: str) -> float:
    seed, index = key
    digest = hashlib.blake2b(f"{seed}/{index}/{name}/{purpose}".encode(), digest_size=8).digest()
    return (int.from_bytes(digest, "little") >> 11) / 2.0**53
