"""Reference invariant zeros: SLICOT's staircase reduction ``AB08ND``, in doubt by polynomials in 60-digit arithmetic.

SLICOT comes with the package ``slycot``, which is no requirement of this project. With it beside the development
requirements, in the folder ``generator``::

    pip install slycot
    python -m ahv_oracle zeros --tables tables --out ../tests/vectors/zeros.txt

Line 1 is a comment; then for each model, set and canard stand rows ``case`` (model, set, canard), ``A`` and ``B``
(rows, columns and the entries by rows), and a row for each pair of inputs and outputs:
``inputs|outputs|rank|orders of infinite zeros|right|left Kronecker indices|zeros``, inputs and outputs by number, of a
pair of conjugate zeros the upper one, as ``real`` or ``real:imaginary``.
"""

import itertools
import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import mpmath
import numpy
import scipy.linalg
import scipy.optimize
import sympy

from .model import build_model
from .roots import GIVEN, REDUNDANT, SOUGHT, START, Matrix
from .table import CHOICES, load_table

Numbers = Sequence[Any]
Pair = tuple[tuple[int, ...], tuple[int, ...]]

CASES = (
    *(("com", model, "section5.1", None) for model in ("com", "com_rigid")),
    *(
        ("dcom", model, parameters, canard)
        for model in ("dcom", "sdcom", "sdcom_printed", "sdcom_gust")
        for parameters in ("section5.1", "section5.3")
        for canard in ("free", "slaved")
    ),
)
"""Table, model, set and canard of each case."""

DIGITS = 60
NOTHING = mpmath.mpf(10) ** -32
"""Relative size below which a number of so many digits is 0."""

COMMON = mpmath.mpf(10) ** -8
"""Relative distance of two roots that are one; multiple ones lose digits."""

RADIUS = 20
"""Of the circle on which polynomials are evaluated, in 1/s."""

SETTINGS = (("S", 0.0), ("N", 0.0), ("N", 1e-11), ("S", 1e-11), ("N", 1e-13), ("N", 1e-9))
"""SLICOT's scaling and tolerance, in the order in which they are tried."""

AGREE = 3
"""So many of the settings must agree; otherwise the exact rank and number of zeros choose one of them."""


@dataclass(frozen=True)
class Structure:
    """What SLICOT finds: the rank, orders and indices, and the zeros."""

    rank: int
    orders: tuple[int, ...]
    right: tuple[int, ...]
    left: tuple[int, ...]
    zeros: tuple[complex, ...]

    @property
    def kind(self) -> tuple[int, int, tuple[int, ...]]:
        """What two computations must agree in."""
        return self.rank, len(self.zeros), self.orders


class System:
    """A model about its trim, in 60 digits."""

    def __init__(self, table: Path, model: str, parameters: str, canard: str | None) -> None:
        """Derive, trim and differentiate."""
        loaded = load_table(table, parameters)
        if canard is not None:
            loaded = replace(loaded, values={**loaded.values, **CHOICES["canard"][1][canard]})
        self._model = build_model(loaded, model)
        symbols, slope = self._model.arguments(), self._model.names.derivative
        columns = [symbols[f"state.{name}"] for name in self._model.states]
        columns += [symbols[f"input.{name}"] for name in self._model.inputs]
        rows = [self._model.drift[name] for name in self._model.states]
        slopes = [[slope(row, column) for column in columns] for row in rows]
        state, held = self._trim(rows, slopes)
        self.states = len(self._model.states)
        matrix = self._compiled(slopes, "mpmath")(state, held)
        # A canard that does not move on its own is no input.
        count = self.states + (3 if canard == "free" else 2)
        self.exact = [row[:count] for row in matrix]
        rounded = self._compiled(slopes, "math")([float(x) for x in state], [float(u) for u in held])
        self.rounded = numpy.array([[float(value) for value in row[:count]] for row in rounded])

    def _compiled(self, outputs: object, module: str) -> Callable[[Numbers, Numbers], list[Any]]:
        values = self._model.table.values
        arguments = [symbol for name, symbol in self._model.arguments().items() if not name.startswith("noise.")]
        steps = list(self._model.names.definitions.items())
        function = sympy.lambdify(arguments, outputs, module, cse=lambda results: (steps, results))
        return lambda state, held: function(*state, *held, *(values[name] for name in values))

    def _trim(self, rows: list[Any], slopes: list[list[Any]]) -> tuple[list[Any], list[Any]]:
        names = (*self._model.states, *self._model.inputs)
        unknown = [name for name in self._model.states if name not in GIVEN] + list(SOUGHT)
        equations = [i for i, name in enumerate(self._model.states) if name not in REDUNDANT]

        def split(values: Numbers) -> tuple[list[Any], list[Any]]:
            known = GIVEN | dict(zip(unknown, values, strict=True))
            point = [known.get(name, 0.0) for name in names]
            return point[: len(self._model.states)], point[len(self._model.states) :]

        drift = self._compiled(rows, "math")
        start = [START.get(name, 0.0) for name in unknown]
        found = scipy.optimize.root(lambda values: numpy.array(drift(*split(values)))[equations], start)
        values = mpmath.matrix([mpmath.mpf(float(value)) for value in found.x])
        exact, jacobian = self._compiled(rows, "mpmath"), self._compiled(slopes, "mpmath")
        for _ in range(6):
            point = [[mpmath.mpf(value) for value in part] for part in split(list(values))]
            matrix = jacobian(*point)
            square = mpmath.matrix([[matrix[row][names.index(name)] for name in unknown] for row in equations])
            residual = exact(*point)
            values -= mpmath.lu_solve(square, mpmath.matrix([residual[row] for row in equations]))
        state, held = split(list(values))
        return [mpmath.mpf(value) for value in state], [mpmath.mpf(value) for value in held]

    @property
    def inputs(self) -> int:
        """Number of inputs."""
        return len(self.exact[0]) - self.states

    def pairs(self) -> Iterator[Pair]:
        """Single inputs and outputs, two of both, all of one kind with each of the other, and all."""
        inputs, outputs = range(self.inputs), range(self.states)
        for count in (1, 2):
            for some in itertools.combinations(inputs, count):
                yield from ((some, seen) for seen in itertools.combinations(outputs, count))
        yield from ((tuple(inputs), (output,)) for output in outputs)
        yield from (((one,), tuple(outputs)) for one in inputs)
        yield tuple(inputs), tuple(outputs)

    def kind(self, pair: Pair) -> tuple[int, int]:
        """Rank and number of zeros: common roots of two random compressions of the pencil to a square one."""
        inputs, outputs = pair
        generator = random.Random(5)
        rank = _rank(self._pencil(inputs, outputs, mpmath.mpf(generator.uniform(1, 2)))) - self.states
        first, second = (self._roots(pair, self.states + rank, generator) for _ in range(2))
        common = 0
        for root in first:
            near = [other for other in second if abs(other - root) < COMMON * (1 + abs(root))]
            if near:
                second.remove(near[0])
                common += 1
        return rank, common

    def _pencil(self, inputs: tuple[int, ...], outputs: tuple[int, ...], s: mpmath.mpc) -> mpmath.matrix:
        size = self.states
        pencil = mpmath.zeros(size + len(outputs), size + len(inputs))
        kept = [*range(size), *(size + index for index in inputs)]
        for row, column in itertools.product(range(size), range(len(kept))):
            pencil[row, column] = self.exact[row][kept[column]] - (s if row == column else 0)
        for index, output in enumerate(outputs):
            pencil[size + index, output] = 1
        return pencil

    def _roots(self, pair: Pair, size: int, generator: random.Random) -> list[mpmath.mpc]:
        def dense(rows: int, columns: int) -> mpmath.matrix:
            return mpmath.matrix([[generator.uniform(-1, 1) for _ in range(columns)] for _ in range(rows)])

        inputs, outputs = pair
        left = dense(size, self.states + len(outputs))
        right = dense(self.states + len(inputs), size)
        count = self.states + 1
        circle = [RADIUS * mpmath.expjpi(mpmath.mpf(2 * index) / count) for index in range(count)]
        values = [mpmath.det(left * self._pencil(inputs, outputs, s) * right) for s in circle]
        # Coefficients by the discrete Fourier transform, each times the radius to its power.
        scaled = [
            mpmath.re(sum(v * mpmath.expjpi(-mpmath.mpf(2 * i * k) / count) for i, v in enumerate(values)) / count)
            for k in range(count)
        ]
        least = NOTHING * max(map(abs, scaled))
        present = [power for power, value in enumerate(scaled) if abs(value) > least]
        if not present:
            return []
        kept = scaled[present[0] : present[-1] + 1]
        roots = mpmath.polyroots(kept[::-1], maxsteps=500, extraprec=400) if len(kept) > 1 else []
        return [mpmath.mpf(0)] * present[0] + [RADIUS * root for root in roots]


def _rank(matrix: mpmath.matrix) -> int:
    rank, rows, columns = 0, matrix.rows, matrix.cols
    for step in range(min(rows, columns)):
        places = itertools.product(range(step, rows), range(step, columns))
        row, column = max(places, key=lambda place: abs(matrix[place]))
        if abs(matrix[row, column]) < NOTHING:
            break
        for index in range(columns):
            matrix[step, index], matrix[row, index] = matrix[row, index], matrix[step, index]
        for index in range(rows):
            matrix[index, step], matrix[index, column] = matrix[index, column], matrix[index, step]
        for below in range(step + 1, rows):
            factor = matrix[below, step] / matrix[step, step]
            for index in range(step, columns):
                matrix[below, index] -= factor * matrix[step, index]
        rank += 1
    return rank


def slicot(a: Matrix, b: Matrix, c: Matrix, scaling: str, tolerance: float) -> Structure:
    """Zeros and structure as ``AB08ND`` finds them."""
    import slycot

    (states, inputs), outputs = b.shape, len(c)
    d = numpy.zeros((outputs, inputs))
    found = slycot.ab08nd(states, inputs, outputs, a, b, c, d, scaling, tolerance)
    count, rank, degree, rights, lefts, infinite, right, left, first, second = found
    roots = scipy.linalg.eig(first[:count, :count], second[:count, :count], right=False) if count else []
    orders = [order + 1 for order in range(degree) for _ in range(infinite[order])]
    indices = [tuple(sorted(int(index) for index in some)) for some in (right[:rights], left[:lefts])]
    return Structure(int(rank), tuple(orders), indices[0], indices[1], tuple(complex(root) for root in roots))


def reference(system: System, pair: Pair) -> Structure:
    """SLICOT's result; where settings differ, the first that has the rank and the number of the exact zeros."""
    inputs, outputs = pair
    a, rest = system.rounded[:, : system.states], system.rounded[:, system.states :]
    b, c = rest[:, list(inputs)], numpy.eye(system.states)[list(outputs)]
    results = [slicot(a, b, c, *setting) for setting in SETTINGS]
    if len({found.kind for found in results[:AGREE]}) == 1:
        return results[0]
    exact = system.kind(pair)
    for found in results:
        if (found.rank, len(found.zeros)) == exact:
            return found
    raise ValueError(f"{pair}: SLICOT has not the rank and number of zeros {exact}")


def zero_lines(tables: Path) -> Iterator[str]:
    """Yield the lines of the file."""
    yield f"# ahv reference zeros, {GIVEN['velocity']} ft/s, {GIVEN['altitude']} ft, SLICOT AB08ND by slycot"
    with mpmath.workdps(DIGITS):
        for table, model, parameters, canard in CASES:
            system = System(tables / f"{table}.toml", model, parameters, canard)
            yield f"case,{model},{parameters},{canard or 'none'}"
            for name, matrix in (("A", system.rounded[:, : system.states]), ("B", system.rounded[:, system.states :])):
                yield ",".join((name, *map(str, matrix.shape), *(repr(float(value)) for value in matrix.flat)))
            for pair in system.pairs():
                yield _row(pair, reference(system, pair))


def _row(pair: Pair, found: Structure) -> str:
    ordered = sorted(found.zeros, key=lambda root: (round(abs(root), 6), root.imag, root.real))
    upper = [root for root in ordered if root.imag >= 0.0]
    roots = [f"{root.real:.10g}:{root.imag:.10g}" if root.imag else f"{root.real:.10g}" for root in upper]
    lists = (*pair, (found.rank,), found.orders, found.right, found.left)
    return "|".join((*(" ".join(map(str, numbers)) for numbers in lists), " ".join(roots)))
