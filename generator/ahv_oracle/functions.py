"""What is derived from a drift: Jacobians, diffusion and its product with Wiener increments."""

import sympy
from sympy import Expr

from .feedback import strict_feedback
from .model import Model, quantities, symbol

Entries = list[tuple[str, Expr]]
"""Labelled expressions, in column order."""

PERTURBED = {"w_gamma": "gamma", "w_alpha": "alpha", "w_q": "pitch_rate"}
"""The state along which each rigid noise perturbs the drift, (27)."""


def all_functions(model: Model) -> dict[str, Entries]:
    """Every function of `model` with its labelled entries."""
    functions = {"drift": drift(model), "jacobians": jacobians(model)}
    if model.name == "sdcom":
        functions |= {"diffusion": diffusion(model), "noise_increment": noise_increment(model)}
        functions |= strict_feedback(model)
    return functions | {name: [(name, expr)] for name, expr in quantities(model).items()}


def drift(model: Model) -> Entries:
    """Time derivative of the state, all rows."""
    return [(f"drift.{row}", expr) for row, expr in model.drift.items()]


def jacobians(model: Model) -> Entries:
    """Entries of the state and input Jacobians that are not structurally zero."""
    entries = [
        (f"jacobians.{kind}.{row}.{name}", sympy.diff(expr, symbol(kind, name)))
        for kind, names in (("state", model.states), ("input", model.inputs))
        for row, expr in model.drift.items()
        for name in names
    ]
    return [(label, expr) for label, expr in entries if expr != 0]


def diffusion(model: Model) -> Entries:
    """Entries of G that are not structurally zero: Ito, derivatives total and at frozen inputs."""
    entries = [
        (f"diffusion.{row}.{noise}", _diffusion_entry(model, row, noise))
        for row in model.states
        for noise in model.noises
    ]
    return [(label, expr) for label, expr in entries if expr != 0]


def noise_increment(model: Model) -> Entries:
    """G times a vector of Wiener increments, all rows."""
    return [
        (
            f"noise_increment.{row}",
            sympy.Add(*(_diffusion_entry(model, row, noise) * symbol("noise", noise) for noise in model.noises)),
        )
        for row in model.states
    ]


def _diffusion_entry(model: Model, row: str, noise: str) -> Expr:
    if noise in PERTURBED:
        intensity = symbol("parameter", noise)
        return intensity * sympy.diff(model.drift[row], symbol("state", PERTURBED[noise]))
    mode = noise.removeprefix("xi_")
    if row != f"chi_{mode}":
        return sympy.Integer(0)
    zeta, sigma, omega = (symbol("parameter", f"{name}_{mode}") for name in ("zeta", "sigma", "omega"))
    return zeta * sigma / omega
