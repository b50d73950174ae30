"""Writes CasADi's C for the timed functions and steps, and CasADi's operation counts of every function.

`python casadi_peer.py --out DIR [--end SECONDS] TABLE...` writes `peer.c`, `steps.c` (with loops up to SECONDS),
`euler_maruyama.c` (the step of the Monte Carlo alone) and `peer.json`; what peers print in another language is saved as
`NAME.casadi`.
"""

from __future__ import annotations

import argparse
import json
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import casadi as ca

from ahv_generator.table import load
from counts import count
from expansion import Expansion
from steps import steps

OPTIONS = {"cse": True}
# The step of the Monte Carlo, and all steps that other peers take.
MONTE_CARLO = "sdcom_euler_maruyama"
PRINTED = ("dcom_runge_kutta", MONTE_CARLO)
# Packages whose versions are told, where they are there.
PACKAGES = ("casadi", "scipy", "wrenfold", "symforce", "numba", "jax", "diffrax", "numpy")


def function(name: str, expansion: Expansion, outputs: list[ca.SX], extra: list[ca.SX] | None = None) -> ca.Function:
    """A CasADi function of state, input, parameters, and whatever is `extra`."""
    inputs = [expansion.leaves("state"), expansion.leaves("input"), expansion.parameters(), *(extra or [])]
    return ca.Function(name, inputs, outputs, OPTIONS)


def timed(expansion: Expansion) -> list[tuple[str, list[ca.SX]]]:
    """The functions that are timed, by name."""
    drift = expansion.drift()
    if expansion.model.name == "dcom":
        jacobians = [expansion.jacobian("state"), expansion.jacobian("input")]
        return [("dcom_drift", [drift]), ("dcom_drift_jacobians", [drift, *jacobians])]
    if expansion.model.name == "sdcom":
        return [("sdcom_drift_diffusion", [drift, expansion.diffusion()])]
    return []


def positions(matrices: list[ca.SX]) -> list[list[int]]:
    """For each output, where its stored values stand in the dense matrix, row by row."""
    return [
        [row * matrix.size2() + column for row, column in zip(*matrix.sparsity().get_triplet(), strict=True)]
        for matrix in matrices
    ]


def dense(function: ca.Function) -> ca.Function:
    """The function with outputs that are dense and row by row."""
    inputs = [ca.SX.sym(f"a{index}", *function.size_in(index)) for index in range(function.n_in())]
    outputs = [ca.densify(output.T) for output in function.call(inputs)]
    return ca.Function(function.name(), inputs, outputs, OPTIONS)


def work(peer: ca.Function) -> list[int]:
    """Numbers of arguments, results, integers and reals that the C function wants room for."""
    return [peer.sz_arg(), peer.sz_res(), peer.sz_iw(), peer.sz_w()]


def versions() -> dict[str, str]:
    """Versions of the packages that are installed."""
    found = {}
    for package in PACKAGES:
        with suppress(PackageNotFoundError):
            found[package] = version(package)
    return found


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--end", type=float)
    parser.add_argument("tables", type=Path, nargs="+")
    arguments = parser.parse_args()

    generator, step_generator = ca.CodeGenerator("peer.c"), ca.CodeGenerator("steps.c")
    kernels: dict[str, object] = {}
    stepping: dict[str, list[int]] = {}
    counts: dict[str, dict[str, object]] = {}
    for path in arguments.tables:
        table = load(path)
        for model in table.build():
            expansion = Expansion(model)
            for name, matrices in timed(expansion):
                peer = function(name, expansion, matrices)
                generator.add(peer)
                dense(peer).save(str(arguments.out / f"{name}.casadi"))
                kernels[name] = {
                    "parameters": [parameter.name for parameter in table.parameters],
                    "outputs": positions(matrices),
                    "operations": count(peer),
                    "work": work(peer),
                }
            for step in steps(expansion, arguments.end):
                step_generator.add(step)
                stepping[step.name()] = work(step)
                if step.name() in PRINTED:
                    step.save(str(arguments.out / f"{step.name()}.casadi"))
                if step.name() == MONTE_CARLO:
                    alone = ca.CodeGenerator("euler_maruyama.c")
                    alone.add(step)
                    alone.generate(f"{arguments.out}/")
            extra = [expansion.leaves("noise"), expansion.leaves("argument")]
            counts[model.name] = {
                f.name: count(function(f.name, expansion, expansion.matrices(f), extra)) for f in model.functions
            }
    generator.generate(f"{arguments.out}/")
    step_generator.generate(f"{arguments.out}/")
    answer = {"versions": versions(), "kernels": kernels, "steps": stepping, "counts": counts}
    (arguments.out / "peer.json").write_text(json.dumps(answer, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
