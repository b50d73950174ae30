"""The `exact` strict-feedback parts of SDCOM: f, g, h, H by the definitions, nothing dropped."""

from collections.abc import Mapping

import sympy
from sympy import Expr, Symbol

from .model import (
    Model,
    aerodynamics,
    generalised_forces,
    own_rows,
    rigid_rows,
    symbol,
    variables,
)

CHANNELS = {
    "V": ("velocity", "input", "phi"),
    "gamma": ("gamma", "state", "alpha"),
    "alpha": ("alpha", "state", "pitch_rate"),
    "Q": ("pitch_rate", "input", "delta_e"),
}
"""For each part's suffix: the row, and kind and name of what g multiplies."""


def strict_feedback(model: Model) -> dict[str, list[tuple[str, Expr]]]:
    """f, g, h, H and f_eta of the four channels, and ``g_Q_total``."""
    whole = _whole_forces(model)
    functions: dict[str, list[tuple[str, Expr]]] = {}
    for suffix, (row, kind, name) in CHANNELS.items():
        drive = symbol(kind, name)
        f, g = _control_split(model, row, drive)
        h = [_flexible_derivative(model, row, mode) for mode in model.table.modes]
        deflections = [_static(mode) for mode in model.table.modes]
        f_eta = sympy.Add(*(a * b for a, b in zip(h, deflections, strict=True)))
        functions[f"f_{suffix}"] = [(f"f_{suffix}", f.xreplace(whole))]
        functions[f"g_{suffix}"] = [(f"g_{suffix}", g.xreplace(whole))]
        functions[f"h_{suffix}"] = [(f"h_{suffix}.{i}", expr.xreplace(whole)) for i, expr in enumerate(h)]
        functions[f"H_{suffix}"] = [(f"H_{suffix}", sympy.diff(model.drift[row], symbol("state", "alpha")))]
        functions[f"f_{suffix}_eta"] = [(f"f_{suffix}_eta", f_eta.xreplace(whole))]
    total = sympy.diff(model.drift["pitch_rate"], symbol("input", "delta_e"))
    return functions | {"g_Q_total": [("g_Q_total", total)]}


def _whole_forces(model: Model) -> dict[Expr, Expr]:
    forces = generalised_forces(model.table, variables(model.states, model.inputs))
    return {_force(mode): force for mode, force in forces.items()}


def _force(mode: int) -> Symbol:
    return symbol("force", f"n_{mode}")


def _static(mode: int) -> Expr:
    return _force(mode) / symbol("parameter", f"omega_{mode}") ** 2


def _control_split(model: Model, row: str, drive: Symbol) -> tuple[Expr, Expr]:
    """Remainder and coefficient of `drive`^1 of a row at chi = 0, each N_i one symbol."""
    static = {f"eta_{mode}": _static(mode) for mode in model.table.modes}
    polynomials = aerodynamics(model.table, variables(model.states, model.inputs, static))
    parts = {name: split(expr, drive) for name, expr in polynomials.items()}
    own = {name: split(expr, drive) for name, expr in own_rows().items()}
    remainder = rigid_rows(_pick(parts, 0), _pick(own, 0))
    coefficient = rigid_rows(_pick(parts, 1), _pick(own, 1))
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


def _flexible_derivative(model: Model, row: str, mode: int) -> Expr:
    """Differentiate a row by eta_i at chi = 0, with the generalised forces whole."""
    free = {f"eta_{i}": symbol("free", f"eta_{i}") for i in model.table.modes}
    bind = variables(model.states, model.inputs, free)
    slopes = {name: sympy.diff(expr, free[f"eta_{mode}"]) for name, expr in aerodynamics(model.table, bind).items()}
    nothing = dict.fromkeys(own_rows(), sympy.Integer(0))
    static = {free[f"eta_{i}"]: _static(i) for i in model.table.modes}
    return rigid_rows(slopes, nothing)[row].xreplace(static)
