"""What the models with flexible modes share: the parameters, coordinates and equation of a mode, (5)."""

from __future__ import annotations

import casadi as ca

from ..model import Model
from ..schema import POSITIVE, ParameterSpec, VariableSpec
from ..table import Table
from ..traits import Mode

FLEXIBLE = "(ft*slug)^0.5"  # ft·(slug/ft)^½, a mass-normalised modal coordinate
FORCE = f"{FLEXIBLE}/s^2"  # generalized force

ETA = VariableSpec("eta", r"\eta", FLEXIBLE, "flexible generalized coordinate")
ETA_DOT = VariableSpec("eta_dot", r"\dot\eta", f"{FLEXIBLE}/s", "rate of the flexible generalized coordinate")
CHI = VariableSpec("chi", r"\chi", FLEXIBLE, "coloured noise of a flexible mode")


def index(mode: int) -> str:
    """The number of a mode as a subscript in LaTeX."""
    return str(mode) if mode < 10 else f"{{{mode}}}"


def subscript(suffix: str) -> str:
    """The suffix of a name, such as `_1` or none, in LaTeX."""
    return suffix and f"_{index(int(suffix[1:]))}"


def of(suffix: str) -> str:
    """The suffix of a name in words."""
    return suffix and f" of mode {suffix[1:]}"


def frequency(suffix: str) -> ParameterSpec:
    """The natural frequency of a mode."""
    doc = f"natural frequency{of(suffix)}"
    return ParameterSpec(f"omega{suffix}", rf"\omega{subscript(suffix)}", "rad/s", doc, POSITIVE)


def damping(suffix: str) -> ParameterSpec:
    """The damping ratio of a mode."""
    doc = f"damping ratio{of(suffix)}"
    return ParameterSpec(f"zeta{suffix}", rf"\zeta{subscript(suffix)}", "1", doc, POSITIVE)


def modal_parameters(modes: int) -> tuple[ParameterSpec, ...]:
    """Frequencies and damping ratios of numbered modes."""
    suffixes = [f"_{i}" for i in range(1, modes + 1)]
    return tuple(map(frequency, suffixes)) + tuple(map(damping, suffixes))


def modes_of(table: Table) -> range:
    """The numbers of the flexible modes of a table."""
    count = sum(p.key.startswith("omega_") for p in table.schema.parameters.get("modes", ()))
    return range(1, count + 1)


def coordinates(modes: range) -> tuple[VariableSpec, ...]:
    """The coordinate of each mode, as a variable of curve fits."""
    return tuple(
        VariableSpec(f"eta_{i}", rf"\eta_{index(i)}", FLEXIBLE, f"flexible generalized coordinate of mode {i}", "eta")
        for i in modes
    )


def modal_state(modes: range) -> tuple[VariableSpec, ...]:
    """Coordinate and rate of each mode, in the order of the paper."""
    found: list[VariableSpec] = []
    for i, coordinate in zip(modes, coordinates(modes), strict=True):
        doc = f"rate of the flexible generalized coordinate of mode {i}"
        rate = VariableSpec(f"eta_dot_{i}", rf"\dot\eta_{index(i)}", f"{FLEXIBLE}/s", doc, "eta_dot")
        found += [coordinate, rate]
    return tuple(found)


def structural_modes(modes: range) -> list[Mode]:
    """The poles of each mode."""
    return [Mode(f"flexible {i}", (f"eta_{i}", f"eta_dot_{i}")) for i in modes]


def modal_load(m: Model, i: int, force: ca.SX) -> ca.SX:
    """N_i less damping and stiffness, (1)."""
    omega, zeta = m.parameter(f"omega_{i}"), m.parameter(f"zeta_{i}")
    damping = m.graph.define(
        f"damping_{i}",
        2 * zeta * omega,
        symbol=rf"2\zeta_{index(i)}\omega_{index(i)}",
        unit="rad/s",
        doc=f"damping of mode {i}",
        equation="(1)",
        section="Flexible modes",
    )
    stiffness = m.graph.define(
        f"stiffness_{i}",
        omega**2,
        symbol=rf"\omega_{index(i)}^2",
        unit="rad^2/s^2",
        doc=f"stiffness of mode {i}",
        equation="(1)",
        section="Flexible modes",
    )
    return force - damping * m[f"eta_dot_{i}"] - stiffness * m[f"eta_{i}"]


def define_modal_acceleration(m: Model, i: int, expr: ca.SX) -> ca.SX:
    """The second derivative of a flexible coordinate by its name."""
    return m.graph.define(
        f"eta_acceleration_{i}",
        expr,
        symbol=rf"\ddot\eta_{index(i)}",
        unit=FORCE,
        doc=f"acceleration of the flexible generalized coordinate of mode {i}",
        equation="(1)",
        section="Flexible modes",
    )
