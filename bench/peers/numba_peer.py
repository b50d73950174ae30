# mypy: disable-error-code="import-not-found, import-untyped, untyped-decorator"
"""numba on CasADi's instructions as Python: loops over points, steps and members are compiled too."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from printed import compiled
from turns import Array, Job, Problem, moments, moments_of_sums, serve

# Tasks of an ensemble whose sums are kept apart.
CHUNKS = 8
njit = numba.njit(error_model="numpy")
parallel = numba.njit(error_model="numpy", parallel=True)


def evaluation(problem: Problem, name: str, model: str) -> Job:
    """A function at every point."""
    function = problem.function(name)
    evaluate = njit(compiled(function, math, stores=True))
    states, inputs = problem.array("points", model, "states"), problem.array("points", model, "inputs")
    p = problem.array("parameters", model)
    outputs = tuple(np.zeros((len(states), function.nnz_out(index))) for index in range(function.n_out()))

    def of(count: int) -> Callable[..., None]:
        # The number of outputs is known when the loop is compiled.
        rows = ", ".join(f"r{index}[k]" for index in range(count))
        arrays = ", ".join(f"r{index}" for index in range(count))
        text = f"def loop(x, u, p, {arrays}):\n    for k in range(x.shape[0]):\n        f(x[k], u[k], p, {rows})\n"
        names: dict[str, Any] = {"f": evaluate}
        exec(text, names)
        found: Callable[..., None] = njit(names["loop"])
        return found

    loop = of(len(outputs))

    def run(_: int) -> None:
        loop(states, inputs, p, *outputs)

    return Job(run, lambda _: np.concatenate(outputs, axis=1).ravel())


def runge_kutta(problem: Problem) -> Job:
    """Flights of DCOM, one after the other."""
    step = njit(compiled(problem.function("dcom_runge_kutta"), math, stores=True))
    start, u, p, h = problem.flight("rk4")

    @njit
    def fly(start: Array, u: Array, p: Array, h: Array, steps: int, repeats: int) -> Array:
        x, after = start.copy(), start.copy()
        for _ in range(repeats):
            x[:] = start
            for _ in range(steps):
                step(x, u, p, h, after)
                x, after = after, x
        return x

    steps, repeats = problem.count("rk4", "steps"), problem.count("rk4", "repeats")
    return Job(lambda _: fly(start, u, p, h, steps, repeats), lambda end: end)


def monte_carlo(problem: Problem) -> Job:
    """Flights of SDCOM."""
    step = njit(compiled(problem.function("sdcom_euler_maruyama"), math, stores=True))
    start, u, p, h = problem.flight("monte_carlo")
    members, steps = (problem.count("monte_carlo", key) for key in ("members", "steps"))
    channels = problem.count("monte_carlo", "channels")

    @parallel
    def fly(start: Array, u: Array, p: Array, h: Array, steps: int, ends: Array) -> None:
        root = math.sqrt(h[0])
        for member in numba.prange(ends.shape[0]):
            x, after, dw = start.copy(), start.copy(), np.empty(channels)
            for _ in range(steps):
                for channel in range(channels):
                    dw[channel] = root * np.random.standard_normal()
                step(x, u, p, h, dw, after)
                x, after = after, x
            ends[member] = x

    ends = np.empty((members, len(start)))
    return Job(lambda _: fly(start, u, p, h, steps, ends), lambda _: moments(ends))


@parallel
def _modes(rates: Array, h: float, runs: int, sums: Array) -> None:
    root = math.sqrt(h)
    for chunk in numba.prange(sums.shape[0]):
        for mode in range(sums.shape[1]):
            stiffness, damping, sigma, decay, intensity = rates[mode]
            for _ in range(chunk * runs // sums.shape[0], (chunk + 1) * runs // sums.shape[0]):
                eta, eta_dot, chi = 0.0, 0.0, 0.0
                for k in range(sums.shape[2]):
                    dw = root * np.random.standard_normal()
                    acceleration = -stiffness * eta - damping * eta_dot
                    eta += h * eta_dot
                    eta_dot += h * acceleration + sigma * dw
                    chi += -h * decay * chi + intensity * dw
                    row = sums[chunk, mode, k]
                    row[0] += eta
                    row[1] += eta * eta
                    row[2] += chi
                    row[3] += chi * chi


def modes(problem: Problem) -> Job:
    """Ensembles of the three modes."""
    rates, h = problem.array("modes", "rates"), problem.dt("modes")
    runs, steps = problem.count("modes", "runs"), problem.count("modes", "steps")

    def run(_: int) -> Array:
        sums = np.zeros((CHUNKS, len(rates), steps, 4))
        _modes(rates, h, runs, sums)
        total: Array = sums.sum(axis=0)
        return total

    return Job(run, lambda sums: moments_of_sums(sums, runs))


def jobs(problem: Problem) -> dict[str, Callable[[], Job]]:
    """All jobs, by name."""
    numba.set_num_threads(problem.threads)
    return {
        "dcom_drift": lambda: evaluation(problem, "dcom_drift", "dcom"),
        "dcom_drift_jacobians": lambda: evaluation(problem, "dcom_drift_jacobians", "dcom"),
        "sdcom_drift_diffusion": lambda: evaluation(problem, "sdcom_drift_diffusion", "sdcom"),
        "rk4": lambda: runge_kutta(problem),
        "monte_carlo": lambda: monte_carlo(problem),
        "modes": lambda: modes(problem),
    }


if __name__ == "__main__":
    serve(jobs)
