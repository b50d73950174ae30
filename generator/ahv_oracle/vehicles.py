"""Published vehicles, written from their publications in NumPy: no number is read from a table.

Functions take complex numbers as well, so that `Vehicle.system` differentiates by complex steps, without cancellation.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy
import scipy.optimize
from numpy import cos, exp, sin
from numpy.typing import NDArray

Number = complex | float | numpy.complex128 | numpy.float64
Values = Mapping[str, Number]
Vector = NDArray[numpy.float64]
Drift = Callable[[Values], dict[str, Number]]

RIGID = ("velocity", "altitude", "gamma", "alpha", "pitch_rate")
STEP = 1e-100
"""Size of an imaginary step: its square is nothing beside 1."""


@dataclass(frozen=True)
class Vehicle:
    """Names of states and inputs, the drift, and the trim problem; what is neither given nor sought is 0."""

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    drift: Drift
    given: Mapping[str, float]
    sought: Mapping[str, float]
    rows: tuple[str, ...]
    names: tuple[str, ...] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", self.states + self.inputs)

    def rates(self, point: NDArray[numpy.complex128] | Vector) -> NDArray[numpy.complex128]:
        """The drift by position, at states and inputs in their order."""
        found = self.drift(dict(zip(self.names, point, strict=True)))
        return numpy.array([found[state] for state in self.states], dtype=complex)

    def slopes(self, point: Vector) -> Vector:
        """The derivatives of the drift by states and inputs."""
        columns = []
        for i in range(len(point)):
            moved = point.astype(complex)
            moved[i] += STEP * 1j
            columns.append(self.rates(moved).imag / STEP)
        return numpy.array(columns).T

    def trim(self) -> Vector:
        """States and inputs where the rows vanish, to rounding."""
        unknown = [self.names.index(name) for name in self.sought]
        rows = [self.states.index(name) for name in self.rows]
        point = numpy.array([{**self.given, **self.sought}.get(name, 0.0) for name in self.names])

        def residual(values: Vector) -> Vector:
            point[unknown] = values
            return self.rates(point).real[rows]

        found = scipy.optimize.root(residual, point[unknown], options={"xtol": 1e-12})
        if not found.success:
            raise ValueError(f"no trim: {found.message}")
        point[unknown] = found.x
        for _ in range(3):
            slopes = self.slopes(point)[numpy.ix_(rows, unknown)]
            point[unknown] -= numpy.linalg.solve(slopes, self.rates(point).real[rows])
        return point

    def system(self, point: Vector) -> tuple[Vector, Vector]:
        """A and B of the linear system."""
        slopes = self.slopes(point)
        return slopes[:, : len(self.states)], slopes[:, len(self.states) :]


@dataclass(frozen=True)
class Coefficients:
    """Coefficients of a winged cone at a point."""

    lift: Number
    drag: Number
    thrust: Number
    moment: Number


def winged_cone_coefficients(x: Values) -> Coefficients:
    """Those of Xu, Mirmirani and Ioannou (2004)."""
    alpha, beta = x["alpha"], x["beta"]
    damping = 80.0 / (2 * x["velocity"]) * x["pitch_rate"] * (-6.796 * alpha**2 + 0.3015 * alpha - 0.2289)
    return Coefficients(
        lift=0.6203 * alpha,
        drag=0.6450 * alpha**2 + 0.0043378 * alpha + 0.003772,
        thrust=0.02576 * beta if beta.real < 1 else 0.0224 + 0.00336 * beta,
        moment=-0.035 * alpha**2 + 0.036617 * alpha + 5.3261e-6 + damping + 0.0292 * (x["delta_e"] - alpha),
    )


def wang_stengel_coefficients(x: Values, *, elevator_lift: bool) -> Coefficients:
    """Those of Wang and Stengel (2000), with or without the elevator's lift of a later study."""
    alpha, elevator, h = x["alpha"], x["delta_e"], x["altitude"]
    mach = x["velocity"] / (8.99e-9 * h**2 - 9.16e-4 * h + 996)
    lift = alpha * (0.493 + 1.91 / mach)
    if elevator_lift:
        slope = -0.235580737050513 * alpha**2 - 0.00451812931308866 * alpha - 0.0291335007132150
        lift = lift + slope * elevator
    damping = 80.0 / (2 * x["velocity"]) * x["pitch_rate"] * (-0.025 * mach + 1.37)
    damping = damping * (-6.83 * alpha**2 + 0.303 * alpha - 0.23)
    still = 1e-4 * (0.06 - exp(-mach / 3)) * (-6565 * alpha**2 + 6875 * alpha + 1)
    beta = x["beta"]
    by_mach = 0.0105 * (1 + 17 / mach)
    return Coefficients(
        lift=lift,
        drag=0.0082 * (171 * alpha**2 + 1.15 * alpha + 1) * (0.0012 * mach**2 - 0.054 * mach + 1),
        thrust=by_mach * 1.15 * beta if beta.real < 1 else by_mach * (1 + 0.15 * beta),
        moment=still + damping + 0.0292 * (elevator - alpha),
    )


def winged_cone(coefficients: Callable[[Values], Coefficients]) -> Vehicle:
    """A winged cone over a spherical Earth, with an engine of second order."""

    def drift(x: Values) -> dict[str, Number]:
        V, h, gamma, alpha = (x[name] for name in RIGID[:4])
        c = coefficients(x)
        r = 20903500.0 + h
        g = 1.39e16 / r**2
        force = 0.5 * 0.00238 * exp(-h / 24000.0) * V**2 * 3603.0
        lift, drag, thrust = force * c.lift, force * c.drag, force * c.thrust
        turn = (lift + thrust * sin(alpha)) / (9375.0 * V) - (g - V**2 / r) * cos(gamma) / V
        return {
            "velocity": (thrust * cos(alpha) - drag) / 9375.0 - g * sin(gamma),
            "altitude": V * sin(gamma),
            "gamma": turn,
            "alpha": x["pitch_rate"] - turn,
            "pitch_rate": force * 80.0 * c.moment / 7e6,
            "beta": x["beta_rate"],
            "beta_rate": 25.0 * (x["beta_command"] - x["beta"]) - 2 * 0.7 * 5.0 * x["beta_rate"],
        }

    return Vehicle(
        states=(*RIGID, "beta", "beta_rate"),
        inputs=("beta_command", "delta_e"),
        drift=drift,
        given={"velocity": 15060.0, "altitude": 110000.0},
        sought={"alpha": 0.03, "beta": 0.2, "beta_command": 0.2, "delta_e": 0.0},
        rows=("velocity", "gamma", "pitch_rate", "beta_rate"),
    )


def parker_canard() -> Vehicle:
    """The rigid vehicle of Parker et al. (2007), per foot of width, with the canard of a later study."""

    def drift(x: Values) -> dict[str, Number]:
        V, h, gamma, alpha, _ = (x[name] for name in RIGID)
        phi, elevator, canard = x["phi"], x["delta_e"], x["delta_c"]
        force = 0.5 * 6.7429e-5 * exp((85000.0 - h) / 21358.0) * V**2 * 17.0
        per_phi = -3.7693e5 * alpha**3 + 2.6814e4 * alpha**2 + 3.5542e4 * alpha + 6378.5
        thrust = per_phi * phi - 3.7225e4 * alpha**3 - 1.7277e4 * alpha**2 - 2421.6 * alpha - 100.9
        lift = force * (4.6773 * alpha + 0.76224 * elevator + 0.76224 * canard - 0.018714)
        drag = 5.8224 * alpha**2 - 0.045315 * alpha + 0.010131
        for deflection in (elevator, canard):
            drag = drag + 0.81993 * deflection**2 + 2.7699e-4 * deflection
        c_m = 6.2926 * alpha**2 + 2.1335 * alpha + 0.18979 - 1.2897 * elevator + 1.93455 * canard
        turn = (lift + thrust * sin(alpha)) / (300.0 * V) - 32.17405 / V * cos(gamma)
        return {
            "velocity": (thrust * cos(alpha) - force * drag) / 300.0 - 32.17405 * sin(gamma),
            "altitude": V * sin(gamma),
            "gamma": turn,
            "alpha": x["pitch_rate"] - turn,
            "pitch_rate": (8.36 * thrust + force * 17.0 * c_m) / 5e5,
        }

    return Vehicle(
        states=RIGID,
        inputs=("phi", "delta_e", "delta_c"),
        drift=drift,
        given={"velocity": 7702.0808, "altitude": 85000.0},
        sought={"alpha": 0.02, "phi": 0.25, "delta_e": 0.2},
        rows=("velocity", "gamma", "pitch_rate"),
    )


PUBLISHED: dict[str, Vehicle] = {
    "winged_cone": winged_cone(winged_cone_coefficients),
    "wang_stengel": winged_cone(lambda x: wang_stengel_coefficients(x, elevator_lift=False)),
    "wang_stengel, elevator lifts": winged_cone(lambda x: wang_stengel_coefficients(x, elevator_lift=True)),
    "parker_canard": parker_canard(),
}
