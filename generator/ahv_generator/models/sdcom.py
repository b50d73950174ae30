"""SDCOM: (25) and (4) in (1)-(3). Its forms: `exact`, nothing dropped; and with a gust in the place of white noise."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ..derivatives import add_drift_and_derivatives, add_lie_derivatives
from ..model import Model
from ..schema import NOT_NEGATIVE, POSITIVE, ParameterSpec, VariableSpec
from ..stochastic import Gains, add_diffusion
from ..table import Table
from ..traits import Mode
from . import reduction
from .dcom import FITS, INPUT, control_variables, define_forces, define_generalized_forces, define_surroundings
from .feedback import StrictFeedback
from .flexible import FLEXIBLE, index, modes_of
from .flight import RIGID_STATE, vehicle_traits
from .noise import PERTURBATIONS, RIGID_INCREMENTS, modal_gains, modal_increments, perturbation_gains
from .vehicle import FORCES, add_outlooks, define_rigid_rates

EQUATION = "(27)"
FLEXIBLE_OUTLOOKS = ("c_n", "generalized_force", "eta_static", "eta")

GUST = (
    ParameterSpec("gust_rms", r"\sigma_g", "rad", "root mean square of the gust incidence", NOT_NEGATIVE),
    ParameterSpec("gust_time", r"\tau_g", "s", "correlation time of the gust incidence", POSITIVE),
)
ALPHA_GUST = VariableSpec("alpha_gust", r"\alpha_g", "rad", "incidence of the gust", "alpha_gust")


def coloured_states(modes: range) -> tuple[VariableSpec, ...]:
    """The coloured noise of each flexible mode."""
    return tuple(
        VariableSpec(f"chi_{i}", rf"\chi_{index(i)}", FLEXIBLE, f"coloured noise of flexible mode {i}", "chi")
        for i in modes
    )


def coloured_modes(modes: range) -> list[Mode]:
    """The pole of each coloured noise."""
    return [Mode(f"coloured noise {i}", (f"chi_{i}",)) for i in modes]


def reduced_bases(modes: range) -> dict[str, tuple[VariableSpec, ...]]:
    """The bases of (27)."""
    return {
        "state": RIGID_STATE + coloured_states(modes),
        "input": INPUT,
        "noise": RIGID_INCREMENTS + modal_increments(modes),
        "mode": tuple(VariableSpec(f"mode_{i}", str(i), "1", f"flexible mode {i}") for i in modes),
    }


def build_sdcom(table: Table) -> Model:
    """The stochastic decoupled control-oriented model, exact form."""
    modes = modes_of(table)
    bases = reduced_bases(modes)
    title = "stochastic decoupled control-oriented model, exact form"
    m = Model("sdcom", title, "(24)-(35)", table, bases, vehicle_traits(*coloured_modes(modes)))
    define_surroundings(m)
    rates, variables = define_exact_rates(m)
    add_drift_and_derivatives(m, rates, EQUATION)
    add_outlooks(m, *FLEXIBLE_OUTLOOKS, fits=FITS, forces=FORCES)
    gains = perturbation_gains(m, rates) | coloured_gains(m)
    add_diffusion(m, rates, gains, PERTURBATIONS, EQUATION)
    static = {f"eta_{i}": m[f"eta_static_{i}"] for i in modes}
    StrictFeedback(m, variables, static, rates).add()
    add_lie_derivatives(m, rates, EQUATION)
    return m


def build_sdcom_gust(table: Table) -> Model:
    """SDCOM whose incidence is disturbed by a band-limited gust in the place of white noise."""
    modes = modes_of(table)
    gust = VariableSpec("w_gust", "w_g", "s^0.5", "Wiener increment that drives the gust")
    bases = reduced_bases(modes) | {
        "state": (*RIGID_STATE, *coloured_states(modes), ALPHA_GUST),
        "noise": (RIGID_INCREMENTS[2], *modal_increments(modes), gust),
    }
    title = "stochastic decoupled control-oriented model with a band-limited gust"
    traits = vehicle_traits(*coloured_modes(modes), Mode("gust", ("alpha_gust",)))
    m = Model("sdcom_gust", title, "(24)-(27)", table, bases, traits)
    define_surroundings(m)
    incidence = m.graph.define(
        "incidence",
        m["alpha"] + m["alpha_gust"],
        symbol=r"\alpha_a",
        unit="rad",
        doc="angle of attack against the air, which moves with the gust",
        equation="(3)",
        section="Gust",
    )
    rates, _ = define_exact_rates(m, incidence)
    rates["alpha_gust"] = -m["alpha_gust"] / m.parameter("gust_time")
    add_drift_and_derivatives(m, rates, EQUATION)
    add_outlooks(m, *FLEXIBLE_OUTLOOKS, fits=FITS, forces=FORCES)
    gains = coloured_gains(m)
    gains["alpha", "w_q"] = m.parameter("w_q")
    gains["alpha_gust", "w_gust"] = m.parameter("gust_rms") * ca.sqrt(2 / m.parameter("gust_time"))
    add_diffusion(m, rates, gains, "the gust is an Ornstein-Uhlenbeck process of rms gust_rms", EQUATION)
    add_lie_derivatives(m, rates, EQUATION)
    return m


def define_exact_rates(m: Model, incidence: ca.SX | None = None) -> tuple[dict[str, ca.SX], dict[str, ca.SX]]:
    """The drift with (25) for the flexible coordinates, and the variables of its curve fits."""
    variables = control_variables(m)
    if incidence is not None:
        variables["alpha"] = incidence
    define_reduced_coordinates(m, variables)
    turn = define_forces(m, variables | {f"eta_{i}": m[f"eta_{i}"] for i in modes_of(m.table)})
    return define_rigid_rates(m, turn) | coloured_rates(m), variables


def define_reduced_coordinates(m: Model, variables: Mapping[str, ca.SX]) -> None:
    """Eq. (25): the flexible coordinate is its static value plus a coloured noise."""
    for i, force in enumerate(define_generalized_forces(m, variables), start=1):
        static = m.graph.define(
            f"eta_static_{i}",
            force / m.parameter(f"omega_{i}") ** 2,
            symbol=rf"N_{index(i)}/\omega_{index(i)}^2",
            unit=FLEXIBLE,
            doc=f"static flexible coordinate of mode {i}",
            equation="(25)",
            section="Reduced flexible coordinates",
        )
        m.graph.define(
            f"eta_{i}",
            static + m[f"chi_{i}"],
            symbol=rf"\hat\eta_{index(i)}",
            unit=FLEXIBLE,
            doc=f"reduced flexible coordinate of mode {i}",
            equation="(25)",
            section="Reduced flexible coordinates",
        )


def coloured_rates(m: Model) -> dict[str, ca.SX]:
    """The drift of each chi."""
    rates = {}
    for i in modes_of(m.table):
        suffix = f"_{i}"
        rates[f"chi{suffix}"] = reduction.define_rate(m, reduction.define_decay(m, suffix), suffix)
    return rates


def coloured_gains(m: Model) -> Gains:
    """What drives each chi."""
    return modal_gains(m, {f"chi_{i}": reduction.define_diffusion(m, f"_{i}") for i in modes_of(m.table)})
