"""A sensor with coloured noise: it measures a state with an error that is a Gauss-Markov process."""

from ahv_generator.modelling import NOT_NEGATIVE, POSITIVE, Parameter, Part, PartModel, State, Variable, sqrt

TIME = Parameter("tau", r"\tau_m", "s", "correlation time of the error of the sensor", POSITIVE)
WIENER = Variable("wiener", "w_m", "s^0.5", "Wiener increment that drives the error of the sensor")


def part(state: State) -> Part:
    """A sensor of `state`, whose measurement is an output."""
    rms = Parameter(
        "sigma", r"\sigma_m", state.unit, f"root mean square error of the measured {state.doc}", NOT_NEGATIVE
    )
    error = Variable("error", rf"\epsilon_{{{state.symbol}}}", state.unit, f"error of the measured {state.doc}")
    made = Part("sensor with coloured noise", (error,), noise=(WIENER,), parameters=(rms, TIME))

    @made.equations
    def equations(model: PartModel) -> None:
        amiss, sigma, tau = model.symbols(error, rms, TIME)
        doc = f"measured {state.doc}"
        measured = model.define("measured", model[state] + amiss, f"{state.symbol}^m", state.unit, doc)
        model.motion({error: -amiss / tau})
        model.diffusion({(error, WIENER): sigma * sqrt(2 / tau)})
        model.outputs(measured)

    return made
