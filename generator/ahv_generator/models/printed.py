"""SDCOM `printed`: (27)-(35) as the paper has them, with only the misprints corrected that the audit finds."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from ..derivatives import add_drift_and_derivatives, add_lie_derivatives
from ..model import Model
from ..stochastic import Gains, add_diffusion
from ..table import Table
from .dcom import define_surroundings
from .flexible import modes_of
from .flight import vehicle_traits
from .sdcom import EQUATION, FLEXIBLE_OUTLOOKS, coloured_gains, coloured_modes, define_exact_rates, reduced_bases
from .strict_feedback import ROWS, Parts, Row, add_row, define_part
from .vehicle import add_outlooks

NOTE = "sdcom_printed leaves out Delta f, which can exceed the exact rate itself; exact is --model sdcom"


def build_sdcom_printed(table: Table) -> Model:
    """The stochastic model in the truncated form of the paper, and what it leaves out of the exact one."""
    modes = modes_of(table)
    bases = reduced_bases(modes)
    title = "stochastic decoupled control-oriented model as printed, without its misprints"
    traits = replace(vehicle_traits(*coloured_modes(modes)), note=NOTE)
    m = Model("sdcom_printed", title, "(24)-(35)", table, bases, traits)
    define_surroundings(m)
    exact, _ = define_exact_rates(m)
    parts = {row.name: _parts(m, row) for row in ROWS}
    rates = {"altitude": exact["altitude"]} | {row.state: _define_rate(m, row, parts[row.name]) for row in ROWS}
    rates |= {f"chi_{i}": exact[f"chi_{i}"] for i in modes}
    add_drift_and_derivatives(m, rates, EQUATION)
    add_outlooks(m, *FLEXIBLE_OUTLOOKS)
    _add_diffusion(m, rates, parts)
    for row in ROWS:
        add_row(m, row, parts[row.name])
    _add_differences(m, exact, rates, parts)
    add_lie_derivatives(m, rates, EQUATION)
    return m


class _Names(dict[str, object]):
    """What the names of a printed equation stand for; a coefficient that the table does not list is 0."""

    def __missing__(self, name: str) -> ca.SX:
        if not name.startswith("c_"):
            raise KeyError(name)
        return ca.SX(0)


def _names(m: Model, row: Row) -> _Names:
    angles = {f"x.{angle}": angle for angle in ("alpha", "gamma")}
    names = _Names({p.name: m.parameter(p.name) for p in m.table.parameters})
    mentioned = ("velocity", "gamma", "alpha", "phi", "delta_e", "dynamic_pressure", "turn_factor")
    names |= {name: m[name] for name in mentioned}
    names |= {
        "sin": lambda angle: m[f"sin_{angles[angle.name()]}"],
        "cos": lambda angle: m[f"cos_{angles[angle.name()]}"],
        # On the spherical Earth the path follows the curvature; along it gravity is whole.
        "g": m["gravity"] if row.name == "V" else m["gravity_turn"] * m["velocity"],
        # Law (4) stands in the print as this ratio; the choice of the canard scales it.
        "c_l_delta_e": -m["canard_gain"],
        "c_l_delta_c": ca.SX(1),
    }
    return names


def _evaluated(text: str, names: _Names) -> ca.SX:
    # The velocity that dynamic pressure and momentum have in common cancels, as in the exact form.
    text = text.replace("dynamic_pressure*s/(m*velocity)", "turn_factor")
    # The text is that of this package's own audit.
    return ca.SX(eval(text, {"__builtins__": {}}, names))


def _parts(m: Model, row: Row) -> Parts:
    # Here, because SymPy takes long to import and most models need none of it.
    from ..audit.corrected import corrected_expressions

    texts = corrected_expressions()
    names, unit = _names(m, row), row.rate_unit(m)
    slopes, flexible = [], ca.SX(0)
    for i in modes_of(m.table):
        of_mode = _Names(names)
        of_mode |= {"n": m[f"generalized_force_{i}"], "omega": m.parameter(f"omega_{i}")}
        of_mode |= {f"{fit}_eta": names[f"{fit}_eta_{i}"] for fit in ("c_t", "c_l", "c_d", "c_m")}
        slopes.append(_evaluated(texts[f"h_{row.name}"], of_mode))
        flexible = flexible + _evaluated(texts[f"f_{row.name}_eta"], of_mode)
    names[f"f_{row.name}_eta"] = f_eta = define_part(m, row, "f_eta", unit, flexible, row.next_equation)
    return Parts(
        define_part(m, row, "f", unit, _evaluated(texts[f"f_{row.name}"], names), row.equation),
        define_part(m, row, "g", row.gain_unit, _evaluated(texts[f"g_{row.name}"], names), row.equation),
        tuple(slopes),
        define_part(m, row, "H", f"{unit}/rad", _evaluated(texts[f"H_{row.name}"], names), row.equation),
        f_eta,
    )


def _define_rate(m: Model, row: Row, parts: Parts) -> ca.SX:
    total = parts.f + parts.g * m[row.control]
    for i, slope in enumerate(parts.h, start=1):
        total = total + slope * m[f"chi_{i}"]
    return m.graph.define(
        f"{row.state}_rate_printed",
        total,
        symbol=rf"\dot {{{'Q' if row.name == 'Q' else row.label}}}",
        unit=row.rate_unit(m),
        doc=f"rate of {row.state} in the printed form",
        equation=EQUATION,
        section="Printed form",
    )


def _add_diffusion(m: Model, rates: dict[str, ca.SX], parts: dict[str, Parts]) -> None:
    gains: Gains = {(row.state, "w_alpha"): parts[row.name].H * m.parameter("w_alpha") for row in ROWS}
    gains["altitude", "w_gamma"] = m["velocity"] * m.parameter("w_gamma")
    gains["alpha", "w_q"] = m.parameter("w_q")
    gains |= coloured_gains(m)
    doc = "the column of w_alpha is H of (28)-(34), w_gamma drives the altitude alone"
    add_diffusion(m, rates, gains, doc, EQUATION)


def _add_differences(m: Model, exact: dict[str, ca.SX], rates: dict[str, ca.SX], parts: dict[str, Parts]) -> None:
    """What (27) calls Delta f, so that it holds identically, and the same of H."""
    for row in ROWS:
        doc = f"Delta f of (27): the {row.state} rate of the exact form less that of the printed one"
        difference = exact[row.state] - rates[row.state]
        m.add_scalar(f"delta_f_{row.name}", "differences", doc, EQUATION, difference, row.rate_unit(m))
    for row in ROWS:
        doc = f"H of the {row.state} row in the exact form less that of the printed one"
        difference = m.graph.derivative(exact[row.state], "x.alpha") - parts[row.name].H
        unit = f"{row.rate_unit(m)}/rad"
        m.add_scalar(f"delta_H_{row.name}", "differences", doc, row.equation, difference, unit)
