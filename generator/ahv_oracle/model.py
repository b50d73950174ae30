"""The models' vectors and drifts, (1)-(4) and (23)-(25), as SymPy expressions."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from sympy import Expr, Symbol

from .modes import cantilever_rows, ornstein_uhlenbeck, oscillator, restoring, static_deflection
from .names import Names, symbol
from .printed import printed_rows
from .table import Table, TableError
from .vehicle import (
    RIGID,
    Binding,
    aerodynamics,
    density,
    generalised_forces,
    own_rows,
    pitching_moment,
    polynomial,
    pressure_force,
    rigid_quantities,
    rigid_rows,
    variables,
)

MODELS = ("com_rigid", "com", "dcom", "sdcom", "sdcom_printed", "sdcom_gust", "flexible_mode")
"""Names of the models that the oracle knows."""

RIGID_NOISES = ("w_gamma", "w_alpha", "w_q")
"""Formal white noise in flight-path angle, incidence and pitch rate."""


@dataclass(frozen=True)
class Model:
    """Names of a model's vectors, its drift row by row, and its quantities by the name of their function."""

    name: str
    table: Table
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    noises: tuple[str, ...]
    extra: tuple[str, ...] = ()
    names: Names = field(default_factory=Names)
    drift: dict[str, Expr] = field(default_factory=dict)
    quantities: dict[str, Expr] = field(default_factory=dict)

    def arguments(self) -> dict[str, Symbol]:
        """All symbols of the model by qualified name (``state.velocity``), in column order."""
        names = {
            "state": self.states,
            "input": self.inputs,
            "noise": self.noises,
            "parameter": tuple(self.table.values),
            "argument": self.extra,
        }
        return {f"{kind}.{name}": symbol(kind, name) for kind in names for name in names[kind]}


def build_model(table: Table, name: str) -> Model:
    """Build the model `name` from the monomials of `table`."""
    if name not in MODELS or name not in table.models:
        raise TableError(f"{table.name}: no model {name!r}")
    if name == "flexible_mode":
        return _flexible_mode(table)
    if name.startswith("com"):
        return _com(table, name)
    return _dcom(table) if name == "dcom" else _sdcom(table, name)


def _flexible_mode(table: Table) -> Model:
    states = ("eta", "eta_dot", "chi")
    model = Model("flexible_mode", table, states, ("force",), ("xi",), ("time", "frequency"))
    model.drift["eta"] = symbol("state", "eta_dot")
    model.drift["eta_dot"] = restoring(None, symbol("input", "force"))
    model.drift["chi"] = ornstein_uhlenbeck(model.names, None)
    return model


def _com(table: Table, name: str) -> Model:
    modes = table.modes if name == "com" else ()
    inputs = ("phi", "delta_e")
    model = Model(name, table, RIGID + _oscillators(modes), inputs, ())
    bind = variables(model.states, inputs)
    fits = _named_fits(model, bind)
    rows = rigid_rows(model.names, fits, own_rows())
    model.quantities.update(rigid_quantities(model.names, fits))
    if name == "com":
        forces = generalised_forces(table, model.names, bind)
        rows |= cantilever_rows(model.names, pitching_moment(model.names, fits), forces)
        model.quantities.update({f"generalized_force_{i}": force for i, force in forces.items()})
    _set_drift(model, rows)
    return model


def _dcom(table: Table) -> Model:
    model = Model("dcom", table, RIGID + _oscillators(table.modes), _dcom_inputs(), _dcom_noises(table))
    bind = variables(model.states, model.inputs)
    forces = generalised_forces(table, model.names, bind)
    fits = _named_fits(model, bind)
    rows = rigid_rows(model.names, fits, own_rows())
    for i, force in forces.items():
        rows |= oscillator(i, force)
    model.quantities.update(rigid_quantities(model.names, fits) | _forces(model, bind, forces))
    _set_drift(model, rows)
    return model


def _sdcom(table: Table, name: str) -> Model:
    states, noises = RIGID + tuple(f"chi_{i}" for i in table.modes), _dcom_noises(table)
    if name == "sdcom_gust":
        states += ("alpha_gust",)
        noises = (*(noise for noise in noises if noise not in ("w_gamma", "w_alpha")), "w_gust")
    model = Model(name, table, states, _dcom_inputs(), noises)
    bind, forces = reduced_binding(model)
    modal_quantities = _forces(model, bind, forces)
    for i, force in forces.items():
        modal_quantities |= {f"eta_static_{i}": static_deflection(i, force), f"eta_{i}": bind(f"eta_{i}")}
    if name == "sdcom_printed":
        air = {"density": density(model.names)}
        air["dynamic_pressure"] = pressure_force(model.names) / symbol("parameter", "s")
        model.quantities.update(air | modal_quantities)
        rows = printed_rows(table, model.names, forces)
    else:
        fits = _named_fits(model, bind)
        model.quantities.update(rigid_quantities(model.names, fits) | modal_quantities)
        rows = rigid_rows(model.names, fits, own_rows())
    for i in table.modes:
        rows[f"chi_{i}"] = ornstein_uhlenbeck(model.names, i)
    if name == "sdcom_gust":
        rows["alpha_gust"] = -symbol("state", "alpha_gust") / symbol("parameter", "gust_time")
    _set_drift(model, rows)
    return model


def reduced_binding(model: Model) -> tuple[Binding, dict[int, Expr]]:
    """What the monomials of a reduced model are written in, (25), and the generalised forces by mode."""
    incidence: dict[str, Expr] = {}
    if "alpha_gust" in model.states:
        incidence["alpha"] = symbol("state", "alpha") + symbol("state", "alpha_gust")
    forces = generalised_forces(model.table, model.names, variables(model.states, model.inputs, incidence))
    etas = {
        f"eta_{i}": model.names.name(f"eta_{i}", static_deflection(i, force) + symbol("state", f"chi_{i}"))
        for i, force in forces.items()
    }
    return variables(model.states, model.inputs, etas | incidence), forces


def exact_rows(model: Model) -> dict[str, Expr]:
    """Rigid rows of SDCOM with everything that (1)-(4) and (25) imply, for a model with its states."""
    bind, _ = reduced_binding(model)
    return rigid_rows(model.names, _named_fits(model, bind), own_rows())


def _named_fits(model: Model, bind: Binding) -> dict[str, Expr]:
    fits = aerodynamics(model.table, bind)
    return {quantity: model.names.name(quantity.lower(), fit) for quantity, fit in fits.items()}


def _forces(model: Model, bind: Binding, forces: Mapping[int, Expr]) -> dict[str, Expr]:
    found: dict[str, Expr] = {}
    for i, force in forces.items():
        found |= {f"c_n_{i}": polynomial(model.table, f"C_N_{i}", bind), f"generalized_force_{i}": force}
    return found


def _set_drift(model: Model, rows: Mapping[str, Expr]) -> None:
    for row in model.states:
        model.drift[row] = model.names.name(f"drift_{row}", rows[row])


def _oscillators(modes: tuple[int, ...]) -> tuple[str, ...]:
    return tuple(f"{state}_{i}" for i in modes for state in ("eta", "eta_dot"))


def _dcom_inputs() -> tuple[str, ...]:
    return ("phi", "delta_e", "delta_c")


def _dcom_noises(table: Table) -> tuple[str, ...]:
    return (*RIGID_NOISES, *(f"xi_{i}" for i in table.modes))
