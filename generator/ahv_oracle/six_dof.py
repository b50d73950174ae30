"""A rigid vehicle with six degrees of freedom as a textbook has it, beside the family of `examples/six-dof`.

Velocities along the body, Euler angles, axes that are fixed to the Earth; the equations are m (dv/dt + w x v) = F and
dh/dt + w x h = M with the whole tensor of inertia. The numbers are those of the example's table. Functions take complex
numbers as well, so that `along` differentiates by a complex step, without cancellation.
"""

import tomllib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import eigvals
from scipy.optimize import root

Vector = NDArray[Any]
Numbers = Mapping[str, float]
CONTROLS = ("throttle", "delta_e", "delta_a", "delta_r")
STATES = (
    *("velocity", "alpha", "beta", "roll_rate", "pitch_rate", "yaw_rate"),
    *("q_0", "q_1", "q_2", "q_3", "north", "east", "altitude"),
)
"""The states of the family, in the order of `converted`."""

BANKS = (0, 30, -50)
"""Bank angles of the trims, in deg."""

END, STEP = 1.0, 0.001
"""Duration and step of a flight, in s."""


def table_numbers(table: Path) -> dict[str, dict[str, float]]:
    """Values of a table, section by section."""
    document = tomllib.loads(table.read_text(encoding="utf-8"))
    sections = {k: v for k, v in document.items() if k not in ("table", "sources", "validity")}
    return {name: {k: float(e["value"]) for k, e in entries.items()} for name, entries in sections.items()}


def polynomial(terms: Numbers, values: Mapping[str, complex]) -> complex:
    """The sum of coefficients times monomials such as `alpha*mach^2`."""
    total: complex = 0.0
    for monomial, coefficient in terms.items():
        product: complex = coefficient
        for factor in () if monomial == "1" else monomial.split("*"):
            name, _, power = factor.partition("^")
            product = product * values[name] ** int(power or 1)
        total = total + product
    return total


def to_body(roll: complex, pitch: complex, yaw: complex) -> Vector:
    """From north, east, down to the body: yaw, then pitch, then roll."""
    cr, sr, cp, sp, cy, sy = (f(x) for x in (roll, pitch, yaw) for f in (np.cos, np.sin))
    about_x = np.array([[1, 0, 0], [0, cr, sr], [0, -sr, cr]])
    about_y = np.array([[cp, 0, -sp], [0, 1, 0], [sp, 0, cp]])
    about_z = np.array([[cy, sy, 0], [-sy, cy, 0], [0, 0, 1]])
    return np.asarray(about_x @ about_y @ about_z)


def quaternion(roll: complex, pitch: complex, yaw: complex) -> Vector:
    """The same rotation as a quaternion, by half angles."""
    cr, sr, cp, sp, cy, sy = (f(x / 2) for x in (roll, pitch, yaw) for f in (np.cos, np.sin))
    return np.array(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    )


class Textbook:
    """The vehicle in velocities along the body and Euler angles."""

    def __init__(self, table: Path) -> None:
        self.table = table_numbers(table)
        self.numbers = self.table["vehicle"] | self.table["environment"]
        n = self.numbers
        xz = n["I_xz"]
        self.inertia = np.array([[n["I_xx"], 0, -xz], [0, n["I_yy"], 0], [-xz, 0, n["I_zz"]]])

    def loads(self, x: Vector, controls: Numbers) -> tuple[Vector, Vector]:
        """Force and moment of air and engine, along the axes of the body."""
        n, (u, v, w), rates = self.numbers, x[:3], x[3:6]
        speed = np.sqrt(u * u + v * v + w * w)
        alpha, beta = np.arctan(w / u), np.arcsin(v / speed)
        scale = np.array([n["b"], n["c_bar"], n["b"]]) / (2 * speed)
        values = dict(controls) | {"alpha": alpha, "beta": beta, "mach": speed / n["a"]}
        values |= dict(zip(("p_hat", "q_hat", "r_hat"), rates * scale, strict=True))
        c = {name: polynomial(terms, values) for name, terms in self.table.items() if name.startswith("C_")}
        pressure = n["rho_0"] * np.exp(-x[11] / n["h_s"]) * speed**2 / 2 * n["S"]
        stability = np.array([[np.cos(alpha), 0, -np.sin(alpha)], [0, 1, 0], [np.sin(alpha), 0, np.cos(alpha)]])
        air = stability @ (pressure * np.array([-c["C_D"], c["C_Y"], -c["C_L"]]))
        moment = pressure * np.array([n["b"] * c["C_R"], n["c_bar"] * c["C_M"], n["b"] * c["C_N"]])
        lever = np.array([n["x_cg"], 0.0, 0.0])
        return air + np.array([pressure * c["C_T"], 0, 0]), moment + np.cross(lever, air)

    def drift(self, x: Vector, controls: Numbers) -> Vector:
        """The rate of every state of the textbook."""
        force, moment = self.loads(x, controls)
        velocity, rates, (roll, pitch, yaw) = x[:3], x[3:6], x[6:9]
        turn = to_body(roll, pitch, yaw)
        weight = turn @ np.array([0, 0, self.numbers["g"]])
        accelerations = force / self.numbers["m"] + weight - np.cross(rates, velocity)
        rotation = np.linalg.solve(self.inertia, moment - np.cross(rates, self.inertia @ rates))
        p, q, r = rates
        across = q * np.sin(roll) + r * np.cos(roll)
        euler = [p + across * np.tan(pitch), q * np.cos(roll) - r * np.sin(roll), across / np.cos(pitch)]
        moved = turn.T @ velocity
        return np.concatenate([accelerations, rotation, euler, moved[:2], -moved[2:]])

    def trim(self, speed: float, altitude: float, bank: float) -> tuple[Vector, dict[str, float], float]:
        """A level turn without sideslip at this bank angle: its state, its controls and its turn rate."""

        def point(unknowns: Vector) -> tuple[Vector, dict[str, float]]:
            alpha, pitch, turn = unknowns[:3]
            rates = turn * to_body(bank, pitch, 0.0) @ np.array([0, 0, 1])
            velocity = speed * np.array([np.cos(alpha), 0, np.sin(alpha)])
            # Like the family's trim it flies north.
            along = to_body(bank, pitch, 0.0).T @ velocity
            yaw = -np.arctan(along[1] / along[0])
            state = np.concatenate([velocity, rates, [bank, pitch, yaw, 0, 0, altitude]])
            return state, dict(zip(CONTROLS, unknowns[3:], strict=True))

        def residual(unknowns: Vector) -> Vector:
            rates = self.drift(*point(unknowns))
            return np.append(rates[:6], rates[11] / speed)

        guess = [0.06, 0.06, 9.8 * np.tan(bank) / speed, 0.3, 0.0, 0.0, 0.0]
        found = root(residual, guess, tol=1e-13)
        if not np.max(np.abs(residual(found.x))) < 1e-9:
            raise ValueError(f"no trim: {found.message}")
        unknowns = found.x
        for _ in range(3):
            unknowns = unknowns - np.linalg.solve(slopes(residual, unknowns), residual(unknowns))
        return (*point(unknowns), float(unknowns[2]))

    def poles(self, x: Vector, controls: Numbers, turn: float) -> list[complex]:
        """The eigenvalues about a trim, in axes that turn with it."""

        def short(y: Vector) -> Vector:
            """Without heading and position, on which nothing depends."""
            whole = np.concatenate([y[:8], [x[8], 0.0, 0.0], y[8:]])
            return self.drift(whole, controls)[[*range(8), 11]]

        found = eigvals(slopes(short, np.concatenate([x[:8], x[11:]])))
        # The norm of a quaternion returns at 2 k; the heading rests; the position turns with the axes.
        return [*map(complex, found), complex(-2 * self.table["kinematics"]["k_norm"]), 0j, 1j * turn, -1j * turn]


def converted(x: Vector) -> Vector:
    """The state of the textbook as that of the family: V alpha beta, rates, quaternion, position."""
    u, v, w = x[:3]
    speed = np.sqrt(u * u + v * v + w * w)
    angles = [np.arctan(w / u), np.arcsin(v / speed)]
    return np.concatenate([[speed, *angles], x[3:6], quaternion(*x[6:9]), x[9:]])


def along(function: Callable[[Vector], Vector], x: Vector, direction: Vector) -> Vector:
    """The derivative of a function along a direction, by a complex step: no difference is taken."""
    step = 1e-30
    return np.asarray(np.imag(function(x + 1j * step * direction)) / step)


def slopes(function: Callable[[Vector], Vector], x: Vector) -> Vector:
    """The Jacobian, by complex steps."""
    return np.column_stack([along(function, x, unit) for unit in np.eye(len(x))])


def questions(table: Path) -> Iterator[tuple[str, dict[str, object]]]:
    """What a program over the family must answer: arguments, and values by JSON pointer."""
    textbook = Textbook(table)
    for bank in BANKS:
        x, controls, turn = textbook.trim(1500.0, 25000.0, np.radians(bank))
        state = dict(zip(STATES, map(float, converted(x)), strict=True))
        inputs = {name: float(value) for name, value in controls.items()} | {"turn_rate": turn}
        answers: dict[str, object] = {f"/state/{name}": value for name, value in state.items()}
        answers |= {f"/input/{name}": value for name, value in inputs.items()}
        answers |= {"/outputs/bank": float(x[6]), "/outputs/pitch": float(x[7]), "/outputs/heading": float(x[8])}
        yield f"trim --bank {bank}", answers
        yield f"poles --bank {bank}", {"/poles": [[p.real, p.imag] for p in textbook.poles(x, controls, turn)]}
    # Off the last trim, over an Earth that does not turn.
    state |= {"alpha": state["alpha"] + 0.01, "beta": 0.01, "roll_rate": 0.05}
    speed, alpha, beta = state["velocity"], state["alpha"], state["beta"]
    velocity = [np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)]
    start = np.concatenate([speed * np.array(velocity), [0.05], x[4:]])
    accuracy = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-13}
    end = converted(solve_ivp(lambda _, x: textbook.drift(x, controls), (0.0, END), start, **accuracy).y[:, -1])
    arguments = f"simulate --bank {BANKS[-1]} --input turn_rate=0rad/s --t-end {END} --dt {STEP} --out flight.csv"
    arguments += f" --initial alpha={alpha!r}rad,beta={beta!r}rad,roll_rate=0.05rad/s"
    yield arguments, {f"/final_state/{name}": float(value) for name, value in zip(STATES, end, strict=True)}
