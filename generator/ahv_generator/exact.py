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

_NAN = mpmath.mpf("nan")

_FUNCTIONS: Mapping[str, tuple[Callable[[Number], Number], Callable[[Number], Number]]] = {
    # A function and the size of its slope.
    "sin": (mpmath.sin, mpmath.cos),
    "cos": (mpmath.cos, mpmath.sin),
    "tan": (mpmath.tan, lambda x: 1 / mpmath.cos(x) ** 2),
    "asin": (mpmath.asin, lambda x: 1 / mpmath.sqrt(1 - x**2)),
    "atan": (mpmath.atan, lambda x: 1 / (1 + x**2)),
    "exp": (mpmath.exp, mpmath.exp),
    "tanh": (mpmath.tanh, lambda x: 1 / mpmath.cosh(x) ** 2),
    "ln": (mpmath.log, lambda x: 1 / x),
    "sqrt": (mpmath.sqrt, lambda x: 1 / (2 * mpmath.sqrt(x)) if x else mpmath.mpf(0)),
}


class Exact:
    """Some expressions of a model, ready to be evaluated at points; a value is NaN where there is none."""

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
    parts = [_value(argument, known) for argument in arguments]
    if any(mpmath.isnan(value) for value, _ in parts):
        return _NAN, 0.0
    try:
        value, size = _applied(str(op), parts)
    except (ZeroDivisionError, ValueError):
        return _NAN, 0.0
    # Outside its real domain a function has a complex value.
    return (_NAN, 0.0) if isinstance(value, mpmath.mpc) else (value, float(size))


def _applied(op: str, parts: list[Value]) -> tuple[Number, Number]:
    """An operation on values. What an error of the measure's size in an argument does belongs to the measure."""
    values, sizes = [value for value, _ in parts], [size for _, size in parts]
    if op in _FUNCTIONS:
        function, slope = _FUNCTIONS[op]
        result = function(values[0])
        return result, abs(result) + abs(slope(values[0])) * sizes[0]
    if op == "pow":
        exponent = int(values[1])
        result = values[0] ** exponent
        return result, sizes[0] ** exponent if exponent > 0 else abs(result)
    if op == "powr":
        base, exponent = values
        result = base**exponent
        return result, abs(result) * (1 + abs(exponent / base) * sizes[0] + abs(mpmath.log(base)) * sizes[1])
    if op == "atan2":
        y, x = values
        result = mpmath.atan2(y, x)
        return result, abs(result) + (abs(x) * sizes[0] + abs(y) * sizes[1]) / (x**2 + y**2)
    if op == "abs":
        return abs(values[0]), sizes[0]
    if op in ("min", "max"):
        return (min if op == "min" else max)(parts, key=lambda part: part[0])
    if op == "select":
        return parts[2] if values[0] < values[1] else parts[3]
    return _combined(op, parts)


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
