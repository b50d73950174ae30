"""A derived model: its named vectors, its quantities, and the functions that are emitted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import casadi as ca

from . import units
from .graph import Graph
from .schema import VariableSpec
from .table import Table
from .traits import Traits

# Prefixes that tell leaves of different bases apart: a Wiener increment and its intensity share a name.
LEAVES = {"state": "x", "input": "u", "noise": "w", "argument": "t"}


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


@dataclass
class Model:
    """A model under construction."""

    name: str
    title: str
    equations: str
    table: Table
    bases: dict[str, tuple[VariableSpec, ...]]
    traits: Traits
    graph: Graph = field(init=False)
    functions: list[Function] = field(default_factory=list)
    noise_structure: NoiseStructure | None = None

    def __post_init__(self) -> None:
        faults = self.traits.faults(self.names("state"), self.names("input"))
        if faults:
            raise ValueError(f"the traits of {self.name} do not fit it: {'; '.join(faults)}")
        self.graph = Graph(self.table.units)
        for basis, prefix in LEAVES.items():
            for variable in self.bases.get(basis, ()):
                self.graph.leaf(f"{prefix}.{variable.name}", variable.unit, variable.symbol)
        for parameter in self.table.parameters:
            self.graph.leaf(f"p.{parameter.name}", parameter.unit, parameter.symbol)

    def parameter(self, name: str) -> ca.SX:
        """The symbol of a parameter, by its name in the generated code."""
        return self.graph.symbols[f"p.{name}"]

    def noise(self, name: str) -> ca.SX:
        """The symbol of a Wiener increment."""
        return self.graph.symbols[f"w.{name}"]

    def argument(self, name: str) -> ca.SX:
        """The symbol of an argument that is neither state nor input, such as a time."""
        return self.graph.symbols[f"t.{name}"]

    def __getitem__(self, name: str) -> ca.SX:
        """The symbol of a quantity, a state or an input."""
        for known in (name, f"x.{name}", f"u.{name}"):
            if known in self.graph.symbols:
                return self.graph.symbols[known]
        raise KeyError(name)

    def unit(self, name: str) -> str:
        """The unit of a state, an input or another component, in the system of the table."""
        return units.converted(self.variable(name).unit, self.table.units)

    def variable(self, name: str) -> VariableSpec:
        """A component of a basis by its name."""
        return next(v for basis in self.bases.values() for v in basis if v.name == name)

    def leaves(self, basis: str) -> dict[str, str]:
        """Names of the entries of a basis, in order, with the names that they have in expressions."""
        if basis == "parameter":
            return {p.name: f"p.{p.name}" for p in self.table.parameters}
        return {v.name: f"{LEAVES[basis]}.{v.name}" for v in self.bases[basis]}

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
            for column, leaf in self.leaves(columns).items()
            for row in self.names(rows)
        }
        at = [(row, column) for row in self.names(rows) for column in self.leaves(columns)]
        entries = tuple(Entry(key, found[key]) for key in at if not found[key].is_zero())
        return Output(name, (rows, columns), entries)

    def add(
        self, name: str, group: str, doc: str, equation: str, outputs: Iterable[Output], *, compressed: bool = False
    ) -> None:
        """Add a function; the units of its outputs are turned into those of the table."""
        system = self.table.units
        converted = tuple(
            replace(o, unit=units.converted(o.unit, system)) if o.unit is not None else o for o in outputs
        )
        self.functions.append(Function(name, group, doc, equation, converted, compressed))

    def add_scalar(self, name: str, group: str, doc: str, equation: str, expr: ca.SX, unit: str) -> None:
        """Add a function with one number as its result."""
        self.add(name, group, doc, equation, [Output("", (), (Entry((), expr),), unit)])

    def add_evaluations(self, *names: str) -> None:
        """Functions that give one named quantity each, for whoever needs no more."""
        for name in names:
            quantity = self.graph.quantities[name]
            doc = quantity.doc[0].upper() + quantity.doc[1:]
            self.add_scalar(name, "evaluations", doc, quantity.equation, self.graph.symbols[name], quantity.unit)

    def add_outputs(self, *names: str) -> None:
        """The function of the quantities that people look at, and the basis of its result; a state is none of them."""
        quantities = [self.graph.quantities[name] for name in names if name not in self.names("state")]
        self.bases["output"] = tuple(VariableSpec(q.name, q.symbol, q.unit, q.doc) for q in quantities)
        entries = tuple(Entry((q.name,), self.graph.symbols[q.name]) for q in quantities)
        doc = "Quantities that people look at, which are not states"
        self.add("outputs", "outputs", doc, "", [Output("", ("output",), entries)])
