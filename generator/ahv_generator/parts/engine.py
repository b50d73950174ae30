"""An engine whose throttle follows its command with two lags: that of the fuel valve, then that of the combustor."""

from ahv_generator.modelling import POSITIVE, Input, Parameter, Part, PartModel, Variable

VALVE_LAG = Parameter("tau_valve", r"\tau_v", "s", "time constant of the fuel valve", POSITIVE)
COMBUSTOR_LAG = Parameter("tau_combustor", r"\tau_b", "s", "time constant of the combustor", POSITIVE)


def part(input: Input) -> Part:
    """An engine that drives `input`, a throttle setting or an equivalence ratio."""
    command = Variable("command", f"{input.symbol}^c", input.unit, f"command of the {input.doc}", input.interval)
    valve = Variable("valve", f"{input.symbol}^v", input.unit, f"{input.doc} at the fuel valve", input.interval)
    combustor = Variable("combustor", f"{input.symbol}^b", input.unit, f"{input.doc} in the combustor", input.interval)
    lags = (VALVE_LAG, COMBUSTOR_LAG)
    made = Part("engine with two lags", (combustor, valve), (command,), parameters=lags, drives=(input,))

    @made.equations
    def equations(model: PartModel) -> None:
        burnt, fed, wanted = model.symbols(combustor, valve, command)
        model.motion({combustor: (fed - burnt) / model[COMBUSTOR_LAG], valve: (wanted - fed) / model[VALVE_LAG]})
        model.drive(input, burnt)

    return made
