"""The winged cone, control-oriented: Marrison and Stengel (1998); Xu, Mirmirani and Ioannou (2004).

A rigid vehicle over a spherical Earth, whose engine follows its command as a system of second order. Thrust has one
curve fit below beta = 1 and another from there on. The table is `winged_cone.toml`.
"""

from ahv_generator.modelling import (
    POSITIVE,
    Equation,
    Family,
    Given,
    Model,
    Parameter,
    Quantity,
    Sought,
    Variable,
    cos,
    exp,
    select,
    sin,
)

velocity = Variable("velocity", "V", "ft/s", "velocity")
altitude = Variable("altitude", "h", "ft", "altitude")
gamma = Variable("gamma", r"\gamma", "rad", "flight-path angle")
alpha = Variable("alpha", r"\alpha", "rad", "angle of attack")
pitch_rate = Variable("pitch_rate", "Q", "rad/s", "pitch rate")
beta = Variable("beta", r"\beta", "1", "throttle setting")
beta_rate = Variable("beta_rate", r"\dot\beta", "1/s", "rate of the throttle setting")
beta_command = Variable("beta_command", r"\beta_c", "1", "throttle setting as commanded")
delta_e = Variable("delta_e", r"\delta_e", "rad", "elevator deflection")
STATES = (velocity, altitude, gamma, alpha, pitch_rate, beta, beta_rate)
INPUTS = (beta_command, delta_e)

# Derived variables, in which curve fits may be written like in a state.
q_hat = Variable("q_hat", r"\hat q", "rad", "pitch rate times chord over twice the velocity")
tail = Variable("tail", r"\delta_\alpha", "rad", "elevator deflection less angle of attack")

m = Parameter("m", "m", "slug", "vehicle mass", POSITIVE)
I_yy = Parameter("I_yy", "I_{yy}", "slug*ft^2", "pitch moment of inertia", POSITIVE)
S = Parameter("S", "S", "ft^2", "reference area", POSITIVE)
c_bar = Parameter("c_bar", r"\bar c", "ft", "mean aerodynamic chord", POSITIVE)
zeta = Parameter("zeta", r"\zeta", "1", "damping ratio of the engine", POSITIVE)
omega = Parameter("omega", r"\omega", "rad/s", "natural frequency of the engine", POSITIVE)
rho_0 = Parameter("rho_0", r"\rho_0", "slug/ft^3", "air density at sea level", POSITIVE)
h_s = Parameter("h_s", "h_s", "ft", "scale height of the air density", POSITIVE)
R_E = Parameter("R_E", "R_E", "ft", "radius of the Earth", POSITIVE)
mu = Parameter("mu", r"\mu", "ft^3/s^2", "gravitational constant of the Earth", POSITIVE)

C_L = Quantity("C_L", "C_L", "1", "lift coefficient", depends_on=(alpha,))
C_D = Quantity("C_D", "C_D", "1", "drag coefficient", depends_on=(alpha,))
C_T = Quantity("C_T", "C_T", "1", "thrust coefficient below beta = 1", depends_on=(beta,))
C_T_high = Quantity("C_T_high", r"C_T^+", "1", "thrust coefficient from beta = 1 on", depends_on=(beta,))
C_M = Quantity("C_M", "C_M", "1", "pitching-moment coefficient", depends_on=(alpha, q_hat, tail))

family = Family()
family.parameters("vehicle", m, I_yy, S, c_bar)
family.parameters("engine", zeta, omega)
family.parameters("environment", rho_0, h_s, R_E, mu)
family.quantities(C_L, C_D, C_T, C_T_high, C_M)
family.bounds(*STATES, *INPUTS)


@family.model("winged_cone", "winged cone, control-oriented", "(1)-(5)", states=STATES, inputs=INPUTS)
def winged_cone(model: Model) -> None:
    """The equations, section by section."""
    V, h, g, a, Q = model.symbols(velocity, altitude, gamma, alpha, pitch_rate)
    throttle, throttle_rate, command, elevator = model.symbols(beta, beta_rate, beta_command, delta_e)
    with model.section("Air and gravity", "(1)"):
        density = model.define("density", model[rho_0] * exp(-h / model[h_s]), r"\rho", "slug/ft^3", "air density")
        pressure = model.define("dynamic_pressure", density * V**2 / 2, r"\bar q", "lb/ft^2", "dynamic pressure")
        radius = model.define("radius", model[R_E] + h, "r", "ft", "distance to the centre of the Earth")
        gravity = model.define("gravity", model[mu] / radius**2, "g(h)", "ft/s^2", "acceleration of gravity")
    with model.section("Curve fits", "(2)"):
        model.define(q_hat, model[c_bar] * Q / (2 * V))
        # A gust that joins the angle of attack meets the tail, too.
        model.define(tail, elevator - model.seen(alpha))
        lift_coefficient, drag_coefficient, moment_coefficient = map(model.fit, (C_L, C_D, C_M))
        thrust_coefficient = model.define(
            "thrust_coefficient",
            select(throttle < 1, model.fit(C_T), model.fit(C_T_high)),
            r"C_T(\beta)",
            "1",
            "thrust coefficient",
        )
    with model.section("Forces and moment", "(3)"):
        force = model.define("reference_force", pressure * model[S], r"\bar q S", "lb", "dynamic pressure times area")
        lift = model.define("lift", force * lift_coefficient, "L", "lb", "lift")
        drag = model.define("drag", force * drag_coefficient, "D", "lb", "drag")
        thrust = model.define("thrust", force * thrust_coefficient, "T", "lb", "thrust")
        moment = force * model[c_bar] * moment_coefficient
        moment = model.define("pitching_moment", moment, "M", "ft*lb", "pitching moment")
    with model.section("Motion", "(4)"):
        theta = model.define("theta", g + a, r"\theta", "rad", "pitch angle")
        across = (lift + thrust * sin(a)) / (model[m] * V)
        turn = model.define(
            "gamma_rate", across - (gravity / V - V / radius) * cos(g), r"\dot\gamma", "rad/s", "turn rate"
        )
        model.motion(
            {
                velocity: (thrust * cos(a) - drag) / model[m] - gravity * sin(g),
                altitude: V * sin(g),
                gamma: turn,
                alpha: Q - turn,
                pitch_rate: moment / model[I_yy],
                beta: throttle_rate,
                beta_rate: model[omega] ** 2 * (command - throttle) - 2 * model[zeta] * model[omega] * throttle_rate,
            }
        )
    model.outputs(theta, density, pressure, lift, drag, thrust, moment)
    model.trim(
        given=[Given(velocity, 15060.0, above=0.0), Given(altitude, 110000.0), Given(gamma, 0.0, -1.5, 1.5)],
        sought=[
            Sought(alpha, scale=0.1),
            Sought(beta, 0.2, 0.1),
            Sought(beta_command, 0.2, 0.1),
            Sought(delta_e, 0.0, 0.1),
        ],
        equations=[
            Equation(velocity, like=(gamma, velocity)),
            Equation(gamma),
            Equation(pitch_rate),
            Equation(beta_rate),
        ],
        moving=[altitude],
        shown=[alpha, beta, beta_command, delta_e],
    )
    model.mode("phugoid", velocity, altitude, gamma, slowest="height")
    model.mode("short period", alpha, pitch_rate)
    model.mode("engine", beta, beta_rate)
    model.defaults(inputs=[beta_command, delta_e], outputs=[velocity, altitude])
    model.deviations(
        {
            velocity: 100.0,
            altitude: 1000.0,
            gamma: 0.01,
            alpha: 0.02,
            pitch_rate: 0.05,
            beta_command: 0.1,
            delta_e: 0.05,
        }
    )
