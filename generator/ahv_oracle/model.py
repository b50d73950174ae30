"""The equations of motion, (1)-(4) and (23)-(25), as SymPy expressions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import sympy
from sympy import Expr, Symbol

from .table import Table, TableError

MODELS = ("com", "dcom", "sdcom")
"""Names of the models that the oracle knows."""

RIGID = ("velocity", "altitude", "gamma", "alpha", "pitch_rate")
"""States of the rigid body."""

Binding = Callable[[str], Expr]
"""What a variable of a monomial stands for."""


def symbol(kind: str, name: str) -> Symbol:
    """Return the symbol of a state, input, noise, parameter, or of a generalised force kept whole."""
    return Symbol(f"{kind}_{name}", real=True)


@dataclass(frozen=True)
class Model:
    """Names of a model's vectors and its drift, row by row."""

    name: str
    table: Table
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    noises: tuple[str, ...]
    drift: Mapping[str, Expr]

    def arguments(self) -> dict[str, Symbol]:
        """All symbols of the model by qualified name (``state.velocity``), in column order."""
        names = {
            "state": self.states,
            "input": self.inputs,
            "noise": self.noises,
            "parameter": tuple(self.table.values),
        }
        return {f"{kind}.{name}": symbol(kind, name) for kind in names for name in names[kind]}


def build_model(table: Table, name: str) -> Model:
    """Build the model `name` from the monomials of `table`."""
    if name not in MODELS or name not in table.models:
        raise TableError(f"{table.name}: no model {name!r}")
    inputs = ("phi", "delta_e") if name == "com" else ("phi", "delta_e", "delta_c")
    modes = () if name == "com" else table.modes
    flexible: tuple[str, ...] = ()
    noises: tuple[str, ...] = ()
    if name == "dcom":
        flexible = tuple(f"{state}_{i}" for i in modes for state in ("eta", "eta_dot"))
    if name == "sdcom":
        flexible = tuple(f"chi_{i}" for i in modes)
        noises = ("w_gamma", "w_alpha", "w_q", *(f"xi_{i}" for i in modes))
    states = RIGID + flexible
    return Model(name, table, states, inputs, noises, _drift(table, name, states, inputs))


def _bindings(
    table: Table, name: str, states: tuple[str, ...], inputs: tuple[str, ...]
) -> tuple[Binding, dict[int, Expr]]:
    """What the monomials are written in, and the generalised forces by mode."""
    rigid = variables(states, inputs)
    forces = generalised_forces(table, rigid) if name != "com" else {}
    if name != "sdcom":
        return rigid, forces
    etas = {f"eta_{i}": static_deflection(i, force) + symbol("state", f"chi_{i}") for i, force in forces.items()}
    return variables(states, inputs, etas), forces


def _drift(table: Table, name: str, states: tuple[str, ...], inputs: tuple[str, ...]) -> dict[str, Expr]:
    bind, forces = _bindings(table, name, states, inputs)
    rows = rigid_rows(aerodynamics(table, bind), own_rows())
    for i, force in forces.items():
        rows |= _mode(i) if name == "sdcom" else _oscillator(i, force)
    return {state: rows[state] for state in states}


def quantities(model: Model) -> dict[str, Expr]:
    """Air, curve fits, forces, moment and modal quantities of (2), (3) and (25), by the name of their function."""
    bind, forces = _bindings(model.table, model.name, model.states, model.inputs)
    fits = aerodynamics(model.table, bind)
    force = pressure_force()
    thrust = fits["T"] if "T" in fits else force * fits["C_T"]
    moment = symbol("parameter", "z_t") * thrust + force * symbol("parameter", "c_bar") * fits["C_M"]
    found = {"density": density(), "dynamic_pressure": force / symbol("parameter", "s")}
    found |= {name.lower(): fit for name, fit in fits.items() if name != "T"}
    found |= {"thrust": thrust, "lift": force * fits["C_L"], "drag": force * fits["C_D"], "pitching_moment": moment}
    for i, generalised in forces.items():
        found |= {f"c_n_{i}": polynomial(model.table, f"C_N_{i}", bind), f"generalized_force_{i}": generalised}
        if model.name == "sdcom":
            found |= {f"eta_static_{i}": static_deflection(i, generalised), f"eta_{i}": bind(f"eta_{i}")}
    return found


def static_deflection(mode: int, force: Expr) -> Expr:
    """N_i / omega_i^2 of (25)."""
    return force / _omega(mode) ** 2


def variables(states: tuple[str, ...], inputs: tuple[str, ...], replaced: Mapping[str, Expr] | None = None) -> Binding:
    """Binds the variables of monomials; the canard is the one that the airframe sees, (4)."""
    bound: dict[str, Expr] = {name: symbol("state", name) for name in states}
    bound |= {name: symbol("input", name) for name in inputs}
    if "delta_c" in bound:
        ratio = symbol("parameter", "c_l_delta_e") / symbol("parameter", "c_l_delta_c")
        slaved = symbol("parameter", "canard_slaving") * ratio * bound["delta_e"]
        bound["delta_c"] = bound["delta_c"] - slaved
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


def generalised_forces(table: Table, bind: Binding) -> dict[int, Expr]:
    """N_i = qbar S C_N_i by mode, (2)."""
    return {i: pressure_force() * polynomial(table, f"C_N_{i}", bind) for i in table.modes}


def density() -> Expr:
    """Air density of the exponential atmosphere."""
    decay = (symbol("state", "altitude") - symbol("parameter", "h_0")) / symbol("parameter", "h_s")
    return symbol("parameter", "rho_0") * sympy.exp(-decay)


def pressure_force() -> Expr:
    """Dynamic pressure times reference area."""
    return sympy.Rational(1, 2) * density() * symbol("state", "velocity") ** 2 * symbol("parameter", "s")


def rigid_rows(coefficients: Mapping[str, Expr], rest: Mapping[str, Expr]) -> dict[str, Expr]:
    """Rows of (1): what is linear in the coefficient polynomials, plus `rest`."""
    force, alpha = pressure_force(), symbol("state", "alpha")
    mass, inertia = symbol("parameter", "m"), symbol("parameter", "i_yy")
    momentum = mass * symbol("state", "velocity")
    thrust = coefficients["T"] if "T" in coefficients else force * coefficients["C_T"]
    turn = force * coefficients["C_L"] / momentum + thrust * sympy.sin(alpha) / momentum
    pitch = symbol("parameter", "c_bar") * force * coefficients["C_M"]
    return {
        "velocity": thrust * sympy.cos(alpha) / mass - force * coefficients["C_D"] / mass + rest["velocity"],
        "altitude": rest["altitude"],
        "gamma": turn + rest["gamma"],
        "alpha": -turn + rest["alpha"],
        "pitch_rate": symbol("parameter", "z_t") * thrust / inertia + pitch / inertia + rest["pitch_rate"],
    }


def own_rows() -> dict[str, Expr]:
    """Return the part of (1) without aerodynamics: gravity and kinematics, on the Earth that is chosen."""
    velocity, gamma = symbol("state", "velocity"), symbol("state", "gamma")
    curvature = symbol("parameter", "spherical_earth") / symbol("parameter", "r_e")
    stretch = 1 + curvature * symbol("state", "altitude")
    gravity = symbol("parameter", "g") / stretch**2
    turn = gravity * sympy.cos(gamma) / velocity - curvature * velocity * sympy.cos(gamma) / stretch
    return {
        "velocity": -gravity * sympy.sin(gamma),
        "altitude": velocity * sympy.sin(gamma),
        "gamma": -turn,
        "alpha": symbol("state", "pitch_rate") + turn,
        "pitch_rate": sympy.Integer(0),
    }


def _omega(mode: int) -> Symbol:
    return symbol("parameter", f"omega_{mode}")


def _oscillator(mode: int, force: Expr) -> dict[str, Expr]:
    eta, rate = symbol("state", f"eta_{mode}"), symbol("state", f"eta_dot_{mode}")
    damping = 2 * symbol("parameter", f"zeta_{mode}") * _omega(mode) * rate
    return {f"eta_{mode}": rate, f"eta_dot_{mode}": -damping - _omega(mode) ** 2 * eta + force}


def _mode(mode: int) -> dict[str, Expr]:
    chi = symbol("state", f"chi_{mode}")
    return {f"chi_{mode}": -symbol("parameter", f"zeta_{mode}") * _omega(mode) * chi}
