"""The models as one writes them for a symbolic tool: full expressions of states, inputs and parameters."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass

import casadi as ca

from ahv_generator.model import Function, Model

sys.setrecursionlimit(10_000)


@dataclass(frozen=True)
class Output:
    """A vector (`columns` is empty) or a matrix over named rows and columns; cells not listed are zero."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    cells: dict[tuple[str, ...], ca.SX]

    def dense(self) -> ca.SX:
        """The output as a CasADi matrix, with structural zeros."""
        found = ca.SX(len(self.rows), max(len(self.columns), 1))
        for at, expr in self.cells.items():
            column = self.columns.index(at[1]) if self.columns else 0
            found[self.rows.index(at[0]), column] = expr
        return found


class Expansion:
    """Quantities of a model, each replaced by what it is made of, down to the leaves."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._known: dict[str, ca.SX] = {}

    def leaves(self, basis: str) -> ca.SX:
        """The symbols of a basis as a column."""
        return self._column(self.model.qualified(basis) if basis in self.model.bases else ())

    def parameters(self) -> ca.SX:
        """The symbols of the parameters as a column, in the order of the table."""
        return self._column(f"p.{parameter.name}" for parameter in self.model.table.parameters)

    def expand(self, expr: ca.SX) -> ca.SX:
        """`expr` in the leaves alone."""
        inner = [symbol for symbol in ca.symvar(expr) if symbol.name() in self.model.graph.quantities]
        if not inner:
            return expr
        return ca.substitute(expr, ca.vertcat(*inner), ca.vertcat(*(self._quantity(s.name()) for s in inner)))

    def drift(self) -> ca.SX:
        """Right-hand side of the model."""
        (drift,) = self.outputs(self._function("drift"))
        return ca.densify(drift.dense())

    def jacobian(self, basis: str) -> ca.SX:
        """Derivative of the drift, by CasADi on the full expression."""
        return ca.jacobian(self.drift(), self.leaves(basis))

    def diffusion(self) -> ca.SX:
        """G: columns of the Jacobian times intensities, and what the table gives for the modes."""
        (given,) = self.outputs(self._function("diffusion"))
        perturbed = {"w_gamma": "x.gamma", "w_alpha": "x.alpha", "w_q": "x.pitch_rate"}
        columns = []
        for j, increment in enumerate(given.columns):
            if increment in perturbed:
                slope = ca.jacobian(self.drift(), self.model.graph.symbols[perturbed[increment]])
                columns.append(slope * self.model.parameter(increment))
            else:
                columns.append(given.dense()[:, j])
        return ca.horzcat(*columns)

    def matrices(self, function: Function) -> list[ca.SX]:
        """The outputs of a function; derivatives are CasADi's, of full expressions."""
        if function.name == "jacobians":
            return [self.jacobian("state"), self.jacobian("input")]
        if function.name == "drift_and_jacobians":
            return [self.drift(), self.jacobian("state"), self.jacobian("input")]
        if function.name == "diffusion":
            return [self.diffusion()]
        if function.name == "drift_and_diffusion":
            return [self.drift(), self.diffusion()]
        return [output.dense() for output in self.outputs(function)]

    def outputs(self, function: Function) -> list[Output]:
        """The outputs of a function as the generator has them, expanded."""
        return [
            Output(
                self.model.names(output.basis[0]) if output.basis else ("",),
                self.model.names(output.basis[1]) if len(output.basis) > 1 else (),
                {(entry.at or ("",)): self.expand(entry.expr) for entry in output.entries},
            )
            for output in function.outputs
        ]

    def _column(self, names: Iterable[str]) -> ca.SX:
        return ca.vertcat(*(self.model.graph.symbols[name] for name in names))

    def _function(self, name: str) -> Function:
        return next(f for f in self.model.functions if f.name == name)

    def _quantity(self, name: str) -> ca.SX:
        if name not in self._known:
            self._known[name] = self.expand(self.model.graph.quantities[name].expr)
        return self._known[name]
