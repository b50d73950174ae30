"""CasADi scalar expressions as trees, and the check of their dimensions."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping

import casadi as ca

from . import units

Tree = str | float | list["Tree"]

_BINARY = {ca.OP_SUB: "-", ca.OP_MUL: "*", ca.OP_DIV: "/"}
_UNARY = {ca.OP_NEG: "neg", ca.OP_SIN: "sin", ca.OP_COS: "cos", ca.OP_EXP: "exp", ca.OP_SQRT: "sqrt"}

_SHORT: dict[int, Callable[[Tree], Tree]] = {
    ca.OP_SQ: lambda x: ["pow", x, 2.0],
    ca.OP_TWICE: lambda x: ["*", 2.0, x],
    ca.OP_INV: lambda x: ["/", 1.0, x],
}
# Known to CasADi; the IR and the emitter do not have them yet.
_NOT_YET = {
    ca.OP_TAN: "tan",
    ca.OP_ASIN: "asin",
    ca.OP_ACOS: "acos",
    ca.OP_ATAN: "atan",
    ca.OP_ATAN2: "atan2",
    ca.OP_SINH: "sinh",
    ca.OP_COSH: "cosh",
    ca.OP_TANH: "tanh",
    ca.OP_LOG: "log",
    ca.OP_FABS: "fabs",
    ca.OP_FMIN: "fmin",
    ca.OP_FMAX: "fmax",
    ca.OP_SIGN: "sign",
    ca.OP_LT: "<",
    ca.OP_LE: "<=",
    ca.OP_IF_ELSE_ZERO: "if_else",
}


class ExpressionError(Exception):
    """An expression that the IR cannot hold, or whose dimensions do not agree."""


def tree(expr: ca.SX) -> Tree:
    """The expression as nested lists: a name, a number, or an operator and its arguments.

    Sums are n-ary: the depth of the tree does not grow with the number of terms.
    """
    if expr.is_constant():
        return float(expr)
    if expr.is_symbolic():
        return str(expr.name())
    op = expr.op()
    if op == ca.OP_ADD:
        return ["+", *(tree(term) for term in _addends(expr))]
    args = [tree(expr.dep(i)) for i in range(expr.n_dep())]
    if op in _BINARY:
        return [_BINARY[op], *args]
    if op in _UNARY:
        return [_UNARY[op], *args]
    if op in _SHORT:
        return _SHORT[op](args[0])
    if op in (ca.OP_POW, ca.OP_CONSTPOW) and isinstance(args[1], float) and args[1].is_integer():
        return ["pow", *args]
    raise ExpressionError(_unavailable(op, expr))


def _unavailable(op: int, expr: ca.SX) -> str:
    if op in (ca.OP_POW, ca.OP_CONSTPOW):
        return f"an exponent is a whole number; this one is not: {expr}"
    known = ", ".join(["+", "-", "*", "/", "**", *_UNARY.values()])
    return f"`{_NOT_YET.get(op, op)}` is not available in a model; available: {known}"


def _addends(expr: ca.SX) -> list[ca.SX]:
    """The terms of a chain of additions, first to last, without recursion along the chain."""
    found: list[ca.SX] = []
    waiting = [expr]
    while waiting:
        term = waiting.pop()
        if not term.is_constant() and not term.is_symbolic() and term.op() == ca.OP_ADD:
            waiting += [term.dep(1), term.dep(0)]
        else:
            found.append(term)
    return found


def check_dimensions(name: str, expr: ca.SX, unit: str, known: Mapping[str, str]) -> None:
    """Raise `ExpressionError` unless `expr` has the dimensions of `unit`; an angle is a pure number."""
    found = _dimensions(tree(expr), known)
    wanted = units.dimensions(unit)
    if found is not None and not _same(found, wanted):
        raise ExpressionError(
            f"{name} is declared in `{unit}`, but its expression has the dimensions {_in_words(found)}"
        )


def _in_words(found: units.Dimensions | None) -> str:
    """Dimensions as a product of powers: `mass*length/time^2`."""
    powers = {name.strip("[]"): power for name, power in (found or {}).items() if power}
    above = [name if power == 1 else f"{name}^{power:g}" for name, power in powers.items() if power > 0]
    below = [name if power == -1 else f"{name}^{-power:g}" for name, power in powers.items() if power < 0]
    return "/".join(["*".join(above) or "1", *below])


def _same(a: units.Dimensions, b: units.Dimensions) -> bool:
    return all(abs(a.get(k, 0.0) - b.get(k, 0.0)) < 1e-9 for k in {*a, *b})


def _dimensions(node: Tree, known: Mapping[str, str]) -> units.Dimensions | None:
    """Dimensions of a tree; None for the number zero, which fits everything."""
    if isinstance(node, float):
        return None if node == 0 else {}
    if isinstance(node, str):
        return units.dimensions(known[node])
    op, *args = node
    if op == "pow":
        exponent = args[1]
        assert isinstance(exponent, float)
        return _scaled(_dimensions(args[0], known), exponent)
    parts = [_dimensions(argument, known) for argument in args]
    if op in ("sin", "cos", "exp"):
        if parts[0] and not _same(parts[0], {}):
            raise ExpressionError(f"{op} of a quantity with dimensions: {args[0]}")
        return {}
    if op == "neg":
        return parts[0]
    if op == "sqrt":
        return _scaled(parts[0], 0.5)
    if op in ("+", "-"):
        return functools.reduce(lambda left, right: _common(left, right, node), parts)
    return _product(parts[0], parts[1], 1.0 if op == "*" else -1.0)


def _scaled(found: units.Dimensions | None, factor: float) -> units.Dimensions:
    return {name: power * factor for name, power in (found or {}).items()}


def _common(left: units.Dimensions | None, right: units.Dimensions | None, node: Tree) -> units.Dimensions | None:
    if left is None or right is None:
        return left if right is None else right
    if not _same(left, right):
        raise ExpressionError(f"a sum of unlike dimensions, {_in_words(left)} and {_in_words(right)}")
    return left


def _product(left: units.Dimensions | None, right: units.Dimensions | None, sign: float) -> units.Dimensions | None:
    if left is None or right is None:
        return None
    return {k: left.get(k, 0.0) + sign * right.get(k, 0.0) for k in sorted({*left, *right})}
