"""SDCOM `printed`: (27)-(35) as the paper has them, with only the misprints corrected that the audit finds."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from ..modelling import Model
from .flexible import modes_of
from .sdcom import coloured_gains, define_exact_rates
from .strict_feedback import ROWS, Parts, Row, add_row, define_part

EQUATION = "(27)"


@dataclass(frozen=True)
class PrintedForm:
    """The rates (27) as printed, their parts by row, and the rates of the exact form."""

    rates: dict[str, ca.SX]
    parts: dict[str, Parts]
    exact: dict[str, ca.SX]


def define_printed_rates(model: Model) -> PrintedForm:
    """The truncated form of the paper, beside the exact one."""
    exact, _ = define_exact_rates(model)
    parts = {row.name: _parts(model, row) for row in ROWS}
    rates = {"altitude": exact["altitude"]}
    rates |= {row.state: _define_rate(model, row, parts[row.name]) for row in ROWS}
    rates |= {f"chi_{i}": exact[f"chi_{i}"] for i in modes_of(model.table)}
    return PrintedForm(rates, parts, exact)


def printed_gains(model: Model, form: PrintedForm) -> dict[tuple[str, str], ca.SX]:
    """The diffusion of (27): the column of w_alpha is H, w_gamma drives the altitude alone."""
    gains = {(row.state, "w_alpha"): form.parts[row.name].H * model["w_alpha"] for row in ROWS}
    gains["altitude", "w_gamma"] = model["velocity"] * model["w_gamma"]
    gains["alpha", "w_q"] = model["w_q"]
    return gains | coloured_gains(model)


def add_printed_parts(model: Model, form: PrintedForm) -> None:
    """The functions of every row, and what (27) calls Delta f, so that it holds identically, and the same of H."""
    for row in ROWS:
        add_row(model, row, form.parts[row.name])
    for row in ROWS:
        doc = f"Delta f of (27): the {row.state} rate of the exact form less that of the printed one"
        difference = form.exact[row.state] - form.rates[row.state]
        model.add_scalar(f"delta_f_{row.name}", "differences", doc, EQUATION, difference, row.rate_unit(model))
    for row in ROWS:
        doc = f"H of the {row.state} row in the exact form less that of the printed one"
        difference = model.derivative(form.exact[row.state], "alpha") - form.parts[row.name].H
        unit = f"{row.rate_unit(model)}/rad"
        model.add_scalar(f"delta_H_{row.name}", "differences", doc, row.equation, difference, unit)


class _Names(dict[str, object]):
    """What the names of a printed equation stand for; a coefficient that the table does not list is 0."""

    def __missing__(self, name: str) -> ca.SX:
        if not name.startswith("c_"):
            raise KeyError(name)
        return ca.SX(0)


def _names(model: Model, row: Row) -> _Names:
    angles = {f"x.{angle}": angle for angle in ("alpha", "gamma")}
    names = _Names(model.parameters)
    mentioned = ("velocity", "gamma", "alpha", "phi", "delta_e", "dynamic_pressure", "turn_factor")
    names |= {name: model[name] for name in mentioned}
    names |= {
        "sin": lambda angle: model[f"sin_{angles[angle.name()]}"],
        "cos": lambda angle: model[f"cos_{angles[angle.name()]}"],
        # On the spherical Earth the path follows the curvature; along it gravity is whole.
        "g": model["gravity"] if row.name == "V" else model["gravity_turn"] * model["velocity"],
        # Law (4) stands in the print as this ratio; the choice of the canard scales it.
        "c_l_delta_e": -model["canard_gain"],
        "c_l_delta_c": ca.SX(1),
    }
    return names


def _evaluated(text: str, names: _Names) -> ca.SX:
    # The velocity that dynamic pressure and momentum have in common cancels, as in the exact form.
    text = text.replace("dynamic_pressure*s/(m*velocity)", "turn_factor")
    # The text is that of this package's own audit.
    return ca.SX(eval(text, {"__builtins__": {}}, names))


def _parts(model: Model, row: Row) -> Parts:
    # Here, because SymPy takes long to import and most models need none of it.
    from ..audit.corrected import corrected_expressions

    texts = corrected_expressions()
    names, unit = _names(model, row), row.rate_unit(model)
    slopes, flexible = [], ca.SX(0)
    for i in modes_of(model.table):
        of_mode = _Names(names)
        of_mode |= {"n": model[f"generalized_force_{i}"], "omega": model[f"omega_{i}"]}
        of_mode |= {f"{fit}_eta": names[f"{fit}_eta_{i}"] for fit in ("c_t", "c_l", "c_d", "c_m")}
        slopes.append(_evaluated(texts[f"h_{row.name}"], of_mode))
        flexible = flexible + _evaluated(texts[f"f_{row.name}_eta"], of_mode)
    names[f"f_{row.name}_eta"] = f_eta = define_part(model, row, "f_eta", unit, flexible, row.next_equation)
    return Parts(
        define_part(model, row, "f", unit, _evaluated(texts[f"f_{row.name}"], names), row.equation),
        define_part(model, row, "g", row.gain_unit, _evaluated(texts[f"g_{row.name}"], names), row.equation),
        tuple(slopes),
        define_part(model, row, "H", f"{unit}/rad", _evaluated(texts[f"H_{row.name}"], names), row.equation),
        f_eta,
    )


def _define_rate(model: Model, row: Row, parts: Parts) -> ca.SX:
    total = parts.f + parts.g * model[row.control]
    for i, slope in enumerate(parts.h, start=1):
        total = total + slope * model[f"chi_{i}"]
    symbol, doc = rf"\dot {{{'Q' if row.name == 'Q' else row.label}}}", f"rate of {row.state} in the printed form"
    with model.section("Printed form", EQUATION):
        return model.define(f"{row.state}_rate_printed", total, symbol, row.rate_unit(model), doc)
