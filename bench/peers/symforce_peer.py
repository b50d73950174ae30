# mypy: disable-error-code="import-not-found"
"""Writes SymForce's C++ for the timed functions.

`python symforce_peer.py --out DIR TABLE...` writes `peer.cpp` and `peer.json`. The statements are those of SymForce's
functions; they stand behind the call that CasADi's C has instead of Eigen's matrices.
"""

from __future__ import annotations

import argparse
import json
import re
from pathlib import Path

import symforce

symforce.set_log_level("ERROR")

import symforce.symbolic as sf  # noqa: E402 (the level must be set before)
from symforce.codegen import CppConfig  # noqa: E402
from symforce.codegen.codegen_util import print_code  # noqa: E402
from symforce.values import Values  # noqa: E402

from ahv_generator.model import Model  # noqa: E402
from ahv_generator.table import load  # noqa: E402
from formulation import Algebra, Formulation, leaves  # noqa: E402

ALGEBRA = Algebra(sf.Rational, sf.Pow, sf.sin, sf.cos, sf.exp, sf.sqrt)
HEAD = """#include <cmath>

using Scalar = double;

"""


class Described:
    """A function of a model, written with SymForce."""

    def __init__(self, model: Model) -> None:
        self.arguments = {
            argument: [sf.Symbol(f"{argument}{i}") for i in range(len(names))]
            for argument, names in leaves(model).items()
        }
        names = {
            name: symbol
            for argument, found in leaves(model).items()
            for name, symbol in zip(found, self.arguments[argument], strict=True)
        }
        self._formulation = Formulation(model, ALGEBRA, names)
        self.drift = sf.Matrix([[rate] for rate in self._formulation.drift()])

    def jacobian(self, argument: str) -> sf.Matrix:
        """Derivative of the drift."""
        return self.drift.jacobian(self.arguments[argument])

    def diffusion(self) -> sf.Matrix:
        """G."""
        return sf.Matrix(self._formulation.diffusion(lambda rate, leaf: rate.diff(leaf)))

    def cpp(self, name: str, *outputs: sf.Matrix) -> tuple[str, int]:
        """The function that gives these outputs, row by row, and its operations as SymForce counts them."""
        symbols = {str(symbol): symbol for found in self.arguments.values() for symbol in found}
        results = {f"r{index}": output for index, output in enumerate(outputs)}
        code = print_code(Values(**symbols), Values(**results), {}, CppConfig())
        statements = [f"const Scalar {left} = {right};" for left, right in code.intermediate_terms]
        for (index, output), (_, _, terms) in zip(enumerate(outputs), code.dense_terms, strict=True):
            for left, right in terms:
                row, column = (int(it) for it in re.findall(r"\d+", left.split("(")[1]))
                statements.append(f"res[{index}][{row * output.shape[1] + column}] = {right};")
        body = "\n    ".join(self._read(statement) for statement in statements)
        head = f'extern "C" int {name}(const double **arg, double **res, long long *, double *, int) {{'
        return f"{head}\n    {body}\n    return 0;\n}}\n", code.total_ops

    def _read(self, statement: str) -> str:
        """The statement with arguments from where they lie."""
        places = {name: index for index, name in enumerate(self.arguments)}
        return re.sub(r"\b([xup])(\d+)\b", lambda it: f"arg[{places[it[1]]}][{it[2]}]", statement)


def timed(model: Model) -> dict[str, tuple[str, int]]:
    """The functions that are timed, by name."""
    if model.name == "dcom":
        it = Described(model)
        return {
            "dcom_drift": it.cpp("dcom_drift", it.drift),
            "dcom_drift_jacobians": it.cpp("dcom_drift_jacobians", it.drift, it.jacobian("x"), it.jacobian("u")),
        }
    if model.name == "sdcom":
        it = Described(model)
        return {"sdcom_drift_diffusion": it.cpp("sdcom_drift_diffusion", it.drift, it.diffusion())}
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
        for model in (table.model(name) for name in table.models if name in ("dcom", "sdcom")):
            for name, (text, operations) in timed(model).items():
                functions.append(text)
                parameters = [parameter.name for parameter in table.parameters]
                kernels[name] = {"parameters": parameters, "operations": operations}
    (arguments.out / "peer.cpp").write_text(HEAD + "\n".join(functions), encoding="utf-8")
    (arguments.out / "peer.json").write_text(json.dumps({"kernels": kernels}, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
