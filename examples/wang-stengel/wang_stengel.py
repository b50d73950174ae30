"""The winged cone whose coefficients depend on the Mach number: Wang and Stengel (2000).

A rigid vehicle over a spherical Earth, whose engine follows its command as a system of second order. Coefficients are
products of curve fits in the angle of attack and in the Mach number, as they are published. Thrust has one factor below
beta = 1 and another from there on. The table is `wang_stengel.toml`.
"""

from ahv_generator.modelling import (
    POSITIVE,
    Choice,
    Equation,
    Expr,
    Family,
    Given,
    Model,
    Option,
    Parameter,
    Quantity,
    Sought,
    Variable,
    cos,
    exp,
    select,
    sin,
    switch,
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
mach = Variable("mach", "M", "1", "Mach number")
inverse_mach = Variable("inverse_mach", "1/M", "1", "reciprocal of the Mach number")

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

C_D_scale = Parameter("C_D_scale", "C_{D,s}", "1", "scale of the drag coefficient", POSITIVE)
C_T_scale = Parameter("C_T_scale", "C_{T,s}", "1", "scale of the thrust coefficient", POSITIVE)
C_M_scale = Parameter("C_M_scale", "C_{M,s}", "1", "scale of the moment coefficient of the angle of attack", POSITIVE)
C_M_limit = Parameter("C_M_limit", r"K_{M,\infty}", "1", "Mach factor of that moment coefficient at high Mach number")
M_s = Parameter("M_s", "M_s", "1", "Mach number in which that factor decays", POSITIVE)
C_M_e = Parameter("C_M_e", r"C_{M,\delta}", "1/rad", "moment coefficient per elevator angle against the air")

a = Quantity("a", "a", "ft/s", "speed of sound", depends_on=(altitude,))
C_L_alpha = Quantity("C_L_alpha", r"C_{L,\alpha}", "1/rad", "lift slope", depends_on=(inverse_mach,))
C_L_elevator = Quantity(
    "C_L_elevator", r"C_{L,\delta}", "1/rad", "lift coefficient per elevator deflection", depends_on=(alpha,)
)
drag_alpha = Quantity(
    "drag_alpha", r"K_{D,\alpha}", "1", "factor of the drag by the angle of attack", depends_on=(alpha,)
)
drag_mach = Quantity("drag_mach", "K_{D,M}", "1", "factor of the drag by the Mach number", depends_on=(mach,))
thrust_mach = Quantity(
    "thrust_mach", "K_{T,M}", "1", "factor of the thrust by the Mach number", depends_on=(inverse_mach,)
)
thrust_beta = Quantity(
    "thrust_beta", r"K_{T,\beta}", "1", "factor of the thrust by the throttle below 1", depends_on=(beta,)
)
thrust_beta_high = Quantity(
    "thrust_beta_high", r"K_{T,\beta}^+", "1", "factor of the thrust by the throttle from 1 on", depends_on=(beta,)
)
moment_alpha = Quantity(
    "moment_alpha", r"K_{M,\alpha}", "1", "factor of the moment by the angle of attack", depends_on=(alpha,)
)
damping_mach = Quantity(
    "damping_mach", "K_{q,M}", "1", "factor of the pitch damping by the Mach number", depends_on=(mach,)
)
damping_alpha = Quantity(
    "damping_alpha", r"K_{q,\alpha}", "1/rad", "factor of the pitch damping by the angle of attack", depends_on=(alpha,)
)

elevator_lift = Choice(
    "elevator_lift",
    "ElevatorLift",
    "lift of the elevator",
    (switch("elevator_lifts", "s_e", "share of the elevator's lift in the lift: 1 with it, 0 without"),),
    (
        Option("none", "the elevator gives a moment alone, as Wang and Stengel have it", (0.0,)),
        Option("fitted", "the elevator lifts as fitted", (1.0,)),
    ),
)

family = Family()
family.parameters("vehicle", m, I_yy, S, c_bar)
family.parameters("engine", zeta, omega)
family.parameters("environment", rho_0, h_s, R_E, mu)
family.parameters("coefficients", C_D_scale, C_T_scale, C_M_scale, C_M_limit, M_s, C_M_e)
family.choices(elevator_lift)
family.quantities(
    a,
    C_L_alpha,
    C_L_elevator,
    drag_alpha,
    drag_mach,
    thrust_mach,
    thrust_beta,
    thrust_beta_high,
    moment_alpha,
    damping_mach,
    damping_alpha,
)
family.bounds(*STATES, *INPUTS)


def define_coefficients(model: Model) -> tuple[Expr, Expr, Expr, Expr]:
    """Coefficients of lift, drag, thrust and pitching moment."""
    V, Q, elevator = model.symbols(velocity, pitch_rate, delta_e)
    # With that of a gust, if one joins.
    incidence = model.seen(alpha)
    with model.section("Mach number", "(2)"):
        sound = model.fit(a)
        model.define(mach, V / sound)
        model.define(inverse_mach, sound / V)
    with model.section("Coefficients", "(3)"):
        lifting = model["elevator_lifts"] * model.fit(C_L_elevator)
        lift = model.fit(C_L_alpha) * incidence + lifting * elevator
        drag = model[C_D_scale] * model.fit(drag_alpha) * model.fit(drag_mach)
        by_throttle = select(model[beta] < 1, model.fit(thrust_beta), model.fit(thrust_beta_high))
        doc = "factor of the thrust by the throttle"
        by_throttle = model.define("thrust_throttle", by_throttle, r"K_T(\beta)", "1", doc)
        thrust = model[C_T_scale] * model.fit(thrust_mach) * by_throttle
        by_mach = model[C_M_limit] - exp(-model[mach] / model[M_s])
        by_mach = model.define("moment_mach", by_mach, "K_{M,M}", "1", "factor of the moment by the Mach number")
        damping = model[c_bar] * Q / (2 * V) * model.fit(damping_mach) * model.fit(damping_alpha)
        moment = model[C_M_scale] * by_mach * model.fit(moment_alpha) + damping + model[C_M_e] * (elevator - incidence)
        return (
            model.define("c_l", lift, "C_L", "1", "lift coefficient"),
            model.define("c_d", drag, "C_D", "1", "drag coefficient"),
            model.define("c_t", thrust, "C_T", "1", "thrust coefficient"),
            model.define("c_m", moment, "C_M", "1", "pitching-moment coefficient"),
        )


@family.model("wang_stengel", "winged cone with Mach number", "(1)-(5)", states=STATES, inputs=INPUTS)
def wang_stengel(model: Model) -> None:
    """The equations, section by section."""
    V, h, path, incidence, Q = model.symbols(velocity, altitude, gamma, alpha, pitch_rate)
    throttle, throttle_rate, command = model.symbols(beta, beta_rate, beta_command)
    with model.section("Air and gravity", "(1)"):
        density = model.define("density", model[rho_0] * exp(-h / model[h_s]), r"\rho", "slug/ft^3", "air density")
        pressure = model.define("dynamic_pressure", density * V**2 / 2, r"\bar q", "lb/ft^2", "dynamic pressure")
        radius = model.define("radius", model[R_E] + h, "r", "ft", "distance to the centre of the Earth")
        gravity = model.define("gravity", model[mu] / radius**2, "g(h)", "ft/s^2", "acceleration of gravity")
    c_l, c_d, c_t, c_m = define_coefficients(model)
    with model.section("Forces and moment", "(4)"):
        force = model.define("reference_force", pressure * model[S], r"\bar q S", "lb", "dynamic pressure times area")
        lift = model.define("lift", force * c_l, "L", "lb", "lift")
        drag = model.define("drag", force * c_d, "D", "lb", "drag")
        thrust = model.define("thrust", force * c_t, "T", "lb", "thrust")
        moment = model.define("pitching_moment", force * model[c_bar] * c_m, "M", "ft*lb", "pitching moment")
    with model.section("Motion", "(5)"):
        theta = model.define("theta", path + incidence, r"\theta", "rad", "pitch angle")
        turn = (lift + thrust * sin(incidence)) / (model[m] * V) - (gravity / V - V / radius) * cos(path)
        turn = model.define("gamma_rate", turn, r"\dot\gamma", "rad/s", "turn rate")
        model.motion(
            {
                velocity: (thrust * cos(incidence) - drag) / model[m] - gravity * sin(path),
                altitude: V * sin(path),
                gamma: turn,
                alpha: Q - turn,
                pitch_rate: moment / model[I_yy],
                beta: throttle_rate,
                beta_rate: model[omega] ** 2 * (command - throttle) - 2 * model[zeta] * model[omega] * throttle_rate,
            }
        )
    model.outputs(theta, model[mach], density, pressure, lift, drag, thrust, moment)
    state_traits(model)


def state_traits(model: Model) -> None:
    """Trim, modes, and what commands take if nobody says otherwise."""
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
        shown=[alpha, beta, beta_command, delta_e, mach],
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
