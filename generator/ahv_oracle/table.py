"""Reads a coefficient table: which monomials there are, their values, and the validity box."""

import math
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

PARAMETER_SECTIONS = ("vehicle", "environment", "modes", "noise")
"""Sections whose entries are parameters under their own (lower-case) name."""

CHOICES: Mapping[str, tuple[str, Mapping[str, Mapping[str, float]]]] = {
    "canard": (
        "vehicle",
        {
            "free": {"canard_command": 1.0, "canard_slaving": 0.0},
            "slaved": {"canard_command": 0.0, "canard_slaving": 1.0},
            "none": {"canard_command": 0.0, "canard_slaving": 0.0},
        },
    ),
    "earth": ("environment", {"flat": {"spherical_earth": 0.0}, "spherical": {"spherical_earth": 1.0}}),
    "noise": ("noise", {"independent": {"shared_noise": 0.0}, "shared": {"shared_noise": 1.0}}),
    "reduction": (
        "noise",
        {
            "printed": {"variance_matching": 0.0, "moment_matching": 0.0},
            "variance": {"variance_matching": 1.0, "moment_matching": 0.0},
            "moment": {"variance_matching": 0.0, "moment_matching": 1.0},
        },
    ),
}
"""For each choice: the section after which its switches stand, and the switches by what is chosen."""

_OTHER_SECTIONS = ("table", "sources", "choices", "validity", "sets")
_QUANTITY = re.compile(r"T|C_[TLDM]|(?:C_)?N_[1-9]")
_MODE = re.compile(r"(?:C_)?N_([1-9])")
_FACTOR = re.compile(r"([a-z]\w*?)(?:\^([1-9]\d*))?")


class TableError(ValueError):
    """A table, or a model asked of it, that the oracle cannot make sense of."""


@dataclass(frozen=True)
class Term:
    """One coefficient of a quantity with the monomial that it multiplies."""

    parameter: str
    powers: tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class Table:
    """A coefficient table: structure (terms by quantity), values by parameter name, validity in rad."""

    name: str
    models: tuple[str, ...]
    values: Mapping[str, float]
    quantities: Mapping[str, tuple[Term, ...]]
    validity: Mapping[str, tuple[float, float]]

    @property
    def coefficients(self) -> frozenset[str]:
        """Names of the parameters that multiply a monomial."""
        return frozenset(term.parameter for terms in self.quantities.values() for term in terms)

    @property
    def modes(self) -> tuple[int, ...]:
        """Numbers of the flexible modes, from the sections ``C_N_i`` or ``N_i``."""
        matches = (_MODE.fullmatch(name) for name in self.quantities)
        found = sorted(int(match[1]) for match in matches if match)
        if found != list(range(1, len(found) + 1)):
            raise TableError(f"{self.name}: modes {found} do not count from 1")
        return tuple(found)


def load_table(path: Path | str, set: str | None = None) -> Table:
    """Parse the TOML file at `path`, with the values of the parameter set `set` in place of its own."""
    with Path(path).open("rb") as file:
        data = tomllib.load(file)
    name = str(data["table"]["name"])
    if set is not None and set != data["table"].get("set"):
        _apply(data, name, set)
    quantities = {
        section: _terms(section, entries)
        for section, entries in data.items()
        if section not in PARAMETER_SECTIONS + _OTHER_SECTIONS
    }
    return Table(
        name=name,
        models=tuple(data["table"]["models"]),
        values=_values(data, tuple(quantities)),
        quantities=quantities,
        validity={name: _limits(entry) for name, entry in data["validity"].items()},
    )


def parameter_name(quantity: str, monomial: str) -> str:
    """Name of a coefficient: ``C_T``, ``phi*alpha^3`` gives ``c_t_phi_alpha_3``; ``1`` counts as ``0``."""
    tail = "0" if monomial == "1" else monomial.replace("*", "_").replace("^", "_")
    return f"{quantity}_{tail}".lower()


def _apply(data: dict[str, Any], table: str, chosen: str) -> None:
    """Replace entries of the table by those of a parameter set."""
    if chosen not in data.get("sets", {}):
        raise TableError(f"{table}: no parameter set {chosen!r}")
    for section, entries in data["sets"][chosen].items():
        for key, entry in entries.items():
            if key not in data.get(section, {}):
                raise TableError(f"sets.{chosen}.{section}.{key}: the table has no such entry")
            data[section][key] = entry


def _values(data: Mapping[str, Any], quantities: tuple[str, ...]) -> dict[str, float]:
    """Values by parameter name, section by section with the switches of the choices where they belong."""
    found: list[tuple[str, str, float]] = []
    for section in PARAMETER_SECTIONS:
        for key, entry in data.get(section, {}).items():
            found.append((f"{section}.{key}", key.lower(), float(entry["value"])))
        found += _switches(data.get("choices", {}), section)
    for quantity in quantities:
        for key, entry in data[quantity].items():
            found.append((f"{quantity}.{key}", parameter_name(quantity, key), float(entry["value"])))
    values: dict[str, float] = {}
    for place, name, value in found:
        if name in values:
            raise TableError(f"{place}: a second parameter named {name}")
        values[name] = value
    return values


def _switches(choices: Mapping[str, str], section: str) -> list[tuple[str, str, float]]:
    unknown = [choice for choice in choices if choice not in CHOICES]
    if unknown:
        raise TableError(f"choices.{unknown[0]}: not a choice of these models")
    found: list[tuple[str, str, float]] = []
    for choice, (place, options) in CHOICES.items():
        if place == section and choice in choices:
            if choices[choice] not in options:
                raise TableError(f"choices.{choice}: {choices[choice]!r} is none of {', '.join(options)}")
            found += [(f"choices.{choice}", name, value) for name, value in options[choices[choice]].items()]
    return found


def _terms(section: str, entries: Mapping[str, Any]) -> tuple[Term, ...]:
    if not _QUANTITY.fullmatch(section):
        raise TableError(f"{section}: not a quantity of these models")
    return tuple(Term(parameter_name(section, key), _powers(section, key)) for key in entries)


def _powers(section: str, monomial: str) -> tuple[tuple[str, int], ...]:
    if monomial == "1":
        return ()
    powers = []
    for factor in monomial.split("*"):
        match = _FACTOR.fullmatch(factor)
        if match is None:
            raise TableError(f"{section}.{monomial}: cannot read the factor {factor!r}")
        powers.append((match[1], int(match[2] or 1)))
    return tuple(powers)


def _limits(entry: Mapping[str, Any]) -> tuple[float, float]:
    scale = math.pi / 180.0 if str(entry["unit"]).startswith("deg") else 1.0
    return float(entry["min"]) * scale, float(entry["max"]) * scale
