"""Reference output error: a decaying mode with measurement noise, fitted by SciPy's ``least_squares``.

The model is the closed form. Line 1 is a comment; then stand rows ``time,eta`` of the record, and a row ``answer`` with
omega and zeta, their standard errors and the standard deviation of the residuals.
"""

from collections.abc import Iterator

import numpy
from numpy.typing import NDArray
from scipy.optimize import least_squares

OMEGA, ZETA, NOISE = 18.0, 0.1, 0.02
"""Natural frequency in rad/s, damping ratio, standard deviation of the noise."""

SAMPLES, STEP, SEED = 80, 0.02, 20261201
"""Of the record; the step is in s."""

GUESS = (19.7437, 0.7, 1.0, 0.0)
"""Where the search starts: omega, zeta, and the mode's position and rate at time 0."""

Vector = NDArray[numpy.float64]


def _decay(unknowns: Vector, times: Vector) -> Vector:
    omega, zeta, position, rate = unknowns
    damped = omega * numpy.emath.sqrt(1.0 - zeta**2)
    swing = position * numpy.cos(damped * times) + (rate + zeta * omega * position) / damped * numpy.sin(damped * times)
    return numpy.asarray(numpy.exp(-zeta * omega * times) * numpy.real(swing))


def identify_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    yield f"# ahv reference output error, scipy.optimize.least_squares, omega {OMEGA}, zeta {ZETA}, seed {SEED}"
    generator = numpy.random.default_rng(SEED)
    times = numpy.arange(SAMPLES, dtype=numpy.float64) * STEP
    measured = _decay(numpy.array([OMEGA, ZETA, 1.0, 0.0]), times) + NOISE * generator.normal(size=SAMPLES)
    for time, eta in zip(times, measured, strict=True):
        yield f"{float(time)!r},{float(eta)!r}"
    found = least_squares(
        lambda it: _decay(it, times) - measured, GUESS, jac="3-point", xtol=1e-14, ftol=1e-14, gtol=1e-14
    )
    unknowns = len(GUESS)
    variance = 2.0 * found.cost / (SAMPLES - unknowns)
    errors = numpy.sqrt(variance * numpy.diag(numpy.linalg.inv(found.jac.T @ found.jac)))
    deviation = numpy.sqrt(2.0 * found.cost / SAMPLES)
    answer = (*found.x[:2], *errors[:2], deviation)
    yield ",".join(("answer", *(repr(float(it)) for it in answer)))
