"""An actuator of first order with limits: its command is held between two positions, its rate is bounded."""

from ahv_generator.modelling import POSITIVE, Input, Parameter, Part, PartModel, Variable, fmax, fmin

LAG = Parameter("tau", r"\tau", "s", "time constant of the actuator", POSITIVE)


def part(input: Input) -> Part:
    """An actuator that drives `input`."""
    command = Variable("command", f"{input.symbol}^c", input.unit, f"command of the {input.doc}", input.interval)
    position = Variable("position", f"{input.symbol}^a", input.unit, f"{input.doc} of the actuator", input.interval)
    lowest = Parameter("lowest", rf"{input.symbol}^-", input.unit, f"lowest {input.doc}")
    highest = Parameter("highest", rf"{input.symbol}^+", input.unit, f"highest {input.doc}", above=lowest)
    fastest = Parameter(
        "fastest", rf"\dot{{{input.symbol}}}^+", f"{input.unit}/s", f"largest rate of the {input.doc}", POSITIVE
    )
    limits = (lowest, highest, fastest)
    made = Part(
        "actuator of first order with limits",
        (position,),
        (command,),
        parameters=(LAG, *limits),
        drives=(input,),
    )

    @made.equations
    def equations(model: PartModel) -> None:
        where, wanted, lag, low, high, top = model.symbols(position, command, LAG, *limits)
        held = fmin(fmax(wanted, low), high)
        model.motion({position: fmin(fmax((held - where) / lag, -top), top)})
        model.drive(input, where)

    return made
