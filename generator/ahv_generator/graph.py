"""Named quantities over CasADi symbols, differentiated name by name."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from . import units
from .expression import check_dimensions


@dataclass(frozen=True)
class Quantity:
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

    def __init__(self) -> None:
        self.symbols: dict[str, ca.SX] = {}
        self.units: dict[str, str] = {}
        self.quantities: dict[str, Quantity] = {}
        self._derivatives: dict[tuple[str, str], ca.SX] = {}

    def leaf(self, name: str, unit: str) -> ca.SX:
        """Declare a leaf."""
        if name in self.symbols:
            raise ValueError(f"the name {name} is taken")
        self.symbols[name] = ca.SX.sym(name)
        self.units[name] = unit
        return self.symbols[name]

    def define(self, name: str, expr: ca.SX, *, symbol: str, unit: str, doc: str, equation: str, section: str) -> ca.SX:
        """Name a quantity and return its symbol; its dimensions are checked against `unit`."""
        check_dimensions(name, expr, unit, self.units)
        result = self.leaf(name, unit)
        self.quantities[name] = Quantity(name, symbol, unit, doc, equation, section, expr)
        return result

    def _used(self, expr: ca.SX) -> list[str]:
        # CasADi lists symbols in traversal order; the order of declaration is the one a reader knows.
        used = {symbol.name() for symbol in ca.symvar(expr)}
        return [name for name in self.symbols if name in used]

    def derivative(self, expr: ca.SX, variable: str) -> ca.SX:
        """The total derivative of `expr` with respect to a leaf; 0 where it is structurally zero."""
        total = ca.SX(0)
        for name in self._used(expr):
            inner = self._derivative_of(name, variable)
            if inner.is_zero():
                continue
            partial = ca.jacobian(expr, self.symbols[name])
            if partial.nnz() == 0:
                continue
            total = total + partial * inner
        return total

    def _derivative_of(self, name: str, variable: str) -> ca.SX:
        if name == variable:
            return ca.SX(1)
        quantity = self.quantities.get(name)
        if quantity is None:
            return ca.SX(0)
        key = (name, variable)
        if key not in self._derivatives:
            total = self.derivative(quantity.expr, variable)
            self._derivatives[key] = total if _is_plain(total) else self._define_derivative(quantity, variable, total)
        return self._derivatives[key]

    def _define_derivative(self, quantity: Quantity, variable: str, total: ca.SX) -> ca.SX:
        plain = variable.rpartition(".")[2]
        return self.define(
            f"d_{quantity.name}_d_{plain}",
            total,
            symbol=rf"\partial {quantity.symbol}/\partial {plain}",
            unit=units.quotient(quantity.unit, self.units[variable]),
            doc=f"derivative of {quantity.doc} with respect to {plain}",
            equation="",
            section=f"Derivatives with respect to {plain}",
        )


def _is_plain(expr: ca.SX) -> bool:
    """Whether a derivative needs no name of its own.

    That is a number, a name, a name negated, or a quantity times a parameter; a derivative times a parameter is
    used often enough to be named.
    """
    if expr.is_constant() or expr.is_symbolic():
        return True
    parts = [expr.dep(i) for i in range(expr.n_dep())]
    if not all(part.is_symbolic() for part in parts):
        return False
    names = [part.name() for part in parts]
    scaled = any(name.startswith("p.") for name in names) and not any(name.startswith("d_") for name in names)
    return bool(expr.op() == ca.OP_NEG or (expr.op() == ca.OP_MUL and scaled))
