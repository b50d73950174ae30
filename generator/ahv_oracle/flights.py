"""Reference flights: SciPy's initial-value solvers on the drift as SymPy derives it, in double precision.

Line 1 is a comment, line 2 the columns; then for each parameter set a row ``start`` and a row for each
solver with the state at the end.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import numpy
import sympy
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from .model import build_model
from .table import load_table

MODEL = "dcom"
SETS = ("section5.1", "section5.3")
SOLVERS = {"DOP853": 2.5e-14, "Radau": 1e-12}
"""Solvers with their tolerances, relative to a component and to its size in ``SIZES``.

SciPy admits no less than the first; with it Radau takes minutes.
"""

END = 0.5
"""Duration in s: the modes swing some times, and the unstable airframe has not yet left the validity box."""

START = {
    "velocity": 7702.0808,
    "altitude": 85000.0,
    "gamma": 0.002,
    "alpha": 0.0262,
    "pitch_rate": 0.01,
    "eta_1": 0.5,
    "eta_2": -0.8,
    "eta_dot_2": 20.0,
    "eta_3": 0.6,
}
"""Near level flight with the modes displaced; what is not named is 0."""

INPUT = {"phi": 0.2821, "delta_e": 0.2286, "delta_c": 0.0}
"""Held inputs."""

SIZES = {"velocity": 1e3, "altitude": 1e4, "gamma": 1e-2, "alpha": 1e-2, "pitch_rate": 1e-1}
"""Sizes of the components for the absolute tolerance; 1 for those of the modes."""

Vector = NDArray[numpy.float64]


class Flight:
    """The model with the values of a parameter set, ready to be flown."""

    def __init__(self, table: Path, parameters: str) -> None:
        """Derive and compile the drift and its derivatives by the state."""
        self._model = build_model(load_table(table, parameters), MODEL)
        symbols, slope = self._model.arguments(), self._model.names.derivative
        states = [symbols[f"state.{name}"] for name in self.states]
        rows = [self._model.drift[name] for name in self.states]
        self._drift = self._compiled(rows)
        self._jacobian = self._compiled([[slope(row, state) for state in states] for row in rows])

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states."""
        return self._model.states

    def end(self, solver: str) -> Vector:
        """Fly with one of ``SOLVERS``; return the last state."""
        tolerance = SOLVERS[solver]
        sizes = numpy.array([SIZES.get(name, 1.0) for name in self.states])
        implicit = {"jac": self._jacobian} if solver == "Radau" else {}
        start = [START.get(name, 0.0) for name in self.states]
        times = (0.0, END)
        flown = solve_ivp(self._drift, times, start, method=solver, rtol=tolerance, atol=tolerance * sizes, **implicit)
        if not flown.success:
            raise ValueError(f"{MODEL}: {solver}: {flown.message}")
        end: Vector = flown.y[:, -1]
        return end

    def _compiled(self, outputs: Sequence[object]) -> Callable[[float, Vector], Vector]:
        """Compile `outputs` to a function of time and state; it computes every name on the way."""
        symbols = self._model.arguments()
        held = [INPUT[name] for name in self._model.inputs]
        held += [self._model.table.values[name] for name in self._model.table.values]
        arguments = [symbol for name, symbol in symbols.items() if not name.startswith("noise.")]
        steps = list(self._model.names.definitions.items())
        function = sympy.lambdify(arguments, outputs, "math", cse=lambda results: (steps, results))
        return lambda _, state: numpy.array(function(*state, *held))


def flight_lines(table: Path) -> Iterator[str]:
    """Yield the lines of the file."""
    flights = {parameters: Flight(table, parameters) for parameters in SETS}
    yield from heading_lines(flights[SETS[0]].states)
    for parameters, flight in flights.items():
        yield _row(parameters, "start", [START.get(name, 0.0) for name in flight.states])
        for solver in SOLVERS:
            yield _row(parameters, solver, flight.end(solver))


def heading_lines(states: Iterable[str]) -> list[str]:
    """Return the two lines before the rows: what this is, and the columns."""
    held = " ".join(f"{name}={value!r}" for name, value in INPUT.items())
    comment = f"# ahv reference flights, model {MODEL}, {END} s by SciPy's {' and '.join(SOLVERS)}, held {held}"
    return [comment, ",".join(("set", "solver", *states))]


def _row(parameters: str, solver: str, state: Iterable[float]) -> str:
    return ",".join((parameters, solver, *(repr(float(value)) for value in state)))
