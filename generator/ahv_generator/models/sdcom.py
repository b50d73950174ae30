"""SDCOM, `exact`: (25) and (4) in (1)-(3), nothing dropped; its strict-feedback parts and diffusion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import casadi as ca

from .. import units
from ..model import Entry, Model, Output
from ..polynomial import Polynomial
from ..schema import FLEXIBLE, RIGID_STATE, VariableSpec
from ..table import Table
from .dcom import (
    INPUT,
    control_variables,
    define_canard,
    define_forces,
    define_generalized_forces,
    total_moment,
)
from .vehicle import coefficient_symbols, define_air, define_angles, define_rigid_rates, resultants, rigid_rates

RIGID_INCREMENTS = (
    VariableSpec("w_gamma", r"w_\gamma", "s^0.5", "Wiener increment that perturbs the flight-path angle"),
    VariableSpec("w_alpha", r"w_\alpha", "s^0.5", "Wiener increment that perturbs the angle of attack"),
    VariableSpec("w_q", "w_Q", "s^0.5", "Wiener increment that perturbs the pitch rate"),
)


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


def build_sdcom(table: Table) -> Model:
    """The stochastic decoupled control-oriented model, exact form."""
    modes = range(1, table.schema.modes + 1)
    chi = tuple(
        VariableSpec(f"chi_{i}", rf"\chi_{i}", FLEXIBLE, f"coloured noise of flexible mode {i}", "chi") for i in modes
    )
    xi = tuple(
        VariableSpec(f"xi_{i}", rf"\xi_{i}", "s^0.5", f"Wiener increment that drives flexible mode {i}") for i in modes
    )
    mode = tuple(VariableSpec(f"mode_{i}", str(i), "1", f"flexible mode {i}") for i in modes)
    m = Model(
        "sdcom",
        "stochastic decoupled control-oriented model, exact form",
        "(24)-(35)",
        table,
        {"state": RIGID_STATE + chi, "input": INPUT, "noise": RIGID_INCREMENTS + xi, "mode": mode},
    )
    define_air(m)
    define_angles(m)
    define_canard(m)
    variables = control_variables(m)
    static = _define_reduced_coordinates(m, variables)
    define_forces(m, variables | {f"eta_{i}": m[f"eta_{i}"] for i in modes})
    rates = define_rigid_rates(m)
    for i in modes:
        rates[f"chi_{i}"] = _define_chi_rate(m, i)
    m.add_drift_and_jacobians(rates, "(27)")
    _add_diffusion(m, rates)
    _StrictFeedback(m, variables, static, rates).add()
    return m


def _define_reduced_coordinates(m: Model, variables: Mapping[str, ca.SX]) -> dict[str, ca.SX]:
    """Eq. (25): the flexible coordinate is its static value plus a coloured noise."""
    static = {}
    for i, force in enumerate(define_generalized_forces(m, variables), start=1):
        static[f"eta_{i}"] = m.graph.define(
            f"eta_static_{i}",
            force / m.parameter(f"omega_{i}") ** 2,
            symbol=rf"N_{i}/\omega_{i}^2",
            unit=FLEXIBLE,
            doc=f"static flexible coordinate of mode {i}",
            equation="(25)",
            section="Reduced flexible coordinates",
        )
        m.graph.define(
            f"eta_{i}",
            static[f"eta_{i}"] + m[f"chi_{i}"],
            symbol=rf"\hat\eta_{i}",
            unit=FLEXIBLE,
            doc=f"reduced flexible coordinate of mode {i}",
            equation="(25)",
            section="Reduced flexible coordinates",
        )
    return static


def _define_chi_rate(m: Model, i: int) -> ca.SX:
    decay = m.graph.define(
        f"chi_decay_{i}",
        m.parameter(f"zeta_{i}") * m.parameter(f"omega_{i}"),
        symbol=f"a_{i}",
        unit="1/s",
        doc=f"decay rate of the coloured noise of mode {i}",
        equation="(23)",
        section="Coloured noise",
    )
    return m.graph.define(
        f"chi_rate_{i}",
        -decay * m[f"chi_{i}"],
        symbol=rf"\dot\chi_{i}",
        unit=f"{FLEXIBLE}/s",
        doc=f"drift of the coloured noise of mode {i}; (24) and (26) omit the factor chi",
        equation="(27)",
        section="Coloured noise",
    )


def _add_diffusion(m: Model, rates: dict[str, ca.SX]) -> None:
    """Columns of G: the derivatives of the drift by gamma, alpha and Q, and (23) for the modes."""
    columns = {"w_gamma": "x.gamma", "w_alpha": "x.alpha", "w_q": "x.pitch_rate"}
    gains = {f"chi_{i}": _define_chi_diffusion(m, i) for i in range(1, m.table.schema.modes + 1)}
    entries: list[Entry] = []
    for row in m.names("state"):
        for column, leaf in columns.items():
            slope = m.graph.derivative(rates[row], leaf)
            if not slope.is_zero():
                entries.append(Entry((row, column), slope * m.parameter(column)))
        if row in gains:
            entries.append(Entry((row, row.replace("chi", "xi")), gains[row]))
    m.add(
        "diffusion",
        "diffusion",
        "Diffusion G(x, u) in the Itô sense; the columns of w_gamma, w_alpha and w_q are derivatives of the drift"
        " at frozen inputs",
        "(27)",
        [Output("", ("state", "noise"), tuple(entries))],
    )
    increments = {row: ca.SX(0) for row in m.names("state")}
    for entry in entries:
        row, column = entry.at
        increments[row] = increments[row] + entry.expr * m.noise(column)
    m.add(
        "noise_increment",
        "diffusion",
        "Itô increment G(x, u) dW of the state for the Wiener increments dW",
        "(27)",
        [m.vector("state", increments)],
    )


def _define_chi_diffusion(m: Model, i: int) -> ca.SX:
    return m.graph.define(
        f"chi_diffusion_{i}",
        m.parameter(f"zeta_{i}") * m.parameter(f"sigma_{i}") / m.parameter(f"omega_{i}"),
        symbol=f"b_{i}",
        unit=f"{FLEXIBLE}/s^0.5",
        doc=f"diffusion of the coloured noise of mode {i}",
        equation="(23)",
        section="Coloured noise",
    )


class _StrictFeedback:
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
        self._add_function(f"f_{row.name}", drift, unit, f"Part of the {row.state} rate that is left to f", row.equation)
        self._add_function(
            f"g_{row.name}", gain, g_unit, f"Coefficient of {row.control} ({control_unit}) in the {row.state} rate",
            row.equation,
        )
        slopes = tuple(
            Entry((mode,), self._carry(row, f"h_{eta}", lambda polynomial, eta=eta: polynomial.linear_part(eta))) for mode, eta in zip(self.m.names("mode"), self.eta, strict=True)
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
            f"f_{row.name}_eta", flexible, unit, f"Part of f_{row.name} from the static flexible coordinates",
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
        unit = self.m.unit(row.control) if kind == "g" and row.control != "phi" else "1"
        return self.m.graph.define(
            f"{fit.lower()}_of_{kind}_{row.state}",
            value,
            symbol=rf"{fit}|_{{{kind}}}",
            unit=units.quotient("1", unit),
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
        carried = self._carry(row, "g", lambda polynomial: polynomial.linear_part(row.control))
        return (direct if direct.nnz() else ca.SX(0)) + carried
