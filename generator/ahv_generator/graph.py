"""Named quantities over CasADi symbols, differentiated name by name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from . import units
from .expression import ExpressionError, check_dimensions

_NOTHING = ca.SX.nan()


@dataclass(frozen=True)
class Intermediate:
    """A quantity an engineer would name; `expr` is written in the names before it."""

    name: str
    symbol: str
    unit: str
    doc: str
    equation: str
    section: str
    expr: ca.SX


class Graph:
    """Leaves (states, inputs, parameters, increments) and the quantities built on them, in order."""

    def __init__(self, system: str = units.IMPERIAL) -> None:
        self.system = system
        self.symbols: dict[str, ca.SX] = {}
        self.units: dict[str, str] = {}
        self.quantities: dict[str, Intermediate] = {}
        self.latex: dict[str, str] = {}
        self._position: dict[str, int] = {}
        # Of a name: what its expression mentions, and the leaves that it depends on in the end.
        self._names: dict[str, list[str]] = {}
        self._leaves: dict[str, frozenset[str]] = {}
        self._partials: dict[tuple[str, str], ca.SX] = {}
        self._derivatives: dict[tuple[str, str], ca.SX] = {}
        # Of a derivative: its order, and the symbols above and below the bar.
        self._derived: dict[str, tuple[int, str, str]] = {}

    def leaf(self, name: str, unit: str, symbol: str = "") -> ca.SX:
        """Declare a leaf; its unit is turned into that of the graph's system."""
        if name in self.symbols:
            raise ValueError(f"the name {name} is taken")
        self._position[name] = len(self.symbols)
        self._leaves[name] = frozenset([name])
        self.symbols[name] = ca.SX.sym(name)
        self.units[name] = units.converted(unit, self.system)
        if symbol:
            self.latex[name] = symbol
        return self.symbols[name]

    def define(self, name: str, expr: ca.SX, *, symbol: str, unit: str, doc: str, equation: str, section: str) -> ca.SX:
        """Name a quantity and return its symbol; its dimensions are checked against `unit`."""
        used = self._names_in(expr)
        check_dimensions(name, expr, unit, self.units)
        result = self.leaf(name, unit)
        self._names[name] = used
        self._leaves[name] = frozenset().union(*(self._leaves[used] for used in self._names[name]))
        self.quantities[name] = Intermediate(name, symbol, self.units[name], doc, equation, section, expr)
        return result

    def check(self, name: str, expr: ca.SX, unit: str) -> None:
        """Raise `ExpressionError` unless an expression, of symbols of this model, has the dimensions of `unit`."""
        self._names_in(expr)
        check_dimensions(name, expr, unit, self.units)

    def leaves_in(self, expr: ca.SX) -> frozenset[str]:
        """The leaves that an expression depends on in the end."""
        return frozenset().union(*(self._leaves[name] for name in self._names_in(expr)))

    def unit_of(self, dimensions: units.Dimensions) -> str:
        """A unit of the graph's system that has these dimensions."""
        return units.converted(units.basic(dimensions), self.system)

    def _names_in(self, expr: ca.SX) -> list[str]:
        symbols = ca.symvar(expr)
        for symbol in symbols:
            # A symbol of the same name that another model has would be a constant here.
            if not ca.is_equal(symbol, self.symbols.get(symbol.name(), _NOTHING)):
                raise ExpressionError(f"`{symbol.name()}` is not a symbol of this model: write it as `model[...]`")
        # CasADi lists symbols in traversal order; the order of declaration is the one a reader knows.
        return sorted((symbol.name() for symbol in symbols), key=self._position.__getitem__)

    def derivative(self, expr: ca.SX, variable: str) -> ca.SX:
        """The total derivative of `expr` with respect to a leaf; 0 where it is structurally zero."""
        return self._chained(expr, self._names_in(expr), variable, None)

    def _chained(self, expr: ca.SX, names: list[str], variable: str, of: Intermediate | None) -> ca.SX:
        """The chain rule over `names`; `of` is the quantity whose definition `expr` is, if it is one."""
        total = ca.SX(0)
        for name in names:
            if variable not in self._leaves[name]:
                continue
            inner = self._derivative_of(name, variable)
            if inner.is_zero():
                continue
            partial = ca.jacobian(expr, self.symbols[name])
            if partial.nnz() == 0:
                continue
            if of is not None and name in self.quantities:
                partial = self._partial(of, name, partial, variable)
            total = total + partial * inner
        return total

    def _partial(self, of: Intermediate, name: str, partial: ca.SX, variable: str) -> ca.SX:
        """The partial derivative of a quantity by another: by a name of its own where it is a sum, to be used again.

        The sine of an angle is what it is: two partial derivatives may be the same one, and neither is the other's.
        """
        own = f"slope_of_{of.name}_in_{name}"
        if _is_product(partial, of_calls=True) or not _is_basic(of.name) or len(own) > _LONGEST:
            return partial
        key = (of.name, name)
        if key not in self._partials:
            self._partials[key] = self.define(
                own,
                partial,
                symbol=rf"\left.\frac{{\partial {of.symbol}}}{{\partial {self.quantities[name].symbol}}}\right|",
                unit=units.quotient(of.unit, self.units[name]),
                doc=f"partial derivative of {of.doc} with respect to {self.quantities[name].doc}",
                equation="",
                section=self._section_of(variable),
            )
        return self._partials[key]

    def _derivative_of(self, name: str, variable: str) -> ca.SX:
        if name == variable:
            return ca.SX(1)
        quantity = self.quantities.get(name)
        if quantity is None:
            return ca.SX(0)
        key = (name, variable)
        if key not in self._derivatives:
            total = self._chained(quantity.expr, self._names[name], variable, quantity)
            plain = _is_plain(total, variable, self.quantities)
            self._derivatives[key] = total if plain else self._define_derivative(quantity, variable, total)
        return self._derivatives[key]

    def _define_derivative(self, quantity: Intermediate, variable: str, total: ca.SX) -> ca.SX:
        plain = variable.rpartition(".")[2]
        order, symbol, below = self._derived.get(quantity.name, (0, quantity.symbol, ""))
        stem = quantity.name.removeprefix("d_" if order == 1 else f"d{order}_") if order else quantity.name
        name = f"d{order + 1 if order else ''}_{stem}_d_{plain}"
        below = rf"{below}\,\partial {self._latex(variable)}"
        power = f"^{order + 1}" if order else ""
        self._derived[name] = (order + 1, symbol, below)
        of = quantity.doc.removeprefix("derivative of ") if order else quantity.doc
        return self.define(
            name,
            total,
            symbol=rf"\frac{{\partial{power} {symbol}}}{{{below.removeprefix(chr(92) + ',')}}}",
            unit=units.quotient(quantity.unit, self.units[variable]),
            doc=f"derivative of {of} {'and' if order else 'with respect to'} {plain}",
            equation="",
            section=self._section_of(variable),
        )

    def _section_of(self, variable: str) -> str:
        return (
            f"Derivatives with respect to {'parameters' if variable.startswith('p.') else variable.rpartition('.')[2]}"
        )

    def _latex(self, variable: str) -> str:
        return self.latex.get(variable, rf"\mathrm{{{variable.rpartition('.')[2]}}}".replace("_", r"\_"))


def _is_plain(expr: ca.SX, variable: str, quantities: Mapping[str, Intermediate]) -> bool:
    """Whether a derivative needs no name of its own.

    That is a number, a name, a name negated, a product of leaves alone (the alpha^2 that a coefficient is multiplied
    with), or a quantity times a parameter. A derivative times a parameter is used often enough to be named. By a
    parameter, a product of quantities and leaves needs no name either.
    """
    if expr.is_constant() or expr.is_symbolic():
        return True
    if _is_product(expr):
        used = [symbol.name() for symbol in ca.symvar(expr)]
        inner = [name for name in used if name in quantities]
        if not inner or (variable.startswith("p.") and not any(_is_derivative(name) for name in inner)):
            return True
    parts = [expr.dep(i) for i in range(expr.n_dep())]
    if not all(part.is_symbolic() for part in parts):
        return False
    names = [part.name() for part in parts]
    scaled = any(name.startswith("p.") for name in names) and not any(_is_derivative(name) for name in names)
    return bool(expr.op() == ca.OP_NEG or (expr.op() == ca.OP_MUL and scaled))


def _is_derivative(name: str) -> bool:
    return re.match(r"d\d?_", name) is not None


def _is_basic(name: str) -> bool:
    """Whether a quantity is neither a derivative nor a slope."""
    return not _is_derivative(name) and not name.startswith("slope_of_")


# A longer name of a slope would not be read.
_LONGEST = 44


_PRODUCT = (ca.OP_MUL, ca.OP_NEG, ca.OP_SQ, ca.OP_TWICE, ca.OP_DIV, ca.OP_INV, ca.OP_POW, ca.OP_CONSTPOW)
_SUM = (ca.OP_ADD, ca.OP_SUB)


def _is_product(expr: ca.SX, *, of_calls: bool = False) -> bool:
    """Whether there is no sum in an expression, and no elementary function but, `of_calls`, of a symbol."""
    if expr.is_constant() or expr.is_symbolic():
        return True
    parts = [expr.dep(i) for i in range(expr.n_dep())]
    if expr.op() in _PRODUCT:
        return all(_is_product(part, of_calls=of_calls) for part in parts)
    return of_calls and expr.op() not in _SUM and all(part.is_symbolic() for part in parts)
