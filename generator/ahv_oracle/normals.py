"""Reference normal numbers: ChaCha8 and Box–Muller, written from their definitions.

Line 1 is a comment; a row is ``precision,seed,member,channel,step,bits,hi``: the bits of the number as
`crates/ahv-integrate/src/noise/box_muller.rs` says it is rounded, and the nearest double to the exact number.
"""

import math
import random
import struct
from collections.abc import Callable, Iterator, Sequence

import mpmath
import numpy

DIGITS = 40
SEED = 20261125
KEYS = 40
"""Drawn (seed, member, channel, step), beside those that are written out."""
WORD = 0xFFFF_FFFF
PER_BLOCK = {"f64": 10, "f32": 16}

POLYNOMIALS = {
    "f64": (
        (
            0.9999999999999498,
            -0.1666666666646722,
            0.008333333320383393,
            -0.00019841266687321236,
            2.7556953229449346e-06,
            -2.5030279200133748e-08,
            1.5411363186105563e-10,
        ),
        (
            0.9999999999999981,
            -0.4999999999998996,
            0.041666666665811244,
            -0.0013888888861122554,
            2.4801582874307304e-05,
            -2.755693565584146e-07,
            2.0858324349964e-09,
            -1.1008026561441563e-11,
        ),
        (0.3333333333692341, 0.1999999793005545, 0.14286057113457418, 0.11087546575232551, 0.09804523740099952),
    ),
    "f32": (
        (
            0.9999999957307073,
            -0.1666665798850269,
            0.008333050980351555,
            -0.00019809068997892726,
            2.6052103270161948e-6,
        ),
        (
            0.9999999534438831,
            -0.49999905309858694,
            0.04166358378561811,
            -0.001385369743337397,
            2.3153772294098156e-5,
        ),
        (0.33333389146356185, 0.19988038941815314, 0.14962796254989294),
    ),
}
"""Sine, cosine, artanh, by crates/ahv-core/scripts/elementary.py."""


def normal_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    yield f"# ahv reference normal numbers, seed {SEED}; precision,seed,member,channel,step,bits,hi"
    draw = random.Random(SEED)
    fixed = [(1, 2, channel, 3) for channel in range(6)]
    drawn = [(*(draw.getrandbits(64) for _ in range(3)), draw.getrandbits(draw.choice((10, 64)))) for _ in range(KEYS)]
    for seed, member, channel, step in [*fixed, *drawn]:
        for precision in ("f64", "f32"):
            rounded, exact = normal(precision, (seed, member, channel), step)
            bits = struct.pack(">d" if precision == "f64" else ">f", rounded).hex()
            yield f"{precision},{seed},{member},{channel},{step},{bits},{exact!r}"


def normal(precision: str, key: Sequence[int], step: int) -> tuple[float, float]:
    """Return number `step` of the stream of (seed, member, channel) as it is rounded, and nearly exact."""
    block, place = divmod(step, PER_BLOCK[precision])
    words = chacha8(key, block)
    pair = place // 2
    if precision == "f64":
        low, high, angle = words[3 * pair : 3 * pair + 3]
        sign, uniform = low & 1, (1 << 52) - ((low | high << 32) >> 12)
        unit = 2.0**-52
    else:
        radius, angle = words[2 * pair : 2 * pair + 2]
        sign, uniform = radius & 1, (radius >> 1) + 1
        unit = 2.0**-31
    signed = angle - (1 << 32 if angle >> 31 else 0)
    with mpmath.workdps(DIGITS):
        theta = mpmath.pi * (mpmath.mpf(signed) / 2**32 + sign)
        length = mpmath.sqrt(-2 * mpmath.log(mpmath.mpf(uniform) * unit))
        exact = float(length * (mpmath.sin(theta) if place % 2 else mpmath.cos(theta)))
    kind: Callable[[float], numpy.floating] = numpy.float64 if precision == "f64" else numpy.float32
    return float(_rounded(precision, kind, uniform, unit, signed, sign)[place % 2]), exact


def chacha8(key: Sequence[int], block: int) -> list[int]:
    """Return the 16 words of a block: constants, a key of 256 bits, a counter of 64 bits, no nonce; 8 rounds."""
    start = [*struct.unpack("<4I", b"expand 32-byte k")]
    for number in (*key, 0, block, 0):
        start += [number & WORD, number >> 32]
    state = start.copy()
    for _ in range(4):
        for column in range(4):
            _quarter(state, column, column + 4, column + 8, column + 12)
        for column in range(4):
            _quarter(state, column, 4 + (column + 1) % 4, 8 + (column + 2) % 4, 12 + (column + 3) % 4)
    return [(a + b) & WORD for a, b in zip(state, start, strict=True)]


def _quarter(state: list[int], a: int, b: int, c: int, d: int) -> None:
    for into, other, target, turn in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
        state[into] = (state[into] + state[other]) & WORD
        mixed = state[target] ^ state[into]
        state[target] = (mixed << turn | mixed >> (32 - turn)) & WORD


def _rounded(
    precision: str, kind: Callable[[float], numpy.floating], uniform: int, unit: float, angle: int, sign: int
) -> tuple[numpy.floating, numpy.floating]:
    """Return both numbers of a pair; every operation is rounded to the precision."""
    sine, cosine, artanh = POLYNOMIALS[precision]

    def polynomial(coefficients: Sequence[float], z: numpy.floating) -> numpy.floating:
        value = kind(coefficients[-1])
        for c in coefficients[-2::-1]:
            value = kind(c) + z * value
        return value

    mantissa, exponent = math.frexp(float((kind(uniform - 1) + kind(1)) * kind(unit)))
    if mantissa < float(kind(math.sqrt(0.5))):
        mantissa, exponent = 2.0 * mantissa, exponent - 1
    m = kind(mantissa)
    s = (m - kind(1)) / (m + kind(1))
    z = s * s
    half_logarithm = s + s * z * polynomial(artanh, z)
    length = numpy.sqrt(kind(exponent) * kind(-2 * math.log(2)) - kind(4) * half_logarithm)
    if sign:
        length = -length
    theta = kind(angle) * kind(math.pi / 2 * 2.0**-31)
    z = theta * theta
    return length * polynomial(cosine, z), length * (theta * polynomial(sine, z))
