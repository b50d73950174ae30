"""SDCOM, `exact`: (25) and (4) in (1)-(3), nothing dropped; its strict-feedback parts and diffusion."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ..model import Entry, Model, Output
from ..schema import FLEXIBLE, RIGID_STATE, VariableSpec
from ..table import Table
from .dcom import (
    INPUT,
    control_variables,
    define_canard,
    define_forces,
    define_generalized_forces,
)
from .feedback import StrictFeedback
from .vehicle import (
    add_flexible_evaluations,
    add_rigid_evaluations,
    define_air,
    define_angles,
    define_gravity,
    define_inverse_momentum,
    define_rigid_rates,
)

RIGID_INCREMENTS = (
    VariableSpec("w_gamma", r"w_\gamma", "s^0.5", "Wiener increment that perturbs the flight-path angle"),
    VariableSpec("w_alpha", r"w_\alpha", "s^0.5", "Wiener increment that perturbs the angle of attack"),
    VariableSpec("w_q", "w_Q", "s^0.5", "Wiener increment that perturbs the pitch rate"),
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
    define_gravity(m)
    define_inverse_momentum(m)
    define_canard(m)
    variables = control_variables(m)
    static = _define_reduced_coordinates(m, variables)
    define_forces(m, variables | {f"eta_{i}": m[f"eta_{i}"] for i in modes})
    rates = define_rigid_rates(m)
    for i in modes:
        rates[f"chi_{i}"] = _define_chi_rate(m, i)
    m.add_drift_and_jacobians(rates, "(27)")
    add_rigid_evaluations(m)
    add_flexible_evaluations(m, "c_n", "generalized_force", "eta_static", "eta")
    _add_diffusion(m, rates)
    StrictFeedback(m, variables, static, rates).add()
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
    diffusion = Output("diffusion", ("state", "noise"), tuple(entries))
    m.add(
        "diffusion",
        "diffusion",
        "Diffusion G(x, u) in the Itô sense; the columns of w_gamma, w_alpha and w_q are derivatives of the drift"
        " at frozen inputs",
        "(27)",
        [diffusion],
    )
    m.add(
        "drift_and_diffusion",
        "diffusion",
        "Time derivative of the state, and the diffusion, for less than one after the other",
        "(27)",
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
        "(27)",
        [m.vector("state", increments, "increment")],
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
