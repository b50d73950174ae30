"""Expressions at 50 digits, with the measure of the audit: K, in which every summand stands with its absolute value."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import mpmath

from .expression import ExpressionError, Tree, tree
from .model import Model

DIGITS = 50
# mpmath has no types.
Number = Any
Value = tuple[Number, float]

_FUNCTIONS: Mapping[str, tuple[Callable[[Number], Number], Callable[[Number], Number]]] = {
    # A function and its slope.
    "sin": (mpmath.sin, mpmath.cos),
    "cos": (mpmath.cos, mpmath.sin),
    "exp": (mpmath.exp, mpmath.exp),
    "sqrt": (mpmath.sqrt, lambda x: 1 / (2 * mpmath.sqrt(x)) if x else mpmath.mpf(0)),
}


class Exact:
    """Some expressions of a model, ready to be evaluated at points."""

    def __init__(self, model: Model, roots: Iterable[Any]) -> None:
        quantities = {name: tree(quantity.expr) for name, quantity in model.graph.quantities.items()}
        self._roots = [tree(root) for root in roots]
        needed: set[str] = set()
        waiting = list(self._roots)
        while waiting:
            for name in _names(waiting.pop()):
                if name in quantities and name not in needed:
                    needed.add(name)
                    waiting.append(quantities[name])
        # In the order of their definition, each of which is written in those before it.
        self._quantities = {name: expr for name, expr in quantities.items() if name in needed}

    def at(self, point: Mapping[str, Number]) -> list[Value]:
        """Value and K of each expression at a point, whose names are those of leaves."""
        with mpmath.workdps(DIGITS):
            known: dict[str, Value] = {}
            for name, number in point.items():
                value = mpmath.mpf(number)
                known[name] = (value, abs(float(value)))
            for name, expr in self._quantities.items():
                known[name] = _value(expr, known)
            return [_value(root, known) for root in self._roots]


def _names(expr: Tree) -> list[str]:
    if isinstance(expr, str):
        return [expr]
    return [name for inner in expr[1:] for name in _names(inner)] if isinstance(expr, list) else []


def _value(expr: Tree, known: Mapping[str, Value]) -> Value:
    if isinstance(expr, str):
        return known[expr]
    if isinstance(expr, float):
        return mpmath.mpf(expr), abs(expr)
    op, *arguments = expr
    if op == "pow":
        value, size = _value(arguments[0], known)
        exponent = int(float(arguments[1]))  # type: ignore[arg-type]
        result = value**exponent
        return result, size**exponent if exponent > 0 else abs(float(result))
    parts = [_value(argument, known) for argument in arguments]
    if op in _FUNCTIONS:
        function, slope = _FUNCTIONS[str(op)]
        ((value, size),) = parts
        result = function(value)
        # What an error of the measure's size in the argument does belongs to the measure.
        return result, abs(float(result)) + abs(float(slope(value))) * size
    return _combined(str(op), parts)


def _combined(op: str, parts: list[Value]) -> Value:
    values, sizes = [value for value, _ in parts], [size for _, size in parts]
    if op == "+":
        return mpmath.fsum(values), sum(sizes)
    if op == "-":
        return values[0] - values[1], sizes[0] + sizes[1]
    if op == "neg":
        return -values[0], sizes[0]
    if op == "*":
        return values[0] * values[1], sizes[0] * sizes[1]
    if op == "/":
        return values[0] / values[1], sizes[0] * abs(float(1 / values[1]))
    raise ExpressionError(f"`{op}` is not known at {DIGITS} digits")
