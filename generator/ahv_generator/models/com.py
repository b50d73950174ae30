"""COM: thrust is a curve fit in lb/ft, not scaled with dynamic pressure; rigid, or with two cantilever modes."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ..derivatives import add_drift_and_derivatives, add_lie_derivatives
from ..family import Family
from ..model import Model
from ..schema import POSITIVE, ParameterSpec, QuantitySpec, Rule, Schema
from ..table import Table
from .flexible import (
    ETA,
    ETA_DOT,
    FLEXIBLE,
    FORCE,
    define_modal_acceleration,
    modal_load,
    modal_parameters,
    modal_state,
    modes_of,
    structural_modes,
)
from .flight import DELTA_E, EARTH, ENVIRONMENT, PHI, RIGID_STATE, VEHICLE, vehicle_traits
from .vehicle import (
    FORCES,
    add_outlooks,
    define_air,
    define_angles,
    define_force,
    define_gravity,
    define_momentum,
    define_pitch_acceleration,
    define_polynomial,
    define_rigid_rates,
)

INPUT = (PHI, DELTA_E)


def build_com_rigid(table: Table) -> Model:
    """The rigid control-oriented model."""
    bases = {"state": RIGID_STATE, "input": INPUT}
    title = "control-oriented model, rigid body"
    m = Model("com_rigid", title, "(1)-(3)", table, bases, vehicle_traits())
    return _finished(m, define_rigid_rates(m, _define_forces(m)))


def build_com(table: Table) -> Model:
    """The control-oriented model with a forebody and an aftbody clamped at the centre of mass."""
    modes = modes_of(table)
    bases = {"state": RIGID_STATE + modal_state(modes), "input": INPUT}
    title = "control-oriented model, forebody and aftbody flexible"
    m = Model("com", title, "(1)-(3)", table, bases, vehicle_traits(*structural_modes(modes)))
    turn = _define_forces(m)
    variables = {name: m[name] for name in ("alpha", "delta_e")}
    loads = {}
    for i in modes:
        spec = next(spec for spec in table.schema.quantities if spec.key == f"N_{i}")
        polynomial = table.polynomials[spec.key]
        force = define_polynomial(m, spec, f"generalized_force_{i}", spec.doc, variables, polynomial, "(2)")
        loads[i] = _define_load(m, i, force)
    mass = inertial_coupling(m, list(loads))
    rates = define_rigid_rates(m, turn, _define_pitch_acceleration(m, mass, loads))
    for i, load in loads.items():
        rates[f"eta_{i}"] = m[f"eta_dot_{i}"]
        rates[f"eta_dot_{i}"] = define_modal_acceleration(m, i, load - mass[0, i] * m["pitch_acceleration"])
    return _finished(m, rates, "generalized_force")


def inertial_coupling(m: Model, modes: list[int]) -> ca.SX:
    """The mass matrix of Lagrange's equations in (Q, rates of the modes), from the kinetic energy.

    A point of a beam clamped at the centre of mass, x ahead of it, moves across the body axis with Q x + phi_i(x) times
    the rate of mode i (displacement and lift positive up). Integrated over the mass, with mass-normalised mode shapes
    of beams that do not overlap, that is T below with psi_i the integral of x phi_i over the mass. As in the published
    model, the plunging motion is that of (1): the integrals of phi_i alone, which would couple it, are left out.
    """
    rates = [m["pitch_rate"], *(m[f"eta_dot_{i}"] for i in modes)]
    energy = m.parameter("i_yy") * rates[0] ** 2 / 2
    for i, rate in zip(modes, rates[1:], strict=True):
        energy = energy + rate**2 / 2 + m.parameter(f"psi_{i}") * rates[0] * rate
    mass, _ = ca.hessian(energy, ca.vertcat(*rates))
    return mass


def _define_load(m: Model, i: int, force: ca.SX) -> ca.SX:
    return m.graph.define(
        f"modal_load_{i}",
        modal_load(m, i, force),
        symbol=f"r_{i}",
        unit=FORCE,
        doc=f"generalized force of mode {i} less damping and stiffness",
        equation="(1)",
        section="Flexible modes",
    )


def _define_pitch_acceleration(m: Model, mass: ca.SX, loads: dict[int, ca.SX]) -> ca.SX:
    """Solves the coupled rows for the pitch acceleration: the modes are eliminated, as they are not coupled by mass."""
    inertia, moment = mass[0, 0], m["pitching_moment"]
    for i, load in loads.items():
        inertia = inertia - mass[0, i] * mass[i, 0] / mass[i, i]
        moment = moment - mass[0, i] / mass[i, i] * load
    inertia = m.graph.define(
        "effective_inertia",
        inertia,
        symbol=r"I_{yy}-\sum\psi_i^2",
        unit="slug*ft",
        doc="pitch moment of inertia that is left when the modes yield",
        equation="(1)",
        section="Flexible modes",
    )
    return define_pitch_acceleration(m, moment / inertia)


def _define_forces(m: Model) -> ca.SX:
    """Forces and moment of (2); the turn rate by lift and thrust."""
    define_air(m)
    define_angles(m)
    define_gravity(m)
    define_momentum(m)
    variables = {name: m[name] for name in ("phi", "alpha", "delta_e")}
    fit = {}
    for spec in m.table.schema.quantities:
        if not spec.key.startswith("N_"):
            name = "thrust" if spec.key == "T" else spec.key.lower()
            fit[spec.key] = define_polynomial(m, spec, name, spec.doc, variables, m.table.polynomials[spec.key])
    force = m["reference_force"]
    define_force(m, "lift", "L", "lb/ft", "lift", force * fit["C_L"])
    define_force(m, "drag", "D", "lb/ft", "drag", force * fit["C_D"])
    define_force(
        m,
        "pitching_moment",
        "M",
        "lb",
        "pitching moment",
        m.parameter("z_t") * fit["T"] + force * m.parameter("c_bar") * fit["C_M"],
    )
    return m["turn_factor"] * fit["C_L"] + fit["T"] * m["sin_alpha"] * m["inverse_momentum"]


def _finished(m: Model, rates: dict[str, ca.SX], *flexible: str) -> Model:
    add_drift_and_derivatives(m, rates, "(1)")
    add_outlooks(m, *flexible, fits=("c_l", "c_d", "c_m"), forces=FORCES)
    add_lie_derivatives(m, rates, "(1)")
    return m


def _schema(models: tuple[str, ...], _document: Mapping[str, object]) -> Schema:
    """Thrust is fitted in lb/ft; there are two cantilever modes, unless the rigid body alone is wanted."""
    aero = ("alpha", "delta_e")
    count = 2 if "com" in models else 0
    modes = range(1, count + 1)
    couplings = tuple(
        ParameterSpec(f"psi_{i}", rf"\psi_{i}", FLEXIBLE, f"inertial coupling of mode {i} with the pitch rate")
        for i in modes
    )
    mass_matrix = Rule(
        "mass-matrix",
        ((1.0, ("i_yy",)), *((-1.0, (psi.name, psi.name)) for psi in couplings)),
        POSITIVE,
        "`I_yy` must exceed the sum of the squares of `psi_i`: no mass matrix is like this",
    )
    flexible = {"modes": (*modal_parameters(count), *couplings)} if modes else {}
    return Schema(
        parameters={"vehicle": VEHICLE, "environment": ENVIRONMENT} | flexible,
        validity=(*RIGID_STATE, *((ETA, ETA_DOT) if modes else ()), PHI, DELTA_E),
        choices=(EARTH,),
        quantities=(
            QuantitySpec("T", "T", "lb/ft", "thrust", ("phi", "alpha")),
            QuantitySpec("C_L", "C_L", "1", "lift coefficient", aero),
            QuantitySpec("C_D", "C_D", "1", "drag coefficient", aero),
            QuantitySpec("C_M", "C_M", "1", "pitching-moment coefficient", aero),
            *(QuantitySpec(f"N_{i}", f"N_{i}", FORCE, f"generalized force of mode {i}", aero) for i in modes),
        ),
        variables=(*RIGID_STATE, PHI, DELTA_E),
        laws=(mass_matrix,) if modes else (),
    )


FAMILY = Family("COM", {"com": build_com, "com_rigid": build_com_rigid}, _schema)
