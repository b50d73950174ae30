"""What every model offers besides its drift: derivatives, first and second, and Lie derivatives of the outputs."""

from __future__ import annotations

import casadi as ca

from .model import Entry, Model, Output

# The outputs of geometric control (section 5.3), by the paper's symbol, and their states.
OUTPUTS = {"V": "velocity", "gamma": "gamma", "h": "altitude"}


def add_drift_and_derivatives(m: Model, rates: dict[str, ca.SX], equation: str) -> None:
    """The drift, its Jacobians by state, input and parameters, and its second derivatives by the state."""
    drift = m.vector("state", rates, "drift")
    by_state = m.matrix("state", "state", "state", rates)
    by_input = m.matrix("input", "state", "input", rates)
    slopes = "derivatives of the drift with respect to the state and to the input"
    m.add("drift", "drift", "Time derivative of the state", equation, [drift])
    m.add("jacobians", "jacobians", slopes.capitalize(), equation, [by_state, by_input], compressed=True)
    both = f"Time derivative of the state, and the {slopes}, for less than one after the other"
    m.add("drift_and_jacobians", "jacobians", both, equation, [drift, by_state, by_input], compressed=True)
    m.add(
        "parameter_jacobian",
        "parameter_jacobian",
        "Derivatives of the drift with respect to every parameter and coefficient of the table",
        equation,
        [m.matrix("parameter", "state", "parameter", rates)],
        compressed=True,
    )
    m.add(
        "hessian",
        "hessian",
        "Second derivatives of the drift with respect to the state, symmetric in the last two indices",
        equation,
        [_hessian(m, by_state)],
        compressed=True,
    )


def _hessian(m: Model, by_state: Output) -> Output:
    """Entries with the later state first; the mirror image is the same number."""
    leaves = m.leaves("state")
    order = list(leaves)
    entries = []
    for entry in by_state.entries:
        row, first = entry.at
        for second in order[order.index(first) :]:
            slope = m.graph.derivative(entry.expr, leaves[second])
            if not slope.is_zero():
                entries.append(Entry((row, second, first), slope))
    entries.sort(key=lambda e: tuple(order.index(name) for name in e.at))
    return Output("hessian", ("state", "state", "state"), tuple(entries), symmetric=True)


def add_lie_derivatives(m: Model, rates: dict[str, ca.SX], equation: str) -> None:
    """L_f and L_g of V, gamma and h, up to the order in which an input first appears.

    The drift is not affine in the elevator: f is taken at the input as it is held, g is its slope there.
    """
    group = "lie_derivatives"
    held = "along the drift at the held input"
    for symbol, state in OUTPUTS.items():
        unit = f"{m.unit(state)}/s"
        m.add_scalar(f"L_f_{symbol}", group, f"Lie derivative of the {state} {held}", equation, rates[state], unit)
        if symbol != "h":
            doc = f"Lie derivatives of the {state} along the input columns: its relative degree is 1"
            m.add(f"L_g_{symbol}", group, doc, equation, [_gradient(m, rates[state])])
    acceleration = m.graph.define(
        "altitude_acceleration",
        _along(m, rates["altitude"], rates),
        symbol=r"\ddot h",
        unit="ft/s^2",
        doc="second time derivative of the altitude at the held input",
        equation=equation,
        section="Lie derivatives",
    )
    m.add_scalar("L_f2_h", group, f"Second Lie derivative of the altitude {held}", equation, acceleration, "ft/s^2")
    doc = "Lie derivatives of L_f h along the input columns: the relative degree of the altitude is 2"
    m.add("L_g_L_f_h", group, doc, equation, [_gradient(m, acceleration)])


def _along(m: Model, expr: ca.SX, rates: dict[str, ca.SX]) -> ca.SX:
    """The derivative of `expr` along the drift."""
    total = ca.SX(0)
    for state, leaf in m.leaves("state").items():
        total = total + m.graph.derivative(expr, leaf) * rates[state]
    return total


def _gradient(m: Model, expr: ca.SX) -> Output:
    slopes = {name: m.graph.derivative(expr, leaf) for name, leaf in m.leaves("input").items()}
    return m.vector("input", slopes, "")
