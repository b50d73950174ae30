"""COM: thrust is a curve fit in lb/ft, not scaled with dynamic pressure; rigid, or with two cantilever modes."""

from __future__ import annotations

import casadi as ca

from ahv_generator.modelling import POSITIVE, Expr, Family, Model, Parameter, Quantity, Rule
from ahv_generator.models.flexible import (
    ETA,
    ETA_DOT,
    FLEXIBLE,
    FORCE,
    define_modal_acceleration,
    modal_load,
    modal_parameters,
    modal_state,
    structural_modes,
)
from ahv_generator.models.flight import (
    ALPHA,
    DELTA_E,
    EARTH,
    ENVIRONMENT,
    PHI,
    RIGID_STATE,
    VEHICLE,
    steady_flight,
)
from ahv_generator.models.lie_derivatives import add_lie_derivatives
from ahv_generator.models.vehicle import (
    FORCES,
    add_outlooks,
    define_air,
    define_angles,
    define_gravity,
    define_momentum,
    define_pitch_acceleration,
    define_rigid_rates,
)

INPUT = (PHI, DELTA_E)
MODES = range(1, 3)  # the forebody and the aftbody, clamped at the centre of mass

family = Family()
family.parameters("vehicle", *VEHICLE)
family.parameters("environment", *ENVIRONMENT)
family.choices(EARTH)
family.quantities(
    Quantity("T", "T", "lb/ft", "thrust", (PHI, ALPHA)),
    Quantity("C_L", "C_L", "1", "lift coefficient", (ALPHA, DELTA_E)),
    Quantity("C_D", "C_D", "1", "drag coefficient", (ALPHA, DELTA_E)),
    Quantity("C_M", "C_M", "1", "pitching-moment coefficient", (ALPHA, DELTA_E)),
)
family.bounds(*RIGID_STATE)
with family.only_for("com"):
    family.bounds(ETA, ETA_DOT)
    family.parameters("modes", *modal_parameters(MODES))
    for i in MODES:
        doc = f"inertial coupling of mode {i} with the pitch rate"
        family.parameters("modes", Parameter(f"psi_{i}", rf"\psi_{i}", FLEXIBLE, doc))
        family.quantities(Quantity(f"N_{i}", f"N_{i}", FORCE, f"generalized force of mode {i}", (ALPHA, DELTA_E)))
    family.rules(
        Rule(
            "mass-matrix",
            ((1.0, ("i_yy",)), *((-1.0, (f"psi_{i}", f"psi_{i}")) for i in MODES)),
            POSITIVE,
            "`I_yy` must exceed the sum of the squares of `psi_i`: no mass matrix is like this",
        )
    )
family.bounds(*INPUT)


@family.model(
    "com",
    "control-oriented model, forebody and aftbody flexible",
    "(1)-(3)",
    states=RIGID_STATE + modal_state(MODES),
    inputs=INPUT,
)
def com(model: Model) -> None:
    """The control-oriented model with a forebody and an aftbody clamped at the centre of mass."""
    turn = define_forces(model)
    loads = {}
    for i in MODES:
        with model.section("Curve fits", "(2)"):
            force = model.fit(f"N_{i}", f"generalized_force_{i}")
        with model.section("Flexible modes", "(1)"):
            doc = f"generalized force of mode {i} less damping and stiffness"
            loads[i] = model.define(f"modal_load_{i}", modal_load(model, i, force), f"r_{i}", FORCE, doc)
    mass = inertial_coupling(model)
    rates = define_rigid_rates(model, turn, define_coupled_pitch(model, mass, loads))
    for i, load in loads.items():
        rates[f"eta_{i}"] = model[f"eta_dot_{i}"]
        acceleration = load - mass[0, i] * model["pitch_acceleration"]
        rates[f"eta_dot_{i}"] = define_modal_acceleration(model, i, acceleration)
    finish(model, rates, "generalized_force")
    steady_flight(model, structural_modes(MODES))


@family.model("com_rigid", "control-oriented model, rigid body", "(1)-(3)", states=RIGID_STATE, inputs=INPUT)
def com_rigid(model: Model) -> None:
    """The rigid control-oriented model."""
    finish(model, define_rigid_rates(model, define_forces(model)))
    steady_flight(model, {})


def define_forces(model: Model) -> Expr:
    """Forces and moment of (2); the turn rate by lift and thrust."""
    define_air(model)
    define_angles(model)
    define_gravity(model)
    define_momentum(model)
    with model.section("Curve fits", "(3)"):
        thrust = model.fit("T", "thrust", collect=PHI)
        c_l, c_d, c_m = (model.fit(key) for key in ("C_L", "C_D", "C_M"))
    force = model["reference_force"]
    with model.section("Forces and moment", "(2)"):
        model.define("lift", force * c_l, "L", "lb/ft", "lift")
        model.define("drag", force * c_d, "D", "lb/ft", "drag")
        moment = model["z_T"] * thrust + force * model["c_bar"] * c_m
        model.define("pitching_moment", moment, "M", "lb", "pitching moment")
    return model["turn_factor"] * c_l + thrust * model["sin_alpha"] * model["inverse_momentum"]


def inertial_coupling(model: Model) -> Expr:
    """The mass matrix of Lagrange's equations in (Q, rates of the modes), from the kinetic energy.

    A point of a beam clamped at the centre of mass, x ahead of it, moves across the body axis with Q x + phi_i(x) times
    the rate of mode i (displacement and lift positive up). Integrated over the mass, with mass-normalised mode shapes
    of beams that do not overlap, that is T below with psi_i the integral of x phi_i over the mass. As in the published
    model, the plunging motion is that of (1): the integrals of phi_i alone, which would couple it, are left out.
    """
    rates = [model["pitch_rate"], *(model[f"eta_dot_{i}"] for i in MODES)]
    energy = model["I_yy"] * rates[0] ** 2 / 2
    for i, rate in zip(MODES, rates[1:], strict=True):
        energy = energy + rate**2 / 2 + model[f"psi_{i}"] * rates[0] * rate
    mass, _ = ca.hessian(energy, ca.vertcat(*rates))
    return mass


def define_coupled_pitch(model: Model, mass: Expr, loads: dict[int, Expr]) -> Expr:
    """Solves the coupled rows for the pitch acceleration: the modes are eliminated, as they are not coupled by mass."""
    inertia, moment = mass[0, 0], model["pitching_moment"]
    for i, load in loads.items():
        inertia = inertia - mass[0, i] * mass[i, 0] / mass[i, i]
        moment = moment - mass[0, i] / mass[i, i] * load
    with model.section("Flexible modes", "(1)"):
        doc = "pitch moment of inertia that is left when the modes yield"
        inertia = model.define("effective_inertia", inertia, r"I_{yy}-\sum\psi_i^2", "slug*ft", doc)
    return define_pitch_acceleration(model, moment / inertia)


def finish(model: Model, rates: dict[str, Expr], *flexible: str) -> None:
    """The equations of motion (1), and what follows from them."""
    model.motion(rates, "(1)")
    add_outlooks(model, *flexible, fits=("c_l", "c_d", "c_m"), forces=FORCES)
    add_lie_derivatives(model, "(1)")
