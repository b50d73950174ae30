"""What is true of every vehicle besides its equations: states and inputs, parameters, steady flight, modes."""

from __future__ import annotations

import math

from ..schema import POSITIVE, Choice, Option, ParameterSpec, VariableSpec, switch
from ..traits import Equation, Given, Mode, Sought, Traits, Trim

RIGID_STATE = (
    VariableSpec("velocity", "V", "ft/s", "velocity", "velocity"),
    VariableSpec("altitude", "h", "ft", "altitude", "altitude"),
    VariableSpec("gamma", r"\gamma", "rad", "flight-path angle", "gamma"),
    VariableSpec("alpha", r"\alpha", "rad", "angle of attack", "alpha"),
    VariableSpec("pitch_rate", "Q", "rad/s", "pitch rate", "pitch_rate"),
)
PHI = VariableSpec("phi", r"\phi", "1", "fuel equivalence ratio", "phi")
DELTA_E = VariableSpec("delta_e", r"\delta_e", "rad", "elevator deflection", "delta_e")

VEHICLE = (
    ParameterSpec("m", "m", "slug/ft", "vehicle mass", POSITIVE),
    ParameterSpec("I_yy", "I_{yy}", "slug*ft", "pitch moment of inertia", POSITIVE),
    ParameterSpec("S", "S", "ft", "reference area", POSITIVE),
    ParameterSpec("c_bar", r"\bar c", "ft", "mean aerodynamic chord", POSITIVE),
    ParameterSpec("z_T", "z_T", "ft", "thrust-to-moment coupling arm"),
)
ENVIRONMENT = (
    ParameterSpec("rho_0", r"\rho_0", "slug/ft^3", "air density at the reference altitude", POSITIVE),
    ParameterSpec("h_0", "h_0", "ft", "reference altitude of the air density"),
    ParameterSpec("h_s", "h_s", "ft", "scale height of the air density", POSITIVE),
    ParameterSpec("g", "g", "ft/s^2", "acceleration of gravity at sea level", POSITIVE),
    ParameterSpec("R_E", "R_E", "ft", "radius of the Earth", POSITIVE),
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


def vehicle_traits(*modes: Mode) -> Traits:
    """Steady flight on a straight path, modes besides those of the rigid body, and deviations that cost alike.

    Two rows of the drift are no equations: `altitude`, which is V sin(gamma) whatever the unknowns, and `alpha`, which
    at zero pitch rate is the row `gamma` again. The rate of the velocity weighs as V times that of gamma, for both are
    accelerations; flexible rows weigh more, so that where there is no trim the rigid body is off balance, not a mode.
    """
    flexible = [state for mode in modes for state in mode.states]
    numbers = [mode.name.rpartition(" ")[2] for mode in modes]
    return Traits(
        trim=Trim(
            given=(
                Given("velocity", 7702.0808, above=0.0),
                Given("altitude", 85000.0),
                Given("gamma", 0.0, -math.pi / 2, math.pi / 2),
            ),
            sought=(
                Sought("alpha", scale=0.1),
                *(Sought(name) for name in flexible),
                Sought("phi", 0.25, 0.1),
                Sought("delta_e", 0.2, 0.1),
            ),
            equations=(
                Equation("velocity", like=("gamma", "velocity")),
                Equation("gamma"),
                Equation("pitch_rate"),
                *(Equation(name, weight=100.0) for name in flexible),
            ),
            moving=("altitude",),
            # A mode is told by its coordinate, be it a state or what coloured noise stands for.
            shown=("alpha", "phi", "delta_e", *(f"eta_{number}" for number in numbers if number.isdigit())),
        ),
        modes=(
            Mode("phugoid", ("velocity", "altitude", "gamma"), "height"),
            Mode("short period", ("alpha", "pitch_rate")),
            *modes,
        ),
        inputs=("phi", "delta_e"),
        outputs=("velocity", "gamma"),
        deviations={
            "velocity": 10.0,
            "altitude": 100.0,
            "gamma": 0.01,
            "alpha": 0.02,
            "pitch_rate": 0.05,
            "phi": 0.2,
            "delta_e": 0.05,
        },
    )
