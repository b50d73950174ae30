"""The strict-feedback parts: of SDCOM by the definitions, nothing dropped, and as printed with what is missing."""

from collections.abc import Mapping

import sympy
from sympy import Expr, Symbol

from .model import Model, exact_rows
from .modes import static_deflection
from .names import symbol
from .printed import DRIVES, Channel, printed_channels
from .vehicle import aerodynamics, generalised_forces, own_rows, rigid_rows, variables


def strict_feedback(model: Model) -> dict[str, list[tuple[str, Expr]]]:
    """f, g, h, H and f_eta of the four channels; also ``g_Q_total``, or Delta f and Delta H."""
    forces = generalised_forces(model.table, model.names, variables(model.states, model.inputs))
    if model.name == "sdcom_printed":
        channels = printed_channels(model.table, model.names, forces)
        return _labelled(channels) | _missing(model, channels)
    total = model.names.derivative(model.drift["pitch_rate"], symbol("input", "delta_e"))
    return _labelled(_exact_channels(model, forces)) | {"g_Q_total": [("g_Q_total", total)]}


def _labelled(channels: Mapping[str, Channel]) -> dict[str, list[tuple[str, Expr]]]:
    functions: dict[str, list[tuple[str, Expr]]] = {}
    for suffix, channel in channels.items():
        h = [(f"h_{suffix}.{place}", expr) for place, expr in enumerate(channel.h.values())]
        functions |= {
            f"f_{suffix}": [(f"f_{suffix}", channel.f)],
            f"g_{suffix}": [(f"g_{suffix}", channel.g)],
            f"h_{suffix}": h,
            f"H_{suffix}": [(f"H_{suffix}", channel.big_h)],
            f"f_{suffix}_eta": [(f"f_{suffix}_eta", channel.f_eta)],
        }
    return functions


def _missing(model: Model, channels: Mapping[str, Channel]) -> dict[str, list[tuple[str, Expr]]]:
    """What the exact rows and their derivatives by alpha have more than the printed ones."""
    exact, alpha = exact_rows(model), symbol("state", "alpha")
    functions: dict[str, list[tuple[str, Expr]]] = {}
    for suffix, (row, _, _) in DRIVES.items():
        whole = model.names.name(f"exact_{row}", exact[row])
        label = f"delta_f_{suffix}"
        functions[label] = [(label, whole - model.drift[row])]
    for suffix, (row, _, _) in DRIVES.items():
        slope = model.names.derivative(model.names.name(f"exact_{row}", exact[row]), alpha)
        label = f"delta_H_{suffix}"
        functions[label] = [(label, slope - model.names.name(f"H_{suffix}", channels[suffix].big_h))]
    return functions


def _exact_channels(model: Model, forces: Mapping[int, Expr]) -> dict[str, Channel]:
    deflections = {i: static_deflection(i, force) for i, force in forces.items()}
    channels = {}
    for suffix, (row, kind, name) in DRIVES.items():
        f, g = _control_split(model, row, symbol(kind, name), deflections)
        h = {i: _flexible_derivative(model, row, i, deflections) for i in deflections}
        f_eta = sympy.Add(*(h[i] * deflections[i] for i in h))
        big_h = model.names.derivative(model.drift[row], symbol("state", "alpha"))
        channels[suffix] = Channel(f, f_eta, g, h, big_h)
    return channels


def _control_split(model: Model, row: str, drive: Symbol, deflections: Mapping[int, Expr]) -> tuple[Expr, Expr]:
    """Remainder and coefficient of `drive`^1 of a row at chi = 0, each N_i one symbol."""
    static = {f"eta_{i}": deflection for i, deflection in deflections.items()}
    polynomials = aerodynamics(model.table, variables(model.states, model.inputs, static))
    parts = {name: split(expr, drive) for name, expr in polynomials.items()}
    own = {name: split(expr, drive) for name, expr in own_rows().items()}
    remainder = rigid_rows(model.names, _pick(parts, 0), _pick(own, 0))
    coefficient = rigid_rows(model.names, _pick(parts, 1), _pick(own, 1))
    return remainder[row], coefficient[row]


def _pick(parts: Mapping[str, tuple[Expr, Expr]], which: int) -> dict[str, Expr]:
    return {name: pair[which] for name, pair in parts.items()}


def split(expr: Expr, drive: Symbol) -> tuple[Expr, Expr]:
    """Split a polynomial in `drive` into (all else, coefficient of `drive`^1).

    Summands without `drive` stay as they are; the others are expanded, so that the removed
    terms are gone and do not merely cancel. ``drive`` inside sin, cos or exp does not occur.
    """
    rest: list[Expr] = []
    first: list[Expr] = []
    for summand in sympy.Add.make_args(expr):
        terms = sympy.Add.make_args(sympy.expand(summand)) if summand.has(drive) else (summand,)
        for term in terms:
            coefficient, power = term.as_coeff_exponent(drive)
            if power == 1:
                first.append(coefficient)
            else:
                rest.append(term)
    return sympy.Add(*rest), sympy.Add(*first)


def _flexible_derivative(model: Model, row: str, mode: int, deflections: Mapping[int, Expr]) -> Expr:
    """Differentiate a row by eta_i at chi = 0, with the generalised forces whole."""
    free = {f"eta_{i}": symbol("free", f"eta_{i}") for i in model.table.modes}
    bind = variables(model.states, model.inputs, free)
    slopes = {name: sympy.diff(expr, free[f"eta_{mode}"]) for name, expr in aerodynamics(model.table, bind).items()}
    nothing = dict.fromkeys(own_rows(), sympy.Integer(0))
    static = {free[f"eta_{i}"]: deflections[i] for i in model.table.modes}
    return rigid_rows(model.names, slopes, nothing)[row].xreplace(static)
