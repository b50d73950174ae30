"""The strict-feedback parts f, g, h and H of SDCOM `exact`, (28)-(35)."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import casadi as ca

from .. import units
from ..modelling import Model
from ..polynomial import Polynomial
from .dcom import normal_coefficient, slaved_fits, total_moment
from .flexible import FLEXIBLE
from .strict_feedback import GROUP, ROWS, Parts, Row, add_row, define_part
from .vehicle import Resultants, rigid_rates


class StrictFeedback:
    """f, g, h and H of (28)-(35), by their definitions on (1)-(4) and (25).

    Each row is affine in the curve-fitted coefficients. Splitting their polynomials by monomial and carrying
    the parts through the derivative of the row with respect to the coefficients leaves no terms that cancel.
    """

    FITS = ("C_T", "C_L", "C_D", "C_M")

    def __init__(
        self, model: Model, variables: Mapping[str, ca.SX], static: Mapping[str, ca.SX], rates: Mapping[str, ca.SX]
    ) -> None:
        self.model = model
        self.rates = rates
        self.eta = tuple(static)
        self.symbols = model.fit_symbols(variables) | dict(static)
        # After (4) the elevator moves the canard: there delta_c is the commanded part alone.
        self.slaved_symbols = self.symbols | {"delta_c": model["canard_commanded"], "canard_gain": model["canard_gain"]}
        self.fits = {key: ca.SX.sym(key) for key in self.FITS}
        force = model["reference_force"]
        thrust = force * self.fits["C_T"]
        moment = total_moment(model, thrust, force * self.fits["C_M"])
        along = thrust * model["cos_alpha"] - force * self.fits["C_D"]
        across = model["turn_factor"] * normal_coefficient(model, self.fits["C_L"], self.fits["C_T"])
        acting = Resultants(along, across, moment)
        self.polynomials = slaved_fits(model)
        self.exprs = rigid_rates(model, acting)
        self.exprs["alpha"] = model["pitch_rate"] - self.exprs["gamma"]

    def add(self) -> None:
        """Add the functions of every row, then g_Q_total."""
        for row in ROWS:
            add_row(self.model, row, self._parts(row))
        doc = (
            "Total derivative of the pitch acceleration with respect to the elevator, through the generalized forces"
            " as well"
        )
        slope = self.model.derivative(self.rates["pitch_rate"], "delta_e")
        self.model.add_scalar("g_Q_total", GROUP, doc, "(34)", slope, "1/s^2")

    def _parts(self, row: Row) -> Parts:
        unit = row.rate_unit(self.model)
        f_eta = define_part(self.model, row, "f_eta", unit, self._left(row, flexible=True), row.next_equation)
        return Parts(
            define_part(self.model, row, "f", unit, self._remainder(row) + f_eta, row.equation),
            define_part(self.model, row, "g", row.gain_unit, self._gain(row), row.equation),
            tuple(self._carry(row, f"h_{eta}", _linear_in(eta)) for eta in self.eta),
            self.model.derivative(self.rates[row.state], "alpha"),
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
        divisors = {"f": "1", "g": self.model.unit(row.control), "h": FLEXIBLE}
        letter = kind[0] + (r"^\eta" if kind == "f_eta" else "")
        symbol = rf"{fit}|_{{{letter}_{row.label}}}"
        doc = f"part of {fit} that belongs to {kind} of the {row.state} row"
        with self.model.section("Strict-feedback form", row.equation):
            unit = units.quotient("1", divisors[kind[0]])
            return self.model.define(f"{fit.lower()}_of_{kind}_{row.state}", value, symbol, unit, doc)

    def _left(self, row: Row, flexible: bool) -> ca.SX:
        def keep(polynomial: Polynomial) -> Polynomial:
            kept = polynomial.without_linear(row.control)
            return kept.where(lambda t: (t.degree(self.eta) > 0) == flexible)

        return self._carry(row, "f_eta" if flexible else "f", keep)

    def _remainder(self, row: Row) -> ca.SX:
        # What does not depend on the curve fits: weight, and nothing that the control multiplies.
        zeroed = [self.model["pitch_rate"], *self.fits.values()]
        without_fits = ca.substitute(self.exprs[row.state], ca.vertcat(*zeroed), ca.DM.zeros(len(zeroed)))
        return without_fits + self._left(row, flexible=False)

    def _gain(self, row: Row) -> ca.SX:
        direct = ca.jacobian(self.exprs[row.state], self.model[row.control])
        carried = self._carry(row, "g", _linear_in(row.control))
        return (direct if direct.nnz() else ca.SX(0)) + carried


def _linear_in(variable: str) -> Callable[[Polynomial], Polynomial]:
    return lambda polynomial: polynomial.linear_part(variable)
