"""What a diffusion offers: the matrix itself, its increments, its derivatives along itself, and its structure."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from .derivation import Derivation
from .function import Entry, NoiseStructure, Output

ITO = "in the Itô sense; derivatives are taken at frozen inputs"

Gains = Mapping[tuple[str, str], ca.SX]


def add_diffusion(
    m: Derivation, rates: Mapping[str, ca.SX], gains: Gains, columns_doc: str, equation: str
) -> NoiseStructure:
    """Add the functions of a diffusion whose entries, by row and Wiener process, are `gains`; returns its structure."""
    gains = {at: expr for at, expr in gains.items() if not expr.is_zero()}
    entries = tuple(
        Entry((row, column), gains[row, column])
        for row in m.names("state")
        for column in m.names("noise")
        if (row, column) in gains
    )
    diffusion = Output("diffusion", ("state", "noise"), entries)
    doc = f"Diffusion G(x, u) {ITO}; {columns_doc}"
    m.add("diffusion", "diffusion", doc, equation, [diffusion], compressed=True)
    m.add(
        "drift_and_diffusion",
        "diffusion",
        "Time derivative of the state, and the diffusion, for less than one after the other",
        equation,
        [m.vector("state", rates, "drift"), diffusion],
    )
    increments = {row: ca.SX(0) for row in m.names("state")}
    for entry in entries:
        row, column = entry.at
        increments[row] = increments[row] + entry.expr * m.noise(column)
    m.add(
        "noise_increment",
        "diffusion",
        "Itô increment G(x, u) dW of the state for the Wiener increments dW",
        equation,
        [m.vector("state", increments, "increment")],
    )
    m.add(
        "drift_and_noise_increment",
        "diffusion",
        "Time derivative of the state, and the Itô increment G(x, u) dW, for less than one after the other",
        equation,
        [m.vector("state", rates, "drift"), m.vector("state", increments, "increment")],
    )
    return _add_derivatives(m, gains, equation)


def _add_derivatives(m: Derivation, gains: Gains, equation: str) -> NoiseStructure:
    """L^j b^k = (∂b_k/∂x) b_j, half the sum of whose diagonal turns a Stratonovich drift into that of Itô."""
    lie = {
        (row, j, k): value
        for row in m.names("state")
        for j in m.names("noise")
        for k in m.names("noise")
        if not (value := _along_column(m, gains, row, j, k)).is_zero()
    }
    structure = _structure(m, gains, lie)
    entries = tuple(Entry(at, value) for at, value in lie.items())
    m.add(
        "noise_derivatives",
        "noise_derivatives",
        "L^j b^k: the derivative of column k of the diffusion along column j, by row, j and k",
        equation,
        [Output("noise_derivatives", ("state", "noise", "noise"), entries)],
        compressed=True,
    )
    correction = {row: ca.SX(0) for row in m.names("state")}
    for (row, j, k), value in lie.items():
        if j == k:
            correction[row] = correction[row] + 0.5 * value
    m.add(
        "ito_correction",
        "noise_derivatives",
        "What the drift in the Itô sense has over that in the Stratonovich sense: half the sum of L^k b^k",
        equation,
        [m.vector("state", correction, "correction")],
    )
    return structure


def _along_column(m: Derivation, gains: Gains, row: str, j: str, k: str) -> ca.SX:
    total = ca.SX(0)
    if (row, k) not in gains:
        return total
    for state, leaf in m.leaves("state").items():
        if (state, j) in gains:
            total = total + m.graph.derivative(gains[row, k], leaf) * gains[state, j]
    return total


def _structure(m: Derivation, gains: Gains, lie: dict[tuple[str, str, str], ca.SX]) -> NoiseStructure:
    def column_class(column: str) -> str:
        kind = "constant"
        for (row, name), expr in gains.items():
            for state, leaf in m.leaves("state").items():
                if name == column and not m.graph.derivative(expr, leaf).is_zero():
                    if state != row:
                        return "general"
                    kind = "diagonal"
        return kind

    def commute(j: str, k: str) -> bool:
        zero = ca.SX(0)
        return all(
            ca.is_equal(lie.get((row, j, k), zero), lie.get((row, k, j), zero), _DEPTH) for row in m.names("state")
        )

    names = m.names("noise")
    pairs = [(j, k) for position, j in enumerate(names) for k in names[position + 1 :]]
    return NoiseStructure(
        tuple((name, column_class(name)) for name in names),
        tuple(pair for pair in pairs if commute(*pair)),
    )


# How far CasADi looks into two expressions to find them the same.
_DEPTH = 20
