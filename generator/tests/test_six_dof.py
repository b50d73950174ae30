"""Six degrees of freedom: the family of `examples/six-dof` beside the textbook, and physics in free flight."""

from __future__ import annotations

import math
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ahv_generator.reference import columns, expanded, labels
from ahv_generator.table import load
from ahv_oracle.six_dof import CONTROLS, Numbers, Textbook, Vector, along, converted, table_numbers

TABLE = Path(__file__).parents[2] / "examples" / "six-dof" / "six_dof.toml"


class Generated:
    """The family's model, by names, with the numbers of its table; evaluated by CasADi."""

    def __init__(self) -> None:
        table = load(TABLE)
        self.model = table.model("six_dof")
        self.states, self.outputs = self.model.names("state"), self.model.names("output")
        self.inputs = self.model.names("input")
        function, found = expanded(self.model), labels(self.model)
        numbers = table_numbers(TABLE)
        self.parameters = {p.name: numbers[p.path[0]][p.path[1]] for p in table.parameters}
        x, u = ca.SX.sym("x", len(self.states)), ca.SX.sym("u", len(self.inputs))
        p = ca.SX.sym("p", len(self.parameters))
        at = {f"state.{n}": x[i] for i, n in enumerate(self.states)}
        at |= {f"input.{n}": u[i] for i, n in enumerate(self.inputs)}
        at |= {f"parameter.{n}": p[i] for i, n in enumerate(self.parameters)}
        values = dict(zip(found, function.call([at[column] for column in columns(self.model)]), strict=True))
        drift = ca.vertcat(*(values[f"drift.{n}"] for n in self.states))
        slopes = ca.SX(len(self.states), len(self.states))
        for i, row in enumerate(self.states):
            for j, column in enumerate(self.states):
                slopes[i, j] = values.get(f"jacobians.state.{row}.{column}", 0)
        self._drift = ca.Function("drift", [x, u, p], [drift])
        self._slopes = ca.Function("slopes", [x, u, p], [slopes])

    def _at(self, function: ca.Function, x: Vector, inputs: Numbers, changes: Numbers) -> Vector:
        u = [inputs.get(name, 0.0) for name in self.inputs]
        return np.array(function(x, u, list((self.parameters | dict(changes)).values())))

    def drift(self, x: Vector, inputs: Numbers, **changes: float) -> Vector:
        """The rate of every state; parameters may be changed."""
        return self._at(self._drift, x, inputs, changes).ravel()

    def slopes(self, x: Vector, inputs: Numbers) -> Vector:
        """The derivatives of the rates by the states, as the IR has them."""
        return self._at(self._slopes, x, inputs, {})


@pytest.fixture(scope="module")
def generated() -> Generated:
    return Generated()


def random_point(random: np.random.Generator) -> tuple[Vector, dict[str, float]]:
    """A state of the textbook and controls, far from rest, in any attitude."""
    speed, alpha, beta = random.uniform(900, 2100), *random.uniform(-0.15, 0.2, 2)
    velocity = speed * np.array([math.cos(alpha) * math.cos(beta), math.sin(beta), math.sin(alpha) * math.cos(beta)])
    angles = random.uniform([-3.1, -1.4, -3.1], [3.1, 1.4, 3.1])
    place = random.uniform([-1e5, -1e5, 15e3], [1e5, 1e5, 32e3])
    x = np.concatenate([velocity, random.uniform(-0.5, 0.5, 3), angles, place])
    return x, dict(zip(CONTROLS, random.uniform([0, -0.3, -0.3, -0.3], [1, 0.3, 0.3, 0.3]), strict=True))


def test_the_drift_is_that_of_the_textbook_at_random_points(generated: Generated) -> None:
    random, textbook = np.random.default_rng(6), Textbook(TABLE)
    for _ in range(200):
        x, controls = random_point(random)
        expected = along(converted, x, textbook.drift(x, controls))
        found = generated.drift(converted(x), controls)
        scale = np.maximum(1.0, np.abs(expected))
        assert np.max(np.abs(found - expected) / scale) < 1e-11, generated.states


def test_axes_that_turn_take_their_turn_from_position_and_attitude(generated: Generated) -> None:
    random, textbook = np.random.default_rng(7), Textbook(TABLE)
    x, controls = random_point(random)
    turn = 0.03
    rates = textbook.drift(x, controls)
    rates[8] -= turn
    rates[9] += turn * x[10]
    rates[10] -= turn * x[9]
    found = generated.drift(converted(x), {**controls, "turn_rate": turn})
    assert found == pytest.approx(along(converted, x, rates), rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("bank", [0.0, 30.0, -50.0])
def test_a_turn_is_a_state_of_rest_with_the_poles_of_the_textbook(generated: Generated, bank: float) -> None:
    textbook = Textbook(TABLE)
    x, controls, turn = textbook.trim(1500.0, 25000.0, math.radians(bank))
    inputs = {**controls, "turn_rate": turn}
    rates = dict(zip(generated.states, generated.drift(converted(x), inputs), strict=True))
    # Only the position north moves, at the speed.
    assert rates.pop("north") == pytest.approx(1500.0, rel=1e-12)
    assert max(map(abs, rates.values())) < 1e-9, rates

    found = list(np.linalg.eigvals(generated.slopes(converted(x), inputs)))
    for pole in textbook.poles(x, controls, turn):
        nearest = min(found, key=lambda other: abs(other - pole))
        # Heading and position in straight flight are one pole of order two: rounding moves it by its root.
        assert abs(nearest - pole) < (1e-5 if abs(pole) < 1e-9 else 1e-8), (pole, nearest)
        found.remove(nearest)


def test_a_flight_out_of_trim_is_that_of_the_textbook(generated: Generated) -> None:
    textbook = Textbook(TABLE)
    x, controls, _ = textbook.trim(1500.0, 25000.0, math.radians(20))
    x = x + np.array([0, 20, 30, 0.1, 0.02, -0.02, 0.3, 0.05, 0, 0, 0, 0])
    accuracy = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-10}
    expected = solve_ivp(lambda _, x: textbook.drift(x, controls), (0, 20), x, **accuracy).y[:, -1]
    found = solve_ivp(lambda _, x: generated.drift(x, controls), (0, 20), converted(x), **accuracy).y[:, -1]
    expected = converted(expected)
    if np.dot(expected[6:10], found[6:10]) < 0:
        expected[6:10] *= -1  # the same attitude
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-6)


# Physics in free flight: no air.


def flown(generated: Generated, x: Vector, span: float, **changes: float) -> Vector:
    """States at 50 times of a flight without air."""
    accuracy = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-11}
    times = np.linspace(0, span, 50)
    flight = solve_ivp(
        lambda _, x: generated.drift(x, {}, rho_0=0.0, **changes), (0, span), x, t_eval=times, **accuracy
    )
    return np.asarray(flight.y)


def along_the_body(x: Vector) -> tuple[Vector, Vector]:
    """Velocity along the axes of the body, and the rotation from there to north, east, down."""
    speed, alpha, beta = x[:3]
    velocity = speed * np.array([np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)])
    q = x[6:10] / np.linalg.norm(x[6:10])
    crossed = np.array([[0, -q[3], q[2]], [q[3], 0, -q[1]], [-q[2], q[1], 0]])
    return velocity, np.eye(3) + 2 * q[0] * crossed + 2 * crossed @ crossed


@pytest.fixture(scope="module")
def tumbling(generated: Generated) -> Vector:
    start = converted(np.array([300, 40, 60, 0.9, 0.7, -0.5, 0.4, 0.3, 1.0, 0, 0, 20000.0]))
    return flown(generated, start, 3.0)


def test_free_flight_keeps_energy_and_momentum(generated: Generated, tumbling: Vector) -> None:
    g = generated.parameters["g"]
    energy = tumbling[0] ** 2 / 2 + g * tumbling[12]
    assert energy == pytest.approx(energy[0], rel=1e-10)
    over_ground = np.array([(to_earth @ v)[:2] for v, to_earth in map(along_the_body, tumbling.T)])
    assert over_ground == pytest.approx(np.tile(over_ground[0], (50, 1)), abs=1e-6)
    fallen = tumbling[12, -1] - tumbling[12, 0]
    _, to_earth = along_the_body(tumbling[:, 0])
    climb = -(to_earth @ along_the_body(tumbling[:, 0])[0])[2]
    assert fallen == pytest.approx(climb * 3.0 - g * 3.0**2 / 2, abs=1e-5)


def test_a_body_that_tumbles_without_torque_keeps_its_angular_momentum_and_energy(tumbling: Vector) -> None:
    inertia = Textbook(TABLE).inertia
    momenta = np.array([along_the_body(x)[1] @ inertia @ x[3:6] for x in tumbling.T])
    assert momenta == pytest.approx(np.tile(momenta[0], (50, 1)), rel=1e-8)
    energies = np.array([x[3:6] @ inertia @ x[3:6] for x in tumbling.T])
    assert energies == pytest.approx(energies[0], rel=1e-9)
    # It does tumble: the rates along the body are not constant.
    assert np.ptp(tumbling[4]) > 0.05


def test_the_norm_of_the_quaternion_stays_and_returns(generated: Generated, tumbling: Vector) -> None:
    norms = np.linalg.norm(tumbling[6:10], axis=0)
    assert norms == pytest.approx(1.0, abs=1e-9)
    start = tumbling[:, 0].copy()
    start[6:10] *= 1.01
    off = flown(generated, start, 3.0)
    k = generated.parameters["k_norm"]
    # d|q|^2/dt = 2 k |q|^2 (1 - |q|^2), a logistic equation.
    n0, t = 1.01**2, np.linspace(0, 3.0, 50)
    expected = n0 / (n0 + (1 - n0) * np.exp(-2 * k * t))
    assert np.sum(off[6:10] ** 2, axis=0) == pytest.approx(expected, rel=1e-8)
    # What the norm is does not matter to the flight.
    for row in (0, 1, 2, 3, 4, 5, 10, 11, 12):
        assert off[row] == pytest.approx(tumbling[row], rel=1e-7, abs=1e-7)
