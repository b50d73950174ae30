"""Reference trims, linear systems, poles and zeros: SciPy on the drift as SymPy derives it, in double precision.

Line 1 is a comment; then for each model and parameter set stand rows ``case`` (model, set), ``state``, ``input``,
``A`` and ``B`` (rows, columns and the entries by rows; inputs phi, delta_e), ``poles`` and ``zeros`` (real and
imaginary parts in turn) of the outputs velocity and gamma.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import numpy
import scipy.linalg
import scipy.optimize
import sympy
from numpy.typing import NDArray

from .model import build_model
from .table import load_table

CASES = (
    ("com", "com", "section5.1"),
    ("com", "com_rigid", "section5.1"),
    ("dcom", "dcom", "section5.1"),
    ("dcom", "dcom", "section5.3"),
    ("dcom", "sdcom", "section5.1"),
    ("dcom", "sdcom", "section5.3"),
)
"""Table, model and set of each case."""

GIVEN = {"velocity": 7702.0808, "altitude": 85000.0, "gamma": 0.0, "pitch_rate": 0.0}
"""Steady level flight; what else stands in the state is sought, with the inputs ``SOUGHT``."""

SOUGHT = ("phi", "delta_e")
REDUNDANT = ("altitude", "alpha")
START = {"phi": 0.25, "delta_e": 0.2}
INPUTS = ("phi", "delta_e")
OUTPUTS = ("velocity", "gamma")

INFINITE = 1e-10
"""A zero is infinite when abs(beta) is at most this share of abs(alpha) + abs(beta)."""

Matrix = NDArray[numpy.float64]
Roots = NDArray[numpy.complex128]


class Case:
    """A model with the values of a parameter set, about its trim."""

    def __init__(self, table: Path, model: str, parameters: str) -> None:
        """Derive and compile the drift and its derivatives, then trim."""
        self._model = build_model(load_table(table, parameters), model)
        symbols, slope = self._model.arguments(), self._model.names.derivative
        rows = [self._model.drift[name] for name in self._model.states]
        states = [symbols[f"state.{name}"] for name in self._model.states]
        inputs = [symbols[f"input.{name}"] for name in INPUTS]
        self._drift = self._compiled(rows)
        self._by_state = self._compiled([[slope(row, state) for state in states] for row in rows])
        self._by_input = self._compiled([[slope(row, of) for of in inputs] for row in rows])
        self.state, self.input = self._trim()

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states."""
        return self._model.states

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the inputs."""
        return self._model.inputs

    def system(self) -> tuple[Matrix, Matrix]:
        """A and B of the linear system."""
        return self._by_state(self.state, self.input), self._by_input(self.state, self.input)

    def _trim(self) -> tuple[list[float], list[float]]:
        names = (*self._model.states, *self._model.inputs)
        unknown = [name for name in self._model.states if name not in GIVEN] + list(SOUGHT)
        rows = [i for i, name in enumerate(self._model.states) if name not in REDUNDANT]

        def split(values: Iterable[float]) -> tuple[list[float], list[float]]:
            known = GIVEN | dict(zip(unknown, values, strict=True))
            point = [known.get(name, 0.0) for name in names]
            return point[: len(self._model.states)], point[len(self._model.states) :]

        start = [START.get(name, 0.0) for name in unknown]
        found = scipy.optimize.root(lambda values: self._drift(*split(values))[rows], start, options={"xtol": 1e-14})
        state, held = split(found.x)
        worst = float(numpy.abs(self._drift(state, held)[rows]).max())
        if worst > 1e-8:
            raise ValueError(f"no trim: a row of the drift is {worst}")
        return state, held

    def _compiled(self, outputs: Sequence[object]) -> Callable[[list[float], list[float]], Matrix]:
        """Compile `outputs` to a function of state and input; it computes every name on the way."""
        values = self._model.table.values
        arguments = [symbol for name, symbol in self._model.arguments().items() if not name.startswith("noise.")]
        steps = list(self._model.names.definitions.items())
        function = sympy.lambdify(arguments, outputs, "math", cse=lambda results: (steps, results))
        return lambda state, held: numpy.array(function(*state, *held, *(values[name] for name in values)))

    def outputs(self) -> Matrix:
        """C of the linear system."""
        return numpy.array([[float(name == output) for name in self._model.states] for output in OUTPUTS])


def zeros(a: Matrix, b: Matrix, c: Matrix) -> Roots:
    """Finite generalised eigenvalues of the system pencil."""
    states, inputs = b.shape
    pencil = numpy.block([[a, b], [c, numpy.zeros((len(c), inputs))]])
    # A diagonal similarity, which leaves the other matrix of the pencil as it is.
    balanced, _ = scipy.linalg.matrix_balance(pencil, permute=False)
    identity = numpy.diag([1.0] * states + [0.0] * inputs)
    alpha, beta = scipy.linalg.eig(balanced, identity, right=False, homogeneous_eigvals=True)
    finite = numpy.abs(beta) > INFINITE * (numpy.abs(alpha) + numpy.abs(beta))
    roots: Roots = alpha[finite] / beta[finite]
    return roots


def root_lines(tables: Path) -> Iterator[str]:
    """Yield the lines of the file."""
    place = f"{GIVEN['velocity']} ft/s, {GIVEN['altitude']} ft"
    yield f"# ahv reference roots, {place}, scipy.optimize.root, scipy.linalg.eig"
    for table, model, parameters in CASES:
        case = Case(tables / f"{table}.toml", model, parameters)
        a, b = case.system()
        yield f"case,{model},{parameters}"
        yield _row("state", case.state)
        yield _row("input", case.input)
        for name, matrix in (("A", a), ("B", b)):
            yield _row(name, (*matrix.shape, *matrix.flat))
        yield _row("poles", _parts(scipy.linalg.eig(a, right=False)))
        yield _row("zeros", _parts(zeros(a, b, case.outputs())))


def _parts(roots: Roots) -> list[float]:
    ordered = sorted(roots, key=lambda root: (round(abs(root), 6), root.imag, root.real))
    return [part for root in ordered for part in (root.real, root.imag)]


def _row(name: str, values: Iterable[float]) -> str:
    return ",".join((name, *(repr(value if isinstance(value, int) else float(value)) for value in values)))
