"""Models from the IR: the same expressions for CasADi, JAX and NumPy."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from operator import add, mul
from typing import Any

import numpy as np

from ._module import Known
from ._names import unknown

Tree = str | float | list[Any]
# Results by their name, each a function of the IR and the number of one of its outputs.
RESULTS = {
    "drift": ("drift", 0),
    "state_jacobian": ("jacobians", 0),
    "input_jacobian": ("jacobians", 1),
    "diffusion": ("diffusion", 0),
    "outputs": ("outputs", 0),
    "parameter_jacobian": ("parameter_jacobian", 0),
}


class Source:
    """A model of the IR: its quantities, and the results that it has."""

    def __init__(self, documents: Sequence[Mapping[str, Any]], name: str) -> None:
        document = next(it for it in documents if any(model["name"] == name for model in it["models"]))
        self.model = next(model for model in document["models"] if model["name"] == name)
        self.bases = {kind: [one["name"] for one in basis] for kind, basis in self.model["bases"].items()}
        self.bases["parameter"] = [one["name"] for one in document["parameters"]]
        self.quantities = {one["name"]: one["expr"] for one in self.model["quantities"]}
        self.functions = {function["name"]: function["outputs"] for function in self.model["functions"]}

    def results(self) -> tuple[str, ...]:
        """The results that the model has."""
        return tuple(name for name, (function, _) in RESULTS.items() if function in self.functions)

    def result(self, name: str) -> Mapping[str, Any]:
        """Basis and entries of a result."""
        if name not in self.results():
            raise unknown("result", name, self.results())
        function, index = RESULTS[name]
        found: Mapping[str, Any] = self.functions[function][index]
        return found

    def shape(self, name: str) -> tuple[int, ...]:
        """Shape of a result."""
        return tuple(len(self.bases[basis]) for basis in self.result(name)["basis"])

    def entries(self, name: str, operations: Mapping[str, Callable[..., Any]], leaves: Mapping[str, Any]) -> list[Any]:
        """Entries (place, value) of a result, in the arithmetic of ``operations``."""
        result = self.result(name)
        values: dict[str, Any] = dict(leaves)
        placed = []
        for entry in result["entries"]:
            place = tuple(self.bases[basis].index(at) for basis, at in zip(result["basis"], entry["at"], strict=True))
            placed.append((place, self._value(entry["expr"], operations, values)))
        return placed

    def _value(self, tree: Tree, operations: Mapping[str, Callable[..., Any]], values: dict[str, Any]) -> Any:
        if isinstance(tree, str):
            if tree not in values:
                values[tree] = self._value(self.quantities[tree], operations, values)
            return values[tree]
        if isinstance(tree, list):
            operator, *arguments = tree
            if operator == "pow":
                return _power(self._value(arguments[0], operations, values), arguments[1])
            return operations[operator](*(self._value(it, operations, values) for it in arguments))
        return tree


def _power(base: Any, exponent: float) -> Any:
    """A whole power, by products: no logarithm is taken, and derivatives are those of a polynomial."""
    whole = int(exponent)
    if whole < 0:
        return 1.0 / _power(base, -exponent)
    if whole < 2:
        return base if whole else 1.0
    half = _power(base, whole // 2)
    return half * half * base if whole % 2 else half * half


_ARITHMETIC: dict[str, Callable[..., Any]] = {
    "+": lambda *terms: reduce(add, terms),
    "*": lambda *factors: reduce(mul, factors),
    "-": lambda left, right: left - right,
    "/": lambda left, right: left / right,
    "neg": lambda value: -value,
}


def operations(
    module: Any, where: Callable[[Any, Any, Any], Any], names: Mapping[str, str]
) -> dict[str, Callable[..., Any]]:
    """The operators of the IR in the arithmetic of a module that calls functions by ``names`` where they differ."""
    plain = ("sin", "cos", "tan", "asin", "atan", "atan2", "exp", "tanh", "ln", "sqrt", "abs", "min", "max", "powr")
    functions = {name: getattr(module, names.get(name, name)) for name in plain}
    return {
        **_ARITHMETIC,
        **functions,
        "select": lambda left, right, below, otherwise: where(left < right, below, otherwise),
    }


_NUMPY = {
    "asin": "arcsin",
    "atan": "arctan",
    "atan2": "arctan2",
    "ln": "log",
    "min": "minimum",
    "max": "maximum",
    "powr": "power",
}
_CASADI = {"ln": "log", "abs": "fabs", "min": "fmin", "max": "fmax", "powr": "power"}


def casadi_function(model: Known, kind: str | None, parameters: bool) -> Any:
    """See `Model.casadi`."""
    import casadi as ca

    source = Source(model.module.documents(), model.name)
    # Slopes by parameters are large, and asked for by name.
    kinds = [it for it in source.results() if it != "parameter_jacobian"] if kind is None else [kind]
    x, u, p = (ca.SX.sym(name, len(basis)) for name, basis in zip("xup", _bases(model), strict=True))
    values = p if parameters else ca.DM(model.parameters.values)
    leaves = _leaves(model, (x, u, values))
    arithmetic = operations(ca, ca.if_else, _CASADI)
    results = []
    for one in kinds:
        rows, *columns = source.shape(one)
        matrix = ca.SX(rows, columns[0] if columns else 1)
        for place, value in source.entries(one, arithmetic, leaves):
            matrix[place if columns else place[0]] = value
        # A vector has no structural zeros.
        results.append(matrix if columns else ca.densify(matrix))
    arguments = {"x": x, "u": u, **({"p": p} if parameters else {})}
    return ca.Function(model.name, [*arguments.values()], results, [*arguments], [*kinds])


def jax_function(model: Known, kind: str) -> Callable[..., Any]:
    """See `Model.jax`."""
    import jax.numpy as jnp

    source = Source(model.module.documents(), model.name)
    source.result(kind)
    arithmetic = operations(jnp, jnp.where, _NUMPY)
    own = model.parameters.values

    def function(x: Any, u: Any, p: Any = own) -> Any:
        rows, *columns = source.shape(kind)
        count = math.prod(columns)
        flat: list[Any] = [0.0] * (rows * count)
        for place, value in source.entries(kind, arithmetic, _leaves(model, (x, u, p))):
            flat[place[0] * count + (place[1] if columns else 0)] = value
        dtype = jnp.result_type(x, u, jnp.float32)
        return jnp.stack([jnp.asarray(it, dtype) for it in flat]).reshape(rows, *columns)

    function.__name__ = f"{model.name}_{kind}"
    return function


def numpy_result(source: Source, kind: str, leaves: Mapping[str, Any], points: int) -> np.ndarray[Any, Any]:
    """A result at many points, (points, …), by NumPy."""
    result = np.zeros((points, *source.shape(kind)))
    for place, value in source.entries(kind, operations(np, np.where, _NUMPY), leaves):
        result[(slice(None), *place)] = value
    return result


def _bases(model: Known) -> tuple[Sequence[str], ...]:
    return model.states.names, model.inputs.names, model.parameter_names.names


def _leaves(model: Known, vectors: Sequence[Any]) -> dict[str, Any]:
    """Leaves of the IR by name, of vectors whose components lie in the first dimension."""
    return {
        f"{prefix}.{name}": vector[index]
        for prefix, names, vector in zip("xup", _bases(model), vectors, strict=True)
        for index, name in enumerate(names)
    }
