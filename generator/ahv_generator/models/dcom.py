"""DCOM, (1)-(4): rigid body and flexible modes, coupled through the aerodynamic forces alone."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ..derivatives import add_drift_and_derivatives, add_lie_derivatives
from ..model import Model
from ..polynomial import Polynomial, Term
from ..schema import Choice, Option, VariableSpec, switch
from ..stochastic import add_diffusion
from ..table import Table
from .flexible import (
    FORCE,
    define_modal_acceleration,
    index,
    modal_load,
    modal_state,
    modes_of,
    structural_modes,
)
from .flight import DELTA_E, PHI, RIGID_STATE, vehicle_traits
from .noise import PERTURBATIONS, RIGID_INCREMENTS, modal_gains, modal_increments, perturbation_gains
from .vehicle import (
    FORCES,
    add_outlooks,
    define_air,
    define_angles,
    define_force,
    define_gravity,
    define_momentum,
    define_polynomial,
    define_rigid_rates,
)

CANARD = Choice(
    "canard",
    "Canard",
    "canard",
    (
        switch("canard_command", "s_{cc}", "share of the commanded canard deflection: 1 canard free, else 0"),
        switch("canard_slaving", "s_c", "share of law (4) in the canard deflection: 1 canard slaved, else 0"),
    ),
    (
        Option("free", "the canard deflection is an input", (1.0, 0.0)),
        Option("slaved", "the canard follows the elevator by law (4)", (0.0, 1.0)),
        Option("none", "there is no canard", (0.0, 0.0)),
    ),
)
DELTA_C = VariableSpec("delta_c", r"\delta_c", "rad", "canard deflection", "delta_c")
INPUT = (PHI, DELTA_E, DELTA_C)
FITS = ("c_l", "c_d", "c_m", "c_t")


def define_canard(m: Model) -> ca.SX:
    """The canard deflection that the airframe sees: commanded where the canard is free, slaved by (4)."""
    gain = m.graph.define(
        "canard_gain",
        -m.parameter("canard_slaving") * m.parameter("c_l_delta_e") / m.parameter("c_l_delta_c"),
        symbol="k_c",
        unit="1",
        doc="canard deflection per elevator deflection",
        equation="(4)",
        section="Canard",
    )
    commanded = m.graph.define(
        "canard_commanded",
        m.parameter("canard_command") * m["delta_c"],
        symbol=r"\delta_{c,0}",
        unit="rad",
        doc="canard deflection as commanded",
        equation="(4)",
        section="Canard",
    )
    m.graph.define(
        "elevator_lift",
        m.parameter("c_l_delta_e") * (1 - m.parameter("canard_slaving")),
        symbol=r"C_L^{\delta_e}(1-s_c)",
        unit="1/rad",
        doc="lift coefficient per elevator deflection that the slaved canard leaves",
        equation="(4)",
        section="Canard",
    )
    return m.graph.define(
        "canard_deflection",
        commanded + gain * m["delta_e"],
        symbol=r"\delta_c",
        unit="rad",
        doc="canard deflection, commanded and slaved",
        equation="(4)",
        section="Canard",
    )


def define_generalized_forces(m: Model, variables: Mapping[str, ca.SX]) -> list[ca.SX]:
    """N_i of (2) and (6)."""
    specs = [spec for spec in m.table.schema.quantities if spec.key.startswith("C_N_")]
    polynomials = m.table.polynomials
    coefficients = [
        define_polynomial(m, spec, spec.key.lower(), spec.doc, variables, polynomials[spec.key]) for spec in specs
    ]
    return [
        m.graph.define(
            f"generalized_force_{mode}",
            m["reference_force"] * coefficient,
            symbol=f"N_{index(mode)}",
            unit=FORCE,
            doc=f"generalized force of mode {mode}",
            equation="(2)",
            section="Generalized forces",
        )
        for mode, coefficient in enumerate(coefficients, start=1)
    ]


def slaved_fits(m: Model) -> dict[str, Polynomial]:
    """The curve fits of the rigid body, law (4) worked out where it makes the elevator's lift vanish.

    The canard lifts with C_L^delta_c delta_c, of which law (4) makes the elevator's lift, negative: in the two linear
    terms they cancel exactly, not to rounding.
    """

    def lifted(term: Term) -> Term:
        if term.powers == (("delta_c", 1),):
            return Term(term.coefficient, (("canard_commanded", 1),), term.scale)
        return Term("elevator_lift", term.powers) if term.powers == (("delta_e", 1),) else term

    fits = {key: p for key, p in m.table.polynomials.items() if not key.startswith("C_N_")}
    return fits | {"C_L": Polynomial(tuple(lifted(term) for term in fits["C_L"].terms))}


def define_forces(m: Model, variables: Mapping[str, ca.SX]) -> ca.SX:
    """Thrust, lift, drag and pitching moment of (2) from the curve fits (3); the turn rate by lift and thrust."""
    fits = slaved_fits(m)
    fit = {
        spec.key: define_polynomial(m, spec, spec.key.lower(), spec.doc, variables, fits[spec.key])
        for spec in m.table.schema.quantities
        if spec.key in fits
    }
    force = m["reference_force"]
    thrust = define_force(m, "thrust", "T", "lb/ft", "thrust", force * fit["C_T"])
    define_force(m, "lift", "L", "lb/ft", "lift", force * fit["C_L"])
    define_force(m, "drag", "D", "lb/ft", "drag", force * fit["C_D"])
    define_force(m, "pitching_moment", "M", "lb", "pitching moment", total_moment(m, thrust, force * fit["C_M"]))
    across = m.graph.define(
        "normal_coefficient",
        normal_coefficient(m, fit["C_L"], fit["C_T"]),
        symbol=r"C_L+C_T\sin\alpha",
        unit="1",
        doc="coefficient of the force across the flight path",
        equation="(1)",
        section="Forces and moment",
    )
    return m["turn_factor"] * across


def normal_coefficient(m: Model, c_l: ca.SX, c_t: ca.SX) -> ca.SX:
    """L + T sin(alpha) of (1) over the dynamic pressure times S."""
    return c_l + c_t * m["sin_alpha"]


def total_moment(m: Model, thrust: ca.SX, force_times_c_m: ca.SX) -> ca.SX:
    """M = z_T T + q c S C_M, (2)."""
    return m.parameter("z_t") * thrust + force_times_c_m * m.parameter("c_bar")


def control_variables(m: Model) -> dict[str, ca.SX]:
    """Variables of the curve fits besides the flexible coordinates."""
    return {name: m[name] for name in ("phi", "alpha", "delta_e")} | {"delta_c": m["canard_deflection"]}


def define_surroundings(m: Model) -> None:
    """What stands before the curve fits: air, angles, gravity, momentum, canard."""
    define_air(m)
    define_angles(m)
    define_gravity(m)
    define_momentum(m)
    define_canard(m)


def build_dcom(table: Table) -> Model:
    """The decoupled control-oriented model, with the noise that drives its reduction."""
    modes = modes_of(table)
    bases = {
        "state": RIGID_STATE + modal_state(modes),
        "input": INPUT,
        "noise": RIGID_INCREMENTS + modal_increments(modes),
    }
    m = Model(
        "dcom", "decoupled control-oriented model", "(1)-(4)", table, bases, vehicle_traits(*structural_modes(modes))
    )
    define_surroundings(m)
    variables = control_variables(m)
    turn = define_forces(m, variables | {f"eta_{i}": m[f"eta_{i}"] for i in modes})
    forces = define_generalized_forces(m, variables)
    rates = define_rigid_rates(m, turn)
    for i, force in zip(modes, forces, strict=True):
        rates[f"eta_{i}"] = m[f"eta_dot_{i}"]
        rates[f"eta_dot_{i}"] = define_modal_acceleration(m, i, modal_load(m, i, force))
    add_drift_and_derivatives(m, rates, "(1)")
    add_outlooks(m, "c_n", "generalized_force", fits=FITS, forces=FORCES)
    gains = perturbation_gains(m, rates)
    gains |= modal_gains(m, {f"eta_dot_{i}": m.parameter(f"sigma_{i}") for i in modes})
    add_diffusion(m, rates, gains, PERTURBATIONS + "; the modes are driven as in (17)", "(17)")
    add_lie_derivatives(m, rates, "(1)")
    return m
