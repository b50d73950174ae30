# mypy: disable-error-code="import-not-found"
"""Writes wrenfold's Rust for the timed functions.

`python wrenfold_peer.py --out DIR TABLE...` writes `peer.rs` and `peer.json`.
"""

from __future__ import annotations

import argparse
import json
import re
from pathlib import Path

from wrenfold import FunctionDescription, RustGenerator, sym, transpile
from wrenfold.type_info import MatrixType

from ahv_generator.model import Model
from ahv_generator.table import load
from formulation import Algebra, Formulation, leaves

ALGEBRA = Algebra(sym.rational, sym.pow, sym.sin, sym.cos, sym.exp, sym.sqrt)


class Described:
    """A function of a model, written with wrenfold."""

    def __init__(self, model: Model, name: str) -> None:
        self.name = name
        self._description = FunctionDescription(name)
        self.arguments: dict[str, list[sym.Expr]] = {}
        symbols: dict[str, sym.Expr] = {}
        for argument, names in leaves(model).items():
            vector = self._description.add_input_argument(argument, MatrixType(len(names), 1))
            self.arguments[argument] = [vector[i, 0] for i in range(len(names))]
            symbols |= dict(zip(names, self.arguments[argument], strict=True))
        self._formulation = Formulation(model, ALGEBRA, symbols)
        self.drift = sym.vector(*self._formulation.drift())

    def jacobian(self, argument: str) -> sym.MatrixExpr:
        """Derivative of the drift."""
        return sym.jacobian(self.drift, self.arguments[argument])

    def diffusion(self) -> sym.MatrixExpr:
        """G."""
        return sym.matrix(self._formulation.diffusion(lambda rate, leaf: rate.diff(leaf)))

    def rust(self, **outputs: sym.MatrixExpr) -> str:
        """The function that gives these outputs."""
        for name, value in outputs.items():
            self._description.add_output_argument(name, False, value)
        return str(RustGenerator().generate(transpile(self._description)))


def timed(model: Model) -> dict[str, str]:
    """The functions that are timed, by name."""
    if model.name == "dcom":
        drift, both = Described(model, "dcom_drift"), Described(model, "dcom_drift_jacobians")
        return {
            drift.name: drift.rust(f=drift.drift),
            both.name: both.rust(f=both.drift, f_x=both.jacobian("x"), f_u=both.jacobian("u")),
        }
    if model.name == "sdcom":
        stochastic = Described(model, "sdcom_drift_diffusion")
        return {stochastic.name: stochastic.rust(f=stochastic.drift, g=stochastic.diffusion())}
    return {}


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
        for model in table.build():
            for name, text in timed(model).items():
                functions.append(text)
                counted = re.search(r"// total: (\d+)", text)
                kernels[name] = {
                    "parameters": [parameter.name for parameter in table.parameters],
                    "operations": int(counted[1]) if counted else None,
                }
    (arguments.out / "peer.rs").write_text("\n".join(functions), encoding="utf-8")
    (arguments.out / "peer.json").write_text(json.dumps({"kernels": kernels}, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
