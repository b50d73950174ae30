"""Van der Pol's oscillator: a family in twenty lines. Its table is `van_der_pol.toml`."""

from ahv_generator.modelling import POSITIVE, Equation, Family, Model, Parameter, Quantity, Sought, Variable

position = Variable("position", "x", "m", "displacement")
rate = Variable("rate", r"\dot x", "m/s", "rate of the displacement")
drive = Variable("drive", "u", "m/s^2", "acceleration of the drive")
omega = Parameter("omega", r"\omega", "rad/s", "natural frequency", POSITIVE)
damping = Quantity("C", "C", "1/s", "damping, negative about the origin", depends_on=(position,))

family = Family()
family.parameters("oscillator", omega)
family.quantities(damping)
family.bounds(position, rate, drive)


@family.model("van_der_pol", "Van der Pol's oscillator", "(1)", states=(position, rate), inputs=(drive,))
def van_der_pol(model: Model) -> None:
    """An oscillator whose damping grows with the displacement."""
    x, v, u, w = model.symbols(position, rate, drive, omega)
    with model.section("Oscillator", "(1)"):
        energy = model.define("energy", (v**2 + (w * x) ** 2) / 2, "E", "m^2/s^2", "energy per mass")
        model.motion({position: v, rate: u - model.fit(damping) * v - w**2 * x})
    model.outputs(energy)
    model.trim(sought=[Sought(position), Sought(rate)], equations=[Equation(position), Equation(rate)])
