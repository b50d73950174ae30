"""What every model offers besides its drift: its first and second derivatives."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from .boundaries import add_boundaries
from .derivation import Derivation
from .function import Entry, Output


def add_drift_and_derivatives(m: Derivation, rates: Mapping[str, ca.SX], equation: str) -> None:
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
    add_boundaries(m, rates)


def _hessian(m: Derivation, by_state: Output) -> Output:
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
