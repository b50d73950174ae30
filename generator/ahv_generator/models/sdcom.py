"""The parts of SDCOM: (25) in (1)-(3), with a coloured noise in the place of each flexible mode."""

from __future__ import annotations

from collections.abc import Mapping

from ..modelling import NOT_NEGATIVE, POSITIVE, Expr, Model, Parameter, Variable
from . import reduction
from .dcom import control_variables, define_forces, define_generalized_forces
from .flexible import FLEXIBLE, index, modes_of
from .noise import modal_gains
from .vehicle import define_rigid_rates

FLEXIBLE_OUTLOOKS = ("c_n", "generalized_force", "eta_static", "eta")

GUST = (
    Parameter("gust_rms", r"\sigma_g", "rad", "root mean square of the gust incidence", NOT_NEGATIVE),
    Parameter("gust_time", r"\tau_g", "s", "correlation time of the gust incidence", POSITIVE),
)
ALPHA_GUST = Variable("alpha_gust", r"\alpha_g", "rad", "incidence of the gust")


def coloured_states(modes: range) -> tuple[Variable, ...]:
    """The coloured noise of each flexible mode."""
    return tuple(
        Variable(f"chi_{i}", rf"\chi_{index(i)}", FLEXIBLE, f"coloured noise of flexible mode {i}", "chi")
        for i in modes
    )


def coloured_modes(modes: range) -> dict[str, tuple[str, ...]]:
    """The state of the pole of each coloured noise, by its name."""
    return {f"coloured noise {i}": (f"chi_{i}",) for i in modes}


def numbered_modes(modes: range) -> tuple[Variable, ...]:
    """What a vector by mode is indexed with."""
    return tuple(Variable(f"mode_{i}", str(i), "1", f"flexible mode {i}") for i in modes)


def define_exact_rates(model: Model, incidence: Expr | None = None) -> tuple[dict[str, Expr], dict[str, Expr]]:
    """The drift with (25) for the flexible coordinates, and the variables of its curve fits."""
    variables = control_variables(model)
    if incidence is not None:
        variables["alpha"] = incidence
    define_reduced_coordinates(model, variables)
    turn = define_forces(model, variables)
    return define_rigid_rates(model, turn) | coloured_rates(model), variables


def define_reduced_coordinates(model: Model, variables: Mapping[str, Expr]) -> None:
    """Eq. (25): the flexible coordinate is its static value plus a coloured noise."""
    forces = define_generalized_forces(model, variables)
    with model.section("Reduced flexible coordinates", "(25)"):
        for i, force in enumerate(forces, start=1):
            symbol, doc = rf"N_{index(i)}/\omega_{index(i)}^2", f"static flexible coordinate of mode {i}"
            static = model.define(f"eta_static_{i}", force / model[f"omega_{i}"] ** 2, symbol, FLEXIBLE, doc)
            symbol, doc = rf"\hat\eta_{index(i)}", f"reduced flexible coordinate of mode {i}"
            model.define(f"eta_{i}", static + model[f"chi_{i}"], symbol, FLEXIBLE, doc)


def coloured_rates(model: Model) -> dict[str, Expr]:
    """The drift of each chi."""
    return {
        f"chi_{i}": reduction.define_rate(model, reduction.define_decay(model, f"_{i}"), f"_{i}")
        for i in modes_of(model.table)
    }


def coloured_gains(model: Model) -> dict[tuple[str, str], Expr]:
    """What drives each chi."""
    return modal_gains(model, {f"chi_{i}": reduction.define_diffusion(model, f"_{i}") for i in modes_of(model.table)})
