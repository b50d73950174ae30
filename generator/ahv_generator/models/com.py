"""COM, rigid part: thrust is a curve fit in lb/ft, not scaled with dynamic pressure."""

from __future__ import annotations

from ..model import Model
from ..schema import DELTA_E, PHI, RIGID_STATE
from ..table import Table
from .vehicle import (
    add_rigid_evaluations,
    define_air,
    define_angles,
    define_force,
    define_gravity,
    define_inverse_momentum,
    define_polynomial,
    define_rigid_rates,
)


def build_com(table: Table) -> Model:
    """The rigid control-oriented model."""
    m = Model(
        "com",
        "control-oriented model, rigid body",
        "(1)-(3)",
        table,
        {"state": RIGID_STATE, "input": (PHI, DELTA_E)},
    )
    define_air(m)
    define_angles(m)
    define_gravity(m)
    define_inverse_momentum(m)
    variables = {name: m[name] for name in ("phi", "alpha", "delta_e")}
    fit = {
        spec.key: define_polynomial(m, spec, "thrust" if spec.key == "T" else spec.key.lower(), spec.doc, variables)
        for spec in table.schema.quantities
    }
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
    m.add_drift_and_jacobians(define_rigid_rates(m), "(1)")
    add_rigid_evaluations(m)
    return m
