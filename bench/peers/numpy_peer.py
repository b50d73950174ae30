"""NumPy, vectorised over members, on CasADi's instructions as Python."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from printed import compiled
from turns import Array, Job, Problem, moments, moments_of_sums, serve

# Members that are stepped together: their arrays stay in the cache.
BLOCK = 1024


def monte_carlo(problem: Problem) -> Job:
    """Flights of SDCOM."""
    step = compiled(problem.function("sdcom_euler_maruyama"), np, stores=False)
    start, u, p, h = problem.flight("monte_carlo")
    members, steps = (problem.count("monte_carlo", key) for key in ("members", "steps"))
    channels = problem.count("monte_carlo", "channels")
    root = np.sqrt(h[0])

    def run(seed: int) -> list[Array]:
        random = np.random.Generator(np.random.SFC64(seed))
        ends = []
        for first in range(0, members, BLOCK):
            count = min(BLOCK, members - first)
            x = [np.full(count, value) for value in start]
            for _ in range(steps):
                dw = random.standard_normal((channels, count))
                dw *= root
                x = step(x, u, p, h, dw)
            ends.append(np.array(x))
        return ends

    return Job(run, lambda ends: moments(np.concatenate(ends, axis=1).T))


def modes(problem: Problem) -> Job:
    """Ensembles of the three modes, all runs of a mode in one array."""
    stiffness, damping, sigma, decay, intensity = problem.array("modes", "rates").T[:, :, np.newaxis]
    h = problem.dt("modes")
    runs, steps = problem.count("modes", "runs"), problem.count("modes", "steps")
    count, root = len(sigma), np.sqrt(h)

    def run(seed: int) -> Array:
        random = np.random.Generator(np.random.SFC64(seed))
        sums = np.zeros((count, steps, 4))
        eta, eta_dot, chi = (np.zeros((count, runs)) for _ in range(3))
        for k in range(steps):
            dw = random.standard_normal((count, runs))
            dw *= root
            acceleration = -stiffness * eta - damping * eta_dot
            eta = eta + h * eta_dot
            eta_dot = eta_dot + h * acceleration + sigma * dw
            chi = chi - h * decay * chi + intensity * dw
            for place, values in ((0, eta), (2, chi)):
                sums[:, k, place] = values.sum(axis=1)
                sums[:, k, place + 1] = np.einsum("ij,ij->i", values, values)
        return sums

    return Job(run, lambda sums: moments_of_sums(sums, runs))


def jobs(problem: Problem) -> dict[str, Callable[[], Job]]:
    """All jobs, by name."""
    return {"monte_carlo": lambda: monte_carlo(problem), "modes": lambda: modes(problem)}


if __name__ == "__main__":
    serve(jobs)
