"""The models as one writes them for a symbolic tool: full expressions of states, inputs and parameters."""

from __future__ import annotations

import sys
from collections.abc import Iterable

import casadi as ca

from ahv_generator.function import Function, Output
from ahv_generator.model import Model

sys.setrecursionlimit(10_000)


class Expansion:
    """Quantities of a model, each replaced by what it is made of, down to the leaves."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._known: dict[str, ca.SX] = {}

    def leaves(self, basis: str) -> ca.SX:
        """The symbols of a basis as a column."""
        return self._column(self.model.leaves(basis).values() if basis in self.model.bases else ())

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
        (drift,) = self._function("drift").outputs
        return ca.densify(self._dense(drift))

    def jacobian(self, basis: str) -> ca.SX:
        """Derivative of the drift, by CasADi on the full expression."""
        return ca.jacobian(self.drift(), self.parameters() if basis == "parameter" else self.leaves(basis))

    def hessian(self) -> ca.SX:
        """Second derivatives of the drift by two states, of each pair one."""
        rows = ca.vertsplit(self.drift())
        return ca.horzcat(*(ca.tril(ca.hessian(row, self.leaves("state"))[0]) for row in rows))

    def diffusion(self) -> ca.SX:
        """G: columns of the Jacobian times intensities, and what the generator gives for the other columns."""
        (output,) = self._function("diffusion").outputs
        given = self._dense(output)
        perturbed = {"w_gamma": "x.gamma", "w_alpha": "x.alpha", "w_q": "x.pitch_rate"}
        if self.model.name == "sdcom_printed":
            perturbed = {}  # its H is not the derivative of its drift
        columns = []
        for j, increment in enumerate(self.model.names("noise")):
            if increment in perturbed:
                slope = ca.jacobian(self.drift(), self.model.graph.symbols[perturbed[increment]])
                columns.append(slope * self.model[increment])
            else:
                columns.append(given[:, j])
        return ca.horzcat(*columns)

    def matrices(self, function: Function) -> list[ca.SX]:
        """What a function computes; first and second derivatives of the drift are CasADi's, of full expressions."""
        drift, diffusion = self.drift, self.diffusion
        derived = {
            "jacobians": lambda: [self.jacobian("state"), self.jacobian("input")],
            "drift_and_jacobians": lambda: [drift(), self.jacobian("state"), self.jacobian("input")],
            "parameter_jacobian": lambda: [self.jacobian("parameter")],
            "hessian": lambda: [self.hessian()],
            "diffusion": lambda: [diffusion()],
            "drift_and_diffusion": lambda: [drift(), diffusion()],
        }
        if function.name in derived:
            return derived[function.name]()
        return [ca.vertcat(*(self.expand(entry.expr) for entry in output.entries)) for output in function.outputs]

    def _dense(self, output: Output) -> ca.SX:
        """A vector or a matrix of the generator, expanded, with structural zeros."""
        rows, *columns = (self.model.names(basis) for basis in output.basis)
        found = ca.SX(len(rows), len(columns[0]) if columns else 1)
        for entry in output.entries:
            column = columns[0].index(entry.at[1]) if columns else 0
            found[rows.index(entry.at[0]), column] = self.expand(entry.expr)
        return found

    def _column(self, names: Iterable[str]) -> ca.SX:
        return ca.vertcat(*(self.model.graph.symbols[name] for name in names))

    def _function(self, name: str) -> Function:
        return next(f for f in self.model.functions if f.name == name)

    def _quantity(self, name: str) -> ca.SX:
        if name not in self._known:
            self._known[name] = self.expand(self.model.graph.quantities[name].expr)
        return self._known[name]
