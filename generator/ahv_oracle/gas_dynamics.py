"""Gas dynamics by mpmath, from conservation laws and roots, never from the closed forms of `ahv-fpm`.

Line 1 of the vectors is a comment; a row is ``relation,mach,argument,mach behind,pressure ratio,temperature ratio,
angle``, angles in rad; an angle that a relation does not have is empty. The ratio of specific heats is 7/5.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator

import mpmath as mp

DIGITS = 40
SEED = 20261130
POINTS = 40
"""Of each relation."""
GAMMA = mp.mpf(7) / 5


def gas_dynamics_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    heading = f"# ahv reference values of gas dynamics, mpmath with {DIGITS} digits, seed {SEED}"
    yield f"{heading}; relation,mach,argument,mach behind,pressure,temperature,angle"
    draw = random.Random(SEED)
    with mp.workdps(DIGITS):
        for point in range(POINTS):
            mach = mp.mpf(draw.uniform(1.1, 5.0) if point % 2 else draw.uniform(5.0, 15.0))
            share = mp.mpf(draw.choice([1e-9, 1e-5, 1e-2]) if point % 8 == 0 else draw.uniform(0.01, 0.99))
            yield _row("shock", mach, share * greatest_turn(mach)[0], shock)
            yield _row("expansion", mach, share * mp.mpf("0.9") * (vacuum_angle() - prandtl_meyer(mach)), expansion)
            yield _row("heat", mach, 1 + share * (choking_ratio(mach) - 1), heat_addition)
            yield _row("duct", mach, mp.exp(mp.mpf(draw.uniform(0.0, 3.0))), area_change)


def _row(name: str, mach: mp.mpf, argument: mp.mpf, relation: Callable[[mp.mpf, mp.mpf], tuple[mp.mpf, ...]]) -> str:
    # What is computed belongs to the doubles that are written.
    mach, argument = mp.mpf(float(mach)), mp.mpf(float(argument))
    found = relation(mach, argument)
    numbers = [float(it) for it in (mach, argument, *found)]
    return ",".join([name, *map(repr, numbers), *[""] * (6 - len(numbers))])


def _stagnation(mach: mp.mpf) -> mp.mpf:
    """Total over static temperature."""
    return 1 + (GAMMA - 1) / 2 * mach**2


def turn_of(mach: mp.mpf, angle: mp.mpf) -> mp.mpf:
    """Turn of the flow by a shock at an angle: its normal part is slowed, its tangential part is kept."""
    density = normal_shock(mach * mp.sin(angle))[2]
    return angle - mp.atan(mp.tan(angle) / density)


def normal_shock(mach: mp.mpf) -> tuple[mp.mpf, mp.mpf, mp.mpf, mp.mpf]:
    """Mach number behind, and ratios of pressure, density and temperature: the other root of the conservation laws.

    With p = ρ = 1 ahead, mass, momentum and energy leave a quadratic in the velocity behind; the product of its roots
    is the square of the critical velocity, Prandtl's relation.
    """
    velocity = mach * mp.sqrt(GAMMA)
    critical_2 = 2 * GAMMA / (GAMMA + 1) * _stagnation(mach)
    behind = critical_2 / velocity
    pressure = 1 + velocity * (velocity - behind)
    density = velocity / behind
    temperature = pressure / density
    return behind / mp.sqrt(GAMMA * temperature), pressure, density, temperature


def greatest_turn(mach: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """Return the greatest turn of an attached shock and its angle, by golden section."""
    low, high = mp.asin(1 / mach), mp.pi / 2
    golden = (mp.sqrt(5) - 1) / 2
    while high - low > mp.mpf(10) ** (-DIGITS // 2):
        left, right = high - golden * (high - low), low + golden * (high - low)
        low, high = (left, high) if turn_of(mach, left) < turn_of(mach, right) else (low, right)
    angle = (low + high) / 2
    return turn_of(mach, angle), angle


def _root(function: Callable[[mp.mpf], mp.mpf], low: mp.mpf, high: mp.mpf) -> mp.mpf:
    """Return the root between two places where the function is below and above 0, in this order."""
    for _ in range(4 * DIGITS):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return (low + high) / 2


def shock(mach: mp.mpf, turn: mp.mpf) -> tuple[mp.mpf, ...]:
    """Return Mach number behind, ratios of pressure and temperature, and angle of the weak oblique shock."""
    angle = _root(lambda at: turn_of(mach, at) - turn, mp.asin(1 / mach), greatest_turn(mach)[1])
    behind, pressure, _, temperature = normal_shock(mach * mp.sin(angle))
    return behind / mp.sin(angle - turn), pressure, temperature, angle


def prandtl_meyer(mach: mp.mpf) -> mp.mpf:
    """Return the Prandtl-Meyer angle: that of √(M² − 1)/(1 + (γ−1)M²/2)/M, with M = cosh s, without a kink at 1."""
    return mp.quad(lambda s: mp.sinh(s) ** 2 / _stagnation(mp.cosh(s)) / mp.cosh(s), [0, mp.acosh(mach)])


def vacuum_angle() -> mp.mpf:
    """Return the Prandtl-Meyer angle of vacuum: that of a Mach number without end."""
    return mp.quad(lambda s: mp.sinh(s) ** 2 / _stagnation(mp.cosh(s)) / mp.cosh(s), [0, 1, 3, 10, 40, 120])


def expansion(mach: mp.mpf, turn: mp.mpf) -> tuple[mp.mpf, ...]:
    """Return Mach number behind and ratios of pressure and temperature."""
    target = prandtl_meyer(mach) + turn
    behind = mp.findroot(lambda at: prandtl_meyer(at) - target, (mach, mach * 1.2 + turn), solver="secant", tol=1e-28)
    temperature = _stagnation(mach) / _stagnation(behind)
    return behind, temperature ** (GAMMA / (GAMMA - 1)), temperature


def choking_ratio(mach: mp.mpf) -> mp.mpf:
    """Return the ratio of total temperatures that takes a stream to Mach 1 in a duct of constant area."""
    return _heated(mach, mp.mpf(1))[0]


def _heated(mach: mp.mpf, behind: mp.mpf) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Ratios of total temperature, pressure and temperature, from p(1 + γM²) and p²M²/T, which are kept."""
    pressure = (1 + GAMMA * mach**2) / (1 + GAMMA * behind**2)
    temperature = (pressure * behind / mach) ** 2
    return temperature * _stagnation(behind) / _stagnation(mach), pressure, temperature


def heat_addition(mach: mp.mpf, heating: mp.mpf) -> tuple[mp.mpf, ...]:
    """Return Mach number behind and ratios of pressure and temperature."""
    behind = _root(lambda at: heating - _heated(mach, at)[0], mp.mpf(1), mach)
    _, pressure, temperature = _heated(mach, behind)
    return behind, pressure, temperature


def area_ratio(mach: mp.mpf) -> mp.mpf:
    """Return A/A*: the mass flow of a unit of area at Mach 1 over that at a Mach number, at the same total state."""

    def flux(at: mp.mpf) -> mp.mpf:
        temperature = 1 / _stagnation(at)
        return temperature ** (1 / (GAMMA - 1)) * at * mp.sqrt(temperature)

    return flux(mp.mpf(1)) / flux(mach)


def area_change(mach: mp.mpf, ratio: mp.mpf) -> tuple[mp.mpf, ...]:
    """Return Mach number behind and ratios of pressure and temperature of a supersonic stream that widens."""
    target = ratio * area_ratio(mach)
    behind = _root(lambda at: area_ratio(at) - target, mach, mp.mpf(200))
    temperature = _stagnation(mach) / _stagnation(behind)
    return behind, temperature ** (GAMMA / (GAMMA - 1)), temperature
