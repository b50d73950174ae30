"""Reference reductions of linear systems: errors and norms by SLICOT.

SLICOT comes with the package ``slycot``, which is no requirement of this project. With it beside the development
requirements, in the folder ``generator``::

    pip install slycot
    python -m ahv_oracle reduction --out ../tests/vectors/reduction.txt

Line 1 is a comment; then for each case stand the rows of A, B, C: name, rows, columns and the entries by rows; a row
``hankel`` of the stable part's Hankel singular values; and for each method and order a row of its name, the order, the
H-infinity and the H2 norm of the error. The whole stable part has the method ``stable``. Balanced truncation is
``AB09AD``; the norms are ``AB13DD`` and ``AB13BD``. SciPy splits off the stable part and projects what matches moments.
"""

from collections.abc import Iterator
from typing import Any

import numpy
import scipy.linalg
from numpy.typing import NDArray

Matrix = NDArray[numpy.float64]

CASES = ((4, 1, 1, 0), (6, 2, 2, 0), (9, 2, 3, 2), (11, 3, 3, 1))
"""States, inputs, outputs and unstable poles of each case."""

SEED = 20261201
"""Of the matrices' entries."""

UNITS = 3.0
"""A case's last state is measured in a unit smaller by this power of ten, as feet stand beside radians."""


def reduction_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    yield f"# ahv reference reductions, SLICOT, states x inputs x outputs x unstable {CASES}, seed {SEED}"
    generator = numpy.random.default_rng(SEED)
    for states, inputs, outputs, unstable in CASES:
        a, b, c = _system(generator, (states, inputs, outputs), unstable)
        for name, matrix in (("A", a), ("B", b), ("C", c)):
            yield _row(name, matrix)
        stable = _stable(a, b, c)
        reach = scipy.linalg.solve_continuous_lyapunov(stable[0], -stable[1] @ stable[1].T)
        seen = scipy.linalg.solve_continuous_lyapunov(stable[0].T, -stable[2].T @ stable[2])
        hankel = numpy.sqrt(numpy.abs(numpy.sort_complex(scipy.linalg.eigvals(reach @ seen))[::-1]))
        yield ",".join(("hankel", *(repr(float(value)) for value in hankel)))
        yield _norms("stable", 0, stable)
        for order in range(1, len(stable[0])):
            yield _norms("balanced", order, _difference(stable, _balanced(stable, order)))
            yield _norms("krylov", order, _difference(stable, _krylov(stable, seen, order)))


System = tuple[Matrix, Matrix, Matrix]


def _system(generator: numpy.random.Generator, shape: tuple[int, int, int], unstable: int) -> System:
    states, inputs, outputs = shape
    blocks = [[[value]] for value in generator.uniform(0.1, 2.0, size=unstable)]
    while sum(len(block) for block in blocks) < states - 1:
        frequency, damping = 10.0 ** generator.uniform(0.0, 2.0), generator.uniform(0.02, 0.7)
        blocks.append([[0.0, 1.0], [-(frequency**2), -2.0 * damping * frequency]])
    if sum(len(block) for block in blocks) < states:
        blocks.append([[-generator.uniform(0.1, 1.0)]])
    mixing = generator.normal(size=(states, states)) @ numpy.diag(10.0 ** numpy.linspace(0.0, UNITS, states))
    a = numpy.linalg.solve(mixing, scipy.linalg.block_diag(*blocks) @ mixing)
    b = numpy.asarray(numpy.linalg.solve(mixing, generator.normal(size=(states, inputs))), dtype=numpy.float64)
    return a, b, generator.normal(size=(outputs, states)) @ mixing


def _stable(a: Matrix, b: Matrix, c: Matrix) -> System:
    """The part with poles in the left half plane: an ordered Schur form, decoupled by a Sylvester equation."""
    triangle, basis, count = scipy.linalg.schur(a, sort="lhp")
    upper, lower = triangle[:count, :count], triangle[count:, count:]
    if count == len(a):
        return a, b, c
    coupling = scipy.linalg.solve_sylvester(upper, -lower, -triangle[:count, count:])
    rotated = basis.T @ b
    return upper, rotated[:count] - coupling @ rotated[count:], (c @ basis)[:, :count]


def _balanced(system: System, order: int) -> System:
    from slycot import ab09ad

    a, b, c = system
    _, reduced_a, reduced_b, reduced_c, _ = ab09ad("C", "B", "S", len(a), b.shape[1], len(c), a, b, c, nr=order)
    return reduced_a, reduced_b, reduced_c


def _krylov(system: System, seen: Matrix, order: int) -> System:
    """What matches moments at zero frequency, projected with the observability Gramian, by plain powers of A⁻¹."""
    a, b, c = system
    inverse = numpy.linalg.inv(a)
    powers = [numpy.linalg.matrix_power(inverse, power + 1) @ b for power in range(order)]
    columns = numpy.hstack(powers)[:, :order]
    basis, _ = numpy.linalg.qr(columns / numpy.linalg.norm(columns, axis=0))
    left = numpy.linalg.solve(basis.T @ seen @ basis, basis.T @ seen)
    return left @ a @ basis, left @ b, c @ basis


def _difference(one: System, other: System) -> System:
    a = scipy.linalg.block_diag(one[0], other[0])
    return a, numpy.vstack([one[1], other[1]]), numpy.hstack([one[2], -other[2]])


def _norms(method: str, order: int, system: System) -> str:
    from slycot import ab13bd, ab13dd

    a, b, c = system
    n, m, p = len(a), b.shape[1], len(c)
    d = numpy.zeros((p, m))
    h_infinity, _ = ab13dd("C", "I", "S", "Z", n, m, p, a, numpy.eye(n), b, c, d, tol=1e-12)
    h2: Any = ab13bd("C", "H", n, m, p, a, b, c, d)
    return f"{method},{order},{float(h_infinity)!r},{float(h2)!r}"


def _row(name: str, matrix: Matrix) -> str:
    rows, columns = matrix.shape
    return ",".join((name, str(rows), str(columns), *(repr(float(value)) for value in matrix.flat)))
