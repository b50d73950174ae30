"""An actuator of first order with limits: its command is held between two positions, its rate is bounded."""

from ahv_generator.modelling import POSITIVE, Parameter, Part, PartModel, Rule, Variable, fmax, fmin

LAG = Parameter("tau", r"\tau", "s", "time constant of the actuator", POSITIVE)


def part(input: Variable) -> Part:
    """An actuator that drives `input`."""
    command = Variable("command", f"{input.symbol}^c", input.unit, f"command of the {input.doc}", input.interval)
    position = Variable("position", f"{input.symbol}^a", input.unit, f"{input.doc} of the actuator", input.interval)
    lowest = Parameter("lowest", rf"{input.symbol}^-", input.unit, f"lowest {input.doc}")
    highest = Parameter("highest", rf"{input.symbol}^+", input.unit, f"highest {input.doc}")
    fastest = Parameter(
        "fastest", rf"\dot{{{input.symbol}}}^+", f"{input.unit}/s", f"largest rate of the {input.doc}", POSITIVE
    )
    in_order = Rule("limits", ((1.0, ("highest",)), (-1.0, ("lowest",))), POSITIVE, "`highest` must exceed `lowest`")
    limits = (lowest, highest, fastest)
    made = Part(
        "actuator of first order with limits",
        (position,),
        (command,),
        parameters=(LAG, *limits),
        rules=(in_order,),
        drives=(input,),
    )

    @made.equations
    def equations(model: PartModel) -> None:
        where, wanted, lag, low, high, top = model.symbols(position, command, LAG, *limits)
        held = fmin(fmax(wanted, low), high)
        model.motion({position: fmin(fmax((held - where) / lag, -top), top)})
        model.drive(input, where)

    return made
