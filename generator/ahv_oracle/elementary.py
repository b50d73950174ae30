"""Reference values of sine, cosine and exponential by mpmath, at random and at hard points.

Line 1 is a comment; a row is ``function,x,nearest,missing``: the nearest double to f(x), and what it misses of f(x), in
its ulp.
"""

import math
import random
from collections.abc import Iterator

import mpmath

DIGITS = 60
SEED = 20261125
POINTS = 400
"""Of each function in each range."""

ANGLES = ((0.0, 1e-3), (0.0, 0.8), (0.7, 10.0), (10.0, 1e6), (1e6, 1e15))
"""Ranges of |x| in rad."""
EXPONENTS = ((0.0, 1e-3), (0.0, 3.0), (3.0, 708.0), (708.0, 709.0))
LARGEST_TURN = 636_619
"""The last multiple of π/2 below 10⁶."""
HARDEST = 200
"""Doubles that are nearest to a multiple of π/2."""


def elementary_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    heading = f"# ahv reference values of sin, cos and exp, mpmath with {DIGITS} digits, seed {SEED}"
    yield f"{heading}; function,x,nearest,missing"
    draw = random.Random(SEED)
    with mpmath.workdps(DIGITS):
        angles = [*_drawn(draw, ANGLES), *_near_multiples()]
        for x in angles:
            yield _row("sin", x, mpmath.sin(mpmath.mpf(x)))
            yield _row("cos", x, mpmath.cos(mpmath.mpf(x)))
        for x in _drawn(draw, EXPONENTS):
            yield _row("exp", x, mpmath.exp(mpmath.mpf(x)))


def _drawn(draw: random.Random, ranges: tuple[tuple[float, float], ...]) -> Iterator[float]:
    for low, high in ranges:
        for _ in range(POINTS):
            yield math.copysign(draw.uniform(low, high), draw.random() - 0.5)


def _near_multiples() -> list[float]:
    """Return the doubles with the smallest distances from a multiple of π/2."""
    bits = 300
    half_pi = int(mpmath.floor(mpmath.ldexp(_half_pi(bits), bits)))
    found = []
    for turn in range(1, LARGEST_TURN + 1):
        multiple = turn * half_pi
        shift = multiple.bit_length() - 53
        nearest = (multiple + (1 << (shift - 1))) >> shift
        distance = abs((nearest << shift) - multiple)
        found.append((distance, math.ldexp(nearest, shift - bits)))
    return [x for _, x in sorted(found)[:HARDEST]]


def _half_pi(bits: int) -> mpmath.mpf:
    with mpmath.workprec(bits + 20):
        return +mpmath.pi / 2


def _row(name: str, x: float, value: mpmath.mpf) -> str:
    nearest = float(value)
    missing = (value - mpmath.mpf(nearest)) / mpmath.mpf(math.ulp(nearest))
    return f"{name},{x!r},{nearest!r},{float(missing):.6f}"
