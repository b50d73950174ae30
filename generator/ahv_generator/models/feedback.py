"""The strict-feedback parts f, g, h and H of SDCOM `exact`, (28)-(35)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import casadi as ca

from .. import units
from ..model import Entry, Model, Output
from ..polynomial import Polynomial
from ..schema import FLEXIBLE
from .dcom import total_moment
from .vehicle import coefficient_symbols, resultants, rigid_rates


@dataclass(frozen=True)
class Row:
    """A row of (27): the paper's subscript, the state it belongs to, and its control or next state."""

    name: str
    state: str
    control: str
    equation: str


ROWS = (
    Row("V", "velocity", "phi", "(28)"),
    Row("gamma", "gamma", "alpha", "(30)"),
    Row("alpha", "alpha", "pitch_rate", "(32)"),
    Row("Q", "pitch_rate", "delta_e", "(34)"),
)


class StrictFeedback:
    """f, g, h and H of (28)-(35), by their definitions on (1)-(4) and (25).

    Each row is affine in the curve-fitted coefficients. Splitting their polynomials by monomial and carrying
    the parts through the derivative of the row with respect to the coefficients leaves no terms that cancel.
    """

    FITS = ("C_T", "C_L", "C_D", "C_M")

    def __init__(
        self, m: Model, variables: Mapping[str, ca.SX], static: Mapping[str, ca.SX], rates: dict[str, ca.SX]
    ) -> None:
        self.m = m
        self.rates = rates
        self.eta = tuple(static)
        self.symbols = coefficient_symbols(m, variables) | dict(static)
        # After (4) the elevator moves the canard: there delta_c is the commanded part alone.
        self.slaved_symbols = self.symbols | {"delta_c": m["delta_c"], "canard_gain": m["canard_gain"]}
        self.fits = {key: ca.SX.sym(key) for key in self.FITS}
        force = m["reference_force"]
        thrust = force * self.fits["C_T"]
        moment = total_moment(m, thrust, force * self.fits["C_M"])
        acting = resultants(m, thrust, force * self.fits["C_L"], force * self.fits["C_D"], moment)
        self.exprs = rigid_rates(m, acting)
        self.exprs["alpha"] = m["pitch_rate"] - self.exprs["gamma"]

    def add(self) -> None:
        """Add the functions of every row, then g_Q_total."""
        for row in ROWS:
            self._add_row(row)
        self._add_function(
            "g_Q_total",
            self.m.graph.derivative(self.rates["pitch_rate"], "u.delta_e"),
            "1/s^2",
            "Total derivative of the pitch acceleration with respect to the elevator, through the generalized"
            " forces as well",
            "(34)",
        )

    def _add_row(self, row: Row) -> None:
        unit = units.quotient(self.m.unit(row.state), "s")
        next_equation = f"({int(row.equation[1:-1]) + 1})"
        control_unit = self.m.unit(row.control)
        g_unit = {"V": "ft/s^2", "gamma": "1/s", "alpha": "1", "Q": "1/s^2"}[row.name]
        flexible = self._define(row, "f", "_eta", unit, self._left(row, flexible=True), next_equation)
        drift = self._define(row, "f", "", unit, self._remainder(row) + flexible, row.equation)
        gain = self._define(row, "g", "", g_unit, self._gain(row), row.equation)
        self._add_function(
            f"f_{row.name}", drift, unit, f"Part of the {row.state} rate that is left to f", row.equation
        )
        self._add_function(
            f"g_{row.name}",
            gain,
            g_unit,
            f"Coefficient of {row.control} ({control_unit}) in the {row.state} rate",
            row.equation,
        )
        slopes = tuple(
            Entry((mode,), self._carry(row, f"h_{eta}", _linear_in(eta)))
            for mode, eta in zip(self.m.names("mode"), self.eta, strict=True)
        )
        slopes = tuple(e for e in slopes if not e.expr.is_zero())
        self.m.add(
            f"h_{row.name}",
            "strict_feedback",
            f"Derivatives of the {row.state} rate with respect to the coloured noises chi",
            next_equation,
            [Output("", ("mode",), slopes)],
        )
        self._add_function(
            f"H_{row.name}",
            self.m.graph.derivative(self.rates[row.state], "x.alpha"),
            units.quotient(unit, "rad"),
            f"Total derivative of the {row.state} rate with respect to the angle of attack",
            row.equation,
        )
        self._add_function(
            f"f_{row.name}_eta",
            flexible,
            unit,
            f"Part of f_{row.name} from the static flexible coordinates",
            next_equation,
        )

    def _add_function(self, name: str, expr: ca.SX, unit: str, doc: str, equation: str) -> None:
        self.m.add(name, "strict_feedback", doc, equation, [Output("", (), (Entry((), expr),), unit)])

    def _define(self, row: Row, kind: str, suffix: str, unit: str, expr: ca.SX, equation: str) -> ca.SX:
        if expr.is_constant():
            return expr
        label = row.name if row.name in ("V", "Q") else f"\\{row.name}"
        return self.m.graph.define(
            f"{kind}_{row.state}{suffix}",
            expr,
            symbol=rf"{kind}_{{{label}}}" + (r"^\eta" if suffix else ""),
            unit=unit,
            doc=f"{kind} of the {row.state} row" + (", flexible part" if suffix else ""),
            equation=equation,
            section="Strict-feedback form",
        )

    def _carry(self, row: Row, kind: str, part: Callable[[Polynomial], Polynomial]) -> ca.SX:
        """The contribution to the row of a part of each polynomial."""
        slaved = row.control == "delta_e"
        total = ca.SX(0)
        for fit in self.FITS:
            slope = ca.jacobian(self.exprs[row.state], self.fits[fit])
            polynomial = self.m.table.polynomials[fit]
            if slaved:
                polynomial = polynomial.substituted("delta_c", "canard_gain", "delta_e")
            chosen = part(polynomial)
            if chosen.terms and slope.nnz():
                value = chosen.expression(self.slaved_symbols if slaved else self.symbols)
                total = total + slope * self._name_part(row, fit, kind, chosen, value)
        return total

    def _name_part(self, row: Row, fit: str, kind: str, part: Polynomial, value: ca.SX) -> ca.SX:
        """A part of a curve fit by a name of its own, unless it is a single term."""
        if len(part.terms) == 1:
            return value
        divisors = {"f": "1", "g": self.m.unit(row.control), "h": FLEXIBLE}
        return self.m.graph.define(
            f"{fit.lower()}_of_{kind}_{row.state}",
            value,
            symbol=rf"{fit}|_{{{kind}}}",
            unit=units.quotient("1", divisors[kind[0]]),
            doc=f"part of {fit} that belongs to {kind} of the {row.state} row",
            equation=row.equation,
            section="Strict-feedback form",
        )

    def _left(self, row: Row, flexible: bool) -> ca.SX:
        def keep(polynomial: Polynomial) -> Polynomial:
            kept = polynomial.without_linear(row.control)
            return kept.where(lambda t: (t.degree(self.eta) > 0) == flexible)

        return self._carry(row, "f_eta" if flexible else "f", keep)

    def _remainder(self, row: Row) -> ca.SX:
        # What does not depend on the curve fits: weight, and nothing that the control multiplies.
        zeroed = [self.m["pitch_rate"], *self.fits.values()]
        without_fits = ca.substitute(self.exprs[row.state], ca.vertcat(*zeroed), ca.DM.zeros(len(zeroed)))
        return without_fits + self._left(row, flexible=False)

    def _gain(self, row: Row) -> ca.SX:
        direct = ca.jacobian(self.exprs[row.state], self.m[row.control])
        carried = self._carry(row, "g", _linear_in(row.control))
        return (direct if direct.nnz() else ca.SX(0)) + carried


def _linear_in(variable: str) -> Callable[[Polynomial], Polynomial]:
    return lambda polynomial: polynomial.linear_part(variable)
