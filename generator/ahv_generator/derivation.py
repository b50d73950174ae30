"""What derivatives are added to: a model's named vectors, its graph of quantities, and its functions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import casadi as ca

from . import names, units
from .checked import checked
from .contents import Contents
from .diagnostics import FamilyError, suggestion
from .function import Entry, Function, Output
from .graph import Graph
from .schema import Variable

# Prefixes that tell leaves of different bases apart: a Wiener increment and its intensity may share a name.
LEAVES = {"state": "x", "input": "u", "noise": "w", "argument": "t"}


@dataclass
class Derivation:
    """Vectors, graph and functions of a model; the leaves of the graph are the vectors and the table's parameters."""

    name: str
    title: str
    equations: str
    table: Contents
    bases: dict[str, tuple[Variable, ...]]
    graph: Graph = field(init=False)
    functions: list[Function] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.graph = Graph(self.table.units)
        for basis, prefix in LEAVES.items():
            for variable in self.bases.get(basis, ()):
                self.graph.leaf(f"{prefix}.{variable.name}", variable.unit, variable.symbol)
        for parameter in self.table.parameters:
            self.graph.leaf(f"p.{parameter.name}", parameter.unit, parameter.symbol)

    def noise(self, name: str) -> ca.SX:
        """The symbol of a Wiener increment."""
        return self.graph.symbols[f"w.{name}"]

    def unit(self, name: str) -> str:
        """The unit of a state, an input or another component, in the system of the table."""
        return units.converted(self.variable(name).unit, self.table.units)

    def variable(self, name: str) -> Variable:
        """A component of a basis by its name."""
        known = {v.name: v for basis in self.bases.values() for v in basis}
        if name not in known:
            raise FamilyError(f"`{self.name}` has no variable `{name}`", suggestion(name, known))
        return known[name]

    def leaves(self, basis: str) -> dict[str, str]:
        """Names of the entries of a basis, in order, with the names that they have in expressions."""
        if basis == "parameter":
            return {p.name: f"p.{p.name}" for p in self.table.parameters}
        return {v.name: f"{LEAVES[basis]}.{v.name}" for v in self.bases[basis]}

    def names(self, basis: str) -> tuple[str, ...]:
        """Names of the entries of a basis, in order."""
        return tuple(v.name for v in self.bases[basis])

    def vector(self, basis: str, values: Mapping[str, ca.SX], name: str) -> Output:
        """An output over one basis."""
        entries = tuple(Entry((row,), values[row]) for row in self.names(basis) if not values[row].is_zero())
        return Output(name, (basis,), entries)

    def matrix(self, name: str, rows: str, columns: str, exprs: Mapping[str, ca.SX]) -> Output:
        """The derivatives of `exprs` (by row) with respect to a basis."""
        # Column by column, so that the derivatives with respect to one variable stand together.
        found = {
            (row, column): self.graph.derivative(exprs[row], leaf)
            for column, leaf in self.leaves(columns).items()
            for row in self.names(rows)
        }
        at = [(row, column) for row in self.names(rows) for column in self.leaves(columns)]
        entries = tuple(Entry(key, found[key]) for key in at if not found[key].is_zero())
        return Output(name, (rows, columns), entries)

    @checked
    def add(
        self, name: str, group: str, doc: str, equation: str, outputs: Iterable[Output], *, compressed: bool = False
    ) -> None:
        """Add a function; the units of its outputs are turned into those of the table, and checked."""
        if name in [function.name for function in self.functions]:
            raise FamilyError(f"the name `{name}` is used twice, for two functions of `{self.name}`")
        fault = names.fault_of_functions([name, *(function.name for function in self.functions)])
        if fault is not None:
            raise FamilyError(fault)
        system = self.table.units
        converted = tuple(
            replace(o, unit=units.converted(o.unit, system)) if o.unit is not None else o for o in outputs
        )
        for output in converted:
            for entry in output.entries:
                if output.unit is not None:
                    self.graph.check(f"the function `{name}`", entry.expr, output.unit)
        self.functions.append(Function(name, group, doc, equation, converted, compressed))

    @checked
    def add_scalar(self, name: str, group: str, doc: str, equation: str, expr: ca.SX, unit: str) -> None:
        """Add a function with one number as its result."""
        self.add(name, group, doc, equation, [Output("", (), (Entry((), expr),), unit)])
