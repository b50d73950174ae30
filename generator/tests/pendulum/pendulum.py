"""A pendulum with friction: all that a model needs, in one file. Its table is `pendulum.toml`."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca
from ahv_generator.derivatives import add_drift_and_derivatives

from ahv_generator.family import Family
from ahv_generator.model import Model
from ahv_generator.schema import POSITIVE, ParameterSpec, QuantitySpec, Rule, Schema, VariableSpec
from ahv_generator.table import Table
from ahv_generator.traits import Equation, Given, Mode, Sought, Traits, Trim

MOMENT = "slug*ft^2/s^2"
ANGLE = VariableSpec("angle", r"\varphi", "rad", "angle from the plumb line", "angle")
RATE = VariableSpec("rate", r"\omega", "rad/s", "rate of the angle", "rate")
TORQUE = VariableSpec("torque", "M", MOMENT, "moment at the pivot", "torque")


def build_pendulum(table: Table) -> Model:
    """A point mass on a massless rod."""
    traits = Traits(
        trim=Trim(
            given=(Given("angle", 0.0, above=-1.5, below=1.5),),
            sought=(Sought("torque"),),
            equations=(Equation("rate"),),
        ),
        modes=(Mode("swing", ("angle", "rate")),),
        inputs=("torque",),
        outputs=("angle",),
        deviations={"angle": 0.1, "torque": 1.0},
    )
    m = Model("pendulum", "a pendulum", "", table, {"state": (ANGLE, RATE), "input": (TORQUE,)}, traits)
    mass, length, gravity = (m.parameter(name) for name in ("mass", "length", "gravity"))
    symbols = {p.name: m.parameter(p.name) for p in table.parameters} | {"rate": m["rate"]}
    (fit,) = table.schema.quantities

    def define(name: str, expr: ca.SX, symbol: str, unit: str, doc: str) -> ca.SX:
        return m.graph.define(name, expr, symbol=symbol, unit=unit, doc=doc, equation="", section="Pendulum")

    friction = define("friction", table.polynomials["C_F"].expression(symbols), fit.symbol, fit.unit, fit.doc)
    define("height", length * (1 - ca.cos(m["angle"])), "h", "ft", "height above the lowest point")
    weight = mass * gravity * length * ca.sin(m["angle"])
    rates = {"angle": m["rate"], "rate": (m["torque"] - friction - weight) / (mass * length**2)}
    add_drift_and_derivatives(m, rates, "")
    m.add_outputs("height")
    return m


def _schema(_models: tuple[str, ...], _document: Mapping[str, object]) -> Schema:
    parameters = (
        ParameterSpec("mass", "m", "slug", "mass of the bob", POSITIVE),
        ParameterSpec("length", "l", "ft", "length of the rod", POSITIVE),
        ParameterSpec("gravity", "g", "ft/s^2", "acceleration of gravity", POSITIVE),
    )
    # The discriminant of m l^2 s^2 + c s + m g l is negative.
    swings = Rule(
        "swings",
        ((4.0, ("mass", "mass", "gravity", "length", "length", "length")), (-1.0, ("c_f_rate", "c_f_rate"))),
        POSITIVE,
        "the friction at rest is too large for the pendulum to swing",
    )
    return Schema(
        parameters={"pendulum": parameters},
        validity=(ANGLE, RATE, TORQUE),
        quantities=(QuantitySpec("C_F", "C_F", MOMENT, "moment of friction", ("rate",), ("rate",), "it swings"),),
        variables=(RATE,),
        laws=(swings,),
    )


FAMILY = Family("pendulum", {"pendulum": build_pendulum}, _schema)
