"""An actuator whose position follows its command as a damped oscillator."""

from ahv_generator.modelling import NOT_NEGATIVE, POSITIVE, Input, Parameter, Part, PartModel, Variable

OMEGA = Parameter("omega", r"\omega", "rad/s", "natural frequency of the actuator", POSITIVE)
ZETA = Parameter("zeta", r"\zeta", "1", "damping ratio of the actuator", NOT_NEGATIVE)


def part(input: Input) -> Part:
    """An actuator that drives `input`."""
    command = Variable("command", f"{input.symbol}^c", input.unit, f"command of the {input.doc}", input.interval)
    position = Variable("position", f"{input.symbol}^a", input.unit, f"{input.doc} of the actuator", input.interval)
    rate = Variable("rate", rf"\dot {{{input.symbol}}}^a", f"{input.unit}/s", f"rate of the {input.doc}")
    made = Part("actuator of second order", (position, rate), (command,), parameters=(OMEGA, ZETA), drives=(input,))

    @made.equations
    def equations(model: PartModel) -> None:
        where, speed, wanted, omega, zeta = model.symbols(position, rate, command, OMEGA, ZETA)
        model.motion({position: speed, rate: omega**2 * (wanted - where) - 2 * zeta * omega * speed})
        model.drive(input, where)

    return made
