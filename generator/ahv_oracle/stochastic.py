"""The stochastic form dx = f dt + G dW, section 4 of the note: G, what follows from it, read in the Ito sense."""

import sympy
from sympy import Expr

from .derivatives import Entries, slope
from .model import RIGID_NOISES, Model
from .modes import chosen_reduction, modal
from .names import symbol
from .printed import DRIVES, printed_channels
from .vehicle import generalised_forces, variables

PERTURBED = {"w_gamma": "gamma", "w_alpha": "alpha", "w_q": "pitch_rate"}
"""The state along which each rigid noise perturbs the drift, (27)."""

Diffusion = dict[tuple[str, str], Expr]
"""Entries of G by row and noise, structural zeros left out."""


def stochastic_functions(model: Model) -> dict[str, Entries]:
    """The functions of a model with noise."""
    matrix = diffusion_matrix(model)
    return {
        "diffusion": [(f"diffusion.{row}.{noise}", expr) for (row, noise), expr in matrix.items()],
        "noise_increment": _noise_increment(model, matrix),
        "noise_derivatives": _noise_derivatives(model, matrix),
        "ito_correction": _ito_correction(model, matrix),
    }


def diffusion_matrix(model: Model) -> Diffusion:
    """G by row and noise; derivatives total and at frozen inputs."""
    if model.name == "flexible_mode":
        entries = {("eta_dot", "xi"): modal("sigma", None), ("chi", "xi"): chosen_reduction(model.names, None)[1]}
    else:
        entries = _rigid_columns(model) | _flexible_columns(model)
    named = {
        (row, noise): model.names.name(f"G_{row}_{noise}", entries[row, noise])
        for row in model.states
        for noise in model.noises
        if (row, noise) in entries
    }
    return {place: expr for place, expr in named.items() if expr != 0}


def _rigid_columns(model: Model) -> Diffusion:
    if model.name == "sdcom_printed":
        return _printed_columns(model)
    if model.name == "sdcom_gust":
        rms, time = symbol("parameter", "gust_rms"), symbol("parameter", "gust_time")
        gust = {("alpha_gust", "w_gust"): rms * sympy.sqrt(2 / time)}
        return gust | {("alpha", "w_q"): symbol("parameter", "w_q")}
    return {
        (row, noise): symbol("parameter", noise) * slope(model, row, "state", PERTURBED[noise])
        for row in model.states
        for noise in RIGID_NOISES
    }


def _printed_columns(model: Model) -> Diffusion:
    forces = generalised_forces(model.table, model.names, variables(model.states, model.inputs))
    channels = printed_channels(model.table, model.names, forces)
    columns: Diffusion = {}
    for suffix, (row, _, _) in DRIVES.items():
        big_h = model.names.name(f"H_{suffix}", channels[suffix].big_h)
        columns[row, "w_alpha"] = big_h * symbol("parameter", "w_alpha")
    columns["altitude", "w_gamma"] = symbol("state", "velocity") * symbol("parameter", "w_gamma")
    columns["alpha", "w_q"] = symbol("parameter", "w_q")
    return columns


def _flexible_columns(model: Model) -> Diffusion:
    """Mode 1 is driven by xi_1, mode i by s xi_1 + sqrt(1 - s^2) xi_i: correlation s."""
    shared = symbol("parameter", "shared_noise")
    own = sympy.sqrt((1 - shared) * (1 + shared))
    columns: Diffusion = {}
    for i in model.table.modes:
        if model.name == "dcom":
            row, intensity = f"eta_dot_{i}", modal("sigma", i)
        else:
            row, intensity = f"chi_{i}", chosen_reduction(model.names, i)[1]
        if i == 1:
            columns[row, "xi_1"] = intensity
        else:
            columns |= {(row, "xi_1"): intensity * shared, (row, f"xi_{i}"): intensity * own}
    return columns


def _noise_increment(model: Model, matrix: Diffusion) -> Entries:
    """G times a vector of Wiener increments, all rows."""
    return [
        (
            f"noise_increment.{row}",
            sympy.Add(
                *(matrix[row, noise] * symbol("noise", noise) for noise in model.noises if (row, noise) in matrix)
            ),
        )
        for row in model.states
    ]


def _along(model: Model, matrix: Diffusion, direction: str, place: tuple[str, str]) -> Expr:
    """Derivative of an entry of G along the column `direction` of G, the input frozen."""
    terms = []
    for name in model.states:
        if (name, direction) in matrix:
            change = model.names.derivative(matrix[place], symbol("state", name))
            terms.append(matrix[name, direction] * change)
    return sympy.Add(*terms)


def _noise_derivatives(model: Model, matrix: Diffusion) -> Entries:
    """L^j b^k by row, j and k."""
    entries = [
        (f"noise_derivatives.{row}.{first}.{second}", _along(model, matrix, first, (row, second)))
        for row in model.states
        for first in model.noises
        for second in model.noises
        if (row, second) in matrix
    ]
    return [(label, expr) for label, expr in entries if expr != 0]


def _ito_correction(model: Model, matrix: Diffusion) -> Entries:
    """Half the sum of (d b_k / d x) b_k over the noises, all rows."""
    entries = []
    for row in model.states:
        terms = (_along(model, matrix, noise, (row, noise)) for noise in model.noises if (row, noise) in matrix)
        entries.append((f"ito_correction.{row}", sympy.Rational(1, 2) * sympy.Add(*terms)))
    return entries
