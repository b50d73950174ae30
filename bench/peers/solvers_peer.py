"""Solves the flight with CasADi's CVODES and SciPy: a line of JSON in, a line of JSON out.

`python solvers_peer.py --library LIBRARY TABLE...`; LIBRARY is CasADi's C of the timed functions. The first line in is
the problem, every other asks for a solution.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from ahv_generator.table import load
from expansion import Expansion
from steps import equation

Vector = NDArray[np.float64]
Solution = dict[str, Any]

_POINTER = ctypes.POINTER(ctypes.c_double)
_CVODES = {
    "bdf": {"linear_multistep_method": "bdf", "nonlinear_solver_iteration": "newton"},
    "adams": {"linear_multistep_method": "adams", "nonlinear_solver_iteration": "functional"},
}
_COMPILED = {
    "max_num_steps": 1_000_000,
    "jit": True,
    "compiler": "shell",
    "jit_options": {"compiler": "gcc", "flags": ["-O3", "-march=native"]},
}


class CompiledFunction:
    """A function of CasADi's C for fixed input and parameters, called through ctypes."""

    def __init__(self, library: ctypes.CDLL, peer: ca.Function, constants: list[Vector]) -> None:
        self._function = getattr(library, peer.name())
        self.results = [np.zeros(peer.nnz_out(i)) for i in range(peer.n_out())]
        # The state goes to one place, so that a call passes only pointers that stand.
        self._state = np.zeros(peer.nnz_in(0))
        self._arguments = [self._state, *constants]
        self._reals = np.zeros(peer.sz_w() + 1)
        integers = np.zeros(peer.sz_iw() + 1, dtype=np.int64)
        self._pointers = (
            _pointers(self._arguments, peer.sz_arg()),
            _pointers(self.results, peer.sz_res()),
            integers.ctypes.data_as(ctypes.POINTER(ctypes.c_int64)),
            self._reals.ctypes.data_as(_POINTER),
            0,
        )

    def __call__(self, state: Vector) -> None:
        """Evaluate into `results`."""
        self._state[:] = state
        self._function(*self._pointers)


def _pointers(arrays: list[Vector], length: int) -> Any:  # noqa: ANN401 (ctypes' arrays have no type of their own)
    """A C array of pointers to the arrays."""
    kind: Any = _POINTER * length
    return kind(*(array.ctypes.data_as(_POINTER) for array in arrays))


class Peer:
    """The flights of one problem."""

    def __init__(self, problem: dict[str, Any], expansion: Expansion, library: ctypes.CDLL) -> None:
        self.end: float = problem["end"]
        self.scales = np.array(problem["scales"])
        self.flights = problem["flights"]
        self._expansion = expansion
        self._library = library
        self._integrators: dict[tuple[str, float], ca.Function] = {}
        arguments = [expansion.leaves("state"), expansion.leaves("input"), expansion.parameters()]
        jacobians = [expansion.jacobian("state"), expansion.jacobian("input")]
        self._drift = ca.Function("dcom_drift", arguments, [expansion.drift()], {"cse": True})
        self._jacobians = ca.Function("dcom_drift_jacobians", arguments, [expansion.drift(), *jacobians], {"cse": True})
        self._places = tuple(np.array(part) for part in jacobians[0].sparsity().get_triplet())

    def integrator(self, method: str, tolerance: float) -> ca.Function:
        """CVODES on compiled functions, in units of the scales: it takes one absolute tolerance for all states."""
        if (method, tolerance) not in self._integrators:
            options: dict[str, Any] = {**_CVODES[method], **_COMPILED, "reltol": tolerance, "abstol": tolerance}
            problem = equation(self._expansion, list(self.scales))
            built = ca.integrator("flight", "cvodes", problem, 0.0, self.end, options)
            self._integrators[method, tolerance] = built
        return self._integrators[method, tolerance]

    def cvodes(self, flight: dict[str, Any], method: str, tolerance: float) -> Callable[[], Solution]:
        """A solution by CVODES."""
        integrator = self.integrator(method, tolerance)
        start = ca.DM(np.array(flight["state"]) / self.scales)
        constants = ca.DM([*flight["input"], *flight["parameters"]])

        def solve() -> Solution:
            after = integrator(x0=start, p=constants)["xf"]
            said = integrator.stats()
            return {
                "state": (np.array(after).ravel() * self.scales).tolist(),
                "steps": said["nsteps"],
                "drifts": said["nfevals"],
                "jacobians": said["nlinsetups"] if method == "bdf" else 0,
            }

        return solve

    def scipy(self, flight: dict[str, Any], method: str, tolerance: float) -> Callable[[], Solution]:
        """A solution by `solve_ivp`; implicit methods get the exact Jacobian."""
        constants = [np.array(flight["input"]), np.array(flight["parameters"])]
        drift = CompiledFunction(self._library, self._drift, constants)
        both = CompiledFunction(self._library, self._jacobians, constants)
        start = np.array(flight["state"])

        def rate(_: float, state: Vector) -> Vector:
            drift(state)
            return drift.results[0].copy()

        def jacobian(_: float, state: Vector) -> Vector:
            both(state)
            dense = np.zeros((len(start), len(start)))
            dense[self._places] = both.results[1]
            return dense

        options = {} if method == "DOP853" else {"jac": jacobian}

        def solve() -> Solution:
            said = solve_ivp(
                rate, (0.0, self.end), start, method, rtol=tolerance, atol=tolerance * self.scales, **options
            )
            if not said.success:
                raise RuntimeError(said.message)
            return {
                "state": said.y[:, -1].tolist(),
                "steps": len(said.t) - 1,
                "drifts": int(said.nfev),
                "jacobians": int(said.njev),
            }

        return solve

    def answer(self, request: dict[str, Any]) -> Solution:
        """Solve once to warm up, and then as often as is asked for."""
        package, method = request["solver"].split(" ")
        prepare = {"cvodes": self.cvodes, "scipy": self.scipy}[package]
        solve = prepare(self.flights[request["flight"]], method, request["setting"])
        solution = solve()
        start = time.perf_counter()
        for _ in range(request["repeats"]):
            solution = solve()
        return {"seconds": (time.perf_counter() - start) / max(1, request["repeats"]), **solution}


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--library", type=Path, required=True)
    parser.add_argument("tables", type=Path, nargs="+")
    arguments = parser.parse_args()

    table = next(table for table in map(load, arguments.tables) if "dcom" in table.models)
    problem = json.loads(sys.stdin.readline())
    peer = Peer(problem, Expansion(table.model("dcom")), ctypes.CDLL(str(arguments.library)))
    for line in sys.stdin:
        try:
            answer = peer.answer(json.loads(line))
        except RuntimeError as failure:
            answer = {"failure": str(failure)}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
