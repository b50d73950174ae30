"""The timed functions in the algebra of another symbolic tool, from the generator's named quantities."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import casadi as ca

from ahv_generator.function import Output
from ahv_generator.model import Model

PERTURBED = {"w_gamma": "x.gamma", "w_alpha": "x.alpha", "w_q": "x.pitch_rate"}


class Algebra(NamedTuple):
    """What a tool calls its functions."""

    rational: Callable[[int, int], Any]
    power: Callable[[Any, Any], Any]
    sin: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    exp: Callable[[Any], Any]
    sqrt: Callable[[Any], Any]

    def operations(self) -> dict[int, Callable[..., Any]]:
        """By CasADi's operation."""
        return {
            ca.OP_ADD: lambda a, b: a + b,
            ca.OP_SUB: lambda a, b: a - b,
            ca.OP_MUL: lambda a, b: a * b,
            ca.OP_DIV: lambda a, b: a / b,
            ca.OP_POW: self.power,
            ca.OP_CONSTPOW: self.power,
            ca.OP_NEG: lambda a: -a,
            ca.OP_SIN: self.sin,
            ca.OP_COS: self.cos,
            ca.OP_EXP: self.exp,
            ca.OP_SQRT: self.sqrt,
            ca.OP_SQ: lambda a: a * a,
            ca.OP_TWICE: lambda a: 2 * a,
            ca.OP_INV: lambda a: 1 / a,
        }


class Formulation:
    """A model in a tool's algebra; `leaves` are the tool's symbols for states, inputs and parameters."""

    def __init__(self, model: Model, algebra: Algebra, leaves: Mapping[str, Any]) -> None:
        self.model = model
        self._algebra = algebra
        self._operations = algebra.operations()
        self.symbols = dict(leaves)
        for quantity in model.graph.quantities.values():
            self.symbols[quantity.name] = self._convert(quantity.expr)

    def drift(self) -> list[Any]:
        """Right-hand side of the model."""
        rates = {entry.at[0]: self._convert(entry.expr) for entry in self._output("drift").entries}
        return [rates.get(row, self._algebra.rational(0, 1)) for row in self.model.names("state")]

    def diffusion(self, derivative: Callable[[Any, Any], Any]) -> list[list[Any]]:
        """G row by row: derivatives of the drift times intensities, and what the table gives for the modes."""
        given = {entry.at: self._convert(entry.expr) for entry in self._output("diffusion").entries}

        def entry(row: str, rate: Any, column: str) -> Any:  # noqa: ANN401 (the tool's expressions)
            if column in PERTURBED:
                return derivative(rate, self.symbols[PERTURBED[column]]) * self.symbols[f"p.{column}"]
            return given.get((row, column), self._algebra.rational(0, 1))

        rows = zip(self.model.names("state"), self.drift(), strict=True)
        return [[entry(row, rate, column) for column in self.model.names("noise")] for row, rate in rows]

    def _output(self, name: str) -> Output:
        (output,) = next(f for f in self.model.functions if f.name == name).outputs
        return output

    def _convert(self, expr: ca.SX) -> Any:  # noqa: ANN401 (the tool's expression)
        if expr.is_constant():
            return self._algebra.rational(*float(expr).as_integer_ratio())
        if expr.is_symbolic():
            return self.symbols[expr.name()]
        return self._operations[expr.op()](*(self._convert(expr.dep(i)) for i in range(expr.n_dep())))


def leaves(model: Model) -> dict[str, list[str]]:
    """Names of the leaves in each argument, in order."""
    return {
        "x": list(model.leaves("state").values()),
        "u": list(model.leaves("input").values()),
        "p": [f"p.{parameter.name}" for parameter in model.table.parameters],
    }
