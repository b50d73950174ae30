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

_OTHER_SECTIONS = ("table", "sources", "validity")
_QUANTITY = re.compile(r"T|C_[TLDM]|C_N_[1-9]\d*")
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
        """Numbers of the flexible modes, from the sections ``C_N_i``."""
        found = sorted(int(name[4:]) for name in self.quantities if name.startswith("C_N_"))
        if found != list(range(1, len(found) + 1)):
            raise TableError(f"{self.name}: modes {found} do not count from 1")
        return tuple(found)


def load_table(path: Path | str) -> Table:
    """Parse the TOML file at `path`."""
    with Path(path).open("rb") as file:
        data = tomllib.load(file)
    values: dict[str, float] = {}
    quantities: dict[str, tuple[Term, ...]] = {}
    for section, entries in data.items():
        if section in _OTHER_SECTIONS:
            continue
        if section not in PARAMETER_SECTIONS:
            quantities[section] = _terms(section, entries)
        for key, entry in entries.items():
            name = key.lower() if section in PARAMETER_SECTIONS else parameter_name(section, key)
            if name in values:
                raise TableError(f"{section}.{key}: a second parameter named {name}")
            values[name] = float(entry["value"])
    return Table(
        name=str(data["table"]["name"]),
        models=tuple(data["table"]["models"]),
        values=values,
        quantities=quantities,
        validity={name: _limits(entry) for name, entry in data["validity"].items()},
    )


def parameter_name(quantity: str, monomial: str) -> str:
    """Name of a coefficient: ``C_T``, ``phi*alpha^3`` gives ``c_t_phi_alpha_3``; ``1`` counts as ``0``."""
    tail = "0" if monomial == "1" else monomial.replace("*", "_").replace("^", "_")
    return f"{quantity}_{tail}".lower()


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
