"""An actuator of second order with limits: its command is held between two positions, its position moves no faster.

The oscillator's own rate may exceed the limit for a while; the position does not follow it then.
"""

from ahv_generator.modelling import NOT_NEGATIVE, POSITIVE, Input, Parameter, Part, PartModel, Variable, fmax, fmin

OMEGA = Parameter("omega", r"\omega", "rad/s", "natural frequency of the actuator", POSITIVE)
ZETA = Parameter("zeta", r"\zeta", "1", "damping ratio of the actuator", NOT_NEGATIVE)


def part(input: Input) -> Part:
    """An actuator that drives `input`."""
    command = Variable("command", f"{input.symbol}^c", input.unit, f"command of the {input.doc}", input.interval)
    position = Variable("position", f"{input.symbol}^a", input.unit, f"{input.doc} of the actuator", input.interval)
    rate = Variable("rate", rf"\dot {{{input.symbol}}}^a", f"{input.unit}/s", f"rate of the {input.doc}")
    lowest = Parameter("lowest", rf"{input.symbol}^-", input.unit, f"lowest {input.doc}")
    highest = Parameter("highest", rf"{input.symbol}^+", input.unit, f"highest {input.doc}", above=lowest)
    fastest = Parameter(
        "fastest", rf"\dot{{{input.symbol}}}^+", f"{input.unit}/s", f"largest rate of the {input.doc}", POSITIVE
    )
    limits = (lowest, highest, fastest)
    made = Part(
        "actuator of second order with limits",
        (position, rate),
        (command,),
        parameters=(OMEGA, ZETA, *limits),
        drives=(input,),
    )

    @made.equations
    def equations(model: PartModel) -> None:
        where, speed, wanted, omega, zeta = model.symbols(position, rate, command, OMEGA, ZETA)
        low, high, top = model.symbols(*limits)
        held = fmin(fmax(wanted, low), high)
        model.motion(
            {
                position: fmin(fmax(speed, -top), top),
                rate: omega**2 * (held - where) - 2 * zeta * omega * speed,
            }
        )
        model.drive(input, where)

    return made
