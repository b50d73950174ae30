"""CasADi scalar expressions as trees, and the check of their dimensions."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping

import casadi as ca

from . import units

Tree = str | float | list["Tree"]

_BINARY = {ca.OP_SUB: "-", ca.OP_MUL: "*", ca.OP_DIV: "/"}
_CALLS = {
    ca.OP_NEG: "neg",
    ca.OP_SIN: "sin",
    ca.OP_COS: "cos",
    ca.OP_TAN: "tan",
    ca.OP_ASIN: "asin",
    ca.OP_ATAN: "atan",
    ca.OP_ATAN2: "atan2",
    ca.OP_EXP: "exp",
    ca.OP_TANH: "tanh",
    ca.OP_LOG: "ln",
    ca.OP_SQRT: "sqrt",
    ca.OP_FABS: "abs",
    ca.OP_FMIN: "min",
    ca.OP_FMAX: "max",
}


def _acos(x: Tree) -> Tree:
    # Not by asin, whose difference from a right angle has few digits near 1.
    return ["*", 2.0, ["atan2", ["sqrt", ["-", 1.0, x]], ["sqrt", ["+", 1.0, x]]]]


def _cosh(x: Tree) -> Tree:
    return ["/", ["+", ["exp", x], ["exp", ["neg", x]]], 2.0]


# Operations that are written in others.
_SHORT: dict[int, Callable[[Tree], Tree]] = {
    ca.OP_ACOS: _acos,
    ca.OP_COSH: _cosh,
    # Not by a difference of exponentials, which has few digits near 0.
    ca.OP_SINH: lambda x: ["*", ["tanh", x], _cosh(x)],
    ca.OP_SQ: lambda x: ["pow", x, 2.0],
    ca.OP_TWICE: lambda x: ["*", 2.0, x],
    ca.OP_INV: lambda x: ["/", 1.0, x],
    ca.OP_SIGN: lambda x: ["select", x, 0.0, -1.0, ["select", 0.0, x, 1.0, 0.0]],
}
_CONDITIONS = (ca.OP_LT, ca.OP_LE, ca.OP_NOT, ca.OP_AND, ca.OP_OR)
# Known to CasADi; the IR and the emitter do not have them.
_NOT_YET = {
    ca.OP_ASINH: "asinh",
    ca.OP_ACOSH: "acosh",
    ca.OP_ATANH: "atanh",
    ca.OP_EQ: "==",
    ca.OP_NE: "!=",
    ca.OP_COPYSIGN: "copysign",
    ca.OP_FLOOR: "floor",
    ca.OP_CEIL: "ceil",
    ca.OP_FMOD: "fmod",
}


class ExpressionError(Exception):
    """An expression that the IR cannot hold, or whose dimensions do not agree."""


_number_of = ca.SX.__float__


def _float(expr: ca.SX) -> float:
    # CasADi's own gives NaN for a symbol, with which `math.sin` and `max` go on.
    if not expr.is_constant():
        raise ExpressionError(
            f"a number is needed where `{expr}` stands: of an expression take `sin`, `sqrt`, `fmax`, ... of"
            " `ahv_generator.modelling`, not those of `math`"
        )
    return float(_number_of(expr))


ca.SX.__float__ = _float  # type: ignore[method-assign]


def tree(expr: ca.SX) -> Tree:
    """The expression as nested lists: a name, a number, or an operator and its arguments.

    Sums are n-ary: the depth of the tree does not grow with the number of terms.
    """
    if expr.is_constant():
        if not expr.is_regular():
            raise ExpressionError(f"a number in it is not finite: {float(expr)}")
        return float(expr)
    if expr.is_symbolic():
        return str(expr.name())
    op = expr.op()
    if op == ca.OP_ADD:
        terms = _cases(_addends(expr))
        return terms[0] if len(terms) == 1 else ["+", *terms]
    if op in _CONDITIONS:
        return _choice(expr, 1.0, 0.0)
    if op == ca.OP_IF_ELSE_ZERO:
        return _choice(expr.dep(0), tree(expr.dep(1)), 0.0)
    if _is_share(expr):
        return _share(*(tree(expr.dep(0).dep(i)) for i in (0, 1)))
    return _operation(op, expr)


def _operation(op: int, expr: ca.SX) -> Tree:
    """An operator on the trees of its arguments."""
    args = [tree(expr.dep(i)) for i in range(expr.n_dep())]
    if op in _BINARY:
        return [_BINARY[op], *args]
    if op in _CALLS:
        return [_CALLS[op], *args]
    if op in _SHORT:
        return _SHORT[op](args[0])
    if op in (ca.OP_POW, ca.OP_CONSTPOW):
        is_whole = isinstance(args[1], float) and args[1].is_integer()
        return ["pow" if is_whole else "powr", *args]
    raise ExpressionError(_unavailable(op))


def _unavailable(op: int) -> str:
    # By the names that a family imports; `abs` is Python's.
    spelled = {"neg": "", "ln": "log", "min": "fmin", "max": "fmax"}
    calls = [*(spelled.get(name, name) for name in _CALLS.values()), "acos", "sinh", "cosh"]
    known = ", ".join(["+", "-", "*", "/", "**", *filter(None, calls), "select"])
    return f"`{_NOT_YET.get(op, op)}` is not available in a model; available: {known}"


def _cases(terms: list[ca.SX]) -> list[Tree]:
    """The trees of addends; two that hold in opposite cases, as CasADi has a choice, are one."""
    found: list[Tree] = []
    waiting = list(terms)
    while waiting:
        term = waiting.pop(0)
        other = next((it for it in waiting if _is_opposite(term, it)), None)
        if other is None:
            found.append(tree(term))
            continue
        waiting = [it for it in waiting if it is not other]
        found.append(_choice(term.dep(0), tree(term.dep(1)), tree(other.dep(1))))
    return found


def _is_opposite(term: ca.SX, other: ca.SX) -> bool:
    """Whether the second of two addends holds where the first does not."""
    if not (_is(term, ca.OP_IF_ELSE_ZERO) and _is(other, ca.OP_IF_ELSE_ZERO)):
        return False
    condition = other.dep(0)
    return _is(condition, ca.OP_NOT) and _equal(condition.dep(0), term.dep(0))


def _is(expr: ca.SX, op: int) -> bool:
    return not expr.is_constant() and not expr.is_symbolic() and bool(expr.op() == op)


def _equal(a: ca.SX, b: ca.SX) -> bool:
    return bool(ca.is_equal(a, b, 100))


def _choice(condition: ca.SX, then: Tree, otherwise: Tree) -> Tree:
    """`then` where the condition holds, else `otherwise`: in words of `<` alone."""
    op = condition.op() if not condition.is_constant() and not condition.is_symbolic() else None
    if op in (ca.OP_LT, ca.OP_LE):
        left, right = tree(condition.dep(0)), tree(condition.dep(1))
        return ["select", left, right, then, otherwise] if op == ca.OP_LT else ["select", right, left, otherwise, then]
    if op == ca.OP_NOT:
        return _choice(condition.dep(0), otherwise, then)
    if op == ca.OP_AND:
        return _choice(condition.dep(0), _choice(condition.dep(1), then, otherwise), otherwise)
    if op == ca.OP_OR:
        return _choice(condition.dep(0), then, _choice(condition.dep(1), then, otherwise))
    if op in _NOT_YET:
        raise ExpressionError(_unavailable(op))
    raise ExpressionError(f"a condition compares two expressions by <, <=, > or >=; this one does not: {condition}")


def _is_share(expr: ca.SX) -> bool:
    """Whether an expression is what CasADi has as the slope of a minimum or maximum: (a <= b)/((a <= b) + (b <= a))."""
    if not (_is(expr, ca.OP_DIV) and _is(expr.dep(0), ca.OP_LE) and _is(expr.dep(1), ca.OP_ADD)):
        return False
    above, below = expr.dep(0), expr.dep(1)
    return all(_is(below.dep(i), ca.OP_LE) for i in (0, 1)) and _equal(below.dep(0), above)


def _share(a: Tree, b: Tree) -> Tree:
    """1 where a < b, 0 where b < a, and a half where they are equal."""
    return ["select", a, b, 1.0, ["select", b, a, 0.0, 0.5]]


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
    if found is not None and not units.alike(found, wanted):
        raise ExpressionError(
            f"{name} is declared in `{unit}`, but its expression has the dimensions {units.in_words(found)}"
        )


def dimensions_of(expr: ca.SX, known: Mapping[str, str]) -> units.Dimensions:
    """The dimensions of an expression; an angle is a pure number."""
    return _dimensions(tree(expr), known) or {}


def _dimensions(node: Tree, known: Mapping[str, str]) -> units.Dimensions | None:
    """Dimensions of a tree; None for the number zero, which fits everything."""
    if isinstance(node, float):
        return None if node == 0 else {}
    if isinstance(node, str):
        return units.dimensions(known[node])
    op, *args = node
    assert isinstance(op, str)
    if op == "pow":
        exponent = args[1]
        assert isinstance(exponent, float)
        return _scaled(_dimensions(args[0], known), exponent)
    parts = [_dimensions(argument, known) for argument in args]
    if op in _OF_NUMBERS:
        if parts[0] and not units.alike(parts[0], {}):
            raise ExpressionError(f"{op} of a quantity with dimensions: {args[0]}")
        return {}
    if op == "powr":
        return _of_power(parts, args[1])
    return _of_like(op, parts)


def _of_like(op: str, parts: list[units.Dimensions | None]) -> units.Dimensions | None:
    """The dimensions of an operation on quantities of any dimensions, some of which must have the same."""
    if op in ("neg", "abs"):
        return parts[0]
    if op == "sqrt":
        return _scaled(parts[0], 0.5)
    if op == "atan2":
        _common(parts[0], parts[1], op)
        return {}
    if op == "select":
        _common(parts[0], parts[1], "<")
        return _common(parts[2], parts[3], op)
    if op in ("+", "-", "min", "max"):
        return functools.reduce(lambda left, right: _common(left, right, op), parts)
    return _product(parts[0], parts[1], 1.0 if op == "*" else -1.0)


_OF_NUMBERS = ("sin", "cos", "tan", "asin", "atan", "exp", "tanh", "ln")
# What is named in a message where two dimensions differ.
_OF_TWO = {"atan2": "atan2", "<": "a comparison", "select": "a choice", "min": "a minimum", "max": "a maximum"}


def _of_power(parts: list[units.Dimensions | None], exponent: Tree) -> units.Dimensions | None:
    """The dimensions of a real power: of any quantity if the exponent is a number, else of a pure number alone."""
    if isinstance(exponent, float):
        return _scaled(parts[0], exponent)
    for part, what in zip(parts, ("base", "exponent"), strict=True):
        if part and not units.alike(part, {}):
            raise ExpressionError(f"a power with an exponent that is no number has dimensions in its {what}")
    return {}


def _scaled(found: units.Dimensions | None, factor: float) -> units.Dimensions:
    return {name: power * factor for name, power in (found or {}).items()}


def _common(left: units.Dimensions | None, right: units.Dimensions | None, op: str) -> units.Dimensions | None:
    if left is None or right is None:
        return left if right is None else right
    if not units.alike(left, right):
        raise ExpressionError(
            f"{_OF_TWO.get(op, 'a sum')} of unlike dimensions, {units.in_words(left)} and {units.in_words(right)}"
        )
    return left


def _product(left: units.Dimensions | None, right: units.Dimensions | None, sign: float) -> units.Dimensions | None:
    if left is None or right is None:
        return None
    return {k: left.get(k, 0.0) + sign * right.get(k, 0.0) for k in sorted({*left, *right})}
