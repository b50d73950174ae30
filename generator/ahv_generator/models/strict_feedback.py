"""The functions of the parametric strict feedback form (27), for whatever derives f, g, h and H."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from .. import units
from ..model import Entry, Model, Output

GROUP = "strict_feedback"


@dataclass(frozen=True)
class Row:
    """A row of (27): the paper's subscript, the state it belongs to, and its control or next state."""

    name: str
    state: str
    control: str
    gain_unit: str
    equation: str

    @property
    def next_equation(self) -> str:
        """The equation that gives the flexible parts."""
        return f"({int(self.equation[1:-1]) + 1})"

    @property
    def label(self) -> str:
        """The subscript in LaTeX."""
        return self.name if self.name in ("V", "Q") else f"\\{self.name}"

    def rate_unit(self, m: Model) -> str:
        """The unit of the row."""
        return units.quotient(m.unit(self.state), "s")


ROWS = (
    Row("V", "velocity", "phi", "ft/s^2", "(28)"),
    Row("gamma", "gamma", "alpha", "1/s", "(30)"),
    Row("alpha", "alpha", "pitch_rate", "1", "(32)"),
    Row("Q", "pitch_rate", "delta_e", "1/s^2", "(34)"),
)


@dataclass(frozen=True)
class Parts:
    """f, g, h by mode, H and the flexible part of f of one row."""

    f: ca.SX
    g: ca.SX
    h: tuple[ca.SX, ...]
    H: ca.SX
    f_eta: ca.SX


def define_part(m: Model, row: Row, kind: str, unit: str, expr: ca.SX, equation: str) -> ca.SX:
    """Names a part of a row, `f`, `g` or `H`, or `f_eta`, unless it is a number."""
    if expr.is_constant():
        return expr
    letter, _, flexible = kind.partition("_")
    # Names in the code are in lower case, where H would be h.
    stem = "alpha_slope" if letter == "H" else letter
    return m.graph.define(
        f"{stem}_{row.state}" + ("_eta" if flexible else ""),
        expr,
        symbol=rf"{letter}_{{{row.label}}}" + (r"^\eta" if flexible else ""),
        unit=unit,
        doc=f"{letter} of the {row.state} row" + (", flexible part" if flexible else ""),
        equation=equation,
        section="Strict-feedback form",
    )


def add_row(m: Model, row: Row, parts: Parts) -> None:
    """Add the functions of one row by the paper's names."""
    unit = row.rate_unit(m)

    def add(name: str, expr: ca.SX, unit: str, doc: str, equation: str) -> None:
        m.add_scalar(name, GROUP, doc, equation, expr, unit)

    add(f"f_{row.name}", parts.f, unit, f"Part of the {row.state} rate that is left to f", row.equation)
    doc = f"Coefficient of {row.control} ({m.unit(row.control)}) in the {row.state} rate"
    add(f"g_{row.name}", parts.g, row.gain_unit, doc, row.equation)
    slopes = zip(m.names("mode"), parts.h, strict=True)
    entries = tuple(Entry((mode,), slope) for mode, slope in slopes if not slope.is_zero())
    doc = f"Derivatives of the {row.state} rate with respect to the coloured noises chi"
    m.add(f"h_{row.name}", GROUP, doc, row.next_equation, [Output("", ("mode",), entries)])
    doc = f"Derivative of the {row.state} rate with respect to the angle of attack, at frozen inputs"
    add(f"H_{row.name}", parts.H, units.quotient(unit, "rad"), doc, row.equation)
    doc = f"Part of f_{row.name} from the static flexible coordinates"
    add(f"f_{row.name}_eta", parts.f_eta, unit, doc, row.next_equation)
