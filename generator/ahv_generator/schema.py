"""What a table may hold: sections, parameters, quantities and the variables of their monomials."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

STATUSES = ("published", "derived", "unverified", "assumed")
FLEXIBLE = "(ft*slug)^0.5"  # ft·(slug/ft)^½, a mass-normalised modal coordinate


POSITIVE, NOT_NEGATIVE, NOT_ZERO = "positive", "not_negative", "not_zero"
_IN_WORDS = {POSITIVE: "must be positive", NOT_NEGATIVE: "must not be negative", NOT_ZERO: "must not be zero"}


@dataclass(frozen=True)
class Rule:
    """What the parameters must keep: a polynomial in them is positive, not negative or not zero.

    A term is a factor and the names of parameters that multiply it. A fault is told at the first of them.
    """

    name: str
    terms: tuple[tuple[float, tuple[str, ...]], ...]
    must: str
    reason: str

    def holds(self, values: Mapping[str, float]) -> bool:
        """Whether parameters of these values keep the rule; one that is not a number does not."""
        # A product overflows to infinity, a power to an exception.
        value = sum(factor * math.prod(values[name] for name in names) for factor, names in self.terms)
        return {POSITIVE: value > 0, NOT_NEGATIVE: value >= 0, NOT_ZERO: value != 0}[self.must]

    def parameters(self) -> tuple[str, ...]:
        """The parameters that it is about, the one at which a fault is told first."""
        return tuple(dict.fromkeys(name for _, names in self.terms for name in names))


@dataclass(frozen=True)
class ParameterSpec:
    """A parameter that a model needs, by its key in the table."""

    key: str
    symbol: str
    unit: str
    doc: str
    must: str | None = None

    @property
    def name(self) -> str:
        """Its name in the generated code."""
        return self.key.lower()

    def rules(self) -> tuple[Rule, ...]:
        """Its range."""
        if self.must is None:
            return ()
        reason = f"`{self.key}` ({self.doc}) {_IN_WORDS[self.must]}"
        return (Rule(self.must.replace("_", "-"), ((1.0, (self.name,)),), self.must, reason),)


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
    ParameterSpec("m", "m", "slug/ft", "vehicle mass", must=POSITIVE),
    ParameterSpec("I_yy", "I_{yy}", "slug*ft", "pitch moment of inertia", must=POSITIVE),
    ParameterSpec("S", "S", "ft", "reference area", must=POSITIVE),
    ParameterSpec("c_bar", r"\bar c", "ft", "mean aerodynamic chord", must=POSITIVE),
    ParameterSpec("z_T", "z_T", "ft", "thrust-to-moment coupling arm"),
)
ENVIRONMENT = (
    ParameterSpec("rho_0", r"\rho_0", "slug/ft^3", "air density at the reference altitude", must=POSITIVE),
    ParameterSpec("h_0", "h_0", "ft", "reference altitude of the air density"),
    ParameterSpec("h_s", "h_s", "ft", "scale height of the air density", must=POSITIVE),
    ParameterSpec("g", "g", "ft/s^2", "acceleration of gravity at sea level", must=POSITIVE),
    ParameterSpec("R_E", "R_E", "ft", "radius of the Earth", must=POSITIVE),
)
RIGID_NOISE = (
    ParameterSpec("w_gamma", r"\sigma_{w_\gamma}", "rad*s^0.5", "intensity of the white noise w_gamma", must=NOT_NEGATIVE),
    ParameterSpec("w_alpha", r"\sigma_{w_\alpha}", "rad*s^0.5", "intensity of the white noise w_alpha", must=NOT_NEGATIVE),
    ParameterSpec("w_q", r"\sigma_{w_Q}", "rad/s^0.5", "intensity of the white noise w_Q", must=NOT_NEGATIVE),
)

GUST = (
    ParameterSpec("gust_rms", r"\sigma_g", "rad", "root mean square of the gust incidence", must=NOT_NEGATIVE),
    ParameterSpec("gust_time", r"\tau_g", "s", "correlation time of the gust incidence", must=POSITIVE),
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
    return tuple(_frequency(f"_{i}", f" of mode {i}") for i in range(1, modes + 1)) + tuple(
        _damping(f"_{i}", f" of mode {i}") for i in range(1, modes + 1)
    )


def coupling_parameters(modes: int) -> tuple[ParameterSpec, ...]:
    """Inertial couplings of cantilever modes with the pitching motion."""
    return tuple(
        ParameterSpec(f"psi_{i}", rf"\psi_{i}", FLEXIBLE, f"inertial coupling of mode {i} with the pitch rate")
        for i in range(1, modes + 1)
    )


def _frequency(suffix: str, of: str) -> ParameterSpec:
    return ParameterSpec(f"omega{suffix}", rf"\omega{suffix}", "rad/s", f"natural frequency{of}", must=POSITIVE)


def _damping(suffix: str, of: str) -> ParameterSpec:
    return ParameterSpec(f"zeta{suffix}", rf"\zeta{suffix}", "1", f"damping ratio{of}", must=POSITIVE)


def _intensity(suffix: str, of: str) -> ParameterSpec:
    unit = f"{FLEXIBLE}/s^1.5"
    return ParameterSpec(f"sigma{suffix}", rf"\sigma{suffix}", unit, f"intensity of the white noise{of}", must=NOT_NEGATIVE)


def noise_parameters(modes: int) -> tuple[ParameterSpec, ...]:
    """Noise intensities of the flexible modes, then of the rigid body."""
    return tuple(_intensity(f"_{i}", f" on mode {i}") for i in range(1, modes + 1)) + RIGID_NOISE


def eta_names(modes: int) -> tuple[str, ...]:
    """Names of the flexible generalized coordinates."""
    return tuple(f"eta_{i}" for i in range(1, modes + 1))


@dataclass(frozen=True)
class Option:
    """One way to choose, and the values of the switches that it sets."""

    name: str
    doc: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class Choice:
    """A key of `[choices]`, its type in the generated code, its switches and its options."""

    name: str
    type_name: str
    doc: str
    switches: tuple[ParameterSpec, ...]
    options: tuple[Option, ...]


def _switch(key: str, symbol: str, doc: str) -> ParameterSpec:
    return ParameterSpec(key, symbol, "1", doc)


CANARD = Choice(
    "canard",
    "Canard",
    "canard",
    (
        _switch("canard_command", "s_{cc}", "share of the commanded canard deflection: 1 canard free, else 0"),
        _switch("canard_slaving", "s_c", "share of law (4) in the canard deflection: 1 canard slaved, else 0"),
    ),
    (
        Option("free", "the canard deflection is an input", (1.0, 0.0)),
        Option("slaved", "the canard follows the elevator by law (4)", (0.0, 1.0)),
        Option("none", "there is no canard", (0.0, 0.0)),
    ),
)
EARTH = Choice(
    "earth",
    "Earth",
    "Earth",
    (_switch("spherical_earth", "s_E", "share of the Earth's curvature in the motion: 1 spherical, 0 flat"),),
    (
        Option("flat", "gravity is constant and the path is straight, as (1) has it", (0.0,)),
        Option("spherical", "gravity falls with altitude, and flight follows the curvature", (1.0,)),
    ),
)
NOISE = Choice(
    "noise",
    "ModalNoise",
    "noise of the flexible modes",
    (_switch("shared_noise", r"\rho_\xi", "correlation of the noise of modes 2, 3, ... with that of mode 1"),),
    (
        Option("independent", "every mode has a white noise of its own", (0.0,)),
        Option("shared", "one white noise drives all modes, as (16) has it", (1.0,)),
    ),
)
REDUCTION = Choice(
    "reduction",
    "Reduction",
    "reduction of a flexible mode to coloured noise",
    (
        _switch("variance_matching", "s_v", "share of the reduction that matches decay rate and variance"),
        _switch("moment_matching", "s_m", "share of the reduction that matches variance and gain at zero frequency"),
    ),
    (
        Option("printed", "decay rate and gain at zero frequency, as (23) has it; the variance is off", (0.0, 0.0)),
        Option("variance", "decay rate and variance; the spectrum at zero frequency is off", (1.0, 0.0)),
        Option("moment", "variance and spectrum at zero frequency; fast for small damping", (0.0, 1.0)),
    ),
)


@dataclass(frozen=True)
class Schema:
    """The sections, quantities and validity entries of one family of models."""

    models: tuple[str, ...]
    modes: int
    parameters: dict[str, tuple[ParameterSpec, ...]]
    choices: tuple[Choice, ...]
    quantities: tuple[QuantitySpec, ...]
    validity: tuple[VariableSpec, ...]
    rules_of_family: tuple[Rule, ...] = ()

    def rules(self) -> tuple[Rule, ...]:
        """The ranges of the parameters, then the rules that are about more."""
        ranges = (rule for group in self.parameters.values() for spec in group for rule in spec.rules())
        return (*ranges, *self.rules_of_family)

    def variable_units(self) -> dict[str, str]:
        """Units of the variables of the monomials."""
        units = {v.name: v.unit for v in (*RIGID_STATE, PHI, DELTA_E, DELTA_C)}
        return units | dict.fromkeys(eta_names(self.modes), FLEXIBLE)


COM_FAMILY = ("com", "com_rigid")
DCOM_FAMILY = ("dcom", "sdcom", "sdcom_printed", "sdcom_gust")
MODE_FAMILY = ("flexible_mode",)
FAMILIES = (COM_FAMILY, DCOM_FAMILY, MODE_FAMILY)

_ETA = VariableSpec("eta", r"\eta", FLEXIBLE, "flexible generalized coordinate")
_ETA_DOT = VariableSpec("eta_dot", r"\dot\eta", f"{FLEXIBLE}/s", "rate of the flexible generalized coordinate")
_CHI = VariableSpec("chi", r"\chi", FLEXIBLE, "coloured noise of a flexible mode")
ALPHA_GUST = VariableSpec("alpha_gust", r"\alpha_g", "rad", "incidence of the gust", "alpha_gust")
FORCE = VariableSpec("force", "N", f"{FLEXIBLE}/s^2", "generalized force", "force")


def com_schema(models: tuple[str, ...]) -> Schema:
    """COM: thrust is fitted in lb/ft; with two cantilever modes unless the rigid body alone is wanted."""
    aero = ("alpha", "delta_e")
    modes = 2 if "com" in models else 0
    flexible: dict[str, tuple[ParameterSpec, ...]] = {
        "modes": modal_parameters(modes) + coupling_parameters(modes),
    }
    forces = tuple(
        QuantitySpec(f"N_{i}", f"N_{i}", f"{FLEXIBLE}/s^2", f"generalized force of mode {i}", aero)
        for i in range(1, modes + 1)
    )
    return Schema(
        models=COM_FAMILY,
        modes=modes,
        parameters={"vehicle": VEHICLE, "environment": ENVIRONMENT} | (flexible if modes else {}),
        choices=(EARTH,),
        quantities=(
            QuantitySpec("T", "T", "lb/ft", "thrust", ("phi", "alpha")),
            QuantitySpec("C_L", "C_L", "1", "lift coefficient", aero),
            QuantitySpec("C_D", "C_D", "1", "drag coefficient", aero),
            QuantitySpec("C_M", "C_M", "1", "pitching-moment coefficient", aero),
            *forces,
        ),
        validity=(*RIGID_STATE, *((_ETA, _ETA_DOT) if modes else ()), PHI, DELTA_E),
        rules_of_family=(_mass_matrix(modes),) if modes else (),
    )


def _mass_matrix(modes: int) -> Rule:
    couplings = tuple((-1.0, (f"psi_{i}", f"psi_{i}")) for i in range(1, modes + 1))
    reason = "`I_yy` must exceed the sum of the squares of `psi_i`: no mass matrix is like this"
    return Rule("mass-matrix", ((1.0, ("i_yy",)), *couplings), POSITIVE, reason)


def dcom_schema(models: tuple[str, ...], modes: int) -> Schema:
    """DCOM and SDCOM: thrust is a coefficient, `modes` flexible modes."""
    eta = eta_names(modes)
    control = ("alpha", "delta_e", "delta_c")
    gust = "sdcom_gust" in models
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
        models=DCOM_FAMILY,
        modes=modes,
        parameters={
            "vehicle": VEHICLE,
            "environment": ENVIRONMENT,
            "modes": modal_parameters(modes),
            "noise": noise_parameters(modes) + (GUST if gust else ()),
        },
        choices=(CANARD, EARTH, NOISE, REDUCTION),
        quantities=(
            QuantitySpec("C_T", "C_T", "1", "thrust coefficient", ("phi", "alpha", *eta)),
            QuantitySpec("C_L", "C_L", "1", "lift coefficient", (*control, *eta), ("delta_e", "delta_c")),
            QuantitySpec("C_D", "C_D", "1", "drag coefficient", (*control, *eta)),
            QuantitySpec("C_M", "C_M", "1", "pitching-moment coefficient", (*control, *eta)),
            *generalized,
        ),
        validity=(*RIGID_STATE, _ETA, _ETA_DOT, _CHI, *((ALPHA_GUST,) if gust else ()), PHI, DELTA_E, DELTA_C),
        rules_of_family=(
            Rule("not-zero", ((1.0, ("c_l_delta_c",)),), NOT_ZERO, "law (4) divides by the C_L of `delta_c`"),
        ),
    )


def mode_schema() -> Schema:
    """One flexible mode and its reduction, by themselves."""
    return Schema(
        models=MODE_FAMILY,
        modes=1,
        parameters={"modes": (_frequency("", ""), _damping("", "")), "noise": (_intensity("", ""),)},
        choices=(REDUCTION,),
        quantities=(),
        validity=(_ETA, _ETA_DOT, _CHI, FORCE),
    )
