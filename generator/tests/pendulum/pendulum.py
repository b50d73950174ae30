"""A pendulum with friction: all that a model needs, in one file. Its table is `pendulum.toml`."""

from __future__ import annotations

from ahv_generator.modelling import (
    POSITIVE,
    Equation,
    Family,
    Given,
    Model,
    Parameter,
    Quantity,
    Rule,
    Sought,
    Variable,
    cos,
    sin,
)

MOMENT = "slug*ft^2/s^2"

angle = Variable("angle", r"\varphi", "rad", "angle from the plumb line")
rate = Variable("rate", r"\omega", "rad/s", "rate of the angle")
torque = Variable("torque", "M", MOMENT, "moment at the pivot")

mass = Parameter("mass", "m", "slug", "mass of the bob", POSITIVE)
length = Parameter("length", "l", "ft", "length of the rod", POSITIVE)
gravity = Parameter("gravity", "g", "ft/s^2", "acceleration of gravity", POSITIVE)
friction = Quantity("C_F", "C_F", MOMENT, "moment of friction", (rate,), required=("rate",), required_by="it swings")
# The discriminant of m l^2 s^2 + c s + m g l is negative.
swings = Rule(
    "swings",
    ((4.0, ("mass", "mass", "gravity", "length", "length", "length")), (-1.0, ("c_f_rate", "c_f_rate"))),
    POSITIVE,
    "the friction at rest is too large for the pendulum to swing",
)

family = Family()
family.parameters("pendulum", mass, length, gravity)
family.quantities(friction)
family.rules(swings)
family.bounds(angle, rate, torque)


@family.model("pendulum", "a pendulum", states=(angle, rate), inputs=(torque,))
def pendulum(model: Model) -> None:
    """A point mass on a massless rod."""
    phi, omega, m, l, g = model.symbols(angle, rate, mass, length, gravity)  # noqa: E741
    with model.section("Pendulum"):
        resistance = model.fit(friction, "friction")
        model.define("height", l * (1 - cos(phi)), "h", "ft", "height above the lowest point")
    model.motion({angle: omega, rate: (model[torque] - resistance - m * g * l * sin(phi)) / (m * l**2)})
    model.outputs("height")
    model.trim(given=[Given(angle, 0.0, above=-1.5, below=1.5)], sought=[Sought(torque)], equations=[Equation(rate)])
    model.mode("swing", angle, rate)
    model.defaults(inputs=[torque], outputs=[angle])
    model.deviations({angle: 0.1, torque: 1.0})
