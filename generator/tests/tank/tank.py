"""A tank: the smallest model, with one state, one input, one output, no curve fit and no noise."""

from ahv_generator.modelling import POSITIVE, Equation, Family, Model, Parameter, Sought, Variable

level = Variable("level", "h", "m", "level")
valve = Variable("valve", "u", "m/s", "inflow by the valve")
outflow = Parameter("outflow", "k", "1/s", "rate of the outflow", POSITIVE)
weight = Parameter("weight", "w", "N/m^3", "weight per volume", POSITIVE)
inflow = Parameter("inflow", "q", "m/s", "inflow")

family = Family()
family.parameters("tank", outflow, inflow, weight)
family.bounds(level, valve)


@family.model("tank", "a tank", "(1)", states=(level,), inputs=(valve,))
def tank(model: Model) -> None:
    """A level that settles."""
    with model.section("Tank", "(1)"):
        pressure = model.define("pressure", model[weight] * model[level], "p", "N/m^2", "pressure at the bottom")
        model.motion({level: model[inflow] + model[valve] - model[outflow] * model[level]})
    model.outputs(pressure)
    model.trim(sought=[Sought(level)], equations=[Equation(level)])
