"""Computes the polynomials of src/elementary and of ahv-integrate/src/noise: near-minimax by Remez exchange, rounded.

Run with the project's development environment; prints Rust constants and the error of each approximation.
"""

from __future__ import annotations

from collections.abc import Callable

import mpmath as mp

mp.mp.dps = 60
Real = Callable[[mp.mpf], mp.mpf]


def remez(
    f: Real, weight: Real, low: float, high: float, first: int, degree: int
) -> list[mp.mpf]:
    """Coefficients of x^first … x^degree that make the largest |weight * (f - p)| on the interval nearly smallest."""
    low_, high_ = mp.mpf(low), mp.mpf(high)
    size = degree - first + 1
    count = size + 1
    middle, half = (low_ + high_) / 2, (high_ - low_) / 2
    nodes = [middle - half * mp.cos(mp.pi * k / (count - 1)) for k in range(count)]
    coefficients: list[mp.mpf] = []
    for _ in range(8):
        matrix = mp.matrix(count, count)
        right = mp.matrix(count, 1)
        for row, x in enumerate(nodes):
            for column in range(size):
                matrix[row, column] = x ** (first + column)
            matrix[row, size] = (-1) ** row / weight(x)
            right[row] = f(x)
        solution = mp.lu_solve(matrix, right)
        coefficients = [solution[k] for k in range(size)]

        def error(x: mp.mpf, c: list[mp.mpf] = coefficients) -> mp.mpf:
            return weight(x) * (f(x) - x**first * mp.polyval(c[::-1], x))

        grid = [middle - half * mp.cos(mp.pi * k / 1201) for k in range(1202)]
        values = [error(x) for x in grid]
        peaks = [
            k
            for k in range(len(grid))
            if (k == 0 or abs(values[k]) >= abs(values[k - 1]))
            and (k == len(grid) - 1 or abs(values[k]) >= abs(values[k + 1]))
        ]
        alternating: list[int] = []
        for k in peaks:
            if alternating and mp.sign(values[k]) == mp.sign(values[alternating[-1]]):
                if abs(values[k]) > abs(values[alternating[-1]]):
                    alternating[-1] = k
            else:
                alternating.append(k)
        while len(alternating) > count:
            ends = (abs(values[alternating[0]]), abs(values[alternating[-1]]))
            alternating.pop(0 if ends[0] < ends[1] else -1)
        if len(alternating) < count:
            break
        nodes = [grid[k] for k in alternating]
    return coefficients


def fit(
    f: Real, weight: Real, low: float, high: float, degree: int, refit: int
) -> tuple[list[float], mp.mpf]:
    """Coefficients as doubles; the first `refit` are rounded one by one and the later ones make good for it."""
    found: list[float] = []
    for fixed in range(refit + 1):

        def rest(x: mp.mpf, done: tuple[float, ...] = tuple(found)) -> mp.mpf:
            return (
                f(x) - mp.polyval([mp.mpf(c) for c in done][::-1], x) if done else f(x)
            )

        solved = remez(rest, weight, low, high, fixed, degree)
        found += [float(c) for c in (solved if fixed == refit else solved[:1])]
    middle, half = (mp.mpf(low) + high) / 2, (mp.mpf(high) - low) / 2
    grid = [
        middle - half * mp.cos(mp.pi * (k + mp.mpf(1) / 3) / 2000) for k in range(2000)
    ]
    worst = max(
        abs(weight(x) * (f(x) - mp.polyval([mp.mpf(c) for c in found][::-1], x)))
        for x in grid
    )
    return found, worst


def show(name: str, coefficients: list[float], worst: mp.mpf) -> None:
    print(f"// error {mp.nstr(worst, 3)} = 2^{mp.nstr(mp.log(worst, 2), 4)}")
    print(f"const {name}: [f64; {len(coefficients)}] = [")
    for c in coefficients:
        print(f"    {c!r},")
    print("];")


def split(value: mp.mpf, bits: list[int]) -> list[float]:
    """The value as a sum of doubles, each but the last with the given number of bits."""
    parts = []
    for count in bits:
        scale = mp.mpf(2) ** (count - 1 - int(mp.floor(mp.log(abs(value), 2))))
        part = mp.floor(value * scale) / scale
        parts.append(float(part))
        value -= part
    return [*parts, float(value)]


def sine_tail(z: mp.mpf) -> mp.mpf:
    """(sin x - x)/x^3 for z = x^2."""
    return sum((-1) ** (k + 1) * z**k / mp.factorial(2 * k + 3) for k in range(25))


def sine_weight(z: mp.mpf) -> mp.mpf:
    """Error of the tail to relative error of sin x."""
    return z / (mp.sin(mp.sqrt(z)) / mp.sqrt(z)) if z else mp.mpf(1e-10)


def cosine_tail(z: mp.mpf) -> mp.mpf:
    """(cos x - 1 + x^2/2)/x^4 for z = x^2."""
    return sum((-1) ** k * z**k / mp.factorial(2 * k + 4) for k in range(25))


def cosine_weight(z: mp.mpf) -> mp.mpf:
    """Error of the tail to relative error of cos x."""
    return z * z / mp.cos(mp.sqrt(z))


def exponential_tail(r: mp.mpf) -> mp.mpf:
    """(e^r - 1 - r)/r^2."""
    return sum(r**k / mp.factorial(k + 2) for k in range(40))


def exponential_weight(r: mp.mpf) -> mp.mpf:
    """Error of the tail to relative error of e^r."""
    return max(r * r, mp.mpf(1e-6)) / mp.exp(r)


def main() -> None:
    edge = float((mp.pi / 4) ** 2) * 1.0001
    half = float(mp.log(2) / 2) * 1.0001
    show("SIN", *fit(sine_tail, sine_weight, 1e-9, edge, 5, 2))
    show("COS", *fit(cosine_tail, cosine_weight, 1e-9, edge, 5, 2))
    show("EXP", *fit(exponential_tail, exponential_weight, -half, half, 9, 0))
    print("const HALF_PI:", split(mp.pi / 2, [33, 33, 33]))
    print("const LN_2:", split(mp.log(2), [33]))

    # Tangent, logarithm, powers and inverses.
    def arc_tail(z: mp.mpf) -> mp.mpf:
        """(atan t - t)/t^3 for z = t^2."""
        return sum((-1) ** (k + 1) * z**k / mp.mpf(2 * k + 3) for k in range(90))

    def artanh_tail(z: mp.mpf) -> mp.mpf:
        """(artanh s - s - s^3/3 - s^5/5)/s^7 for z = s^2."""
        return sum(z**k / mp.mpf(2 * k + 7) for k in range(60))

    def less_one_tail(r: mp.mpf) -> mp.mpf:
        """(e^r - 1 - r - r^2/2)/r^3."""
        return sum(r**k / mp.factorial(k + 3) for k in range(30))

    arc_edge = float(mp.tan(mp.pi / 8) ** 2) * 1.0001
    show("ARC", *fit(arc_tail, lambda z: z, 1e-9, arc_edge, 10, 2))
    root = mp.sqrt(2)
    artanh_edge = float(((root - 1) / (root + 1)) ** 2) * 1.0001
    show("ARTANH", *fit(artanh_tail, lambda z: z**3, 1e-4, artanh_edge, 6, 0))

    def less_one_weight(r: mp.mpf) -> mp.mpf:
        """Error of the tail to relative error of e^r - 1."""
        return max(r * r, mp.mpf(1e-6))

    show("EXP_LESS_ONE", *fit(less_one_tail, less_one_weight, -half, half, 9, 0))
    print("const THIRD, FIFTH:", split(mp.mpf(1) / 3, [53]), split(mp.mpf(1) / 5, [53]))

    # Single precision; the doubles are written as f32 constants.
    show("SIN of f32", *fit(sine_tail, sine_weight, 1e-9, edge, 2, 0))
    show("COS of f32", *fit(cosine_tail, cosine_weight, 1e-9, edge, 2, 0))
    show("EXP of f32", *fit(exponential_tail, exponential_weight, -half, half, 4, 0))
    print("const HALF_PI of f32, doubles:", split(mp.pi / 2, [33]))
    print("const LN_2 of f32:", split(mp.log(2), [12]))

    # Normal numbers: sine and cosine of half a turn, logarithm by (1 + s)/(1 - s).
    quarter = float((mp.pi / 2) ** 2) * 1.0001

    def sine(z: mp.mpf) -> mp.mpf:
        return sum((-1) ** k * z**k / mp.factorial(2 * k + 1) for k in range(30))

    def cosine(z: mp.mpf) -> mp.mpf:
        return sum((-1) ** k * z**k / mp.factorial(2 * k) for k in range(30))

    def one(_: mp.mpf) -> mp.mpf:
        return mp.mpf(1)

    def logarithm(z: mp.mpf) -> mp.mpf:
        return sum(z**k / (2 * k + 3) for k in range(60))

    edge = float(((mp.sqrt(2) - 1) / (mp.sqrt(2) + 1)) ** 2) * 1.0001
    for name, degrees in (("f64", (6, 7, 4)), ("f32", (4, 4, 2))):
        show(f"SINE, {name}", *fit(sine, one, 1e-9, quarter, degrees[0], 0))
        show(f"COSINE, {name}", *fit(cosine, one, 1e-9, quarter, degrees[1], 0))
        show(
            f"LOGARITHM, {name}",
            *fit(logarithm, lambda z: z, 1e-9, edge, degrees[2], 0),
        )


if __name__ == "__main__":
    main()
