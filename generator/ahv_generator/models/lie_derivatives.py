"""Lie derivatives of the outputs of geometric control, section 5.3."""

from __future__ import annotations

from collections.abc import Mapping

from ..modelling import Expr, Model, Output

# The outputs of geometric control (section 5.3), by the paper's symbol, and their states.
OUTPUTS = {"V": "velocity", "gamma": "gamma", "h": "altitude"}


def add_lie_derivatives(model: Model, equation: str) -> None:
    """L_f and L_g of V, gamma and h, up to the order in which an input first appears.

    The drift is not affine in the elevator: f is taken at the input as it is held, g is its slope there.
    """
    group = "lie_derivatives"
    held = "along the drift at the held input"
    rates = model.rates or {}
    for symbol, state in OUTPUTS.items():
        unit = f"{model.unit(state)}/s"
        model.add_scalar(f"L_f_{symbol}", group, f"Lie derivative of the {state} {held}", equation, rates[state], unit)
        if symbol != "h":
            doc = f"Lie derivatives of the {state} along the input columns: its relative degree is 1"
            model.add(f"L_g_{symbol}", group, doc, equation, [_gradient(model, rates[state])])
    with model.section("Lie derivatives", equation):
        doc = "second time derivative of the altitude at the held input"
        acceleration = _along(model, rates["altitude"], rates)
        acceleration = model.define("altitude_acceleration", acceleration, r"\ddot h", "ft/s^2", doc)
    doc = f"Second Lie derivative of the altitude {held}"
    model.add_scalar("L_f2_h", group, doc, equation, acceleration, "ft/s^2")
    doc = "Lie derivatives of L_f h along the input columns: the relative degree of the altitude is 2"
    model.add("L_g_L_f_h", group, doc, equation, [_gradient(model, acceleration)])


def _along(model: Model, expr: Expr, rates: Mapping[str, Expr]) -> Expr:
    """The derivative of `expr` along the drift."""
    total = Expr(0)
    for state in model.names("state"):
        total = total + model.derivative(expr, state) * rates[state]
    return total


def _gradient(model: Model, expr: Expr) -> Output:
    slopes = {name: model.derivative(expr, name) for name in model.names("input")}
    return model.vector("input", slopes, "")
