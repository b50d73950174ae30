"""Functions of a family as trees: the values and slopes of CasADi, and the dimensions."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping

import casadi as ca
import mpmath
import pytest

from ahv_generator.expression import ExpressionError, Tree, check_dimensions, tree
from ahv_generator.modelling import acos, asin, atan, atan2, cosh, fmax, fmin, log, select, sinh, tan, tanh

NAMES = ("a", "b", "c")
A, B, C = (ca.SX.sym(name) for name in NAMES)

OPERATIONS: dict[str, Callable[..., float]] = {
    "+": lambda *terms: math.fsum(terms),
    "-": lambda x, y: x - y,
    "*": lambda x, y: x * y,
    "/": lambda x, y: x / y,
    "neg": lambda x: -x,
    "pow": math.pow,
    "powr": math.pow,
    "ln": math.log,
    "abs": abs,
    "min": min,
    "max": max,
    "select": lambda x, bound, below, otherwise: below if x < bound else otherwise,
}


def value(node: Tree, at: Mapping[str, float]) -> float:
    if isinstance(node, float):
        return node
    if isinstance(node, str):
        return at[node]
    op, *arguments = node
    assert isinstance(op, str)
    return float(OPERATIONS.get(op, getattr(math, op, math.fabs))(*(value(it, at) for it in arguments)))


EXPRESSIONS = {
    "tan": tan(A * B),
    "asin": asin(A / 3),
    "atan": atan(A * B),
    "atan2": atan2(A, B),
    "tanh": tanh(A * C),
    "acos": acos(A / 3),
    "sinh": sinh(A * C),
    "cosh": cosh(A * C),
    "log": log(C),
    "abs": abs(A * B) * C,
    "min": fmin(A * C, B),
    "max": fmax(A, B * B) * C,
    "clipped": fmin(fmax(A, -1), 1) ** 2,
    "power": C**0.3 + C**A,
    "root": C**1.5,
    "select": select(A < B, A * C, B**2),
    "select at or above": C - 2 * select(A >= B, A * C, B) + A,
    "layers": select(A < -1, A, select(A < 1, A**2 * C, B)),
    "both": select(ca.logic_and(A < B, B < C), A * B, C),
    "either": select(ca.logic_or(A < B, B < 0), A * B, C),
    "sum": select(A < 1, B, C) + select(A < 1, C * B, B) + A,
    "condition": (A < B) * C,
    "guarded": select(B < C, log(C) * A, B) * B,
}


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_a_tree_has_the_values_and_slopes_of_casadi(name: str) -> None:
    expr = EXPRESSIONS[name]
    rows = [expr, *(ca.jacobian(expr, it) for it in (A, B, C))]
    rows += [ca.jacobian(row, it) for row in rows[1:] for it in (A, C)]
    trees = [tree(row) if row.nnz() else 0.0 for row in rows]
    function = ca.Function("f", [A, B, C], [ca.densify(row) for row in rows])
    draw = random.Random(name)
    for _ in range(200):
        point = [draw.uniform(-2, 2), draw.uniform(-2, 2), draw.uniform(0.1, 2)]
        at = dict(zip(NAMES, point, strict=True))
        for found, exact in zip(trees, function(*point), strict=True):
            assert value(found, at) == pytest.approx(float(exact), rel=1e-11, abs=1e-11), (found, at)


COMPOSED = {
    "acos": (acos(A), mpmath.acos, 1.0),
    "sinh": (sinh(A), mpmath.sinh, 709.0),
    "cosh": (cosh(A), mpmath.cosh, 709.0),
}


@pytest.mark.parametrize("name", COMPOSED)
def test_what_is_written_in_other_functions_is_within_4_ulp(name: str) -> None:
    expr, exact, largest = COMPOSED[name]
    written, draw = tree(expr), random.Random(name)
    points = [sign * largest * 10.0 ** draw.uniform(-20, 0) for _ in range(2000) for sign in (1, -1)]
    points += [sign * (1 - 10.0 ** draw.uniform(-15, 0)) for _ in range(2000) for sign in (1, -1)]
    worst = 0.0
    with mpmath.workdps(50):
        for x in [*points, 0.0, 1.0, -1.0]:
            true = exact(mpmath.mpf(x))
            worst = max(worst, float(abs(value(written, {"a": x}) - true)) / math.ulp(float(true)))
    assert 0.4 < worst <= 4.0


def test_a_choice_is_one_operation_and_its_slope_another() -> None:
    expr = select(A < B, A * C, B**2)
    assert tree(expr) == ["select", "a", "b", ["*", "a", "c"], ["pow", "b", 2.0]]
    assert tree(ca.jacobian(expr, C)) == ["select", "a", "b", "a", 0.0]


def test_slopes_at_a_kink_are_the_mean_or_that_of_what_is_chosen() -> None:
    at = {"a": 0.0, "b": 0.0, "c": 1.0}
    slopes = [ca.jacobian(expr, A) for expr in (abs(A), fmin(A, B), fmax(A, B), select(A < B, A, 3 * A))]
    assert [value(tree(slope), at) for slope in slopes] == [0.0, 0.5, 0.5, 3.0]


UNITS = {"V": "ft/s", "a": "ft/s", "h": "ft", "M": "1", "angle": "rad"}


def dimensions(expr: Callable[..., ca.SX], unit: str) -> None:
    symbols = {name: ca.SX.sym(name) for name in UNITS}
    check_dimensions("it", expr(**symbols), unit, UNITS)


@pytest.mark.parametrize(
    ("expr", "unit"),
    [
        (lambda V, a, **_: atan2(V, a), "rad"),
        (lambda V, a, **_: fmin(V, a), "ft/s"),
        (lambda V, **_: fmax(V, 0), "ft/s"),
        (lambda V, **_: abs(V), "ft/s"),
        (lambda V, a, h, **_: select(V < a, h, 2 * h), "ft"),
        (lambda h, **_: h**1.5, "ft^1.5"),
        (lambda V, a, M, **_: (V / a) ** M, "1"),
        (lambda V, a, angle, **_: tan(angle) * log(V / a), "1"),
    ],
)
def test_like_dimensions_are_found(expr: Callable[..., ca.SX], unit: str) -> None:
    dimensions(expr, unit)
    with pytest.raises(ExpressionError, match="it is declared in `slug`"):
        dimensions(expr, "slug")


@pytest.mark.parametrize(
    ("expr", "message"),
    [
        (lambda V, h, **_: atan2(V, h), "atan2 of unlike dimensions"),
        (lambda V, h, **_: fmin(V, h), "a minimum of unlike dimensions"),
        (lambda V, h, **_: fmax(V, h), "a maximum of unlike dimensions"),
        (lambda V, h, M, **_: select(V < h, M, M**2), "a comparison of unlike dimensions"),
        (lambda V, h, **_: select(V < 1, V, V), "a comparison of unlike dimensions"),
        (lambda V, a, h, **_: select(V < a, V, h), "a choice of unlike dimensions"),
        (lambda V, M, **_: V**M, "an exponent that is no number has dimensions in its base"),
        (lambda V, M, **_: M**V, "an exponent that is no number has dimensions in its exponent"),
        (lambda V, **_: tan(V), "tan of a quantity with dimensions"),
        (lambda h, **_: log(h), "ln of a quantity with dimensions"),
        (lambda V, a, M, **_: select(V == a, M, 1), "`==` is not available"),
        (lambda M, **_: select(M, M, 1), "a condition compares two expressions"),
        (lambda M, **_: ca.acosh(M), "`acosh` is not available in a model"),
        (lambda V, **_: ca.sinh(V), "tanh of a quantity with dimensions"),
        (lambda V, **_: ca.acos(V), "a sum of unlike dimensions, 1 and length/time"),
    ],
)
def test_unlike_dimensions_are_refused(expr: Callable[..., ca.SX], message: str) -> None:
    with pytest.raises(ExpressionError, match=message):
        dimensions(expr, "1")
