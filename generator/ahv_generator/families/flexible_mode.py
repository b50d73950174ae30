"""One flexible mode and its reduction, (5)-(26), with the closed forms of their responses and moments."""

from __future__ import annotations

from dataclasses import dataclass

from ahv_generator.modelling import Entry, Equation, Expr, Family, Model, Output, Sought, Variable, cos, exp, sin, sqrt
from ahv_generator.models import reduction
from ahv_generator.models.flexible import CHI, ETA, ETA_DOT, FLEXIBLE, FORCE, damping, frequency
from ahv_generator.models.noise import intensity

GROUP = "moments"
RESPONSE = "responses"
SECTION = "Response of the mode"
VARIANCE = "ft*slug"  # of a flexible coordinate

STATES = (
    ETA,
    ETA_DOT,
    Variable("chi", r"\chi", FLEXIBLE, "coloured noise in the place of the coordinate"),
)
INPUT = Variable("force", "N", FORCE, "generalized force")
NOISE = Variable("xi", r"\xi", "s^0.5", "Wiener increment that drives mode and coloured noise")
TIME = Variable("time", "t", "s", "time from the start, or lag")
FREQUENCY = Variable("frequency", r"\Omega", "rad/s", "angular frequency of a spectrum")

family = Family()
family.parameters("modes", frequency(""), damping(""))
family.parameters("noise", intensity(""))
family.choices(reduction.REDUCTION)
family.bounds(ETA, ETA_DOT, CHI, INPUT)


@family.model(
    "flexible_mode",
    "a flexible mode and its reduction to coloured noise",
    "(5)-(26)",
    states=STATES,
    inputs=(INPUT,),
    noise=(NOISE,),
    arguments=(TIME, FREQUENCY),
)
def flexible_mode(model: Model) -> None:
    """The mode (17) and the coloured noise (24) in its place, driven by the same white noise."""
    omega, zeta = model.symbols("omega", "zeta")
    with model.section(SECTION, "(5)"):
        resistance = model.define("damping", 2 * zeta * omega, r"2\zeta\omega", "rad/s", "damping of the mode")
        stiffness = model.define("stiffness", omega**2, r"\omega^2", "rad^2/s^2", "stiffness of the mode")
        acceleration = model["force"] - resistance * model["eta_dot"] - stiffness * model["eta"]
        doc = "acceleration of the flexible generalized coordinate"
        acceleration = model.define("eta_acceleration", acceleration, r"\ddot\eta", f"{FLEXIBLE}/s^2", doc)
    decay = reduction.define_decay(model)
    rates = {"eta": model["eta_dot"], "eta_dot": acceleration, "chi": reduction.define_rate(model, decay)}
    diffusion = reduction.define_diffusion(model)
    model.motion(rates, "(5)")
    gains = {("eta_dot", "xi"): model["sigma"], ("chi", "xi"): diffusion}
    model.diffusion(gains, "mode (17) and coloured noise (24) share one white noise", "(17)")
    add_reductions(model)
    add_stationary(model, decay, diffusion)
    with model.section(SECTION, "(15)"):
        static = model.define("eta_static", model["force"] / stiffness, r"N/\omega^2", FLEXIBLE, "static coordinate")
    for regime in (underdamped(model), critical(model), overdamped(model)):
        add_responses(model, regime, static, decay)
        add_moments(model, regime)
    model.outputs("eta_static")
    model.trim(sought=map(Sought, STATES), equations=map(Equation, STATES))
    model.mode("flexible", "eta", "eta_dot")
    model.mode("coloured noise", "chi")
    model.defaults(inputs=["force"], outputs=["eta"])
    model.deviations({"eta": 1.0, "eta_dot": 1.0, "force": 1.0})


def add_reductions(model: Model) -> None:
    """Decay and diffusion of the three reductions, and the stationary variance that each gives."""
    omega, zeta, sigma = model.symbols("omega", "zeta", "sigma")
    true_variance = sigma**2 / (4 * zeta * omega**3)
    reductions = {
        "printed": (
            "decay rate and gain at zero frequency",
            zeta * omega,
            zeta * sigma / omega,
            zeta * sigma**2 / (2 * omega**3),
        ),
        "variance": ("decay rate and variance", zeta * omega, sigma / (sqrt(2) * omega), true_variance),
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
        model.add(f"reduction_{name}", GROUP, f"Decay rate (1/s) and diffusion that match {matched}", "(23)", outputs)
        doc = f"Stationary variance of the coloured noise that matches {matched}"
        model.add_scalar(f"chi_variance_{name}", GROUP, doc, "(24)", variance, VARIANCE)


def add_stationary(model: Model, decay: Expr, diffusion: Expr) -> None:
    """Stationary moments and spectra of the mode and of the coloured noise that was chosen."""
    omega, zeta, sigma = model.symbols("omega", "zeta", "sigma")
    time, frequency = model.symbols("time", "frequency")
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
            variance * (1 - exp(-2 * decay * time)),
            VARIANCE,
        ),
        (
            "chi_autocorrelation",
            "Stationary autocorrelation of the coloured noise at a lag",
            variance * exp(-decay * time),
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
        model.add_scalar(name, GROUP, doc, "(17)" if name.startswith("eta") else "(24)", expr, unit)


@dataclass(frozen=True)
class Regime:
    """A range of the damping ratio: its name, and e^{-zeta omega t} times E_11, E_12, E_21, E_22 of (13)."""

    name: str
    condition: str
    transition: tuple[Expr, Expr, Expr, Expr]
    variance: Expr  # of the mode from rest over its stationary value
    correlation: Expr  # stationary, over the variance


def underdamped(model: Model) -> Regime:
    """The oscillation that decays."""
    omega, zeta, t = model.symbols("omega", "zeta", "time")
    with model.section(SECTION, "(13)"):
        ratio, doc = sqrt((1 - zeta) * (1 + zeta)), "damped over natural frequency"
        root = model.define("damped_ratio", ratio, r"\sqrt{1-\zeta^2}", "1", doc)
        decay = exp(-zeta * omega * t)
        envelope = model.define("envelope", decay, r"e^{-\zeta\omega t}", "1", "decay of the mode", equation="(14)")
        angle = model.define("phase", omega * root * t, r"\omega_d t", "1", "phase of the damped oscillation")
        cosine = model.define("cos_phase", cos(angle), r"\cos\omega_d t", "1", "cosine of the phase")
        symbol = r"\sin(\omega_d t)/\sqrt{1-\zeta^2}"
        sine = model.define("sin_phase", sin(angle) / root, symbol, "1", "scaled sine")
    transition = (
        envelope * (cosine + zeta * sine),
        envelope * sine / omega,
        -envelope * omega * sine,
        envelope * (cosine - zeta * sine),
    )
    # sigma^2 times the integral of h^2, h the impulse response, over its limit.
    lost = envelope**2 * (1 + 2 * zeta * sine * cosine + 2 * zeta**2 * sine**2)
    return Regime("underdamped", "zeta < 1", transition, 1 - lost, transition[0])


def critical(model: Model) -> Regime:
    """The limit between oscillation and decay."""
    omega, t = model.symbols("omega", "time")
    with model.section(SECTION, "(13)"):
        angle = model.define("scaled_time", omega * t, r"\omega t", "1", "time in radians of the natural frequency")
        doc = "decay of the critically damped mode"
        envelope = model.define("critical_envelope", exp(-angle), r"e^{-\omega t}", "1", doc, equation="(14)")
    transition = (envelope * (1 + angle), envelope * t, -envelope * omega * angle, envelope * (1 - angle))
    lost = envelope**2 * (1 + 2 * angle + 2 * angle**2)
    return Regime("critical", "zeta = 1, whatever zeta says", transition, 1 - lost, transition[0])


def overdamped(model: Model) -> Regime:
    """Two real poles."""
    omega, zeta, t = model.symbols("omega", "zeta", "time")
    with model.section(SECTION, "(13)"):
        ratio, doc = sqrt((zeta - 1) * (zeta + 1)), "half the distance of the poles over the natural frequency"
        root = model.define("overdamped_ratio", ratio, r"\sqrt{\zeta^2-1}", "1", doc)
        # The product of the poles is omega^2: the slow one is had from the fast one without cancellation.
        fast = model.define("fast_pole", omega * (zeta + root), r"p_1", "1/s", "faster decay rate of the mode")
        slow = model.define("slow_pole", omega / (zeta + root), r"p_2", "1/s", "slower decay rate of the mode")
        quick = model.define("fast_envelope", exp(-fast * t), r"e^{-p_1t}", "1", "faster decay", equation="(14)")
        lasting = model.define("slow_envelope", exp(-slow * t), r"e^{-p_2t}", "1", "slower decay", equation="(14)")
        gap = model.define("pole_gap", 2 * omega * root, r"p_1-p_2", "1/s", "distance of the poles")
    transition = (
        (fast * lasting - slow * quick) / gap,
        (lasting - quick) / gap,
        (quick - lasting) * omega**2 / gap,
        (fast * quick - slow * lasting) / gap,
    )
    even, odd = (lasting + quick) / 2, zeta * omega * (lasting - quick) / gap
    lost = quick * lasting + 2 * odd**2 + 2 * odd * even
    return Regime("overdamped", "zeta > 1", transition, 1 - lost, transition[0])


def add_responses(model: Model, regime: Regime, static: Expr, decay: Expr) -> None:
    """The transition matrix (14) and the response (15), with the coloured noise beside them."""
    e11, e12, e21, e22 = regime.transition
    fading = exp(-decay * model["time"])
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
    model.add(f"transition_{regime.name}", RESPONSE, doc, "(14)", [output])
    offset = model["eta"] - static
    response = {
        "eta": static + e11 * offset + e12 * model["eta_dot"],
        "eta_dot": e21 * offset + e22 * model["eta_dot"],
        "chi": fading * model["chi"],
    }
    doc = f"State after a time under a constant force and no noise, for {regime.condition}; (15) has one sign wrong"
    model.add(f"response_{regime.name}", RESPONSE, doc, "(15)", [model.vector("state", response, "response")])


def add_moments(model: Model, regime: Regime) -> None:
    """The variance from rest, and the autocorrelation."""
    omega, zeta, sigma = model.symbols("omega", "zeta", "sigma")
    if regime.name == "critical":
        zeta = Expr(1)
    variance = sigma**2 / (4 * zeta * omega**3)
    doc = f"Variance of the mode at a time, from rest, for {regime.condition}"
    model.add_scalar(f"eta_variance_at_{regime.name}", GROUP, doc, "(17)", variance * regime.variance, VARIANCE)
    doc = f"Stationary autocorrelation of the mode at a lag, for {regime.condition}"
    model.add_scalar(f"eta_autocorrelation_{regime.name}", GROUP, doc, "(17)", variance * regime.correlation, VARIANCE)
