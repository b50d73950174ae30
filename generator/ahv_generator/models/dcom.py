"""DCOM, (1)-(4): rigid body and flexible modes, coupled through the aerodynamic forces alone."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ..model import Model
from ..schema import DELTA_C, DELTA_E, FLEXIBLE, PHI, RIGID_STATE, VariableSpec
from ..table import Table
from .vehicle import (
    add_flexible_evaluations,
    add_rigid_evaluations,
    define_air,
    define_angles,
    define_force,
    define_gravity,
    define_inverse_momentum,
    define_polynomial,
    define_rigid_rates,
)

INPUT = (PHI, DELTA_E, DELTA_C)


def modal_state(modes: int) -> tuple[VariableSpec, ...]:
    """Coordinate and rate of each mode, in the order of the paper."""
    found: list[VariableSpec] = []
    for i in range(1, modes + 1):
        found.append(
            VariableSpec(f"eta_{i}", rf"\eta_{i}", FLEXIBLE, f"flexible generalized coordinate of mode {i}", "eta")
        )
        found.append(
            VariableSpec(
                f"eta_dot_{i}",
                rf"\dot\eta_{i}",
                f"{FLEXIBLE}/s",
                f"rate of the flexible generalized coordinate of mode {i}",
                "eta_dot",
            )
        )
    return tuple(found)


def define_canard(m: Model) -> ca.SX:
    """The canard deflection that the airframe sees: commanded, and slaved to the elevator by (4)."""
    gain = m.graph.define(
        "canard_gain",
        -m.parameter("canard_slaving") * m.parameter("c_l_delta_e") / m.parameter("c_l_delta_c"),
        symbol="k_c",
        unit="1",
        doc="canard deflection per elevator deflection",
        equation="(4)",
        section="Canard",
    )
    return m.graph.define(
        "canard_deflection",
        m["delta_c"] + gain * m["delta_e"],
        symbol=r"\delta_c",
        unit="rad",
        doc="canard deflection, commanded and slaved",
        equation="(4)",
        section="Canard",
    )


def define_generalized_forces(m: Model, variables: Mapping[str, ca.SX]) -> list[ca.SX]:
    """N_i of (2) and (6)."""
    specs = [spec for spec in m.table.schema.quantities if spec.key.startswith("C_N_")]
    coefficients = [define_polynomial(m, spec, spec.key.lower(), spec.doc, variables) for spec in specs]
    return [
        m.graph.define(
            f"generalized_force_{mode}",
            m["reference_force"] * coefficient,
            symbol=f"N_{mode}",
            unit=f"{FLEXIBLE}/s^2",
            doc=f"generalized force of mode {mode}",
            equation="(2)",
            section="Generalized forces",
        )
        for mode, coefficient in enumerate(coefficients, start=1)
    ]


def define_forces(m: Model, variables: Mapping[str, ca.SX]) -> None:
    """Thrust, lift, drag and pitching moment of (2) from the curve fits (3)."""
    fit = {
        spec.key: define_polynomial(m, spec, spec.key.lower(), spec.doc, variables)
        for spec in m.table.schema.quantities
        if not spec.key.startswith("C_N_")
    }
    force = m["reference_force"]
    thrust = define_force(m, "thrust", "T", "lb/ft", "thrust", force * fit["C_T"])
    define_force(m, "lift", "L", "lb/ft", "lift", force * fit["C_L"])
    define_force(m, "drag", "D", "lb/ft", "drag", force * fit["C_D"])
    define_force(m, "pitching_moment", "M", "lb", "pitching moment", total_moment(m, thrust, force * fit["C_M"]))


def total_moment(m: Model, thrust: ca.SX, force_times_c_m: ca.SX) -> ca.SX:
    """M = z_T T + q c S C_M, (2)."""
    return m.parameter("z_t") * thrust + force_times_c_m * m.parameter("c_bar")


def control_variables(m: Model) -> dict[str, ca.SX]:
    """Variables of the curve fits besides the flexible coordinates."""
    return {name: m[name] for name in ("phi", "alpha", "delta_e")} | {"delta_c": m["canard_deflection"]}


def build_dcom(table: Table) -> Model:
    """The decoupled control-oriented model."""
    modes = range(1, table.schema.modes + 1)
    m = Model(
        "dcom",
        "decoupled control-oriented model",
        "(1)-(4)",
        table,
        {"state": RIGID_STATE + modal_state(table.schema.modes), "input": INPUT},
    )
    define_air(m)
    define_angles(m)
    define_gravity(m)
    define_inverse_momentum(m)
    define_canard(m)
    variables = control_variables(m)
    define_forces(m, variables | {f"eta_{i}": m[f"eta_{i}"] for i in modes})
    forces = define_generalized_forces(m, variables)
    rates = define_rigid_rates(m)
    for i, force in zip(modes, forces, strict=True):
        rates[f"eta_{i}"] = m[f"eta_dot_{i}"]
        rates[f"eta_dot_{i}"] = _define_modal_acceleration(m, i, force)
    m.add_drift_and_jacobians(rates, "(1)")
    add_rigid_evaluations(m)
    add_flexible_evaluations(m, "c_n", "generalized_force")
    return m


def _define_modal_acceleration(m: Model, i: int, force: ca.SX) -> ca.SX:
    omega, zeta = m.parameter(f"omega_{i}"), m.parameter(f"zeta_{i}")
    section = "Flexible modes"
    damping = m.graph.define(
        f"damping_{i}",
        2 * zeta * omega,
        symbol=rf"2\zeta_{i}\omega_{i}",
        unit="rad/s",
        doc=f"damping of mode {i}",
        equation="(1)",
        section=section,
    )
    stiffness = m.graph.define(
        f"stiffness_{i}",
        omega**2,
        symbol=rf"\omega_{i}^2",
        unit="rad^2/s^2",
        doc=f"stiffness of mode {i}",
        equation="(1)",
        section=section,
    )
    return m.graph.define(
        f"eta_acceleration_{i}",
        force - damping * m[f"eta_dot_{i}"] - stiffness * m[f"eta_{i}"],
        symbol=rf"\ddot\eta_{i}",
        unit=f"{FLEXIBLE}/s^2",
        doc=f"acceleration of the flexible generalized coordinate of mode {i}",
        equation="(1)",
        section=section,
    )
