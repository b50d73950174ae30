"""The reference roots: the committed file, and zeros by another way."""

from pathlib import Path

import numpy

from ahv_oracle.roots import Case, root_lines, zeros

TABLES = Path(__file__).parents[1] / "tables"
COMMITTED = Path(__file__).parents[2] / "tests" / "vectors" / "roots.txt"


def test_the_committed_roots_are_those_of_the_oracle() -> None:
    """To rounding, which differs between machines."""
    committed = COMMITTED.read_text(encoding="utf-8").splitlines()
    for line, fresh in zip(committed, root_lines(TABLES), strict=True):
        name, *fields = line.split(",")
        assert name == fresh.split(",")[0]
        if name not in ("case",) and not name.startswith("#"):
            values = numpy.array([float(field) for field in fields])
            again = numpy.array([float(field) for field in fresh.split(",")[1:]])
            numpy.testing.assert_allclose(values, again, rtol=1e-8, atol=1e-9)


def test_zeros_are_the_poles_of_the_system_with_its_outputs_held() -> None:
    """With C B regular, u = -(C B)^-1 C A x keeps y at 0: zeros are the poles left, beside one at 0 for each output."""
    case = Case(TABLES / "dcom.toml", "dcom", "section5.3")
    a, b = case.system()
    c = case.outputs()
    held = numpy.linalg.eigvals(a - b @ numpy.linalg.solve(c @ b, c @ a))
    found = zeros(a, b, c)
    assert len(found) == len(a) - len(c)
    for zero in found:
        assert numpy.abs(held - zero).min() < 1e-8 * max(1.0, abs(zero))
