"""The rigid body of (1) to (4): curve fits, forces and the rows of the equations of motion."""

from collections.abc import Callable, Mapping

import sympy
from sympy import Expr

from .names import Names, symbol
from .table import Table, TableError

RIGID = ("velocity", "altitude", "gamma", "alpha", "pitch_rate")
"""States of the rigid body."""

Binding = Callable[[str], Expr]
"""What a variable of a monomial stands for."""


def variables(states: tuple[str, ...], inputs: tuple[str, ...], replaced: Mapping[str, Expr] | None = None) -> Binding:
    """Binds the variables of monomials; the canard is the one that the airframe sees, (4)."""
    bound: dict[str, Expr] = {name: symbol("state", name) for name in states}
    bound |= {name: symbol("input", name) for name in inputs}
    if "delta_c" in bound:
        ratio = symbol("parameter", "c_l_delta_e") / symbol("parameter", "c_l_delta_c")
        slaved = symbol("parameter", "canard_slaving") * ratio * bound["delta_e"]
        bound["delta_c"] = symbol("parameter", "canard_command") * bound["delta_c"] - slaved
    bound |= replaced or {}

    def bind(name: str) -> Expr:
        if name not in bound:
            raise TableError(f"a monomial holds {name!r}, which this model does not have")
        return bound[name]

    return bind


def polynomial(table: Table, quantity: str, bind: Binding) -> Expr:
    """Return the sum of coefficients times monomials of one quantity, (3)."""
    if quantity not in table.quantities:
        raise TableError(f"{table.name}: the section [{quantity}] is missing")
    terms = [
        sympy.Mul(symbol("parameter", term.parameter), *(bind(name) ** power for name, power in term.powers))
        for term in table.quantities[quantity]
    ]
    return sympy.Add(*terms)


def aerodynamics(table: Table, bind: Binding) -> dict[str, Expr]:
    """Return the polynomials of the rigid body: ``C_L``, ``C_D``, ``C_M`` and ``T`` or ``C_T``."""
    if ("T" in table.quantities) == ("C_T" in table.quantities):
        raise TableError(f"{table.name}: needs one of [T] and [C_T]")
    thrust = "T" if "T" in table.quantities else "C_T"
    return {quantity: polynomial(table, quantity, bind) for quantity in ("C_L", "C_D", "C_M", thrust)}


def generalised_forces(table: Table, names: Names, bind: Binding) -> dict[int, Expr]:
    """N_i by mode: qbar S C_N_i of (2), or what [N_i] gives."""
    forces: dict[int, Expr] = {}
    for i in table.modes:
        if f"N_{i}" in table.quantities:
            force = polynomial(table, f"N_{i}", bind)
        else:
            force = pressure_force(names) * names.name(f"c_n_{i}", polynomial(table, f"C_N_{i}", bind))
        forces[i] = names.name(f"force_{i}", force)
    return forces


def density(names: Names) -> Expr:
    """Air density of the exponential atmosphere."""
    decay = (symbol("state", "altitude") - symbol("parameter", "h_0")) / symbol("parameter", "h_s")
    return names.name("density", symbol("parameter", "rho_0") * sympy.exp(-decay))


def pressure_force(names: Names) -> Expr:
    """Dynamic pressure times reference area."""
    pressure = sympy.Rational(1, 2) * density(names) * symbol("state", "velocity") ** 2
    return names.name("pressure_force", pressure * symbol("parameter", "s"))


def turning_rate(names: Names) -> Expr:
    """Dynamic pressure times reference area, over m V, with V cancelled."""
    flow = sympy.Rational(1, 2) * density(names) * symbol("state", "velocity") * symbol("parameter", "s")
    return names.name("turning_rate", flow / symbol("parameter", "m"))


def sine_and_cosine(names: Names) -> tuple[Expr, Expr]:
    """Sine and cosine of the angle of attack, by name."""
    alpha = symbol("state", "alpha")
    return names.name("sin_alpha", sympy.sin(alpha)), names.name("cos_alpha", sympy.cos(alpha))


def thrust_force(names: Names, coefficients: Mapping[str, Expr]) -> Expr:
    """Thrust from [T] or [C_T]."""
    return coefficients["T"] if "T" in coefficients else pressure_force(names) * coefficients["C_T"]


def pitching_moment(names: Names, coefficients: Mapping[str, Expr]) -> Expr:
    """M of (2)."""
    aerodynamic = symbol("parameter", "c_bar") * pressure_force(names) * coefficients["C_M"]
    return symbol("parameter", "z_t") * thrust_force(names, coefficients) + aerodynamic


def rigid_rows(names: Names, coefficients: Mapping[str, Expr], rest: Mapping[str, Expr]) -> dict[str, Expr]:
    """Rows of (1): what is linear in the coefficient polynomials, plus `rest`."""
    force, flow = pressure_force(names), turning_rate(names)
    sine, cosine = sine_and_cosine(names)
    mass, inertia = symbol("parameter", "m"), symbol("parameter", "i_yy")
    thrust = thrust_force(names, coefficients)
    if "T" in coefficients:
        thrust_turn = thrust / (mass * symbol("state", "velocity"))
    else:
        thrust_turn = flow * coefficients["C_T"]
    turn = flow * coefficients["C_L"] + thrust_turn * sine
    pitch = symbol("parameter", "c_bar") * force * coefficients["C_M"]
    return {
        "velocity": thrust * cosine / mass - force * coefficients["C_D"] / mass + rest["velocity"],
        "altitude": rest["altitude"],
        "gamma": turn + rest["gamma"],
        "alpha": -turn + rest["alpha"],
        "pitch_rate": symbol("parameter", "z_t") * thrust / inertia + pitch / inertia + rest["pitch_rate"],
    }


def gravity_turn() -> tuple[Expr, Expr]:
    """Gravity along the flight path's tangent and the turn rate by apparent gravity, on the chosen Earth."""
    velocity, gamma = symbol("state", "velocity"), symbol("state", "gamma")
    curvature = symbol("parameter", "spherical_earth") / symbol("parameter", "r_e")
    stretch = 1 + curvature * symbol("state", "altitude")
    gravity = symbol("parameter", "g") / stretch**2
    turn = gravity * sympy.cos(gamma) / velocity - curvature * velocity * sympy.cos(gamma) / stretch
    return gravity * sympy.sin(gamma), turn


def own_rows() -> dict[str, Expr]:
    """Return the part of (1) without aerodynamics: gravity and kinematics."""
    weight, turn = gravity_turn()
    return {
        "velocity": -weight,
        "altitude": symbol("state", "velocity") * sympy.sin(symbol("state", "gamma")),
        "gamma": -turn,
        "alpha": symbol("state", "pitch_rate") + turn,
        "pitch_rate": sympy.Integer(0),
    }


def rigid_quantities(names: Names, fits: Mapping[str, Expr]) -> dict[str, Expr]:
    """Air, curve fits, forces and moment of (2) and (3), by the name of their function."""
    force = pressure_force(names)
    found = {"density": density(names), "dynamic_pressure": force / symbol("parameter", "s")}
    found |= {name.lower(): fit for name, fit in fits.items() if name != "T"}
    return found | {
        "thrust": thrust_force(names, fits),
        "lift": force * fits["C_L"],
        "drag": force * fits["C_D"],
        "pitching_moment": pitching_moment(names, fits),
    }
