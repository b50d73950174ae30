"""Reference solutions of the algebraic Riccati equation, by SciPy's ordered QZ decomposition of the extended pencil.

Line 1 is a comment; then for each case stand the rows of A, B, Q, R, X: name, rows, columns and the entries by rows.
"""

from collections.abc import Iterator

import numpy
from numpy.typing import NDArray
from scipy.linalg import solve_continuous_are

CASES = ((2, 1), (3, 2), (5, 2), (8, 2), (11, 2))
"""States and inputs of each case."""

SEED = 20261125
"""Of the matrices' entries."""

UNITS = 3.0
"""A case's last state is measured in a unit smaller by this power of ten, as feet stand beside radians."""


def riccati_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    sizes = ", ".join(f"{states} x {inputs}" for states, inputs in CASES)
    yield f"# ahv reference Riccati solutions, scipy.linalg.solve_continuous_are, states x inputs {sizes}, seed {SEED}"
    generator = numpy.random.default_rng(SEED)
    for states, inputs in CASES:
        units = numpy.diag(10.0 ** numpy.linspace(0.0, UNITS, states))
        a = units @ generator.normal(size=(states, states)) @ numpy.linalg.inv(units)
        b = units @ generator.normal(size=(states, inputs))
        root = generator.normal(size=(states, states)) @ numpy.linalg.inv(units)
        q = root.T @ root
        q = 0.5 * (q + q.T)
        r = numpy.diag(generator.uniform(0.5, 2.0, size=inputs))
        x = solve_continuous_are(a, b, q, r)
        for name, matrix in (("A", a), ("B", b), ("Q", q), ("R", r), ("X", x)):
            yield _row(name, matrix)


def _row(name: str, matrix: NDArray[numpy.float64]) -> str:
    rows, columns = matrix.shape
    return ",".join((name, str(rows), str(columns), *(repr(float(value)) for value in matrix.flat)))
