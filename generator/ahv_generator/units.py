"""The unit systems of the tables: foot, slug, second, radian; and metre, kilogram, second, radian; kelvin in both.

The radian is a base unit here, so that 1/rad and 1/deg and 1 are told apart in a table.
Only when the dimensions of an equation are checked does an angle count as a pure number.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable
from decimal import Decimal, localcontext
from typing import cast

import pint
from pint.util import UnitsContainer

from .diagnostics import shortened

IMPERIAL = "ft-slug-s-rad"
SI = "si"
SYSTEMS = (IMPERIAL, SI)

_FOOT = Decimal("0.3048")  # m, exact
_POUND_FORCE = Decimal("4.4482216152605")  # N, exact

_DEFINITIONS = (
    "foot = [length] = ft",
    "slug = [mass]",
    "second = [time] = s",
    "radian = [angle] = rad",
    "kelvin = [temperature] = K",
    "degree = 0.017453292519943295 * radian = deg",
    "pound_force = slug * foot / second ** 2 = lb",
    f"metre = foot / {_FOOT} = m",
    f"newton = pound_force / {_POUND_FORCE} = N",
    "kilogram = newton * second ** 2 / metre = kg",
)

_SHORT = {
    "foot": "ft",
    "slug": "slug",
    "second": "s",
    "radian": "rad",
    "degree": "deg",
    "kelvin": "K",
    "pound_force": "lb",
    "metre": "m",
    "newton": "N",
    "kilogram": "kg",
}

_LONG = {short: name for name, short in _SHORT.items()}

# Brackets hold names alone. The reader of `ahv ... --table` has the same grammar; `tests/units.txt` holds for both.
_NAME = "(?:ft|slug|lb|m|kg|N|s|rad|deg|K)"
_BASE = rf"1|{_NAME}|\({_NAME}(?:[*/]{_NAME})*\)"
_EXPONENT = r"(?!0+(?:\.0+)?(?:[*/]|$))[0-9]{1,2}(?:\.[0-9]{1,3})?"  # positive
_ATOM = rf"(?:{_BASE})(?:\^{_EXPONENT})?"
_GRAMMAR = re.compile(rf"{_ATOM}(?:[*/]{_ATOM})*")
_ATOMS = re.compile(rf"(^|[*/])({_BASE})(?:\^({_EXPONENT}))?")
_NAMES = re.compile(r"(^|[*/])([A-Za-z]+)")

_PAIRS = {"ft": "m", "slug": "kg", "lb": "N"}
_WORDS = {IMPERIAL: {si: ft for ft, si in _PAIRS.items()}, SI: _PAIRS}
_SIZES = {"ft": _FOOT, "lb": _POUND_FORCE, "slug": _POUND_FORCE / _FOOT}

# Of a unit; no equation has so many.
_MOST_FACTORS = 32

_KNOWN = "ft, slug, lb, m, kg, N, s, rad, deg, K"

Dimensions = dict[str, float]


def _registry() -> pint.UnitRegistry[float]:
    registry: pint.UnitRegistry[float] = pint.UnitRegistry(None)
    for definition in _DEFINITIONS:
        registry.define(definition)
    return registry


_REGISTRY = _registry()


class UnitError(Exception):
    """A unit that cannot be read or does not fit."""


@functools.cache
def _parse(text: str) -> pint.Unit:
    if not text.strip():
        raise UnitError("the unit is empty; a pure number has the unit `1`")
    if not _GRAMMAR.fullmatch(text):
        example = "written like `slug/ft^3` or `(ft*slug)^0.5/s`"
        raise UnitError(f"`{shortened(text)}` is not a unit; known are {_KNOWN}, {example}")
    factors = 1 + len(re.findall("[*/]", text))
    if factors > _MOST_FACTORS:
        raise UnitError(f"`{shortened(text)}` has too many factors, {factors}; there may be {_MOST_FACTORS}")
    # Not by pint's own parser, which evaluates what it reads and stumbles over exponents like `01`.
    powers: dict[str, float] = {}
    for sign, base, exponent in _ATOMS.findall(text):
        for inner, name in _NAMES.findall(base.strip("()")):
            power = float(exponent or 1) * (1 if (sign == "/") == (inner == "/") else -1)
            powers[_LONG[name]] = powers.get(_LONG[name], 0.0) + power
    whole = {name: int(power) if power.is_integer() else power for name, power in powers.items() if power != 0}
    return _REGISTRY.Unit(UnitsContainer(whole))


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


def in_radians(text: str) -> str:
    """A unit with radians for degrees."""
    return text.replace("deg", "rad")


def whole(text: str) -> bool:
    """Whether degrees stand in a unit with a whole power: only then is their conversion the same on every machine."""
    return cast("float", _parse(text)._units.get("degree", 0)) % 1 == 0


def other(system: str) -> str:
    """The system that is not `system`."""
    return SI if system == IMPERIAL else IMPERIAL


def converted(text: str, system: str) -> str:
    """The unit that `system` has in the place of `text`: `slug/ft^3` in SI is `kg/m^3`."""
    return re.sub(r"[A-Za-z]+", lambda word: _WORDS[system].get(word[0], word[0]), text)


def conversion(text: str, system: str) -> float:
    """The number that turns a value in `text` into one in `converted(text, system)`.

    Decimal arithmetic gives the same bits on every platform, which powers of doubles do not.
    """
    with localcontext() as context:
        context.prec = 40
        size = Decimal(1)
        for name, power in _parse(converted(text, IMPERIAL))._units.items():
            size *= _SIZES.get(_SHORT.get(name, name), Decimal(1)) ** Decimal(str(power))
        if converted(text, system) == text:
            return 1.0
        return float(size if system == SI else 1 / size)


@functools.cache
def dimensions(text: str) -> Dimensions:
    """Exponents of length, mass, time and temperature; an angle counts as a pure number."""
    found = _parse(text).dimensionality
    return {str(k): cast("float", v) * 1.0 for k, v in found.items() if str(k) != "[angle]" and v != 0}


def basic(found: Dimensions) -> str:
    """The unit of these dimensions in foot, slug, second and kelvin."""
    names = {"[length]": "ft", "[mass]": "slug", "[time]": "s", "[temperature]": "K"}
    powers = {names[name]: power for name, power in found.items() if abs(power) > 1e-9}
    above = [_power(name, power) for name, power in powers.items() if power > 0]
    below = [_power(name, -power) for name, power in powers.items() if power < 0]
    return "/".join(["*".join(above) or "1", *below])


def in_words(found: Dimensions | None) -> str:
    """Dimensions as a product of powers: `mass*length/time^2`."""
    powers = {name.strip("[]"): power for name, power in (found or {}).items() if power}
    above = [_power(name, power) for name, power in powers.items() if power > 0]
    below = [_power(name, -power) for name, power in powers.items() if power < 0]
    return "/".join(["*".join(above) or "1", *below])


def alike(a: Dimensions, b: Dimensions) -> bool:
    """Whether two dimensions are the same, but for rounding of their exponents."""
    return all(abs(a.get(k, 0.0) - b.get(k, 0.0)) < 1e-9 for k in {*a, *b})


def spelled(texts: Iterable[str]) -> dict[str, str]:
    """The spelling of each unit: that in which its like, `ft/s^2` of `ft/s/s`, stands first among `texts`."""
    first: dict[UnitsContainer, str] = {}
    return {text: first.setdefault(_parse(text)._units, text) for text in texts}


@functools.cache
def quotient(numerator: str, denominator: str) -> str:
    """The unit text of a derivative."""
    unit = _parse(numerator) / _parse(denominator)
    exponents = {_SHORT.get(name, name): power for name, power in unit._units.items()}
    above = [_power(name, k) for name, k in exponents.items() if k > 0]
    below = [_power(name, -k) for name, k in exponents.items() if k < 0]
    return "/".join(["*".join(above) or "1", *below])


def _power(name: str, exponent: float) -> str:
    return name if exponent == 1 else f"{name}^{exponent:g}"
