"""The vertical gust of Dryden's spectrum, of second order: its incidence is added to an angle where curve fits see it.

Of white noise of unit intensity the filter sigma sqrt(T) (1 + sqrt(3) T s) / (1 + T s)^2 with T = L / V makes a gust of
root mean square sigma. It is a lag, followed by a second one that the first one passes in part.
"""

from typing import Annotated

from ahv_generator.modelling import NOT_NEGATIVE, POSITIVE, Join, Parameter, Part, PartModel, Variable, sqrt

Angle = Annotated[Variable, Join("state", "rad")]
Speed = Annotated[Variable, Join("state", "ft/s")]

LENGTH = Parameter("length", "L_w", "ft", "length of the turbulence", POSITIVE)
WIENER = Variable("wiener", "w_g", "s^0.5", "Wiener increment that drives the gust")


def part(state: Angle, speed: Speed) -> Part:
    """A gust whose incidence is added to `state`, an angle, where the vehicle flies at `speed`."""
    rms = Parameter("sigma", r"\sigma_w", speed.unit, "root mean square of the vertical gust", NOT_NEGATIVE)
    first = Variable("first", "w_1", speed.unit, "vertical gust behind one lag")
    second = Variable("second", "w_2", speed.unit, "vertical gust behind two lags")
    made = Part("vertical gust after Dryden", (first, second), noise=(WIENER,), parameters=(rms, LENGTH))

    @made.equations
    def equations(model: PartModel) -> None:
        one, two, sigma, length, V = model.symbols(first, second, rms, LENGTH, speed)
        doc = "time in which the turbulence passes the vehicle"
        time = model.define("time", length / V, "T_w", "s", doc)
        doc = "vertical gust"
        gust = model.define("velocity", sqrt(3) * one + (1 - sqrt(3)) * two, "w_g", speed.unit, doc)
        model.motion({first: -one / time, second: (one - two) / time})
        model.diffusion({(first, WIENER): sigma / sqrt(time)})
        model.add(state, gust / V)
        model.outputs(gust)

    return made
