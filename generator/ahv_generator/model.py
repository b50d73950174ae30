"""A derived model: its named vectors, its quantities, and the functions that are emitted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import casadi as ca

from .graph import Graph
from .schema import VariableSpec
from .table import Table

# Prefixes that tell leaves of different bases apart: a Wiener increment and its intensity share a name.
LEAVES = {"state": "x", "input": "u", "noise": "w"}


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


@dataclass(frozen=True)
class Function:
    """A function of the generated code; functions of one `group` share a file."""

    name: str
    group: str
    doc: str
    equation: str
    outputs: tuple[Output, ...]


@dataclass
class Model:
    """A model under construction."""

    name: str
    title: str
    equations: str
    table: Table
    bases: dict[str, tuple[VariableSpec, ...]]
    graph: Graph = field(default_factory=Graph)
    functions: list[Function] = field(default_factory=list)

    def __post_init__(self) -> None:
        for basis, prefix in LEAVES.items():
            for variable in self.bases.get(basis, ()):
                self.graph.leaf(f"{prefix}.{variable.name}", variable.unit)
        for parameter in self.table.parameters:
            self.graph.leaf(f"p.{parameter.name}", parameter.unit)

    def parameter(self, name: str) -> ca.SX:
        """The symbol of a parameter, by its name in the generated code."""
        return self.graph.symbols[f"p.{name}"]

    def noise(self, name: str) -> ca.SX:
        """The symbol of a Wiener increment."""
        return self.graph.symbols[f"w.{name}"]

    def __getitem__(self, name: str) -> ca.SX:
        """The symbol of a quantity, a state or an input."""
        for known in (name, f"x.{name}", f"u.{name}"):
            if known in self.graph.symbols:
                return self.graph.symbols[known]
        raise KeyError(name)

    def unit(self, name: str) -> str:
        """The unit of a state or an input."""
        return next(v.unit for basis in self.bases.values() for v in basis if v.name == name)

    def qualified(self, basis: str) -> tuple[str, ...]:
        """Names of the leaves of a basis as expressions hold them."""
        return tuple(f"{LEAVES[basis]}.{name}" for name in self.names(basis))

    def names(self, basis: str) -> tuple[str, ...]:
        """Names of the entries of a basis, in order."""
        return tuple(v.name for v in self.bases[basis])

    def vector(self, basis: str, values: dict[str, ca.SX], name: str) -> Output:
        """An output over one basis."""
        entries = tuple(Entry((row,), values[row]) for row in self.names(basis) if not values[row].is_zero())
        return Output(name, (basis,), entries)

    def matrix(self, name: str, rows: str, columns: str, exprs: dict[str, ca.SX]) -> Output:
        """The derivatives of `exprs` (by row) with respect to a basis."""
        # Column by column, so that the derivatives with respect to one variable stand together.
        found = {
            (row, column): self.graph.derivative(exprs[row], leaf)
            for column, leaf in zip(self.names(columns), self.qualified(columns), strict=True)
            for row in self.names(rows)
        }
        at = [(row, column) for row in self.names(rows) for column in self.names(columns)]
        entries = tuple(Entry(key, found[key]) for key in at if not found[key].is_zero())
        return Output(name, (rows, columns), entries)

    def add(self, name: str, group: str, doc: str, equation: str, outputs: Iterable[Output]) -> None:
        """Add a function."""
        self.functions.append(Function(name, group, doc, equation, tuple(outputs)))

    def add_drift_and_jacobians(self, rates: dict[str, ca.SX], equation: str) -> None:
        """The functions that every model has."""
        drift = self.vector("state", rates, "drift")
        by_state = self.matrix("state", "state", "state", rates)
        by_input = self.matrix("input", "state", "input", rates)
        slopes = "derivatives of the drift with respect to the state and to the input"
        self.add("drift", "drift", "Time derivative of the state", equation, [drift])
        self.add("jacobians", "jacobians", slopes.capitalize(), equation, [by_state, by_input])
        both = f"Time derivative of the state, and the {slopes}, for less than one after the other"
        self.add("drift_and_jacobians", "jacobians", both, equation, [drift, by_state, by_input])

    def add_evaluations(self, *names: str) -> None:
        """Functions that give one named quantity each, for whoever needs no more."""
        for name in names:
            quantity = self.graph.quantities[name]
            doc = quantity.doc[0].upper() + quantity.doc[1:]
            value = Output("value", (), (Entry((), self.graph.symbols[name]),), quantity.unit)
            self.add(name, "evaluations", doc, quantity.equation, [value])
