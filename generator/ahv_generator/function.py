"""The functions that are emitted of a model, by their outputs over named bases."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca


@dataclass(frozen=True)
class Entry:
    """A structurally non-zero entry of a function's output, by the names of its row and column."""

    at: tuple[str, ...]
    expr: ca.SX


@dataclass(frozen=True)
class Output:
    """An output of a function over named bases: a scalar (no basis), a vector, or a matrix."""

    name: str
    basis: tuple[str, ...]
    entries: tuple[Entry, ...]
    unit: str | None = None
    symmetric: bool = False


@dataclass(frozen=True)
class Function:
    """A function of the generated code; functions of one `group` share a file."""

    name: str
    group: str
    doc: str
    equation: str
    outputs: tuple[Output, ...]
    compressed: bool = False


@dataclass(frozen=True)
class NoiseStructure:
    """The class of each column of the diffusion, and the pairs of columns that commute."""

    columns: tuple[tuple[str, str], ...]
    commuting: tuple[tuple[str, str], ...]
