"""The functions of the parametric strict feedback form (27), for whatever derives f, g, h and H."""

from __future__ import annotations

from dataclasses import dataclass

from .. import units
from ..modelling import Entry, Expr, Model, Output

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

    def rate_unit(self, model: Model) -> str:
        """The unit of the row."""
        return units.quotient(model.unit(self.state), "s")


ROWS = (
    Row("V", "velocity", "phi", "ft/s^2", "(28)"),
    Row("gamma", "gamma", "alpha", "1/s", "(30)"),
    Row("alpha", "alpha", "pitch_rate", "1", "(32)"),
    Row("Q", "pitch_rate", "delta_e", "1/s^2", "(34)"),
)


@dataclass(frozen=True)
class Parts:
    """f, g, h by mode, H and the flexible part of f of one row."""

    f: Expr
    g: Expr
    h: tuple[Expr, ...]
    H: Expr
    f_eta: Expr


def define_part(model: Model, row: Row, kind: str, unit: str, expr: Expr, equation: str) -> Expr:
    """Names a part of a row, `f`, `g` or `H`, or `f_eta`, unless it is a number."""
    if expr.is_constant():
        return expr
    letter, _, flexible = kind.partition("_")
    # Names in the code are in lower case, where H would be h.
    stem = "alpha_slope" if letter == "H" else letter
    name = f"{stem}_{row.state}" + ("_eta" if flexible else "")
    symbol = rf"{letter}_{{{row.label}}}" + (r"^\eta" if flexible else "")
    doc = f"{letter} of the {row.state} row" + (", flexible part" if flexible else "")
    with model.section("Strict-feedback form", equation):
        return model.define(name, expr, symbol, unit, doc)


def add_row(model: Model, row: Row, parts: Parts) -> None:
    """Add the functions of one row by the paper's names."""
    unit = row.rate_unit(model)

    def add(name: str, expr: Expr, unit: str, doc: str, equation: str) -> None:
        model.add_scalar(name, GROUP, doc, equation, expr, unit)

    add(f"f_{row.name}", parts.f, unit, f"Part of the {row.state} rate that is left to f", row.equation)
    doc = f"Coefficient of {row.control} ({model.unit(row.control)}) in the {row.state} rate"
    add(f"g_{row.name}", parts.g, row.gain_unit, doc, row.equation)
    slopes = zip(model.names("mode"), parts.h, strict=True)
    entries = tuple(Entry((mode,), slope) for mode, slope in slopes if not slope.is_zero())
    doc = f"Derivatives of the {row.state} rate with respect to the coloured noises chi"
    model.add(f"h_{row.name}", GROUP, doc, row.next_equation, [Output("", ("mode",), entries)])
    doc = f"Derivative of the {row.state} rate with respect to the angle of attack, at frozen inputs"
    add(f"H_{row.name}", parts.H, units.quotient(unit, "rad"), doc, row.equation)
    doc = f"Part of f_{row.name} from the static flexible coordinates"
    add(f"f_{row.name}_eta", parts.f_eta, unit, doc, row.next_equation)
