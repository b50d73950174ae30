"""Forces of the first-principles model a second time: from the geometry table by SciPy's roots and integrals.

Shares no formula with `ahv-fpm` but those of the model itself (docs/first-principles.md): shocks are roots of the
θ-β-M relation, expansions of the Prandtl-Meyer function, heat and areas of their tables' functions.
Loads are integrals along the surfaces; mode shapes are normalised by integrals.

Line 1 of the vectors is a comment, line 2 names the columns; the last row is the trim at velocity and
altitude of Table 2.
"""

from __future__ import annotations

import random
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import asin, atan, cos, cosh, degrees, exp, log, pi, radians, sin, sinh, sqrt, tan
from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar, root

SEED = 20261130
POINTS = 60
TABLE = Path(__file__).parents[2] / "crates" / "ahv-fpm" / "vehicle.toml"
STATES = ("velocity", "altitude", "alpha", "eta_1", "eta_2")
INPUTS = ("phi", "delta_e")
SURFACES = ("forebody", "upper", "underside", "aftbody", "elevator_lower", "elevator_upper", "inlet", "nozzle")
BOX = {
    "velocity": (7000.0, 11000.0),
    "altitude": (80000.0, 110000.0),
    "alpha": (-0.08, 0.17),
    "eta_1": (-5.0, 5.0),
    "eta_2": (-5.0, 5.0),
    "phi": (0.05, 0.6),
    "delta_e": (-0.3, 0.3),
}
TRIM = {"velocity": 7702.08, "altitude": 85000.0, "alpha": radians(1.5153), "eta_1": 0.0, "eta_2": 0.0}
TRIM |= {"phi": 0.2514, "delta_e": radians(11.4635)}
CLAMPED_ROOT = float(brentq(lambda b: cos(b) + 1 / cosh(b), 1.5, 2.2, xtol=1e-15))


def parameters() -> dict[str, float]:
    """Return the values of the table, angles in rad."""
    sections = tomllib.loads(TABLE.read_text())
    found = {}
    for section in ("vehicle", "geometry", "engine", "structure", "air", "environment"):
        for key, entry in sections[section].items():
            found[key] = radians(entry["value"]) if entry["unit"] == "deg" else entry["value"]
    return found


def first_principles_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    yield f"# ahv reference values of the first-principles model, SciPy, seed {SEED}; lb/ft, lb, (ft*slug)^0.5/s^2"
    loads = [f"{surface}_{part}" for surface in SURFACES for part in ("axial", "normal", "moment")]
    yield ",".join([*STATES, *INPUTS, *loads, "generalized_1", "generalized_2"])
    draw = random.Random(SEED)
    vehicle = Vehicle(parameters())
    points = [TRIM]
    while len(points) < POINTS:
        points.append({name: draw.uniform(*bounds) for name, bounds in BOX.items()})
    points.append(vehicle.steady(TRIM))
    for point in points:
        values = [point[name] for name in (*STATES, *INPUTS)]
        yield ",".join(repr(float(it)) for it in (*values, *vehicle.forces(point)))


@dataclass(frozen=True)
class Stream:
    """A uniform stream: Mach number, and pressure and temperature over those of the air."""

    mach: float
    pressure: float
    temperature: float


def stagnation(k: float, mach: float) -> float:
    """Total over static temperature."""
    return 1 + (k - 1) / 2 * mach * mach


def turned(k: float, stream: Stream, turn: float) -> Stream:
    """Return the stream behind a wall that turns it into itself (shock), or away (expansion)."""
    return shocked(k, stream, turn) if turn >= 0 else expanded(k, stream, -turn)


def shocked(k: float, stream: Stream, turn: float) -> Stream:
    """Behind an oblique shock: a root of the θ-β-M relation below the angle of the greatest turn."""
    mach = stream.mach

    def reached(b: float) -> float:
        n = (mach * sin(b)) ** 2
        return atan(2 / tan(b) * (n - 1) / (mach * mach * (k + cos(2 * b)) + 2))

    low = asin(1 / mach)
    high = minimize_scalar(lambda b: -reached(b), bounds=(low, pi / 2), method="bounded", options={"xatol": 1e-10}).x
    angle = brentq(lambda b: reached(b) - turn, low, high, xtol=1e-15, rtol=1e-15)
    n = (mach * sin(angle)) ** 2
    pressure = 1 + 2 * k / (k + 1) * (n - 1)
    density = (k + 1) * n / ((k - 1) * n + 2)
    behind = sqrt((1 + (k - 1) / 2 * n) / (k * n - (k - 1) / 2)) / sin(angle - turn)
    return Stream(behind, stream.pressure * pressure, stream.temperature * pressure / density)


def prandtl_meyer(k: float, mach: float) -> float:
    """Return the Prandtl-Meyer angle."""
    reach = sqrt((k + 1) / (k - 1))
    y = sqrt(mach * mach - 1)
    return reach * atan(y / reach) - atan(y)


def expanded(k: float, stream: Stream, turn: float) -> Stream:
    """Behind an expansion."""
    target = prandtl_meyer(k, stream.mach) + turn
    behind = brentq(lambda m: prandtl_meyer(k, m) - target, stream.mach, 1e4, xtol=1e-13, rtol=1e-15)
    return isentropic(k, stream, behind)


def isentropic(k: float, stream: Stream, behind: float) -> Stream:
    """Return the stream at another Mach number with the same total state."""
    ratio = stagnation(k, stream.mach) / stagnation(k, behind)
    return Stream(behind, stream.pressure * ratio ** (k / (k - 1)), stream.temperature * ratio)


def widened(k: float, stream: Stream, ratio: float) -> Stream:
    """Behind a duct that ends with `ratio` times its area, supersonic."""
    if ratio == 1:
        return stream

    def area(mach: float) -> float:
        return float((2 / (k + 1) * stagnation(k, mach)) ** ((k + 1) / (k - 1) / 2) / mach)

    target = ratio * area(stream.mach)
    return isentropic(k, stream, brentq(lambda m: area(m) - target, 1.0, 100.0, xtol=1e-13, rtol=1e-15))


def heated(k: float, stream: Stream, heating: float) -> Stream:
    """Behind a combustor that multiplies the total temperature."""

    def total(mach: float) -> float:
        return 2 * (k + 1) * mach**2 * stagnation(k, mach) / (1 + k * mach * mach) ** 2

    target = heating * total(stream.mach)
    behind = brentq(lambda m: total(m) - target, 1.0, stream.mach + 1, xtol=1e-13, rtol=1e-15)
    pressure = (1 + k * stream.mach**2) / (1 + k * behind**2)
    temperature = (pressure * behind / stream.mach) ** 2
    return Stream(behind, stream.pressure * pressure, stream.temperature * temperature)


class Beam:
    """The first mode of a clamped beam, mass-normalised: the shape that solves its boundary conditions at both ends."""

    def __init__(self, length: float, mass: float) -> None:
        self.length, b = length, CLAMPED_ROOT
        self.share: float = (sinh(b) - sin(b)) / (cosh(b) + cos(b))
        square = quad(lambda x: self._raw(x) ** 2, 0, length, epsabs=1e-13, epsrel=1e-13)[0]
        self.scale: float = 1 / sqrt(mass * square)

    def _raw(self, x: float) -> float:
        b = CLAMPED_ROOT * x / self.length
        return cosh(b) - cos(b) - self.share * (sinh(b) - sin(b))

    def shape(self, x: float) -> float:
        """Return the deflection at x from the clamp."""
        return self.scale * self._raw(x)

    def end_slope(self) -> float:
        """Return the slope at the end, by the beam's shape there."""
        b = CLAMPED_ROOT
        return self.scale * b / self.length * (sinh(b) + sin(b) - self.share * (cosh(b) - cos(b)))


class Vehicle:
    """The vehicle of a table."""

    def __init__(self, p: dict[str, float]) -> None:
        self.p = p
        self.length = p["L_f"] + p["L_n"] + p["L_a"]
        self.fore = Beam(p["x_cm"], p["mu_f"])
        self.aft = Beam(self.length - p["x_cm"], p["mu_a"])

    def air(self, altitude: float) -> tuple[float, float]:
        """Return temperature, K, and pressure, lb/ft^2, of the US Standard Atmosphere 1976."""
        p = self.p
        height = p["r_0"] * altitude / (p["r_0"] + altitude)
        temperature, pressure, weight = p["T_0"], p["p_0"], p["g_0"] / p["R_air"]
        floors = [0.0, p["H_1"], p["H_2"], p["H_3"], p["H_4"], 1e9]
        lapses = [p["lapse_0"], 0.0, p["lapse_2"], p["lapse_3"], 0.0]
        for floor, top, lapse in zip(floors, floors[1:], lapses, strict=False):
            rise = min(height, top) - floor
            warmer = temperature + lapse * rise
            pressure *= exp(-weight * rise / temperature) if lapse == 0 else (warmer / temperature) ** (-weight / lapse)
            temperature = warmer
            if height <= top:
                break
        return temperature, pressure

    def forces(self, point: dict[str, float]) -> list[float]:
        """Axial force, normal force and moment of each surface, then the generalized forces."""
        p, k = self.p, self.p["kappa"]
        warm, ambient = self.air(point["altitude"])
        sound = sqrt(k * p["R_air"] * warm)
        alpha, velocity = point["alpha"], point["velocity"]
        free = Stream(velocity / sound, 1.0, 1.0)
        nose = self.fore.end_slope() * point["eta_1"]
        slope = p["tau_l"] + nose
        bow = turned(k, free, slope + alpha)
        gauge = [
            (turned(k, free, turn).pressure - 1) * ambient
            for turn in (
                slope + alpha,
                p["tau_u"] - alpha - nose,
                alpha,
                alpha + point["delta_e"],
                -alpha - point["delta_e"],
            )
        ]
        depth, rise = p["L_f"] * tan(p["tau_l"]), tan(p["tau_u"])
        start = p["L_f"] + p["L_n"]
        ramp = tan(p["tau_t"] + p["tau_u"])
        stream = self._stream(point, free, bow, slope, (warm, ambient, sound))
        ratio = stream["pressure"]

        def on_ramp(x: float) -> float:
            return ambient * (ratio / (1 + (x - start) / p["L_a"] * (ratio - 1)) - 1)

        total = self.length
        loads = [
            self._surface(lambda _: gauge[0], (0, p["L_f"]), lambda x: x * tan(p["tau_l"]), -tan(p["tau_l"]), 1),
            self._surface(lambda _: gauge[1], (0, total), lambda x: -x * rise, -rise, -1),
            self._surface(lambda _: gauge[2], (p["L_f"], start), lambda _: 0.0, 0.0, 1),
            self._surface(on_ramp, (start, total), lambda x: depth - (x - start) * ramp, ramp, 1),
            *(self._face(gauge[3 + face] * (1, -1)[face], point["delta_e"]) for face in (0, 1)),
        ]
        flow, v1 = stream["mass"], stream["inlet"]
        entry = (-flow * v1 * cos(slope) - gauge[0] * p["h_i"], -flow * v1 * sin(slope))
        loads.append((*entry, (p["x_cm"] - p["L_f"]) * entry[1] + (depth + p["h_i"] / 2) * entry[0]))
        thrust = stream["thrust"]
        loads.append((thrust, 0.0, p["z_e"] * thrust))
        generalized = self._generalized(gauge, on_ramp, entry[1], point["delta_e"])
        return [float(it) for load in loads for it in load] + generalized

    def steady(self, start: dict[str, float]) -> dict[str, float]:
        """Return the trim of level flight over a flat Earth at the velocity and altitude of a point."""
        p = self.p
        sought = ("alpha", "phi", "delta_e", "eta_1", "eta_2")
        stiffness = []
        for length, mass, bending in (
            (p["x_cm"], p["mu_f"], p["EI_f"]),
            (self.length - p["x_cm"], p["mu_a"], p["EI_a"]),
        ):
            stiffness.append(CLAMPED_ROOT**4 * bending / mass / length**4)
        weight = p["m"] * p["g"]

        def left(values: list[float]) -> list[float]:
            point = start | dict(zip(sought, values, strict=True))
            *loads, first, second = self.forces(point)
            axial, normal, moment = (sum(loads[part::3]) for part in range(3))
            alpha = point["alpha"]
            return [
                (axial * cos(alpha) - normal * sin(alpha)) / weight,
                (normal * cos(alpha) + axial * sin(alpha)) / weight - 1,
                moment / weight / p["x_cm"],
                (first - stiffness[0] * point["eta_1"]) / stiffness[0],
                (second - stiffness[1] * point["eta_2"]) / stiffness[1],
            ]

        found = root(left, [start[name] for name in sought], tol=1e-13)
        return start | dict(zip(sought, (float(it) for it in found.x), strict=True))

    def _surface(
        self,
        pressure: Callable[[float], float],
        ends: tuple[float, float],
        depth: Callable[[float], float],
        forward: float,
        up: int,
    ) -> tuple[float, float, float]:
        """Integrate a pressure over x aft of the nose: forward and up of a unit of length, and their moment."""

        def integral(of: Callable[[float], float]) -> float:
            return float(quad(of, *ends, epsabs=1e-9, epsrel=1e-12)[0])

        def moment(x: float) -> float:
            return pressure(x) * (up * (self.p["x_cm"] - x) + forward * depth(x))

        return integral(lambda x: forward * pressure(x)), integral(lambda x: up * pressure(x)), integral(moment)

    def _face(self, pressure: float, delta: float) -> tuple[float, float, float]:
        force = pressure * self.p["S_e"]
        axial, normal = -force * sin(delta), force * cos(delta)
        return axial, normal, -self.p["x_e"] * normal + self.p["z_el"] * axial

    def _stream(
        self, point: dict[str, float], free: Stream, bow: Stream, slope: float, air: tuple[float, float, float]
    ) -> dict[str, float]:
        """The engine's stream: mass flow, velocity ahead of the cowl, gross thrust and pressure at the end."""
        p, k = self.p, self.p["kappa"]
        warm, ambient, sound = air
        gas = p["R_air"]

        def density(stream: Stream) -> float:
            return ambient * stream.pressure / (gas * warm * stream.temperature)

        def speed(stream: Stream) -> float:
            return stream.mach * sound * sqrt(stream.temperature)

        lip = p["L_f"] * tan(p["tau_l"]) + p["h_i"]
        # The lip's distance from the streamline through the nose, as the air comes.
        reach = np.hypot(p["L_f"], lip) * sin(np.arctan2(lip, p["L_f"]) + point["alpha"])
        mass = min(density(bow) * speed(bow) * p["h_i"] * cos(slope), density(free) * speed(free) * reach)
        cowl = turned(k, bow, slope)
        height = mass / (density(cowl) * speed(cowl))
        diffused = widened(k, cowl, p["A_d"])
        total = warm * cowl.temperature * stagnation(k, cowl.mach)
        fuel = p["f_st"] * point["phi"]
        heat = k * gas / (k - 1)
        burnt_total = (heat * total + p["eta_c"] * fuel * p["H_f"]) / ((1 + fuel) * heat)
        burnt = heated(k, diffused, burnt_total / total)
        # Heat alone: the temperature behind it is that of the total one.
        leaves = widened(k, burnt, p["A_n"])
        velocity = leaves.mach * sqrt(k * gas * burnt_total / stagnation(k, leaves.mach))
        area = height * p["A_d"] * p["A_n"]
        thrust = mass * (1 + fuel) * velocity + (leaves.pressure - 1) * ambient * area
        return {"mass": mass, "inlet": speed(bow), "thrust": thrust, "pressure": leaves.pressure}

    def _generalized(
        self, gauge: list[float], on_ramp: Callable[[float], float], entry: float, delta: float
    ) -> list[float]:
        """Integrate the pressures against the shapes; entry is the force at the inlet."""
        p, middle = self.p, self.p["x_cm"]
        start = p["L_f"] + p["L_n"]

        def on_fore(x: float) -> float:
            below = gauge[0] if x < p["L_f"] else gauge[2]
            return (below - gauge[1]) * self.fore.shape(middle - x)

        def on_aft(x: float) -> float:
            below = gauge[2] if x < start else on_ramp(x)
            return (below - gauge[1]) * self.aft.shape(x - middle)

        first = quad(on_fore, 0, middle, points=[p["L_f"]], epsabs=1e-10, epsrel=1e-12)[0]
        second = quad(on_aft, middle, self.length, points=[start], epsabs=1e-10, epsrel=1e-12)[0]
        faces = (gauge[3] - gauge[4]) * p["S_e"] * cos(delta) * self.aft.shape(p["x_e"])
        inlet = entry * self.fore.shape(middle - p["L_f"])
        return [float(first + inlet), float(second + faces)]


def main() -> None:
    """Print the loads at the trim of Table 2, for people."""
    vehicle = Vehicle(parameters())
    found = vehicle.forces(TRIM)
    print(f"alpha {degrees(TRIM['alpha']):.4f} deg, ln of pressure {log(vehicle.air(TRIM['altitude'])[1]):.6f}")
    for index, surface in enumerate(SURFACES):
        axial, normal, moment = found[3 * index : 3 * index + 3]
        print(f"{surface:16s} {axial:12.2f} {normal:12.2f} {moment:14.2f}")
    print(found[-2:])


if __name__ == "__main__":
    main()
