"""A gust of first order, a Gauss-Markov process: it is added to a state where curve fits see it."""

from ahv_generator.modelling import NOT_NEGATIVE, POSITIVE, Parameter, Part, PartModel, State, Variable, sqrt

TIME = Parameter("tau", r"\tau_g", "s", "correlation time of the gust", POSITIVE)
WIENER = Variable("wiener", "w_g", "s^0.5", "Wiener increment that drives the gust")


def part(state: State) -> Part:
    """A gust that is added to `state`, such as the angle of attack."""
    rms = Parameter("sigma", r"\sigma_g", state.unit, f"root mean square of the gust, as a {state.doc}", NOT_NEGATIVE)
    level = Variable("level", f"{state.symbol}^g", state.unit, f"gust, as a {state.doc}")
    made = Part("band-limited gust", (level,), noise=(WIENER,), parameters=(rms, TIME))

    @made.equations
    def equations(model: PartModel) -> None:
        gust, sigma, tau = model.symbols(level, rms, TIME)
        model.motion({level: -gust / tau})
        model.diffusion({(level, WIENER): sigma * sqrt(2 / tau)})
        model.add(state, gust)

    return made
