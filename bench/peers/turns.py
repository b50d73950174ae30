"""Peers that take turns: a line of JSON in, a line of JSON out.

`python NAME_peer.py --functions DIR --threads N`; DIR holds CasADi's functions, as `casadi_peer.py` saves them. The
first line in is the problem, every other asks for a turn at a job.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Job(NamedTuple):
    """Work that is ready to be done."""

    # Does the work once, with a seed.
    run: Callable[[int], Any]
    # What is compared of what `run` gives.
    values: Callable[[Any], Array]


class Problem:
    """What all jobs are about."""

    def __init__(self, said: dict[str, Any], functions: Path, threads: int) -> None:
        self.said = said
        self.threads = threads
        self._functions = functions

    def function(self, name: str) -> ca.Function:
        """A function of CasADi."""
        return ca.Function.load(str(self._functions / f"{name}.casadi"))

    def array(self, *path: str) -> Array:
        """Numbers of the problem."""
        found: Any = self.said
        for key in path:
            found = found[key]
        return np.array(found, dtype=np.float64)

    def count(self, group: str, key: str) -> int:
        """A number of members, steps or runs."""
        return int(self.said[group][key])

    def dt(self, group: str) -> float:
        """The step size in s."""
        return float(self.said[group]["dt"])

    def flight(self, group: str) -> tuple[Array, Array, Array, Array]:
        """Start, input, parameters, and step size as an array."""
        start, u, p, h = (self.array(group, key) for key in ("start", "input", "parameters", "dt"))
        return start, u, p, h.reshape(1)


def moments(ends: Array) -> Array:
    """Means of the columns, then their standard deviations."""
    return np.concatenate([ends.mean(axis=0), ends.std(axis=0, ddof=1)])


def moments_of_sums(sums: Array, runs: int) -> Array:
    """The same of the last step, from sums of eta, its square, chi and its square: modes by steps by four."""
    total = sums[:, -1, 0::2].ravel()
    squares = sums[:, -1, 1::2].ravel()
    mean = total / runs
    return np.concatenate([mean, np.sqrt((squares - runs * mean * mean) / (runs - 1))])


class _Ready(NamedTuple):
    job: Job
    # Seconds until it had run for the first time, less those of a run.
    first: float


def _prepared(prepare: Callable[[], Job]) -> _Ready:
    start = time.perf_counter()
    job = prepare()
    job.run(0)
    between = time.perf_counter()
    job.run(0)
    return _Ready(job, max(0.0, 2.0 * between - start - time.perf_counter()))


def serve(jobs: Callable[[Problem], Mapping[str, Callable[[], Job]]]) -> None:
    """Answer until the input ends. Each job is made ready, and compiled, when it is asked for first."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--functions", type=Path, required=True)
    parser.add_argument("--threads", type=int, required=True)
    arguments = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        # Some libraries have no other way to say how many threads they may use.
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: arguments.threads])
    known = jobs(Problem(json.loads(sys.stdin.readline()), arguments.functions, arguments.threads))
    ready: dict[str, _Ready] = {}
    for line in sys.stdin:
        asked = json.loads(line)
        name = asked["job"]
        if name not in ready:
            ready[name] = _prepared(known[name])
        job, first = ready[name]
        for _ in range(asked["warm_up"]):
            job.run(asked["seed"])
        start = time.perf_counter()
        for _ in range(asked["repeats"]):
            found = job.run(asked["seed"])
        seconds = (time.perf_counter() - start) / asked["repeats"]
        values = job.values(found).tolist() if asked["values"] else []
        print(json.dumps({"seconds": seconds, "first": first, "values": values}), flush=True)
