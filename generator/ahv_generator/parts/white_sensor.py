"""A sensor with white noise behind a lag: what it measures follows a state and is driven by the noise."""

from ahv_generator.modelling import NOT_NEGATIVE, POSITIVE, Parameter, Part, PartModel, State, Variable

LAG = Parameter("tau", r"\tau_m", "s", "time constant of the sensor", POSITIVE)
WIENER = Variable("wiener", "w_m", "s^0.5", "Wiener increment that disturbs the sensor")


def part(state: State) -> Part:
    """A sensor of `state`, whose measurement is a state."""
    doc = f"intensity of the white noise of the measured {state.doc}"
    intensity = Parameter("sigma", r"\sigma_m", f"{state.unit}/s^0.5", doc, NOT_NEGATIVE)
    measured = Variable("measured", f"{state.symbol}^m", state.unit, f"measured {state.doc}", state.interval)
    made = Part("sensor with white noise", (measured,), noise=(WIENER,), parameters=(intensity, LAG))

    @made.equations
    def equations(model: PartModel) -> None:
        model.motion({measured: (model[state] - model[measured]) / model[LAG]})
        model.diffusion({(measured, WIENER): model[intensity]})

    return made
