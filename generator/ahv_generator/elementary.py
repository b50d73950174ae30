"""The functions of a family's expressions. Dimensions are checked where an expression is named."""

from __future__ import annotations

import casadi

from .checked import checked

Expr = casadi.SX
Number = Expr | float


@checked
def sin(x: Number) -> Expr:
    """The sine of a pure number or an angle."""
    return casadi.sin(x)


@checked
def cos(x: Number) -> Expr:
    """The cosine of a pure number or an angle."""
    return casadi.cos(x)


@checked
def tan(x: Number) -> Expr:
    """The tangent of a pure number or an angle."""
    return casadi.tan(x)


@checked
def asin(x: Number) -> Expr:
    """The angle in rad whose sine is `x`, a pure number."""
    return casadi.asin(x)


@checked
def acos(x: Number) -> Expr:
    """The angle in rad whose cosine is `x`, a pure number."""
    return casadi.acos(x)


@checked
def atan(x: Number) -> Expr:
    """The angle in rad whose tangent is `x`, a pure number."""
    return casadi.atan(x)


@checked
def sinh(x: Number) -> Expr:
    """The hyperbolic sine of a pure number."""
    return casadi.sinh(x)


@checked
def cosh(x: Number) -> Expr:
    """The hyperbolic cosine of a pure number."""
    return casadi.cosh(x)


@checked
def tanh(x: Number) -> Expr:
    """The hyperbolic tangent of a pure number."""
    return casadi.tanh(x)


@checked
def exp(x: Number) -> Expr:
    """The exponential of a pure number."""
    return casadi.exp(x)


@checked
def log(x: Number) -> Expr:
    """The natural logarithm of a pure number."""
    return casadi.log(x)


@checked
def sqrt(x: Number) -> Expr:
    """The square root of any quantity."""
    return casadi.sqrt(x)


@checked
def atan2(y: Number, x: Number) -> Expr:
    """The angle in rad of the point (x, y), from -pi to pi; both of any unit, the same."""
    return casadi.atan2(y, x)


@checked
def fmin(x: Number, y: Number) -> Expr:
    """The smaller of two of a kind."""
    return casadi.fmin(x, y)


@checked
def fmax(x: Number, y: Number) -> Expr:
    """The larger of two of a kind."""
    return casadi.fmax(x, y)


@checked
def select(condition: Number | bool, then: Number, otherwise: Number) -> Expr:
    """`then` where the condition (`a < b`, or `<=`, `>`, `>=`) holds, else `otherwise`.

    Both are computed; the slope is that of the one that is chosen.
    """
    return casadi.if_else(condition, then, otherwise)
