"""The strict-feedback parts f, g, h and H of SDCOM `exact`, (28)-(35)."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import casadi as ca

from .. import units
from ..model import Model
from ..polynomial import Polynomial
from .dcom import normal_coefficient, slaved_fits, total_moment
from .flexible import FLEXIBLE
from .strict_feedback import GROUP, ROWS, Parts, Row, add_row, define_part
from .vehicle import Resultants, coefficient_symbols, rigid_rates


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
        self.slaved_symbols = self.symbols | {"delta_c": m["canard_commanded"], "canard_gain": m["canard_gain"]}
        self.fits = {key: ca.SX.sym(key) for key in self.FITS}
        force = m["reference_force"]
        thrust = force * self.fits["C_T"]
        moment = total_moment(m, thrust, force * self.fits["C_M"])
        along = thrust * m["cos_alpha"] - force * self.fits["C_D"]
        across = m["turn_factor"] * normal_coefficient(m, self.fits["C_L"], self.fits["C_T"])
        acting = Resultants(along, across, moment)
        self.polynomials = slaved_fits(m)
        self.exprs = rigid_rates(m, acting)
        self.exprs["alpha"] = m["pitch_rate"] - self.exprs["gamma"]

    def add(self) -> None:
        """Add the functions of every row, then g_Q_total."""
        for row in ROWS:
            add_row(self.m, row, self._parts(row))
        doc = (
            "Total derivative of the pitch acceleration with respect to the elevator, through the generalized forces"
            " as well"
        )
        slope = self.m.graph.derivative(self.rates["pitch_rate"], "u.delta_e")
        self.m.add_scalar("g_Q_total", GROUP, doc, "(34)", slope, "1/s^2")

    def _parts(self, row: Row) -> Parts:
        unit = row.rate_unit(self.m)
        f_eta = define_part(self.m, row, "f_eta", unit, self._left(row, flexible=True), row.next_equation)
        return Parts(
            define_part(self.m, row, "f", unit, self._remainder(row) + f_eta, row.equation),
            define_part(self.m, row, "g", row.gain_unit, self._gain(row), row.equation),
            tuple(self._carry(row, f"h_{eta}", _linear_in(eta)) for eta in self.eta),
            self.m.graph.derivative(self.rates[row.state], "x.alpha"),
            f_eta,
        )

    def _carry(self, row: Row, kind: str, part: Callable[[Polynomial], Polynomial]) -> ca.SX:
        """The contribution to the row of a part of each polynomial."""
        slaved = row.control == "delta_e"
        total = ca.SX(0)
        for fit in self.FITS:
            slope = ca.jacobian(self.exprs[row.state], self.fits[fit])
            polynomial = self.polynomials[fit]
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
        letter = kind[0] + (r"^\eta" if kind == "f_eta" else "")
        return self.m.graph.define(
            f"{fit.lower()}_of_{kind}_{row.state}",
            value,
            symbol=rf"{fit}|_{{{letter}_{row.label}}}",
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
