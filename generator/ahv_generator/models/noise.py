"""The white noises of the paper: on the rigid states, (27), and on the flexible modes, (16)."""

from __future__ import annotations

from collections.abc import Mapping

from ..modelling import NOT_NEGATIVE, Choice, Expr, Model, Option, Parameter, Variable, sqrt, switch
from .flexible import FLEXIBLE, index, of, subscript

NOISE = Choice(
    "noise",
    "ModalNoise",
    "noise of the flexible modes",
    (switch("shared_noise", r"\rho_\xi", "correlation of the noise of modes 2, 3, ... with that of mode 1"),),
    (
        Option("independent", "every mode has a white noise of its own", (0.0,)),
        Option("shared", "one white noise drives all modes, as (16) has it", (1.0,)),
    ),
)

RIGID_INCREMENTS = (
    Variable("w_gamma", r"w_\gamma", "s^0.5", "Wiener increment that perturbs the flight-path angle"),
    Variable("w_alpha", r"w_\alpha", "s^0.5", "Wiener increment that perturbs the angle of attack"),
    Variable("w_q", "w_Q", "s^0.5", "Wiener increment that perturbs the pitch rate"),
)
PERTURBATIONS = "the columns of w_gamma, w_alpha and w_q are derivatives of the drift"

_PERTURBED = {"w_gamma": "gamma", "w_alpha": "alpha", "w_q": "pitch_rate"}


def intensity(suffix: str) -> Parameter:
    """The intensity of the noise of a mode."""
    doc = f"intensity of the white noise{of(suffix).replace(' of', ' on')}"
    return Parameter(f"sigma{suffix}", rf"\sigma{subscript(suffix)}", f"{FLEXIBLE}/s^1.5", doc, NOT_NEGATIVE)


def noise_parameters(modes: range) -> tuple[Parameter, ...]:
    """Noise intensities of the flexible modes, then of the rigid body."""
    rigid = (
        Parameter(name, rf"\sigma_{{w_{label}}}", unit, f"intensity of the white noise w_{word}", NOT_NEGATIVE)
        for name, label, unit, word in (
            ("w_gamma", r"\gamma", "rad*s^0.5", "gamma"),
            ("w_alpha", r"\alpha", "rad*s^0.5", "alpha"),
            ("w_q", "Q", "rad/s^0.5", "Q"),
        )
    )
    return (*(intensity(f"_{i}") for i in modes), *rigid)


def modal_increments(modes: range) -> tuple[Variable, ...]:
    """One Wiener increment for each flexible mode."""
    return tuple(
        Variable(f"xi_{i}", rf"\xi_{index(i)}", "s^0.5", f"Wiener increment that drives flexible mode {i}")
        for i in modes
    )


def perturbation_gains(model: Model, rates: Mapping[str, Expr]) -> dict[tuple[str, str], Expr]:
    """The derivatives of the drift by gamma, alpha and Q, times the intensities of their noise."""
    return {
        (row, column): model.derivative(rates[row], state) * model[column]
        for row in rates
        for column, state in _PERTURBED.items()
    }


def modal_gains(model: Model, by_row: Mapping[str, Expr]) -> dict[tuple[str, str], Expr]:
    """What drives the modes, by the rows that it enters: correlated with mode 1 as `shared_noise` says."""
    share = model["shared_noise"]
    own = None
    if len(by_row) > 1:
        doc = "share of its own noise in what drives a mode"
        with model.section("Noise of the modes", "(16)"):
            own = model.define("own_noise", sqrt((1 - share) * (1 + share)), r"\sqrt{1-\rho_\xi^2}", "1", doc)
    gains: dict[tuple[str, str], Expr] = {}
    for i, (row, gain) in enumerate(by_row.items(), start=1):
        if i == 1 or own is None:
            gains[row, "xi_1"] = gain
        else:
            gains[row, "xi_1"] = gain * share
            gains[row, f"xi_{i}"] = gain * own
    return gains
