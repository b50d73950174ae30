"""What is derived from a drift without noise: Jacobians, second derivatives, Lie derivatives."""

import sympy
from sympy import Expr

from .model import Model
from .names import symbol

Entries = list[tuple[str, Expr]]
"""Labelled expressions, in column order."""

_HEIGHT = "altitude"


def drift(model: Model) -> Entries:
    """Time derivative of the state, all rows."""
    return [(f"drift.{row}", expr) for row, expr in model.drift.items()]


def slope(model: Model, row: str, kind: str, name: str) -> Expr:
    """Derivative of a row of the drift, by name."""
    return model.names.name(f"d_{row}_{name}", model.names.derivative(model.drift[row], symbol(kind, name)))


def _not_zero(entries: Entries) -> Entries:
    """Leave out what is structurally zero: no path leads from the variable to the row."""
    return [(label, expr) for label, expr in entries if expr != 0]


def jacobians(model: Model) -> Entries:
    """State and input Jacobians."""
    return _not_zero(
        [
            (f"jacobians.{kind}.{row}.{name}", slope(model, row, kind, name))
            for kind, names in (("state", model.states), ("input", model.inputs))
            for row in model.drift
            for name in names
        ]
    )


def parameter_jacobian(model: Model) -> Entries:
    """Derivatives of the drift by every parameter."""
    return _not_zero(
        [
            (f"parameter_jacobian.{row}.{name}", slope(model, row, "parameter", name))
            for row in model.drift
            for name in model.table.values
        ]
    )


def hessian(model: Model) -> Entries:
    """Second derivatives by two states, the first not before the second in the state."""
    return _not_zero(
        [
            (
                f"hessian.{row}.{first}.{second}",
                model.names.derivative(slope(model, row, "state", first), symbol("state", second)),
            )
            for row in model.drift
            for place, first in enumerate(model.states)
            for second in model.states[: place + 1]
        ]
    )


def lie_derivatives(model: Model) -> dict[str, Entries]:
    """Derivatives of V, gamma and h along the drift at frozen input, and their gradients by the input."""
    functions: dict[str, Entries] = {
        f"L_f_{suffix}": [(f"L_f_{suffix}", model.drift[row])]
        for suffix, row in (("V", "velocity"), ("gamma", "gamma"), ("h", _HEIGHT))
    }
    for suffix, row in (("V", "velocity"), ("gamma", "gamma")):
        functions[f"L_g_{suffix}"] = _gradient(model, f"L_g_{suffix}", model.drift[row])
    second = model.names.name(
        "L_f2_h", sympy.Add(*(slope(model, _HEIGHT, "state", name) * model.drift[name] for name in model.states))
    )
    functions["L_f2_h"] = [("L_f2_h", second)]
    functions["L_g_L_f_h"] = _gradient(model, "L_g_L_f_h", second)
    return functions


def _gradient(model: Model, label: str, expr: Expr) -> Entries:
    slopes = [(f"{label}.{name}", model.names.derivative(expr, symbol("input", name))) for name in model.inputs]
    return _not_zero(slopes)
