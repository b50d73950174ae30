"""What the vehicles share: air, forces and moment, and the motion of the rigid body, eq. (1)-(3)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ..modelling import Expr, Model, cos, exp, sin
from .flexible import modes_of

FORCES = ("thrust", "lift", "drag", "pitching_moment")


def define_air(model: Model) -> None:
    """Density, dynamic pressure and reference force, (2)."""
    with model.section("Air", "(2)"):
        ratio = exp((model["h_0"] - model["altitude"]) / model["h_s"])
        ratio = model.define("density_ratio", ratio, r"\rho/\rho_0", "1", "air density over its reference")
        density = model.define("density", model["rho_0"] * ratio, r"\rho", "slug/ft^3", "air density")
        pressure = 0.5 * density * model["velocity"] ** 2
        pressure = model.define("dynamic_pressure", pressure, r"\bar q", "lb/ft^2", "dynamic pressure")
        doc = "dynamic pressure times reference area"
        model.define("reference_force", pressure * model["s"], r"\bar q S", "lb/ft", doc)


def define_angles(model: Model) -> None:
    """Sines and cosines of angle of attack and flight-path angle, and their sum."""
    with model.section("Angles", "(1)"):
        for angle, doc in (("alpha", "angle of attack"), ("gamma", "flight-path angle")):
            for function, word in ((sin, "sin"), (cos, "cos")):
                model.define(
                    f"{word}_{angle}", function(model[angle]), rf"\{word}\{angle}", "1", f"{word} of the {doc}"
                )
        model.define("theta", model["gamma"] + model["alpha"], r"\theta", "rad", "pitch angle")


def define_gravity(model: Model) -> None:
    """Gravity at altitude, and what flight along the Earth's curvature leaves of it across the path.

    With `spherical_earth` = 0 both are g, bit for bit.
    """
    with model.section("Gravity", "(1)"):
        doc = "curvature of the Earth, 0 where it is flat"
        curvature = model["spherical_earth"] / model["r_e"]
        curvature = model.define("earth_curvature", curvature, r"\kappa", "1/ft", doc)
        doc = "radius of the Earth over the distance to its centre"
        ratio = model.define("radius_ratio", 1 / (1 + curvature * model["altitude"]), "R_E/r", "1", doc)
        doc = "acceleration of gravity at altitude"
        gravity = model.define("gravity", model["g"] * ratio**2, "g(h)", "ft/s^2", doc)
        doc = "turn rate of a level path by gravity, less that of the Earth's curvature"
        turn = gravity / model["velocity"] - curvature * ratio * model["velocity"]
        model.define("gravity_turn", turn, "g(h)/V-V/r", "1/s", doc)


def define_momentum(model: Model) -> None:
    """1/(m V) of (1), and the dynamic pressure times S over it; the velocity that both have cancels."""
    with model.section("Motion", "(1)"):
        momentum = model["m"] * model["velocity"]
        model.define("inverse_momentum", 1 / momentum, "1/(mV)", "s/slug", "reciprocal of mass times velocity")
        turn = 0.5 * model["density"] * model["velocity"] * model["s"] / model["m"]
        doc = "turn rate per force coefficient across the flight path"
        model.define("turn_factor", turn, r"\bar q S/(mV)", "1/s", doc)


def define_force(model: Model, name: str, symbol: str, unit: str, doc: str, expr: Expr) -> Expr:
    """A force or moment of (2)."""
    with model.section("Forces and moment", "(2)"):
        return model.define(name, expr, symbol, unit, doc)


@dataclass(frozen=True)
class Resultants:
    """What acts on the rigid body: force along the flight path, the turn rate by lift and thrust, and the moment."""

    path_force: Expr
    turn: Expr
    moment: Expr


def rigid_rates(model: Model, acting: Resultants) -> dict[str, Expr]:
    """Right-hand sides of the rigid rows of (1), but for the angle of attack, by state."""
    return {
        "velocity": acting.path_force / model["m"] - model["gravity"] * model["sin_gamma"],
        "altitude": model["velocity"] * model["sin_gamma"],
        "gamma": acting.turn - model["gravity_turn"] * model["cos_gamma"],
        "pitch_rate": acting.moment / model["i_yy"],
    }


def define_pitch_acceleration(model: Model, expr: Expr) -> Expr:
    """The last rigid row of (1)."""
    with model.section("Motion", "(1)"):
        return model.define("pitch_acceleration", expr, r"\dot Q", "rad/s^2", "pitch acceleration")


def define_rigid_rates(model: Model, turn: Expr, pitch_acceleration: Expr | None = None) -> dict[str, Expr]:
    """The rigid rows of (1) as named quantities, by state; the pitch acceleration is M/I_yy unless it is given."""
    with model.section("Motion", "(1)"):
        force = model["thrust"] * model["cos_alpha"] - model["drag"]
        force = model.define("path_force", force, r"T\cos\alpha-D", "lb/ft", "force along the flight path")
        doc = "turn rate by the force across the flight path"
        turn = model.define("force_turn", turn, r"(L+T\sin\alpha)/(mV)", "rad/s", doc)
        rows = rigid_rates(model, Resultants(force, turn, model["pitching_moment"]))
        rates = {
            "velocity": model.define("velocity_rate", rows["velocity"], r"\dot V", "ft/s^2", "rate of the velocity"),
            "altitude": model.define("altitude_rate", rows["altitude"], r"\dot h", "ft/s", "rate of the altitude"),
            "gamma": model.define("gamma_rate", rows["gamma"], r"\dot\gamma", "rad/s", "rate of the flight-path angle"),
        }
        if pitch_acceleration is None:
            pitch_acceleration = define_pitch_acceleration(model, rows["pitch_rate"])
        incidence = model["pitch_rate"] - rates["gamma"]
        incidence = model.define("alpha_rate", incidence, r"\dot\alpha", "rad/s", "rate of the angle of attack")
    return rates | {"pitch_rate": pitch_acceleration, "alpha": incidence}


def add_outlooks(model: Model, *flexible: str, fits: Iterable[str] = (), forces: Iterable[str] = ()) -> None:
    """What a model offers by name: air, curve fits, forces and moment, then such quantities of each flexible mode.

    All of them, after the pitch angle, are also the output of one function.
    """
    of_modes = (f"{name}_{i}" for i in modes_of(model.table) for name in flexible)
    names = ["density", "dynamic_pressure", *fits, *forces, *of_modes]
    model.evaluations(*names)
    model.outputs("theta", *names)
