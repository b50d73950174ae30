"""Coefficients of DCOM from geometry a second time: what `ahv fit --from fpm` fits.

Loads are those of `first_principles`; modes of the whole vehicle as a beam that is free at both ends are normalised and
integrated by quadrature. Line 1 of the vectors is a comment, line 2 names the columns.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from math import cos, cosh, pi, sin, sinh, sqrt

from scipy.integrate import quad
from scipy.optimize import brentq

from .first_principles import Stream, Vehicle, parameters, turned

SEED = 20261202
POINTS = 25
AREA, CHORD, THRUST_LINE = 17.0, 17.0, 8.36
BOX = {
    "velocity": (7500.0, 7900.0),
    "altitude": (84000.0, 86000.0),
    "alpha": (-0.017, 0.087),
    "phi": (0.1, 0.5),
    "delta_e": (-0.26, 0.26),
    "delta_c": (-0.26, 0.26),
    "eta_1": (-1.0, 1.0),
    "eta_2": (-1.0, 1.0),
    "eta_3": (-1.0, 1.0),
}
QUANTITIES = ("C_T", "C_L", "C_D", "C_M", "C_N_1", "C_N_2", "C_N_3")


class Free:
    """A mass-normalised mode of a uniform beam that is free at both ends; the nose's deflection is above 0."""

    def __init__(self, number: int, length: float, mass: float) -> None:
        self.length = length
        guess = (number + 0.5) * pi
        self.root = float(brentq(lambda b: cos(b) - 1 / cosh(b), guess - 0.5, guess + 0.5, xtol=1e-15))
        b = self.root
        self.share = (cosh(b) - cos(b)) / (sinh(b) - sin(b))
        square = quad(lambda x: self._raw(x) ** 2, 0, length, epsabs=1e-13, epsrel=1e-13, limit=200)[0]
        self.scale = 1 / sqrt(mass * square)

    def _raw(self, x: float) -> float:
        b = self.root * x / self.length
        return cosh(b) + cos(b) - self.share * (sinh(b) + sin(b))

    def shape(self, x: float) -> float:
        """Return the deflection at x aft of the nose."""
        return self.scale * self._raw(x)

    def nose_up(self) -> float:
        """Return the angle of the nose, by differences of the shape."""
        step = 1e-3

        def slope(h: float) -> float:
            return (self.shape(-h) - self.shape(h)) / (2 * h)

        return (4 * slope(step) - slope(2 * step)) / 3


class FreeVehicle(Vehicle):
    """The vehicle with modes of its whole length, and a canard."""

    def __init__(self, p: dict[str, float]) -> None:
        super().__init__(p)
        self.modes = [Free(number, self.length, p["mu_f"]) for number in (1, 2, 3)]
        self.forced: list[float] = []

    def coefficients(self, point: dict[str, float]) -> list[float]:
        """Return the quantities at a point."""
        p, k = self.p, self.p["kappa"]
        alpha, delta_c = point["alpha"], point["delta_c"]
        nose = sum(mode.nose_up() * point[f"eta_{i}"] for i, mode in enumerate(self.modes, 1))
        clamped = {"eta_1": nose / self.fore.end_slope(), "eta_2": 0.0}
        loads = self.forces({**point, **clamped})
        axial, normal, moment = (sum(loads[:24][part::3]) for part in range(3))
        warm, ambient = self.air(point["altitude"])
        free = Stream(point["velocity"] / sqrt(k * p["R_air"] * warm), 1.0, 1.0)
        up, down = (turned(k, free, sign * (alpha + delta_c)).pressure for sign in (1, -1))
        force = (up - down) * ambient * p["S_c"]
        lift_c, push_c = force * cos(delta_c), -force * sin(delta_c)
        axial, normal = axial + push_c, normal + lift_c
        moment += p["x_c"] * lift_c + p["z_c"] * push_c
        reference = 0.5 * ambient / (p["R_air"] * warm) * point["velocity"] ** 2 * AREA
        thrust = loads[18] + loads[21]
        drag = normal * sin(alpha) - (axial - thrust) * cos(alpha)
        lift = normal * cos(alpha) + (axial - thrust) * sin(alpha)
        place = p["x_cm"] - p["x_c"]
        modal = [
            (forced + lift_c * mode.shape(place)) / reference
            for forced, mode in zip(self.forced, self.modes, strict=True)
        ]
        turn = (moment - THRUST_LINE * thrust) / (reference * CHORD)
        return [float(it) for it in (thrust / reference, lift / reference, drag / reference, turn, *modal)]

    def _generalized(
        self, gauge: list[float], on_ramp: Callable[[float], float], entry: float, delta: float
    ) -> list[float]:
        """Integrate the pressures against the free shapes, too."""
        p = self.p
        start = p["L_f"] + p["L_n"]
        faces = (gauge[3] - gauge[4]) * p["S_e"] * cos(delta)
        self.forced = []
        for mode in self.modes:

            def pushed(x: float, shape: Callable[[float], float] = mode.shape) -> float:
                below = gauge[0] if x < p["L_f"] else gauge[2] if x < start else on_ramp(x)
                return (below - gauge[1]) * shape(x)

            whole = quad(pushed, 0, self.length, points=[p["L_f"], start], epsabs=1e-9, epsrel=1e-12, limit=200)[0]
            points = entry * mode.shape(p["L_f"]) + faces * mode.shape(p["x_cm"] + p["x_e"])
            self.forced.append(float(whole + points))
        return super()._generalized(gauge, on_ramp, entry, delta)


def fit_sample_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    yield f"# ahv reference coefficients from geometry, SciPy, seed {SEED}"
    yield ",".join([*BOX, *QUANTITIES])
    draw = random.Random(SEED)
    vehicle = FreeVehicle(parameters())
    for _ in range(POINTS):
        point = {name: draw.uniform(*bounds) for name, bounds in BOX.items()}
        yield ",".join(repr(float(it)) for it in (*point.values(), *vehicle.coefficients(point)))
