"""What a checked table holds: its parameters, and the polynomials of its quantities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from .polynomial import Polynomial
from .schema import Schema


@dataclass(frozen=True)
class TableParameter:
    """A parameter or coefficient of a table; its value stays in the table.

    `kind` is one of `parameter`, `coefficient`, `required` (a coefficient that must be listed) and `switch`.
    """

    name: str
    path: tuple[str, ...]
    symbol: str
    unit: str
    doc: str
    source: str
    status: str
    uncertainty: float
    kind: str


@dataclass(frozen=True)
class ParameterSet:
    """A named set: the parameters that it replaces, with the places of their new values."""

    name: str
    parameters: tuple[TableParameter, ...]


@dataclass(frozen=True)
class Contents:
    """What models are derived from: the file, the unit system, parameters in order, the polynomial of each quantity.

    `emitted` are the groups of functions that are emitted, None for all; `values` are by paths, `box` is the validity
    box with angles in rad.
    """

    path: Path
    units: str
    schema: Schema
    parameters: tuple[TableParameter, ...]
    polynomials: Mapping[str, Polynomial]
    emitted: tuple[str, ...] | None
    values: Mapping[tuple[str, ...], float]
    box: Mapping[str, tuple[float, float]]
