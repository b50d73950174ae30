"""The parts of DCOM and SDCOM, (1)-(4): law (4) of the canard, and the forces of rigid body and flexible modes."""

from __future__ import annotations

from collections.abc import Mapping

from ..modelling import Choice, Expr, Model, Option, Variable, switch
from ..polynomial import Polynomial, Term
from .flexible import FORCE, index, modes_of
from .flight import DELTA_E, PHI
from .vehicle import define_air, define_angles, define_gravity, define_momentum

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
DELTA_C = Variable("delta_c", r"\delta_c", "rad", "canard deflection")
INPUT = (PHI, DELTA_E, DELTA_C)
FITS = ("c_l", "c_d", "c_m", "c_t")


def define_canard(model: Model) -> Expr:
    """The canard deflection that the airframe sees: commanded where the canard is free, slaved by (4)."""
    with model.section("Canard", "(4)"):
        gain = -model["canard_slaving"] * model["c_l_delta_e"] / model["c_l_delta_c"]
        gain = model.define("canard_gain", gain, "k_c", "1", "canard deflection per elevator deflection")
        commanded = model["canard_command"] * model["delta_c"]
        doc = "canard deflection as commanded"
        commanded = model.define("canard_commanded", commanded, r"\delta_{c,0}", "rad", doc)
        lift = model["c_l_delta_e"] * (1 - model["canard_slaving"])
        doc = "lift coefficient per elevator deflection that the slaved canard leaves"
        model.define("elevator_lift", lift, r"C_L^{\delta_e}(1-s_c)", "1/rad", doc)
        deflection = commanded + gain * model["delta_e"]
        doc = "canard deflection, commanded and slaved"
        return model.define("canard_deflection", deflection, r"\delta_c", "rad", doc)


def define_generalized_forces(model: Model, variables: Mapping[str, Expr]) -> list[Expr]:
    """N_i of (2) and (6)."""
    modes = modes_of(model.table)
    with model.section("Curve fits", "(3)"):
        coefficients = [model.fit(f"C_N_{i}", variables=variables) for i in modes]
    with model.section("Generalized forces", "(2)"):
        return [
            model.define(
                f"generalized_force_{i}",
                model["reference_force"] * coefficient,
                f"N_{index(i)}",
                FORCE,
                f"generalized force of mode {i}",
            )
            for i, coefficient in zip(modes, coefficients, strict=True)
        ]


def slaved_fits(model: Model) -> dict[str, Polynomial]:
    """The curve fits of the rigid body, law (4) worked out where it makes the elevator's lift vanish.

    The canard lifts with C_L^delta_c delta_c, of which law (4) makes the elevator's lift, negative: in the two linear
    terms they cancel exactly, not to rounding.
    """

    def lifted(term: Term) -> Term:
        if term.powers == (("delta_c", 1),):
            return Term(term.coefficient, (("canard_commanded", 1),), term.scale)
        return Term("elevator_lift", term.powers) if term.powers == (("delta_e", 1),) else term

    fits = {key: p for key, p in model.table.polynomials.items() if not key.startswith("C_N_")}
    return fits | {"C_L": Polynomial(tuple(lifted(term) for term in fits["C_L"].terms))}


def define_forces(model: Model, variables: Mapping[str, Expr]) -> Expr:
    """Thrust, lift, drag and pitching moment of (2) from the curve fits (3); the turn rate by lift and thrust."""
    with model.section("Curve fits", "(3)"):
        fit = {
            key: model.fit(key, variables=variables, polynomial=polynomial, collect=PHI)
            for key, polynomial in slaved_fits(model).items()
        }
    force = model["reference_force"]
    with model.section("Forces and moment", "(2)"):
        thrust = model.define("thrust", force * fit["C_T"], "T", "lb/ft", "thrust")
        model.define("lift", force * fit["C_L"], "L", "lb/ft", "lift")
        model.define("drag", force * fit["C_D"], "D", "lb/ft", "drag")
        moment = total_moment(model, thrust, force * fit["C_M"])
        model.define("pitching_moment", moment, "M", "lb", "pitching moment")
        across = normal_coefficient(model, fit["C_L"], fit["C_T"])
        doc = "coefficient of the force across the flight path"
        across = model.define("normal_coefficient", across, r"C_L+C_T\sin\alpha", "1", doc, equation="(1)")
    return model["turn_factor"] * across


def normal_coefficient(model: Model, c_l: Expr, c_t: Expr) -> Expr:
    """L + T sin(alpha) of (1) over the dynamic pressure times S."""
    return c_l + c_t * model["sin_alpha"]


def total_moment(model: Model, thrust: Expr, force_times_c_m: Expr) -> Expr:
    """M = z_T T + q c S C_M, (2)."""
    return model["z_T"] * thrust + force_times_c_m * model["c_bar"]


def control_variables(model: Model) -> dict[str, Expr]:
    """Variables of the curve fits besides the flexible coordinates."""
    return {name: model[name] for name in ("phi", "alpha", "delta_e")} | {"delta_c": model["canard_deflection"]}


def define_flight_environment(model: Model) -> None:
    """What stands before the curve fits: air, angles, gravity, momentum, canard."""
    define_air(model)
    define_angles(model)
    define_gravity(model)
    define_momentum(model)
    define_canard(model)
