"""Points at which a model is checked: states and inputs of its box, parameters about the values of its table.

A number depends on seed, index and name alone, so that another coefficient moves no other number.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping

from .model import Model

Point = Mapping[str, float]

# A parameter is its value times a factor of this range; a value of 0 is drawn from -1 to 1.
_FACTOR = (0.7, 1.3)
_WIENER_LIMIT = 0.3
_ARGUMENT = (0.1, 2.0)
# How often other parameters are drawn, where those that are drawn break a rule of the table.
_ATTEMPTS = 100


def draw(model: Model, seed: int, index: int) -> dict[str, float]:
    """The point `index` of the sequence `seed`, by the names that expressions have for leaves (`x.alpha`)."""
    point = {f"p.{name}": value for name, value in _parameters(model, (seed, index)).items()}
    for kind, prefix in (("state", "x"), ("input", "u")):
        for variable in model.bases[kind]:
            name = f"{prefix}.{variable.name}"
            point[name] = _between(model.table.box[variable.interval], _uniform(name, seed, index))
    for kind, prefix, limits in (("noise", "w", (-_WIENER_LIMIT, _WIENER_LIMIT)), ("argument", "t", _ARGUMENT)):
        for variable in model.bases.get(kind, ()):
            name = f"{prefix}.{variable.name}"
            point[name] = _between(limits, _uniform(name, seed, index))
    # Few digits: the point is read again from text.
    return {name: float(f"{value:.7g}") for name, value in point.items()}


def _parameters(model: Model, key: tuple[int, int]) -> dict[str, float]:
    """Parameters that keep the rules of the table; its own values where none are found."""
    table = model.table
    own = {p.name: table.values.get(p.path, 0.0) for p in table.parameters}
    for choice in table.schema.choices:
        option = choice.options[int(_uniform(f"choice {choice.name}", *key) * len(choice.options))]
        own |= dict(zip((switch.name for switch in choice.switches), option.values, strict=True))
    switches = {switch.name for choice in table.schema.choices for switch in choice.switches}
    for attempt in range(_ATTEMPTS):
        drawn = {
            name: value if name in switches else _near(value, _uniform(f"p.{name} {attempt}", *key))
            for name, value in own.items()
        }
        rounded = {name: float(f"{value:.7g}") for name, value in drawn.items()}
        rules = [rule for rule in table.schema.rules() if all(name in rounded for name in rule.parameters())]
        if all(rule.holds(rounded) for rule in rules):
            return rounded
    return own


def _near(value: float, fraction: float) -> float:
    return value * _between(_FACTOR, fraction) if value else _between((-1.0, 1.0), fraction)


def _between(limits: tuple[float, float], fraction: float) -> float:
    low, high = limits
    return low + (high - low) * fraction


def _uniform(name: str, seed: int, index: int) -> float:
    digest = hashlib.blake2b(f"{seed}/{index}/{name}".encode(), digest_size=8).digest()
    return (int.from_bytes(digest, "little") >> 11) / 2.0**53
