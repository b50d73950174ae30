"""Section 3 of the paper by itself: one mode, its reduction, and both in closed form."""

from dataclasses import dataclass

import sympy
from sympy import Expr

from .derivatives import Entries
from .model import Model
from .modes import REDUCTIONS, chosen_reduction, modal, reduction
from .names import Names, symbol


@dataclass(frozen=True)
class Regime:
    """Motion of a mode without force: cosine-like and sine-like solution, e^{-damping t} inside.

    From rest at eta = 1 it is ``even + damping odd``; from eta_dot = 1 at eta = 0 it is ``odd``.
    """

    even: Expr
    odd: Expr
    damping: Expr
    variance: Expr
    positive: Expr | None


def flexible_mode_functions(model: Model) -> dict[str, Entries]:
    """Reductions, variances, correlations and spectra that need no regime."""
    time, frequency = symbol("argument", "time"), symbol("argument", "frequency")
    zeta, omega, sigma = (modal(name, None) for name in ("zeta", "omega", "sigma"))
    decay, intensity = chosen_reduction(model.names, None)
    functions: dict[str, Entries] = {}
    for kind in REDUCTIONS:
        a, b = reduction(kind, None)
        functions[f"reduction_{kind}"] = [(f"reduction_{kind}.decay", a), (f"reduction_{kind}.diffusion", b)]
    scalars = {f"chi_variance_{kind}": _stationary(*reduction(kind, None)) for kind in REDUCTIONS}
    stiffness = ((omega - frequency) * (omega + frequency)) ** 2
    variance = model.names.name("chi_variance", _stationary(decay, intensity))
    scalars |= {
        "eta_variance": sigma**2 / (4 * zeta * omega**3),
        "eta_dot_variance": sigma**2 / (4 * zeta * omega),
        "chi_variance": variance,
        "chi_variance_at": variance * (1 - sympy.exp(-2 * decay * time)),
        "chi_autocorrelation": variance * sympy.exp(-decay * time),
        "eta_spectrum": sigma**2 / (stiffness + (2 * zeta * omega * frequency) ** 2),
        "chi_spectrum": intensity**2 / (decay**2 + frequency**2),
    }
    return functions | {name: [(name, expr)] for name, expr in scalars.items()}


def regime_functions(model: Model) -> tuple[dict[str, Entries], dict[str, Expr]]:
    """The functions of each regime, and by function what must be positive for it to have a value."""
    functions: dict[str, Entries] = {}
    positive: dict[str, Expr] = {}
    for name, regime in regimes(model.names).items():
        found = _regime(model, name, regime)
        functions |= found
        if regime.positive is not None:
            positive |= dict.fromkeys(found, regime.positive)
    return functions, positive


def _stationary(decay: Expr, intensity: Expr) -> Expr:
    return intensity**2 / (2 * decay)


def regimes(names: Names) -> dict[str, Regime]:
    """Real forms of (13) for zeta below, at and above 1."""
    time = symbol("argument", "time")
    zeta, omega, sigma = (modal(name, None) for name in ("zeta", "omega", "sigma"))
    variance = sigma**2 / (4 * zeta * omega**3)

    ringing = names.name("ringing", omega * sympy.sqrt((1 - zeta) * (1 + zeta)))
    envelope = names.name("envelope", sympy.exp(-zeta * omega * time))
    under = (envelope * sympy.cos(ringing * time), envelope * sympy.sin(ringing * time) / ringing)

    double = names.name("double", sympy.exp(-omega * time))

    root = names.name("root", sympy.sqrt((zeta - 1) * (zeta + 1)))
    # omega (zeta - root), written without the difference
    slow = names.name("slow", sympy.exp(-omega / (zeta + root) * time))
    fast = names.name("fast", sympy.exp(-omega * (zeta + root) * time))
    over = ((slow + fast) / 2, (slow - fast) / (2 * omega * root))

    def named(pair: tuple[Expr, Expr]) -> tuple[Expr, Expr]:
        return names.name("even", pair[0]), names.name("odd", pair[1])

    return {
        "underdamped": Regime(*named(under), zeta * omega, variance, 1 - zeta),
        "critical": Regime(double, names.name("odd", time * double), omega, variance.subs(zeta, 1), None),
        "overdamped": Regime(*named(over), zeta * omega, variance, zeta - 1),
    }


def _regime(model: Model, name: str, regime: Regime) -> dict[str, Entries]:
    time, omega, force = symbol("argument", "time"), modal("omega", None), symbol("input", "force")
    decay, _ = chosen_reduction(model.names, None)
    even, odd, damping = regime.even, regime.odd, regime.damping
    matrix = {
        ("eta", "eta"): even + damping * odd,
        ("eta", "eta_dot"): odd,
        ("eta_dot", "eta"): -(omega**2) * odd,
        ("eta_dot", "eta_dot"): even - damping * odd,
        ("chi", "chi"): sympy.exp(-decay * time),
    }
    matrix = {place: model.names.name("E_" + "_".join(place), expr) for place, expr in matrix.items()}
    static = force / omega**2
    away = {state: symbol("state", state) for state in model.states}
    away["eta"] = away["eta"] - static
    response = {
        row: sympy.Add(*(entry * away[column] for (at, column), entry in matrix.items() if at == row))
        for row in model.states
    }
    response["eta"] = static + response["eta"]
    # the variance still to come is that of the mode left to itself from its stationary state
    to_come = sympy.exp(-2 * damping * time) + 2 * (damping * odd) ** 2 + 2 * damping * odd * even
    return {
        f"transition_{name}": [(f"transition_{name}.{row}.{column}", e) for (row, column), e in matrix.items()],
        f"response_{name}": [(f"response_{name}.{row}", expr) for row, expr in response.items()],
        f"eta_variance_at_{name}": [(f"eta_variance_at_{name}", regime.variance * (1 - to_come))],
        f"eta_autocorrelation_{name}": [(f"eta_autocorrelation_{name}", regime.variance * matrix["eta", "eta"])],
    }
