"""One flexible mode and its reduction, (5)-(26), with the closed forms of their responses and moments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from ..derivatives import add_drift_and_derivatives
from ..family import Family
from ..model import Entry, Model, Output
from ..schema import Schema, VariableSpec
from ..stochastic import add_diffusion
from ..table import Table
from ..traits import Equation, Mode, Sought, Traits, Trim
from . import reduction
from .flexible import CHI, ETA, ETA_DOT, FLEXIBLE, FORCE, damping, frequency
from .noise import intensity

GROUP = "moments"
RESPONSE = "responses"
SECTION = "Response of the mode"
VARIANCE = "ft*slug"  # of a flexible coordinate

_INPUT = VariableSpec("force", "N", FORCE, "generalized force", "force")
_STATES = ("eta", "eta_dot", "chi")
TRAITS = Traits(
    trim=Trim(sought=tuple(Sought(name) for name in _STATES), equations=tuple(Equation(name) for name in _STATES)),
    modes=(Mode("flexible", ("eta", "eta_dot")), Mode("coloured noise", ("chi",))),
    inputs=("force",),
    outputs=("eta",),
    deviations={"eta": 1.0, "eta_dot": 1.0, "force": 1.0},
)


def build_flexible_mode(table: Table) -> Model:
    """The mode (17) and the coloured noise (24) in its place, driven by the same white noise."""
    bases = {
        "state": (
            VariableSpec("eta", r"\eta", FLEXIBLE, "flexible generalized coordinate", "eta"),
            VariableSpec(
                "eta_dot", r"\dot\eta", f"{FLEXIBLE}/s", "rate of the flexible generalized coordinate", "eta_dot"
            ),
            VariableSpec("chi", r"\chi", FLEXIBLE, "coloured noise in the place of the coordinate", "chi"),
        ),
        "input": (_INPUT,),
        "noise": (VariableSpec("xi", r"\xi", "s^0.5", "Wiener increment that drives mode and coloured noise"),),
        "argument": (
            VariableSpec("time", "t", "s", "time from the start, or lag"),
            VariableSpec("frequency", r"\Omega", "rad/s", "angular frequency of a spectrum"),
        ),
    }
    title = "a flexible mode and its reduction to coloured noise"
    m = Model("flexible_mode", title, "(5)-(26)", table, bases, TRAITS)
    omega, zeta = m.parameter("omega"), m.parameter("zeta")
    resistance = _define(m, "damping", 2 * zeta * omega, r"2\zeta\omega", "rad/s", "damping of the mode", "(5)")
    stiffness = _define(m, "stiffness", omega**2, r"\omega^2", "rad^2/s^2", "stiffness of the mode", "(5)")
    acceleration = _define(
        m,
        "eta_acceleration",
        m["force"] - resistance * m["eta_dot"] - stiffness * m["eta"],
        r"\ddot\eta",
        f"{FLEXIBLE}/s^2",
        "acceleration of the flexible generalized coordinate",
        "(5)",
    )
    decay = reduction.define_decay(m)
    rates = {"eta": m["eta_dot"], "eta_dot": acceleration, "chi": reduction.define_rate(m, decay)}
    diffusion = reduction.define_diffusion(m)
    add_drift_and_derivatives(m, rates, "(5)")
    gains = {("eta_dot", "xi"): m.parameter("sigma"), ("chi", "xi"): diffusion}
    add_diffusion(m, rates, gains, "mode (17) and coloured noise (24) share one white noise", "(17)")
    _add_reductions(m)
    _add_stationary(m, decay, diffusion)
    static = _define(m, "eta_static", m["force"] / stiffness, r"N/\omega^2", FLEXIBLE, "static coordinate", "(15)")
    for regime in (_underdamped(m), _critical(m), _overdamped(m)):
        _add_responses(m, regime, static, decay)
        _add_moments(m, regime)
    m.add_outputs("eta_static")
    return m


def _define(
    m: Model, name: str, expr: ca.SX, symbol: str, unit: str, doc: str, equation: str, section: str = SECTION
) -> ca.SX:
    return m.graph.define(name, expr, symbol=symbol, unit=unit, doc=doc, equation=equation, section=section)


def _add_reductions(m: Model) -> None:
    """Decay and diffusion of the three reductions, and the stationary variance that each gives."""
    omega, zeta, sigma = (m.parameter(name) for name in ("omega", "zeta", "sigma"))
    true_variance = sigma**2 / (4 * zeta * omega**3)
    reductions = {
        "printed": (
            "decay rate and gain at zero frequency",
            zeta * omega,
            zeta * sigma / omega,
            zeta * sigma**2 / (2 * omega**3),
        ),
        "variance": ("decay rate and variance", zeta * omega, sigma / (ca.sqrt(2) * omega), true_variance),
        "moment": (
            "variance and spectrum at zero frequency",
            omega / (2 * zeta),
            sigma / (2 * zeta * omega),
            true_variance,
        ),
    }
    for name, (matched, decay, diffusion, variance) in reductions.items():
        outputs = [
            Output("decay", (), (Entry((), decay),), "1/s"),
            Output("diffusion", (), (Entry((), diffusion),), f"{FLEXIBLE}/s^0.5"),
        ]
        m.add(f"reduction_{name}", GROUP, f"Decay rate (1/s) and diffusion that match {matched}", "(23)", outputs)
        doc = f"Stationary variance of the coloured noise that matches {matched}"
        m.add_scalar(f"chi_variance_{name}", GROUP, doc, "(24)", variance, VARIANCE)


def _add_stationary(m: Model, decay: ca.SX, diffusion: ca.SX) -> None:
    """Stationary moments and spectra of the mode and of the coloured noise that was chosen."""
    omega, zeta, sigma = (m.parameter(name) for name in ("omega", "zeta", "sigma"))
    time, frequency = m.argument("time"), m.argument("frequency")
    variance = diffusion**2 / (2 * decay)
    spectrum_unit = f"{VARIANCE}*s"
    distance = (omega - frequency) * (omega + frequency)
    scalars = (
        ("eta_variance", "Stationary variance of the mode", sigma**2 / (4 * zeta * omega**3), VARIANCE),
        ("eta_dot_variance", "Stationary variance of its rate", sigma**2 / (4 * zeta * omega), f"{VARIANCE}/s^2"),
        ("chi_variance", "Stationary variance of the coloured noise", variance, VARIANCE),
        (
            "chi_variance_at",
            "Variance of the coloured noise at a time, from rest",
            variance * (1 - ca.exp(-2 * decay * time)),
            VARIANCE,
        ),
        (
            "chi_autocorrelation",
            "Stationary autocorrelation of the coloured noise at a lag",
            variance * ca.exp(-decay * time),
            VARIANCE,
        ),
        (
            "eta_spectrum",
            "Two-sided spectral density of the mode at an angular frequency, for white noise of intensity sigma^2",
            sigma**2 / (distance**2 + (2 * zeta * omega * frequency) ** 2),
            spectrum_unit,
        ),
        (
            "chi_spectrum",
            "Two-sided spectral density of the coloured noise at an angular frequency",
            diffusion**2 / (decay**2 + frequency**2),
            spectrum_unit,
        ),
    )
    for name, doc, expr, unit in scalars:
        m.add_scalar(name, GROUP, doc, "(17)" if name.startswith("eta") else "(24)", expr, unit)


@dataclass(frozen=True)
class _Regime:
    """A range of the damping ratio: its name, and e^{-zeta omega t} times E_11, E_12, E_21, E_22 of (13)."""

    name: str
    condition: str
    transition: tuple[ca.SX, ca.SX, ca.SX, ca.SX]
    variance: ca.SX  # of the mode from rest over its stationary value
    correlation: ca.SX  # stationary, over the variance


def _underdamped(m: Model) -> _Regime:
    omega, zeta, t = m.parameter("omega"), m.parameter("zeta"), m.argument("time")
    root = _define(
        m,
        "damped_ratio",
        ca.sqrt((1 - zeta) * (1 + zeta)),
        r"\sqrt{1-\zeta^2}",
        "1",
        "damped over natural frequency",
        "(13)",
    )
    envelope = _define(
        m, "envelope", ca.exp(-zeta * omega * t), r"e^{-\zeta\omega t}", "1", "decay of the mode", "(14)"
    )
    angle = _define(m, "phase", omega * root * t, r"\omega_d t", "1", "phase of the damped oscillation", "(13)")
    cos = _define(m, "cos_phase", ca.cos(angle), r"\cos\omega_d t", "1", "cosine of the phase", "(13)")
    sin = _define(
        m, "sin_phase", ca.sin(angle) / root, r"\sin(\omega_d t)/\sqrt{1-\zeta^2}", "1", "scaled sine", "(13)"
    )
    transition = (
        envelope * (cos + zeta * sin),
        envelope * sin / omega,
        -envelope * omega * sin,
        envelope * (cos - zeta * sin),
    )
    # sigma^2 times the integral of h^2, h the impulse response, over its limit.
    lost = envelope**2 * (1 + 2 * zeta * sin * cos + 2 * zeta**2 * sin**2)
    return _Regime("underdamped", "zeta < 1", transition, 1 - lost, transition[0])


def _critical(m: Model) -> _Regime:
    omega, t = m.parameter("omega"), m.argument("time")
    angle = _define(m, "scaled_time", omega * t, r"\omega t", "1", "time in radians of the natural frequency", "(13)")
    envelope = _define(
        m, "critical_envelope", ca.exp(-angle), r"e^{-\omega t}", "1", "decay of the critically damped mode", "(14)"
    )
    transition = (envelope * (1 + angle), envelope * t, -envelope * omega * angle, envelope * (1 - angle))
    lost = envelope**2 * (1 + 2 * angle + 2 * angle**2)
    return _Regime("critical", "zeta = 1, whatever zeta says", transition, 1 - lost, transition[0])


def _overdamped(m: Model) -> _Regime:
    omega, zeta, t = m.parameter("omega"), m.parameter("zeta"), m.argument("time")
    root = _define(
        m,
        "overdamped_ratio",
        ca.sqrt((zeta - 1) * (zeta + 1)),
        r"\sqrt{\zeta^2-1}",
        "1",
        "half the distance of the poles over the natural frequency",
        "(13)",
    )
    # The product of the poles is omega^2: the slow one is had from the fast one without cancellation.
    fast = _define(m, "fast_pole", omega * (zeta + root), r"p_1", "1/s", "faster decay rate of the mode", "(13)")
    slow = _define(m, "slow_pole", omega / (zeta + root), r"p_2", "1/s", "slower decay rate of the mode", "(13)")
    quick = _define(m, "fast_envelope", ca.exp(-fast * t), r"e^{-p_1t}", "1", "faster decay", "(14)")
    lasting = _define(m, "slow_envelope", ca.exp(-slow * t), r"e^{-p_2t}", "1", "slower decay", "(14)")
    gap = _define(m, "pole_gap", 2 * omega * root, r"p_1-p_2", "1/s", "distance of the poles", "(13)")
    transition = (
        (fast * lasting - slow * quick) / gap,
        (lasting - quick) / gap,
        (quick - lasting) * omega**2 / gap,
        (fast * quick - slow * lasting) / gap,
    )
    damping = zeta * omega
    even, odd = (lasting + quick) / 2, damping * (lasting - quick) / gap
    lost = quick * lasting + 2 * odd**2 + 2 * odd * even
    return _Regime("overdamped", "zeta > 1", transition, 1 - lost, transition[0])


def _add_responses(m: Model, regime: _Regime, static: ca.SX, decay: ca.SX) -> None:
    """The transition matrix (14) and the response (15), with the coloured noise beside them."""
    e11, e12, e21, e22 = regime.transition
    fading = ca.exp(-decay * m.argument("time"))
    blocks = {
        ("eta", "eta"): e11,
        ("eta", "eta_dot"): e12,
        ("eta_dot", "eta"): e21,
        ("eta_dot", "eta_dot"): e22,
        ("chi", "chi"): fading,
    }
    doc = f"Transition matrix of mode and coloured noise over a time, for {regime.condition}"
    entries = tuple(Entry(at, expr) for at, expr in blocks.items())
    output = Output("transition", ("state", "state"), entries)
    m.add(f"transition_{regime.name}", RESPONSE, doc, "(14)", [output])
    offset = m["eta"] - static
    response = {
        "eta": static + e11 * offset + e12 * m["eta_dot"],
        "eta_dot": e21 * offset + e22 * m["eta_dot"],
        "chi": fading * m["chi"],
    }
    doc = f"State after a time under a constant force and no noise, for {regime.condition}; (15) has one sign wrong"
    m.add(f"response_{regime.name}", RESPONSE, doc, "(15)", [m.vector("state", response, "response")])


def _add_moments(m: Model, regime: _Regime) -> None:
    omega, zeta, sigma = (m.parameter(name) for name in ("omega", "zeta", "sigma"))
    if regime.name == "critical":
        zeta = ca.SX(1)
    variance = sigma**2 / (4 * zeta * omega**3)
    doc = f"Variance of the mode at a time, from rest, for {regime.condition}"
    m.add_scalar(f"eta_variance_at_{regime.name}", GROUP, doc, "(17)", variance * regime.variance, VARIANCE)
    doc = f"Stationary autocorrelation of the mode at a lag, for {regime.condition}"
    m.add_scalar(f"eta_autocorrelation_{regime.name}", GROUP, doc, "(17)", variance * regime.correlation, VARIANCE)


def _schema(_models: tuple[str, ...], _document: Mapping[str, object]) -> Schema:
    return Schema(
        parameters={"modes": (frequency(""), damping("")), "noise": (intensity(""),)},
        validity=(ETA, ETA_DOT, CHI, _INPUT),
        choices=(reduction.REDUCTION,),
    )


FAMILY = Family("one mode", {"flexible_mode": build_flexible_mode}, _schema)
