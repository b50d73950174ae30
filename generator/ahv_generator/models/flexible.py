"""What the models with flexible modes share: the parameters, coordinates and equation of a mode, (5)."""

from __future__ import annotations

from ..contents import Contents
from ..modelling import POSITIVE, Expr, Model, Parameter, Variable

FLEXIBLE = "(ft*slug)^0.5"  # ft·(slug/ft)^½, a mass-normalised modal coordinate
FORCE = f"{FLEXIBLE}/s^2"  # generalized force

ETA = Variable("eta", r"\eta", FLEXIBLE, "flexible generalized coordinate")
ETA_DOT = Variable("eta_dot", r"\dot\eta", f"{FLEXIBLE}/s", "rate of the flexible generalized coordinate")
CHI = Variable("chi", r"\chi", FLEXIBLE, "coloured noise of a flexible mode")


def index(mode: int) -> str:
    """The number of a mode as a subscript in LaTeX."""
    return str(mode) if mode < 10 else f"{{{mode}}}"


def subscript(suffix: str) -> str:
    """The suffix of a name, such as `_1` or none, in LaTeX."""
    return suffix and f"_{index(int(suffix[1:]))}"


def of(suffix: str) -> str:
    """The suffix of a name in words."""
    return suffix and f" of mode {suffix[1:]}"


def frequency(suffix: str) -> Parameter:
    """The natural frequency of a mode."""
    doc = f"natural frequency{of(suffix)}"
    return Parameter(f"omega{suffix}", rf"\omega{subscript(suffix)}", "rad/s", doc, POSITIVE)


def damping(suffix: str) -> Parameter:
    """The damping ratio of a mode."""
    doc = f"damping ratio{of(suffix)}"
    return Parameter(f"zeta{suffix}", rf"\zeta{subscript(suffix)}", "1", doc, POSITIVE)


def modal_parameters(modes: range) -> tuple[Parameter, ...]:
    """Frequencies and damping ratios of numbered modes."""
    suffixes = [f"_{i}" for i in modes]
    return tuple(map(frequency, suffixes)) + tuple(map(damping, suffixes))


def modes_of(table: Contents) -> range:
    """The numbers of the flexible modes of a table."""
    count = sum(p.key.startswith("omega_") for p in table.schema.parameters.get("modes", ()))
    return range(1, count + 1)


def coordinates(modes: range) -> tuple[Variable, ...]:
    """The coordinate of each mode, as a variable of curve fits."""
    return tuple(
        Variable(f"eta_{i}", rf"\eta_{index(i)}", FLEXIBLE, f"flexible generalized coordinate of mode {i}", "eta")
        for i in modes
    )


def modal_state(modes: range) -> tuple[Variable, ...]:
    """Coordinate and rate of each mode, in the order of the paper."""
    found: list[Variable] = []
    for i, coordinate in zip(modes, coordinates(modes), strict=True):
        doc = f"rate of the flexible generalized coordinate of mode {i}"
        rate = Variable(f"eta_dot_{i}", rf"\dot\eta_{index(i)}", f"{FLEXIBLE}/s", doc, "eta_dot")
        found += [coordinate, rate]
    return tuple(found)


def structural_modes(modes: range) -> dict[str, tuple[str, ...]]:
    """The states of the poles of each mode, by its name."""
    return {f"flexible {i}": (f"eta_{i}", f"eta_dot_{i}") for i in modes}


def modal_load(model: Model, i: int, force: Expr) -> Expr:
    """N_i less damping and stiffness, (1)."""
    omega, zeta = model.symbols(f"omega_{i}", f"zeta_{i}")
    with model.section("Flexible modes", "(1)"):
        symbol = rf"2\zeta_{index(i)}\omega_{index(i)}"
        resistance = model.define(f"damping_{i}", 2 * zeta * omega, symbol, "rad/s", f"damping of mode {i}")
        symbol = rf"\omega_{index(i)}^2"
        stiffness = model.define(f"stiffness_{i}", omega**2, symbol, "rad^2/s^2", f"stiffness of mode {i}")
    return force - resistance * model[f"eta_dot_{i}"] - stiffness * model[f"eta_{i}"]


def define_modal_acceleration(model: Model, i: int, expr: Expr) -> Expr:
    """The second derivative of a flexible coordinate by its name."""
    doc = f"acceleration of the flexible generalized coordinate of mode {i}"
    with model.section("Flexible modes", "(1)"):
        return model.define(f"eta_acceleration_{i}", expr, rf"\ddot\eta_{index(i)}", FORCE, doc)
