"""Flexible modes: the oscillator of (5), what (18) to (25) reduce it to, and the cantilevers of COM."""

from collections.abc import Mapping

import sympy
from sympy import Expr, Symbol

from .names import Names, symbol

REDUCTIONS = ("printed", "variance", "moment")
"""How the Ornstein-Uhlenbeck process is matched to the oscillator."""


def modal(name: str, mode: int | None) -> Symbol:
    """Return the symbol of a modal parameter; of the only mode where `mode` is None."""
    return symbol("parameter", name if mode is None else f"{name}_{mode}")


def static_deflection(mode: int, force: Expr) -> Expr:
    """N_i / omega_i^2 of (25)."""
    return force / modal("omega", mode) ** 2


def restoring(mode: int | None, force: Expr) -> Expr:
    """N - 2 zeta omega eta_dot - omega^2 eta of (5)."""
    suffix = "" if mode is None else f"_{mode}"
    eta, rate = symbol("state", f"eta{suffix}"), symbol("state", f"eta_dot{suffix}")
    omega = modal("omega", mode)
    return force - 2 * modal("zeta", mode) * omega * rate - omega**2 * eta


def oscillator(mode: int, force: Expr) -> dict[str, Expr]:
    """Rows of (5) as two equations of first order."""
    return {f"eta_{mode}": symbol("state", f"eta_dot_{mode}"), f"eta_dot_{mode}": restoring(mode, force)}


def reduction(kind: str, mode: int | None) -> tuple[Expr, Expr]:
    """Decay rate a and intensity b of d chi = -a chi dt + b dw for one way of matching."""
    zeta, omega, sigma = modal("zeta", mode), modal("omega", mode), modal("sigma", mode)
    if kind == "printed":  # (23): decay rate, and response to a constant
        return zeta * omega, zeta * sigma / omega
    if kind == "variance":  # decay rate, and variance: b^2 / (2 a) = sigma^2 / (4 zeta omega^3)
        return zeta * omega, sigma / (sympy.sqrt(2) * omega)
    return omega / (2 * zeta), sigma / (2 * zeta * omega)  # variance, and response to a constant


def chosen_reduction(names: Names, mode: int | None) -> tuple[Expr, Expr]:
    """Decay rate and intensity as the switches have them."""
    zeta, omega, sigma = modal("zeta", mode), modal("omega", mode), modal("sigma", mode)
    variance, moment = symbol("parameter", "variance_matching"), symbol("parameter", "moment_matching")
    decay = zeta * omega + moment * (omega / (2 * zeta) - zeta * omega)
    share = zeta * (1 - variance - moment) + variance / sympy.sqrt(2) + moment / (2 * zeta)
    return names.name(f"decay_{mode}", decay), names.name(f"intensity_{mode}", sigma / omega * share)


def ornstein_uhlenbeck(names: Names, mode: int | None) -> Expr:
    """Drift of chi of one mode."""
    decay, _ = chosen_reduction(names, mode)
    return -decay * symbol("state", "chi" if mode is None else f"chi_{mode}")


def cantilever_rows(names: Names, moment: Expr, forces: Mapping[int, Expr]) -> dict[str, Expr]:
    """Rows of the pitch rate and of cantilevers that are clamped at the centre of mass, from the kinetic energy.

    A point of the beam at x ahead of the centre of mass moves with x Q + phi(x) eta_dot. With mass-normalised
    modes and psi_i = integral of m x phi_i that gives the energy below; Lagrange's equations do the rest.
    """
    rates = {i: symbol("state", f"eta_dot_{i}") for i in forces}
    turn = symbol("state", "pitch_rate")
    energy = symbol("parameter", "i_yy") * turn**2 / 2
    for i, rate in rates.items():
        energy += rate**2 / 2 + modal("psi", i) * turn * rate
    speeds = [*rates.values(), turn]
    mass = sympy.hessian(energy, speeds)
    count = len(rates)
    beam, coupling = mass[:count, :count].inv(), mass[:count, count]
    load = sympy.Matrix([names.name(f"restoring_{i}", restoring(i, force)) for i, force in forces.items()])
    inertia = mass[count, count] - (coupling.T * beam * coupling)[0, 0]
    turning = names.name("turning", (moment - (coupling.T * beam * load)[0, 0]) / inertia)
    bending = beam * (load - coupling * turning)
    rows = {"pitch_rate": turning}
    for place, (i, rate) in enumerate(rates.items()):
        rows |= {f"eta_{i}": rate, f"eta_dot_{i}": bending[place]}
    return rows
