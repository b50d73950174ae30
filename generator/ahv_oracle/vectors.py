"""Reference vectors: sampled inputs with 50-digit outputs, one text row a point.

Line 1 is a comment, line 2 the columns ``inputs|outputs``; a row is ``inputs|outputs`` with each
output ``hi;lo;K``: the nearest double, what it misses of the exact value, and K; ``nan;0;0`` where
there is no real value.
"""

import os
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

import mpmath

from .evaluate import DIGITS, Oracle
from .program import Number
from .sampling import Point, sample


def write_vectors(oracle: Oracle, points: int, seed: int, out: Path) -> None:
    """Write `points` reference rows to `out`, all or nothing."""
    write_lines(vector_lines(oracle, points, seed), out)


def write_lines(lines: Iterable[str], out: Path) -> None:
    """Write lines to `out`, all or nothing."""
    descriptor, name = tempfile.mkstemp(dir=out.parent, prefix=f".{out.name}.")
    temporary = Path(name)
    try:
        with os.fdopen(descriptor, "w", encoding="utf-8", newline="\n") as file:
            file.writelines(f"{line}\n" for line in lines)
        temporary.chmod(0o644)
        temporary.replace(out)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def vector_lines(oracle: Oracle, points: int, seed: int) -> Iterator[str]:
    """Yield the lines of a file of reference vectors."""
    yield from heading(oracle, points, seed)
    for index in range(points):
        yield vector_row(oracle, sample(oracle.model, seed, index))


def heading(oracle: Oracle, points: int, seed: int) -> tuple[str, str]:
    """Return the two lines before the rows: what this is, and the columns."""
    model, table = oracle.model.name, oracle.table.name
    functions = f"functions {' '.join(oracle.functions)}" if oracle.restricted else "all functions"
    comment = f"# ahv reference vectors, model {model}, table {table}, seed {seed}, points {points}, {functions}; "
    columns = f"{','.join(oracle.names)}|{','.join(oracle.labels)}"
    return comment + "inputs|outputs, an output is hi;lo;K", columns


def vector_row(oracle: Oracle, point: Point) -> str:
    """Return the row of a point."""
    inputs = ",".join(repr(point[name]) for name in oracle.names)
    results = oracle.evaluate(point)
    return f"{inputs}|{','.join(_output(*results[label]) for label in oracle.labels)}"


def _output(value: Number, magnitude: Number) -> str:
    if mpmath.isnan(value):
        return "nan;0;0"
    with mpmath.workdps(DIGITS):
        high = float(value)
        low = float(value - mpmath.mpf(high))
    return f"{high!r};{_short(low)};{_short(float(magnitude))}"


def _short(number: float) -> str:
    return f"{number:.3e}" if number else "0"
