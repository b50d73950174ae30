"""Reference values of the other elementary functions by mpmath, at random points and where they go another way.

Line 1 is a comment; a row is ``function,x,y,nearest,missing``: the nearest double to f(x) or f(x, y), and what it
misses of that, in its ulp.
"""

import math
import random
from collections.abc import Callable, Iterator

import mpmath

DIGITS = 60
SEED = 20261130
POINTS = 250
"""Of each function in each range."""

Pair = tuple[float, float]
Range = tuple[float, float]


def _uniform(draw: random.Random, low: float, high: float) -> float:
    return math.copysign(draw.uniform(low, high), draw.random() - 0.5)


def _wide(draw: random.Random) -> float:
    """Draw a number of any magnitude, subnormal ones among them."""
    return math.copysign(math.ldexp(draw.uniform(0.5, 1.0), draw.randint(-1073, 1023)), draw.random() - 0.5)


def _of_one(
    ranges: tuple[Range, ...], edges: tuple[float, ...], widest: float
) -> Callable[[random.Random], list[Pair]]:
    """Points of a function of one number: ranges of |x|, edges with their neighbours, numbers of any magnitude."""

    def points(draw: random.Random) -> list[Pair]:
        drawn = [_uniform(draw, low, high) for low, high in ranges for _ in range(POINTS)]
        around = [sign * x for edge in edges for x in _around(edge) for sign in (1.0, -1.0)]
        wide = [x for x in (_wide(draw) for _ in range(4 * POINTS)) if abs(x) <= widest]
        return [(x, 0.0) for x in [*drawn, *around, *wide]]

    return points


def _around(x: float) -> list[float]:
    up, down = math.nextafter(x, math.inf), math.nextafter(x, 0.0)
    return [x, up, math.nextafter(up, math.inf), down, math.nextafter(down, 0.0)]


def _of_two_sides(draw: random.Random) -> list[Pair]:
    """Points of the plane: near each other in size, near the rays where the reduction changes, of any size."""
    points = [(_uniform(draw, 0.0, 2.0), _uniform(draw, 0.0, 2.0)) for _ in range(4 * POINTS)]
    for ray in (math.tan(math.pi / 8), 1.0, math.tan(3 * math.pi / 8)):
        for _ in range(POINTS):
            x = _uniform(draw, 0.5, 2.0)
            points.append((math.copysign(ray * x * (1 + draw.uniform(-4, 4) * 2**-52), draw.random() - 0.5), x))
    points += [(_wide(draw), _wide(draw)) for _ in range(2 * POINTS)]
    for _ in range(2 * POINTS):
        x = _wide(draw)
        points.append((max(min(x * draw.uniform(0.01, 100.0), 1e308), -1e308), x))
    return points


def _powers(draw: random.Random) -> list[Pair]:
    """Bases and exponents whose power is a double: near 1, of any size, at the ends of the range."""
    points = [(draw.uniform(0.0, 4.0), draw.uniform(-8.0, 8.0)) for _ in range(4 * POINTS)]
    for _ in range(4 * POINTS):
        base = abs(_wide(draw))
        points.append((base, draw.uniform(-744.0, 709.0) / math.log(base)))
    for _ in range(2 * POINTS):
        base = 1.0 + _uniform(draw, 0.0, 1.0) * 2.0 ** -draw.randint(1, 40)
        points.append((base, draw.uniform(-708.0, 709.0) / math.log(base)))
    for _ in range(2 * POINTS):
        base = draw.uniform(1.3, 1.5)
        points.append((base, draw.choice((-708.0, 709.0)) / math.log(base)))
    return points


_ANGLES = ((0.0, 1e-3), (0.0, 0.8), (0.7, 10.0), (10.0, 1e6))
_QUARTERS = tuple(k * math.pi / 4 for k in (1, 2, 3, 4, 5, 6, 1000, 1001, 1002, 400_000, 400_001))

FUNCTIONS: dict[str, tuple[Callable[..., mpmath.mpf], Callable[[random.Random], list[Pair]]]] = {
    "tan": (lambda x, _: mpmath.tan(x), _of_one(_ANGLES, _QUARTERS, 1e6)),
    "asin": (
        lambda x, _: mpmath.asin(x),
        _of_one(((0.0, 1e-3), (0.0, 0.4), (0.3, 1.0), (0.9, 1.0), (0.9999, 1.0)), (0.5, math.sin(math.pi / 8)), 1.0),
    ),
    "atan": (
        lambda x, _: mpmath.atan(x),
        _of_one(
            ((0.0, 1e-3), (0.0, 0.5), (0.4, 2.5), (2.0, 20.0), (1.0, 1e6)), (0.41421356237309503, 1.0, 2.0**60), 2e308
        ),
    ),
    "atan2": (mpmath.atan2, _of_two_sides),
    "tanh": (
        lambda x, _: mpmath.tanh(x),
        _of_one(((0.0, 1e-3), (0.0, 0.2), (0.1, 1.0), (1.0, 22.0)), (math.log(2) / 4, 2.0**-30, 20.0), 1e3),
    ),
    "ln": (
        lambda x, _: mpmath.log(x),
        lambda draw: [
            (abs(x), 0.0)
            for x, _ in _of_one(((0.5, 2.0), (0.99, 1.01), (0.0, 100.0)), (math.sqrt(2), 1.0, 2.0**-1022), 2e308)(draw)
        ],
    ),
    "powr": (mpmath.power, _powers),
}
"""Of each function: its value, and the points at which it is given."""


def transcendental_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    heading = f"# ahv reference values of {', '.join(FUNCTIONS)}, mpmath with {DIGITS} digits, seed {SEED}"
    yield f"{heading}; function,x,y,nearest,missing"
    with mpmath.workdps(DIGITS):
        for name, (function, points) in FUNCTIONS.items():
            for x, y in points(random.Random(f"{SEED} {name}")):
                yield _row(name, x, y, function(mpmath.mpf(x), mpmath.mpf(y)))


def _row(name: str, x: float, y: float, value: mpmath.mpf) -> str:
    nearest = float(value)
    if math.isinf(nearest):
        return f"{name},{x!r},{y!r},{nearest!r},0"
    missing = (value - mpmath.mpf(nearest)) / mpmath.mpf(math.ulp(nearest))
    return f"{name},{x!r},{y!r},{nearest!r},{float(missing):.6f}"
