"""What the models share: air, forces and moment, and the motion of the rigid body, eq. (1)-(3)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import casadi as ca

from ..model import Model
from ..polynomial import Polynomial
from ..schema import QuantitySpec
from .flexible import modes_of


def define_air(m: Model) -> None:
    """Density, dynamic pressure and reference force, (2)."""
    define = m.graph.define
    ratio = define(
        "density_ratio",
        ca.exp((m.parameter("h_0") - m["altitude"]) / m.parameter("h_s")),
        symbol=r"\rho/\rho_0",
        unit="1",
        doc="air density over its reference",
        equation="(2)",
        section="Air",
    )
    density = define(
        "density",
        m.parameter("rho_0") * ratio,
        symbol=r"\rho",
        unit="slug/ft^3",
        doc="air density",
        equation="(2)",
        section="Air",
    )
    pressure = define(
        "dynamic_pressure",
        0.5 * density * m["velocity"] ** 2,
        symbol=r"\bar q",
        unit="lb/ft^2",
        doc="dynamic pressure",
        equation="(2)",
        section="Air",
    )
    define(
        "reference_force",
        pressure * m.parameter("s"),
        symbol=r"\bar q S",
        unit="lb/ft",
        doc="dynamic pressure times reference area",
        equation="(2)",
        section="Air",
    )


def define_gravity(m: Model) -> None:
    """Gravity at altitude, and what flight along the Earth's curvature leaves of it across the path.

    With `spherical_earth` = 0 both are g, bit for bit.
    """
    define = m.graph.define
    curvature = define(
        "earth_curvature",
        m.parameter("spherical_earth") / m.parameter("r_e"),
        symbol=r"\kappa",
        unit="1/ft",
        doc="curvature of the Earth, 0 where it is flat",
        equation="(1)",
        section="Gravity",
    )
    ratio = define(
        "radius_ratio",
        1 / (1 + curvature * m["altitude"]),
        symbol="R_E/r",
        unit="1",
        doc="radius of the Earth over the distance to its centre",
        equation="(1)",
        section="Gravity",
    )
    gravity = define(
        "gravity",
        m.parameter("g") * ratio**2,
        symbol="g(h)",
        unit="ft/s^2",
        doc="acceleration of gravity at altitude",
        equation="(1)",
        section="Gravity",
    )
    define(
        "gravity_turn",
        gravity / m["velocity"] - curvature * ratio * m["velocity"],
        symbol="g(h)/V-V/r",
        unit="1/s",
        doc="turn rate of a level path by gravity, less that of the Earth's curvature",
        equation="(1)",
        section="Gravity",
    )


def define_momentum(m: Model) -> None:
    """1/(m V) of (1), and the dynamic pressure times S over it; the velocity that both have cancels."""
    m.graph.define(
        "inverse_momentum",
        1 / (m.parameter("m") * m["velocity"]),
        symbol="1/(mV)",
        unit="s/slug",
        doc="reciprocal of mass times velocity",
        equation="(1)",
        section="Motion",
    )
    m.graph.define(
        "turn_factor",
        0.5 * m["density"] * m["velocity"] * m.parameter("s") / m.parameter("m"),
        symbol=r"\bar q S/(mV)",
        unit="1/s",
        doc="turn rate per force coefficient across the flight path",
        equation="(1)",
        section="Motion",
    )


def define_angles(m: Model) -> None:
    """Sines and cosines of angle of attack and flight-path angle, and their sum."""
    for angle, doc in (("alpha", "angle of attack"), ("gamma", "flight-path angle")):
        for function, word in ((ca.sin, "sin"), (ca.cos, "cos")):
            m.graph.define(
                f"{word}_{angle}",
                function(m[angle]),
                symbol=rf"\{word}\{angle}",
                unit="1",
                doc=f"{word} of the {doc}",
                equation="(1)",
                section="Angles",
            )
    m.graph.define(
        "theta",
        m["gamma"] + m["alpha"],
        symbol=r"\theta",
        unit="rad",
        doc="pitch angle",
        equation="(1)",
        section="Angles",
    )


def coefficient_symbols(m: Model, variables: Mapping[str, ca.SX]) -> dict[str, ca.SX]:
    """What a polynomial is written in: the coefficients of the table, quantities by name and the given variables."""
    quantities = {name: m[name] for name in m.graph.quantities}
    return quantities | {p.name: m.parameter(p.name) for p in m.table.parameters} | dict(variables)


def define_polynomial(
    m: Model,
    spec: QuantitySpec,
    name: str,
    doc: str,
    variables: Mapping[str, ca.SX],
    polynomial: Polynomial,
    equation: str = "(3)",
) -> ca.SX:
    """A curve-fitted quantity; what depends on the fuel equivalence ratio is factored as in (3)."""
    symbols = coefficient_symbols(m, variables)
    section = "Curve fits"
    slope = polynomial.linear_part("phi")
    expr = polynomial.without_linear("phi").expression(symbols)
    if slope.terms:
        base, _, index = spec.symbol.partition("_")
        per_phi = m.graph.define(
            f"{name}_phi",
            slope.expression(symbols),
            symbol=f"{base}_{{{index},\\phi}}" if index else f"{base}_\\phi",
            unit=spec.unit,
            doc=f"slope of the {doc} in the fuel equivalence ratio",
            equation=equation,
            section=section,
        )
        expr = per_phi * variables["phi"] + expr
    return m.graph.define(name, expr, symbol=spec.symbol, unit=spec.unit, doc=doc, equation=equation, section=section)


def define_force(m: Model, name: str, symbol: str, unit: str, doc: str, expr: ca.SX) -> ca.SX:
    """A force or moment of (2)."""
    return m.graph.define(name, expr, symbol=symbol, unit=unit, doc=doc, equation="(2)", section="Forces and moment")


@dataclass(frozen=True)
class Resultants:
    """What acts on the rigid body: force along the flight path, the turn rate by lift and thrust, and the moment."""

    path_force: ca.SX
    turn: ca.SX
    moment: ca.SX


def rigid_rates(m: Model, acting: Resultants) -> dict[str, ca.SX]:
    """Right-hand sides of the rigid rows of (1), but for the angle of attack, by state."""
    return {
        "velocity": acting.path_force / m.parameter("m") - m["gravity"] * m["sin_gamma"],
        "altitude": m["velocity"] * m["sin_gamma"],
        "gamma": acting.turn - m["gravity_turn"] * m["cos_gamma"],
        "pitch_rate": acting.moment / m.parameter("i_yy"),
    }


def define_pitch_acceleration(m: Model, expr: ca.SX) -> ca.SX:
    """The last rigid row of (1)."""
    return m.graph.define(
        "pitch_acceleration",
        expr,
        symbol=r"\dot Q",
        unit="rad/s^2",
        doc="pitch acceleration",
        equation="(1)",
        section="Motion",
    )


def define_rigid_rates(m: Model, turn: ca.SX, pitch_acceleration: ca.SX | None = None) -> dict[str, ca.SX]:
    """The rigid rows of (1) as named quantities, by state; the pitch acceleration is M/I_yy unless it is given."""
    path_force = m.graph.define(
        "path_force",
        m["thrust"] * m["cos_alpha"] - m["drag"],
        symbol=r"T\cos\alpha-D",
        unit="lb/ft",
        doc="force along the flight path",
        equation="(1)",
        section="Motion",
    )
    turn = m.graph.define(
        "force_turn",
        turn,
        symbol=r"(L+T\sin\alpha)/(mV)",
        unit="rad/s",
        doc="turn rate by the force across the flight path",
        equation="(1)",
        section="Motion",
    )
    exprs = rigid_rates(m, Resultants(path_force, turn, m["pitching_moment"]))
    rows = {
        "velocity": ("velocity_rate", r"\dot V", "ft/s^2", "rate of the velocity"),
        "altitude": ("altitude_rate", r"\dot h", "ft/s", "rate of the altitude"),
        "gamma": ("gamma_rate", r"\dot\gamma", "rad/s", "rate of the flight-path angle"),
    }
    rates = {}
    for row, (name, symbol, unit, doc) in rows.items():
        rates[row] = m.graph.define(
            name, exprs[row], symbol=symbol, unit=unit, doc=doc, equation="(1)", section="Motion"
        )
    if pitch_acceleration is None:
        pitch_acceleration = define_pitch_acceleration(m, exprs["pitch_rate"])
    rates["pitch_rate"] = pitch_acceleration
    rates["alpha"] = m.graph.define(
        "alpha_rate",
        m["pitch_rate"] - rates["gamma"],
        symbol=r"\dot\alpha",
        unit="rad/s",
        doc="rate of the angle of attack",
        equation="(1)",
        section="Motion",
    )
    return rates


def add_outlooks(m: Model, *flexible: str, fits: Iterable[str] = (), forces: Iterable[str] = ()) -> None:
    """What a model offers by name: air, curve fits, forces and moment, then such quantities of each flexible mode.

    All of them, after the pitch angle, are also the output of one function.
    """
    of_modes = (f"{name}_{i}" for i in modes_of(m.table) for name in flexible)
    names = ["density", "dynamic_pressure", *fits, *forces, *of_modes]
    m.add_evaluations(*names)
    m.add_outputs("theta", *names)


FORCES = ("thrust", "lift", "drag", "pitching_moment")
