# mypy: disable-error-code="import-not-found"
"""Writes wrenfold's Rust for the timed functions.

`python wrenfold_peer.py --out DIR TABLE...` writes `peer.rs` and `peer.json`.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Callable, Mapping
from importlib.metadata import version
from pathlib import Path

import casadi as ca
from wrenfold import FunctionDescription, RustGenerator, sym, transpile
from wrenfold.type_info import MatrixType

from ahv_generator.model import Model
from ahv_generator.models import BUILDERS
from ahv_generator.table import load

_BINARY: dict[int, Callable[[sym.Expr, sym.Expr], sym.Expr]] = {
    ca.OP_ADD: lambda a, b: a + b,
    ca.OP_SUB: lambda a, b: a - b,
    ca.OP_MUL: lambda a, b: a * b,
    ca.OP_DIV: lambda a, b: a / b,
    ca.OP_POW: lambda a, b: sym.pow(a, b),
    ca.OP_CONSTPOW: lambda a, b: sym.pow(a, b),
}
_UNARY: dict[int, Callable[[sym.Expr], sym.Expr]] = {
    ca.OP_NEG: lambda a: -a,
    ca.OP_SIN: lambda a: sym.sin(a),
    ca.OP_COS: lambda a: sym.cos(a),
    ca.OP_EXP: lambda a: sym.exp(a),
    ca.OP_SQRT: lambda a: sym.sqrt(a),
    ca.OP_SQ: lambda a: a * a,
    ca.OP_TWICE: lambda a: 2 * a,
    ca.OP_INV: lambda a: 1 / a,
}


def convert(expr: ca.SX, symbols: Mapping[str, sym.Expr]) -> sym.Expr:
    """The CasADi expression as wrenfold's."""
    if expr.is_constant():
        value = float(expr)
        if value.is_integer():
            return sym.integer(int(value))
        numerator, denominator = value.as_integer_ratio()
        return sym.rational(numerator, denominator)
    if expr.is_symbolic():
        return symbols[expr.name()]
    arguments = [convert(expr.dep(i), symbols) for i in range(expr.n_dep())]
    return _BINARY[expr.op()](*arguments) if len(arguments) == 2 else _UNARY[expr.op()](*arguments)


class Formulation:
    """A model written with wrenfold, from the generator's named quantities."""

    def __init__(self, model: Model, name: str) -> None:
        self.model = model
        self.description = FunctionDescription(name)
        self.symbols: dict[str, sym.Expr] = {}
        self.state = self._argument("x", tuple(model.leaves("state").values()))
        self.input = self._argument("u", tuple(model.leaves("input").values()))
        self._argument("p", tuple(f"p.{parameter.name}" for parameter in model.table.parameters))
        for quantity in model.graph.quantities.values():
            self.symbols[quantity.name] = convert(quantity.expr, self.symbols)

    def _argument(self, name: str, leaves: tuple[str, ...]) -> list[sym.Expr]:
        vector = self.description.add_input_argument(name, MatrixType(len(leaves), 1))
        entries = [vector[i, 0] for i in range(len(leaves))]
        self.symbols |= dict(zip(leaves, entries, strict=True))
        return entries

    def drift(self) -> sym.MatrixExpr:
        """Right-hand side of the model."""
        (output,) = next(f for f in self.model.functions if f.name == "drift").outputs
        rates = {entry.at[0]: convert(entry.expr, self.symbols) for entry in output.entries}
        return sym.vector(*(rates.get(row, sym.integer(0)) for row in self.model.names("state")))

    def diffusion(self) -> sym.MatrixExpr:
        """G: columns of the Jacobian times intensities, and what the table gives for the modes."""
        (output,) = next(f for f in self.model.functions if f.name == "diffusion").outputs
        given = {entry.at: convert(entry.expr, self.symbols) for entry in output.entries}
        perturbed = {"w_gamma": "x.gamma", "w_alpha": "x.alpha", "w_q": "x.pitch_rate"}
        drift = self.drift()
        slopes = {
            increment: sym.jacobian(drift, [self.symbols[leaf]]) * self.symbols[f"p.{increment}"]
            for increment, leaf in perturbed.items()
        }
        return sym.matrix(
            [
                [
                    slopes[column][i, 0] if column in slopes else given.get((row, column), sym.integer(0))
                    for column in self.model.names("noise")
                ]
                for i, row in enumerate(self.model.names("state"))
            ]
        )

    def add(self, name: str, value: sym.MatrixExpr) -> None:
        """Add an output argument."""
        self.description.add_output_argument(name, False, value)

    def rust(self) -> str:
        """The generated function."""
        return str(RustGenerator().generate(transpile(self.description)))


def timed(model: Model) -> list[Formulation]:
    """The functions that are timed."""
    if model.name == "dcom":
        drift, both = Formulation(model, "dcom_drift"), Formulation(model, "dcom_drift_jacobians")
        drift.add("f", drift.drift())
        both.add("f", both.drift())
        both.add("f_x", sym.jacobian(both.drift(), both.state))
        both.add("f_u", sym.jacobian(both.drift(), both.input))
        return [drift, both]
    if model.name == "sdcom":
        stochastic = Formulation(model, "sdcom_drift_diffusion")
        stochastic.add("f", stochastic.drift())
        stochastic.add("g", stochastic.diffusion())
        return [stochastic]
    return []


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("tables", type=Path, nargs="+")
    arguments = parser.parse_args()

    functions: list[str] = []
    kernels: dict[str, object] = {}
    for path in arguments.tables:
        table = load(path)
        for model in (BUILDERS[name](table) for name in table.models):
            for formulation in timed(model):
                text = formulation.rust()
                functions.append(text)
                counted = re.search(r"// total: (\d+)", text)
                kernels[formulation.description.name] = {
                    "parameters": [parameter.name for parameter in table.parameters],
                    "operations": int(counted[1]) if counted else None,
                }
    (arguments.out / "peer.rs").write_text("\n".join(functions), encoding="utf-8")
    answer = {"version": version("wrenfold"), "kernels": kernels}
    (arguments.out / "peer.json").write_text(json.dumps(answer, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
