"""An actuator whose position follows its command with a lag of first order."""

from ahv_generator.modelling import POSITIVE, Input, Parameter, Part, PartModel, Variable

LAG = Parameter("tau", r"\tau", "s", "time constant of the actuator", POSITIVE)


def part(input: Input) -> Part:
    """An actuator that drives `input`."""
    command = Variable("command", f"{input.symbol}^c", input.unit, f"command of the {input.doc}", input.interval)
    position = Variable("position", f"{input.symbol}^a", input.unit, f"{input.doc} of the actuator", input.interval)
    made = Part("actuator of first order", (position,), (command,), parameters=(LAG,), drives=(input,))

    @made.equations
    def equations(model: PartModel) -> None:
        where, wanted, lag = model.symbols(position, command, LAG)
        model.motion({position: (wanted - where) / lag})
        model.drive(input, where)

    return made
