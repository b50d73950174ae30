"""The unit system of the tables: foot, slug, second, radian.

The radian is a base unit here, so that 1/rad and 1/deg and 1 are told apart in a table.
Only when the dimensions of an equation are checked does an angle count as a pure number.
"""

from __future__ import annotations

import re
from typing import cast

import pint

SYSTEM = "ft-slug-s-rad"

_DEFINITIONS = (
    "foot = [length] = ft",
    "slug = [mass]",
    "second = [time] = s",
    "radian = [angle] = rad",
    "degree = 0.017453292519943295 * radian = deg",
    "pound_force = slug * foot / second ** 2 = lb",
)

_SHORT = {"foot": "ft", "second": "s", "radian": "rad", "degree": "deg", "pound_force": "lb"}

_ATOM = r"(?:1|[a-z]+|\([a-z]+(?:[*/][a-z]+)*\))(?:\^\d(?:\.\d{1,3})?)?"
_GRAMMAR = re.compile(rf"{_ATOM}(?:[*/]{_ATOM})*")

Dimensions = dict[str, float]


def _registry() -> pint.UnitRegistry[float]:
    registry: pint.UnitRegistry[float] = pint.UnitRegistry(None)
    for definition in _DEFINITIONS:
        registry.define(definition)
    return registry


_REGISTRY = _registry()


class UnitError(Exception):
    """A unit that cannot be read or does not fit."""


def _parse(text: str) -> pint.Unit:
    if not text.strip():
        raise UnitError("the unit is empty; a pure number has the unit `1`")
    # pint evaluates what it reads: only what a unit can look like is let through.
    if not _GRAMMAR.fullmatch(text):
        raise UnitError(f"{text!r} is not a unit; write it like `slug/ft^3` or `(ft*slug)^0.5/s`")
    try:
        return _REGISTRY.parse_units(text)
    except Exception as error:  # pint raises many unrelated types for malformed text
        raise UnitError(f"`{text}` is not a unit; known are ft, slug, s, rad, deg, lb") from error


def factor(text: str, expected: str) -> float:
    """The number that turns a value in `text` into one in `expected`.

    Raises:
        UnitError: when `text` is not a unit or measures something else.
    """
    unit, wanted = _parse(text), _parse(expected)
    if unit.dimensionality != wanted.dimensionality:
        raise UnitError(f"the unit `{text}` does not fit; this quantity is in `{expected}`")
    ratio: float = _REGISTRY.Quantity(1.0, unit).to(wanted).magnitude
    return ratio


def dimensions(text: str) -> Dimensions:
    """Exponents of length, mass and time; an angle counts as a pure number."""
    found = _parse(text).dimensionality
    return {str(k): cast("float", v) * 1.0 for k, v in found.items() if str(k) != "[angle]" and v != 0}


def quotient(numerator: str, denominator: str) -> str:
    """The unit text of a derivative."""
    unit = _parse(numerator) / _parse(denominator)
    exponents = {_SHORT.get(name, name): power for name, power in unit._units.items()}
    above = [_power(name, k) for name, k in exponents.items() if k > 0]
    below = [_power(name, -k) for name, k in exponents.items() if k < 0]
    return "/".join(["*".join(above) or "1", *below])


def _power(name: str, exponent: float) -> str:
    return name if exponent == 1 else f"{name}^{exponent:g}"
