"""What is true of every vehicle besides its equations: states and inputs, parameters, steady flight, modes."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ..modelling import POSITIVE, Choice, Equation, Given, Model, Option, Parameter, Sought, Variable, switch

VELOCITY, ALTITUDE, GAMMA, ALPHA, PITCH_RATE = RIGID_STATE = (
    Variable("velocity", "V", "ft/s", "velocity"),
    Variable("altitude", "h", "ft", "altitude"),
    Variable("gamma", r"\gamma", "rad", "flight-path angle"),
    Variable("alpha", r"\alpha", "rad", "angle of attack"),
    Variable("pitch_rate", "Q", "rad/s", "pitch rate"),
)
PHI = Variable("phi", r"\phi", "1", "fuel equivalence ratio")
DELTA_E = Variable("delta_e", r"\delta_e", "rad", "elevator deflection")

VEHICLE = (
    Parameter("m", "m", "slug/ft", "vehicle mass", POSITIVE),
    Parameter("I_yy", "I_{yy}", "slug*ft", "pitch moment of inertia", POSITIVE),
    Parameter("S", "S", "ft", "reference area", POSITIVE),
    Parameter("c_bar", r"\bar c", "ft", "mean aerodynamic chord", POSITIVE),
    Parameter("z_T", "z_T", "ft", "thrust-to-moment coupling arm"),
)
ENVIRONMENT = (
    Parameter("rho_0", r"\rho_0", "slug/ft^3", "air density at the reference altitude", POSITIVE),
    Parameter("h_0", "h_0", "ft", "reference altitude of the air density"),
    Parameter("h_s", "h_s", "ft", "scale height of the air density", POSITIVE),
    Parameter("g", "g", "ft/s^2", "acceleration of gravity at sea level", POSITIVE),
    Parameter("R_E", "R_E", "ft", "radius of the Earth", POSITIVE),
)
EARTH = Choice(
    "earth",
    "Earth",
    "Earth",
    (switch("spherical_earth", "s_E", "share of the Earth's curvature in the motion: 1 spherical, 0 flat"),),
    (
        Option("flat", "gravity is constant and the path is straight, as (1) has it", (0.0,)),
        Option("spherical", "gravity falls with altitude, and flight follows the curvature", (1.0,)),
    ),
)


def steady_flight(model: Model, modes: Mapping[str, tuple[str, ...]]) -> None:
    """Steady flight on a straight path; the modes, those of the rigid body and `modes`; deviations that cost alike.

    Two rows of the drift are no equations: `altitude`, which is V sin(gamma) whatever the unknowns, and `alpha`, which
    at zero pitch rate is the row `gamma` again. The rate of the velocity weighs as V times that of gamma, for both are
    accelerations; flexible rows weigh more, so that where there is no trim the rigid body is off balance, not a mode.
    """
    flexible = [state for states in modes.values() for state in states]
    numbers = [name.rpartition(" ")[2] for name in modes]
    model.trim(
        given=[
            Given(VELOCITY, 7702.0808, above=0.0),
            Given(ALTITUDE, 85000.0),
            Given(GAMMA, 0.0, -math.pi / 2, math.pi / 2),
        ],
        sought=[
            Sought(ALPHA, scale=0.1),
            *(Sought(name) for name in flexible),
            Sought(PHI, 0.25, 0.1),
            Sought(DELTA_E, 0.2, 0.1),
        ],
        equations=[
            Equation(VELOCITY, like=(GAMMA, VELOCITY)),
            Equation(GAMMA),
            Equation(PITCH_RATE),
            *(Equation(name, weight=100.0) for name in flexible),
        ],
        moving=[ALTITUDE],
        # A mode is shown by its coordinate, be it a state or the quantity in the place of one.
        shown=[ALPHA, PHI, DELTA_E, *(f"eta_{number}" for number in numbers if number.isdigit())],
    )
    model.mode("phugoid", VELOCITY, ALTITUDE, GAMMA, slowest="height")
    model.mode("short period", ALPHA, PITCH_RATE)
    for name, states in modes.items():
        model.mode(name, *states)
    model.defaults(inputs=[PHI, DELTA_E], outputs=[VELOCITY, GAMMA])
    model.deviations(
        {VELOCITY: 10.0, ALTITUDE: 100.0, GAMMA: 0.01, ALPHA: 0.02, PITCH_RATE: 0.05, PHI: 0.2, DELTA_E: 0.05}
    )
