"""Six degrees of freedom: a rigid winged cone over a flat Earth, with a quaternion. Its table is `six_dof.toml`.

The structure of forces and moments is that of Keshmiri, Colgren and Mirmirani (2005): polynomials in the Mach number,
the angle of attack and the deflections, moments about a centre ahead of the centre of mass. They are smaller.

Position and attitude are relative to axes north, east, down that turn about the vertical at `turn_rate`. With 0 they
are fixed to the Earth. In a steady turn they turn with the vehicle: so a turn is a state of rest, and has poles.
"""

from math import pi

from ahv_generator.modelling import (
    NOT_NEGATIVE,
    POSITIVE,
    Equation,
    Expr,
    Family,
    Given,
    Model,
    Parameter,
    Quantity,
    Rule,
    Sought,
    Variable,
    asin,
    atan2,
    cos,
    exp,
    sin,
)

velocity = Variable("velocity", "V", "m/s", "airspeed")
alpha = Variable("alpha", r"\alpha", "rad", "angle of attack")
beta = Variable("beta", r"\beta", "rad", "sideslip angle")
roll_rate = Variable("roll_rate", "p", "rad/s", "roll rate")
pitch_rate = Variable("pitch_rate", "q", "rad/s", "pitch rate")
yaw_rate = Variable("yaw_rate", "r", "rad/s", "yaw rate")
ATTITUDE = tuple(
    Variable(f"q_{i}", f"q_{i}", "1", f"{part} of the attitude quaternion", bounds="quaternion")
    for i, part in enumerate(("scalar part", "first component", "second component", "third component"))
)
quaternion = Variable("quaternion", "q", "1", "component of the attitude quaternion")
north = Variable("north", "N", "m", "position north")
east = Variable("east", "E", "m", "position east")
altitude = Variable("altitude", "h", "m", "altitude")
STATES = (velocity, alpha, beta, roll_rate, pitch_rate, yaw_rate, *ATTITUDE, north, east, altitude)

throttle = Variable("throttle", r"\delta_T", "1", "throttle setting")
delta_e = Variable("delta_e", r"\delta_e", "rad", "elevator deflection")
delta_a = Variable("delta_a", r"\delta_a", "rad", "aileron deflection")
delta_r = Variable("delta_r", r"\delta_r", "rad", "rudder deflection")
turn_rate = Variable("turn_rate", r"\Omega", "rad/s", "rate at which the axes of position and attitude turn")
CONTROLS = (throttle, delta_e, delta_a, delta_r)
INPUTS = (*CONTROLS, turn_rate)

# Derived variables, in which curve fits may be written like in a state.
mach = Variable("mach", "M", "1", "Mach number")
p_hat = Variable("p_hat", r"\hat p", "rad", "roll rate times span over twice the airspeed")
q_hat = Variable("q_hat", r"\hat q", "rad", "pitch rate times chord over twice the airspeed")
r_hat = Variable("r_hat", r"\hat r", "rad", "yaw rate times span over twice the airspeed")

m = Parameter("m", "m", "kg", "mass", POSITIVE)
I_xx = Parameter("I_xx", "I_{xx}", "kg*m^2", "roll moment of inertia", POSITIVE)
I_yy = Parameter("I_yy", "I_{yy}", "kg*m^2", "pitch moment of inertia", POSITIVE)
I_zz = Parameter("I_zz", "I_{zz}", "kg*m^2", "yaw moment of inertia", POSITIVE)
I_xz = Parameter("I_xz", "I_{xz}", "kg*m^2", "product of inertia")
S = Parameter("S", "S", "m^2", "reference area", POSITIVE)
c_bar = Parameter("c_bar", r"\bar c", "m", "mean aerodynamic chord", POSITIVE)
b = Parameter("b", "b", "m", "span", POSITIVE)
x_cg = Parameter("x_cg", "x_{cg}", "m", "distance of the centre of mass behind the moment reference centre")
rho_0 = Parameter("rho_0", r"\rho_0", "kg/m^3", "air density at sea level", POSITIVE)
h_s = Parameter("h_s", "h_s", "m", "scale height of the air density", POSITIVE)
a = Parameter("a", "a", "m/s", "speed of sound", POSITIVE)
g = Parameter("g", "g", "m/s^2", "acceleration of gravity", POSITIVE)
k_norm = Parameter("k_norm", "k", "1/s", "gain that holds the norm of the quaternion at 1", NOT_NEGATIVE)
inertia = Rule(
    "inertia",
    ((1.0, ("i_xx", "i_zz")), (-1.0, ("i_xz", "i_xz"))),
    POSITIVE,
    "the tensor of inertia must be positive definite: I_xx I_zz > I_xz^2",
)

C_L = Quantity("C_L", "C_L", "1", "lift coefficient", depends_on=(alpha, mach, delta_e))
C_D = Quantity("C_D", "C_D", "1", "drag coefficient", depends_on=(alpha, beta, mach, delta_e, delta_a, delta_r))
C_Y = Quantity("C_Y", "C_Y", "1", "side-force coefficient", depends_on=(beta, mach, delta_a, delta_r))
C_T = Quantity("C_T", "C_T", "1", "thrust coefficient", depends_on=(throttle, mach))
C_R = Quantity("C_R", "C_R", "1", "rolling-moment coefficient", depends_on=(beta, mach, delta_a, delta_r, p_hat, r_hat))
C_M = Quantity("C_M", "C_M", "1", "pitching-moment coefficient", depends_on=(alpha, mach, delta_e, q_hat))
C_N = Quantity("C_N", "C_N", "1", "yawing-moment coefficient", depends_on=(beta, mach, delta_a, delta_r, p_hat, r_hat))

family = Family()
family.parameters("vehicle", m, I_xx, I_yy, I_zz, I_xz, S, c_bar, b, x_cg)
family.parameters("environment", rho_0, h_s, a, g)
family.parameters("kinematics", k_norm)
family.rules(inertia)
family.quantities(C_L, C_D, C_Y, C_T, C_R, C_M, C_N)
family.bounds(velocity, alpha, beta, roll_rate, pitch_rate, yaw_rate, quaternion, north, east, altitude)
family.bounds(*INPUTS)

Triple = tuple[Expr, Expr, Expr]


def dot(one: Triple, other: Triple) -> Expr:
    """The scalar product."""
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def forces(model: Model) -> tuple[Triple, Triple]:
    """Force and moment of air and engine about the centre of mass, along the axes of the body."""
    V, incidence, h = model.symbols(velocity, alpha, altitude)
    with model.section("Air", "(1)"):
        density = model.define("density", model[rho_0] * exp(-h / model[h_s]), r"\rho", "kg/m^3", "air density")
        pressure = model.define("dynamic_pressure", density * V**2 / 2, r"\bar q", "N/m^2", "dynamic pressure")
        model.define(mach, V / model[a])
        model.define(p_hat, model[b] * model[roll_rate] / (2 * V))
        model.define(q_hat, model[c_bar] * model[pitch_rate] / (2 * V))
        model.define(r_hat, model[b] * model[yaw_rate] / (2 * V))
    with model.section("Forces", "(2)"):
        force = model.define("reference_force", pressure * model[S], r"\bar q S", "N", "dynamic pressure times area")
        lift = model.define("lift", force * model.fit(C_L), "L", "N", "lift")
        drag = model.define("drag", force * model.fit(C_D), "D", "N", "drag")
        side = model.define("side_force", force * model.fit(C_Y), "Y", "N", "side force")
        thrust = model.define("thrust", force * model.fit(C_T), "T", "N", "thrust")
        along = thrust - drag * cos(incidence) + lift * sin(incidence)
        along = model.define("axial_force", along, "X", "N", "force along the axis of the body")
        down = -drag * sin(incidence) - lift * cos(incidence)
        down = model.define("normal_force", down, "Z", "N", "force along the third axis of the body")
    with model.section("Moments", "(3)"):
        roll = force * model[b] * model.fit(C_R)
        roll = model.define("rolling_moment", roll, r"\mathcal{L}", "N*m", "rolling moment")
        pitch = force * model[c_bar] * model.fit(C_M) - model[x_cg] * down
        pitch = model.define("pitching_moment", pitch, r"\mathcal{M}", "N*m", "pitching moment")
        yaw = force * model[b] * model.fit(C_N) + model[x_cg] * side
        yaw = model.define("yawing_moment", yaw, r"\mathcal{N}", "N*m", "yawing moment")
    return (along, side, down), (roll, pitch, yaw)


def axes(model: Model) -> tuple[Triple, Triple, Triple]:
    """North, east and down along the axes of the body. Whatever the norm of the quaternion, they are of length 1."""
    q0, q1, q2, q3 = model.symbols(*ATTITUDE)
    norm = model.define("norm_squared", q0**2 + q1**2 + q2**2 + q3**2, "|q|^2", "1", "norm of the quaternion, squared")

    def axis(name: str, index: int, *components: Expr) -> Triple:
        letters = ("x", "y", "z")
        named = (
            model.define(
                f"{name}_{letter}", value / norm, f"R_{{{index}{letter}}}", "1", f"direction {name}, component {letter}"
            )
            for letter, value in zip(letters, components, strict=True)
        )
        return tuple(named)

    return (
        axis("to_north", 1, q0**2 + q1**2 - q2**2 - q3**2, 2 * (q1 * q2 - q0 * q3), 2 * (q1 * q3 + q0 * q2)),
        axis("to_east", 2, 2 * (q1 * q2 + q0 * q3), q0**2 - q1**2 + q2**2 - q3**2, 2 * (q2 * q3 - q0 * q1)),
        axis("downward", 3, 2 * (q1 * q3 - q0 * q2), 2 * (q2 * q3 + q0 * q1), q0**2 - q1**2 - q2**2 + q3**2),
    )


def attitude_rates(model: Model) -> dict[Variable, Expr]:
    """Half the product of the quaternion with the rates, less that of the turning axes; and the norm returns to 1."""
    q0, q1, q2, q3 = model.symbols(*ATTITUDE)
    p, q, r, turn = model.symbols(roll_rate, pitch_rate, yaw_rate, turn_rate)
    back = model.define(
        "norm_return", model[k_norm] * (1 - model["norm_squared"]), "k_q", "1/s", "rate at which the norm returns to 1"
    )
    rates = (
        (-q1 * p - q2 * q - q3 * r + turn * q3) / 2,
        (q0 * p + q2 * r - q3 * q + turn * q2) / 2,
        (q0 * q + q3 * p - q1 * r - turn * q1) / 2,
        (q0 * r + q1 * q - q2 * p - turn * q0) / 2,
    )
    return {part: rate + back * model[part] for part, rate in zip(ATTITUDE, rates, strict=True)}


def rotation_rates(model: Model, moment: Triple) -> dict[Variable, Expr]:
    """Euler's equations of a body whose plane of symmetry is that of x and z."""
    roll, pitch, yaw = moment
    p, q, r, xx, yy, zz, xz = model.symbols(roll_rate, pitch_rate, yaw_rate, I_xx, I_yy, I_zz, I_xz)
    about_x = model.define(
        "roll_torque", roll + (yy - zz) * q * r + xz * p * q, "M_x", "N*m", "rolling moment less the gyroscopic one"
    )
    about_z = model.define(
        "yaw_torque", yaw + (xx - yy) * p * q - xz * q * r, "M_z", "N*m", "yawing moment less the gyroscopic one"
    )
    determinant = model.define("inertia", xx * zz - xz**2, r"\Gamma", "kg^2*m^4", "determinant of inertia")
    return {
        roll_rate: (zz * about_x + xz * about_z) / determinant,
        pitch_rate: (pitch + (zz - xx) * p * r - xz * (p**2 - r**2)) / yy,
        yaw_rate: (xz * about_x + xx * about_z) / determinant,
    }


@family.model("six_dof", "rigid vehicle, six degrees of freedom", "(1)-(6)", states=STATES, inputs=INPUTS)
def six_dof(model: Model) -> None:
    """The equations, section by section."""
    V, incidence, sideslip, p, q, r = model.symbols(*STATES[:6])
    force, moment = forces(model)
    with model.section("Attitude", "(4)"):
        to_north, to_east, downward = axes(model)
        attitude = attitude_rates(model)
    with model.section("Translation", "(5)"):
        path = (cos(incidence) * cos(sideslip), sin(sideslip), sin(incidence) * cos(sideslip))
        ax, ay, az = (
            model.define(f"a_{axis}", one / model[m] + model[g] * below, f"a_{axis}", "m/s^2", f"acceleration, {axis}")
            for axis, one, below in zip("xyz", force, downward, strict=True)
        )
        climb = model.define("climb_rate", -V * dot(downward, path), r"\dot h", "m/s", "climb rate")
        across = (az * cos(incidence) - ax * sin(incidence)) / (V * cos(sideslip))
        side = ay * cos(sideslip) - (ax * cos(incidence) + az * sin(incidence)) * sin(sideslip)
        model_rates = {
            velocity: dot((ax, ay, az), path),
            alpha: q - (p * cos(incidence) + r * sin(incidence)) * sin(sideslip) / cos(sideslip) + across,
            beta: p * sin(incidence) - r * cos(incidence) + side / V,
            north: V * dot(to_north, path) + model[turn_rate] * model[east],
            east: V * dot(to_east, path) - model[turn_rate] * model[north],
            altitude: climb,
        }
    with model.section("Rotation", "(6)"):
        rotation = rotation_rates(model, moment)
        model.motion({**model_rates, **attitude, **rotation})
    with model.section("Outputs"):
        bank = model.define("bank", atan2(downward[1], downward[2]), r"\phi", "rad", "bank angle")
        pitch = model.define("pitch", asin(-downward[0]), r"\theta", "rad", "pitch angle")
        heading = model.define("heading", atan2(to_east[0], to_north[0]), r"\psi", "rad", "heading")
        load = model.define("load_factor", -force[2] / (model[m] * model[g]), "n_z", "1", "load factor")
    forces_and_norm = ("lift", "drag", "side_force", "thrust", "norm_squared")
    model.outputs(bank, pitch, heading, climb, load, mach, "dynamic_pressure", *forces_and_norm)
    describe(model)


def describe(model: Model) -> None:
    """Where it is trimmed, its modes, and what commands take if nobody says otherwise."""
    q0, q1, q2, q3 = ATTITUDE
    model.trim(
        given=[
            Given(velocity, 1500.0, above=0.0),
            Given(altitude, 25000.0),
            Given("bank", 0.0, above=-pi / 2, below=pi / 2),
            Given("climb_rate", 0.0),
            Given(beta, 0.0, above=-pi / 2, below=pi / 2),
        ],
        sought=[
            Sought(alpha, 0.05, 0.1),
            *(Sought(rate, scale=0.1) for rate in (roll_rate, pitch_rate, yaw_rate)),
            Sought(q0, 1.0),
            *(Sought(part) for part in (q1, q2, q3)),
            Sought(throttle, 0.3, 0.1),
            *(Sought(deflection, scale=0.1) for deflection in (delta_e, delta_a, delta_r)),
            Sought(turn_rate, scale=0.1),
        ],
        # It flies north: the position east is at rest.
        equations=[Equation(s) for s in (velocity, alpha, beta, roll_rate, pitch_rate, yaw_rate, *ATTITUDE, east)],
        moving=[north, altitude],
        shown=[alpha, throttle, delta_e, delta_a, delta_r, turn_rate, "load_factor"],
    )
    model.mode("short period", alpha, pitch_rate)
    model.mode("phugoid", velocity, q2, altitude, slowest="speed")
    model.mode("dutch roll", beta, yaw_rate)
    model.mode("roll", roll_rate)
    model.mode("spiral", q1)
    model.mode("heading", q3)
    model.mode("norm of the quaternion", q0)
    model.mode("position", north, east)
    model.defaults(inputs=CONTROLS, outputs=[velocity, altitude, beta, q3])
    model.deviations(
        {
            velocity: 10.0,
            altitude: 100.0,
            alpha: 0.02,
            beta: 0.02,
            roll_rate: 0.1,
            pitch_rate: 0.05,
            yaw_rate: 0.05,
            q1: 0.05,
            q2: 0.02,
            q3: 0.05,
            throttle: 0.2,
            delta_e: 0.1,
            delta_a: 0.1,
            delta_r: 0.1,
        }
    )
