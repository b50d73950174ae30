"""What a table may hold: sections, parameters, quantities and the variables of their monomials."""

from __future__ import annotations

from dataclasses import dataclass

STATUSES = ("published", "derived", "unverified", "assumed")
FLEXIBLE = "(ft*slug)^0.5"  # ft·(slug/ft)^½, a mass-normalised modal coordinate


@dataclass(frozen=True)
class ParameterSpec:
    """A parameter that a model needs, by its key in the table."""

    key: str
    symbol: str
    unit: str
    doc: str
    lowest: float = float("-inf")
    positive: bool = False


@dataclass(frozen=True)
class QuantitySpec:
    """A curve-fitted quantity: its unit, and the variables that eq. (2) lets it depend on."""

    key: str
    symbol: str
    unit: str
    doc: str
    variables: tuple[str, ...]
    required: tuple[str, ...] = ()


@dataclass(frozen=True)
class VariableSpec:
    """A state, an input or a Wiener increment."""

    name: str
    symbol: str
    unit: str
    doc: str
    validity: str | None = None


VEHICLE = (
    ParameterSpec("m", "m", "slug/ft", "vehicle mass", positive=True),
    ParameterSpec("I_yy", "I_{yy}", "slug*ft", "pitch moment of inertia", positive=True),
    ParameterSpec("S", "S", "ft", "reference area", positive=True),
    ParameterSpec("c_bar", r"\bar c", "ft", "mean aerodynamic chord", positive=True),
    ParameterSpec("z_T", "z_T", "ft", "thrust-to-moment coupling arm"),
)
CANARD = (ParameterSpec("canard_slaving", "s_c", "1", "share of law (4) in the canard deflection: 1 slaved, 0 free"),)
ENVIRONMENT = (
    ParameterSpec("rho_0", r"\rho_0", "slug/ft^3", "air density at the reference altitude", positive=True),
    ParameterSpec("h_0", "h_0", "ft", "reference altitude of the air density"),
    ParameterSpec("h_s", "h_s", "ft", "scale height of the air density", positive=True),
    ParameterSpec("g", "g", "ft/s^2", "acceleration of gravity at sea level", positive=True),
    ParameterSpec("R_E", "R_E", "ft", "radius of the Earth", positive=True),
    ParameterSpec("spherical_earth", "s_E", "1", "share of the Earth's curvature in the motion: 1 spherical, 0 flat"),
)
RIGID_NOISE = (
    ParameterSpec("w_gamma", r"\sigma_{w_\gamma}", "rad*s^0.5", "intensity of the white noise w_gamma", lowest=0.0),
    ParameterSpec("w_alpha", r"\sigma_{w_\alpha}", "rad*s^0.5", "intensity of the white noise w_alpha", lowest=0.0),
    ParameterSpec("w_q", r"\sigma_{w_Q}", "rad/s^0.5", "intensity of the white noise w_Q", lowest=0.0),
)

RIGID_STATE = (
    VariableSpec("velocity", "V", "ft/s", "velocity", "velocity"),
    VariableSpec("altitude", "h", "ft", "altitude", "altitude"),
    VariableSpec("gamma", r"\gamma", "rad", "flight-path angle", "gamma"),
    VariableSpec("alpha", r"\alpha", "rad", "angle of attack", "alpha"),
    VariableSpec("pitch_rate", "Q", "rad/s", "pitch rate", "pitch_rate"),
)
PHI = VariableSpec("phi", r"\phi", "1", "fuel equivalence ratio", "phi")
DELTA_E = VariableSpec("delta_e", r"\delta_e", "rad", "elevator deflection", "delta_e")
DELTA_C = VariableSpec("delta_c", r"\delta_c", "rad", "canard deflection", "delta_c")


def modal_parameters(modes: int) -> tuple[ParameterSpec, ...]:
    """Frequencies and damping ratios of the flexible modes."""
    omega = [
        ParameterSpec(f"omega_{i}", rf"\omega_{i}", "rad/s", f"natural frequency of mode {i}", positive=True)
        for i in range(1, modes + 1)
    ]
    zeta = [
        ParameterSpec(f"zeta_{i}", rf"\zeta_{i}", "1", f"damping ratio of mode {i}", lowest=0.0)
        for i in range(1, modes + 1)
    ]
    return (*omega, *zeta)


def noise_parameters(modes: int) -> tuple[ParameterSpec, ...]:
    """Noise intensities of the flexible modes, then of the rigid body."""
    sigma = tuple(
        ParameterSpec(
            f"sigma_{i}", rf"\sigma_{i}", f"{FLEXIBLE}/s^1.5", f"intensity of the noise on mode {i}", lowest=0.0
        )
        for i in range(1, modes + 1)
    )
    return sigma + RIGID_NOISE


def eta_names(modes: int) -> tuple[str, ...]:
    """Names of the flexible generalized coordinates."""
    return tuple(f"eta_{i}" for i in range(1, modes + 1))


@dataclass(frozen=True)
class Schema:
    """The sections, quantities and validity entries of one family of models."""

    models: tuple[str, ...]
    modes: int
    parameters: dict[str, tuple[ParameterSpec, ...]]
    quantities: tuple[QuantitySpec, ...]
    validity: tuple[VariableSpec, ...]

    def variable_units(self) -> dict[str, str]:
        """Units of the variables of the monomials."""
        units = {v.name: v.unit for v in (*RIGID_STATE, PHI, DELTA_E, DELTA_C)}
        return units | dict.fromkeys(eta_names(self.modes), FLEXIBLE)


def com_schema() -> Schema:
    """COM, rigid part: thrust is fitted in lb/ft."""
    aero = ("alpha", "delta_e")
    return Schema(
        models=("com",),
        modes=0,
        parameters={"vehicle": VEHICLE, "environment": ENVIRONMENT},
        quantities=(
            QuantitySpec("T", "T", "lb/ft", "thrust", ("phi", "alpha")),
            QuantitySpec("C_L", "C_L", "1", "lift coefficient", aero),
            QuantitySpec("C_D", "C_D", "1", "drag coefficient", aero),
            QuantitySpec("C_M", "C_M", "1", "pitching-moment coefficient", aero),
        ),
        validity=(*RIGID_STATE, PHI, DELTA_E),
    )


def dcom_schema(modes: int) -> Schema:
    """DCOM and SDCOM: thrust is a coefficient, `modes` flexible modes."""
    eta = eta_names(modes)
    control = ("alpha", "delta_e", "delta_c")
    generalized = tuple(
        QuantitySpec(
            f"C_N_{i}",
            rf"C_{{N_{i}}}",
            "(ft/slug)^0.5",
            f"generalized-force coefficient of mode {i}",
            control,
        )
        for i in range(1, modes + 1)
    )
    return Schema(
        models=("dcom", "sdcom"),
        modes=modes,
        parameters={
            "vehicle": VEHICLE + CANARD,
            "environment": ENVIRONMENT,
            "modes": modal_parameters(modes),
            "noise": noise_parameters(modes),
        },
        quantities=(
            QuantitySpec("C_T", "C_T", "1", "thrust coefficient", ("phi", "alpha", *eta)),
            QuantitySpec("C_L", "C_L", "1", "lift coefficient", (*control, *eta), ("delta_e", "delta_c")),
            QuantitySpec("C_D", "C_D", "1", "drag coefficient", (*control, *eta)),
            QuantitySpec("C_M", "C_M", "1", "pitching-moment coefficient", (*control, *eta)),
            *generalized,
        ),
        validity=(
            *RIGID_STATE,
            VariableSpec("eta", r"\eta", FLEXIBLE, "flexible generalized coordinate"),
            VariableSpec("eta_dot", r"\dot\eta", f"{FLEXIBLE}/s", "rate of the flexible generalized coordinate"),
            VariableSpec("chi", r"\chi", FLEXIBLE, "coloured noise of a flexible mode"),
            PHI,
            DELTA_E,
            DELTA_C,
        ),
    )
