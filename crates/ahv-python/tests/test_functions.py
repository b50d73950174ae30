"""Functions of whole arrays against closed forms, differences and expressions written here."""

import threading

import casadi as ca
import numpy as np
import pytest
from scipy.optimize._numdiff import approx_derivative

import ahv

MODELS = tuple(ahv.models())


def points(model: ahv.Model, count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Points of the validity box."""
    random = np.random.default_rng(seed)
    ends = [np.array(list(bounds.values())) for bounds in (model.state_bounds, model.input_bounds)]
    x, u = (random.uniform(low, high, (count, len(low))) for low, high in (it.T for it in ends))
    return x, u


def test_a_flexible_mode_in_closed_form():
    model = ahv.flexible_mode
    p = model.parameters
    x, u = points(model, 100)
    eta, eta_dot, chi = x.T
    decay = p.zeta * p.omega
    expected = np.stack([eta_dot, -2 * p.zeta * p.omega * eta_dot - p.omega**2 * eta + u[:, 0], -decay * chi], axis=1)
    np.testing.assert_allclose(model.drift(x, u), expected, rtol=1e-13, atol=1e-9)
    diffusion = model.diffusion(x[0], u[0])
    np.testing.assert_allclose(diffusion[:, 0], [0.0, p.sigma, p.zeta * p.sigma / p.omega], rtol=1e-14)


def test_rigid_flight_by_an_expression_of_casadi():
    """Equations (1) of the paper, written here, with the forces that the model tells."""
    model = ahv.com_rigid
    names = ("thrust", "lift", "drag", "pitching_moment")
    state, force, p = ca.SX.sym("x", 5), ca.SX.sym("f", 4), ca.SX.sym("p", 3)
    velocity, _, gamma, alpha, rate = ca.vertsplit(state)
    thrust, lift, drag, moment = ca.vertsplit(force)
    mass, inertia, gravity = ca.vertsplit(p)
    turn = (lift + thrust * ca.sin(alpha)) / (mass * velocity) - gravity * ca.cos(gamma) / velocity
    own = ca.Function(
        "own",
        [state, force, p],
        [
            ca.vertcat(
                (thrust * ca.cos(alpha) - drag) / mass - gravity * ca.sin(gamma),
                velocity * ca.sin(gamma),
                turn,
                rate - turn,
                moment / inertia,
            )
        ],
    )
    x, u = points(model, 200)
    seen = model.output(x, u)
    forces = np.stack([seen[:, model.outputs.index(name)] for name in names])
    numbers = [model.parameters[name] for name in ("m", "i_yy", "g")]
    expected = np.array(own.map(len(x))(x.T, forces, np.array([numbers] * len(x)).T)).T
    np.testing.assert_allclose(model.drift(x, u), expected, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("name", MODELS)
def test_jacobians_are_slopes(name):
    model = ahv.model(name)
    (x,), (u,) = points(model, 1, seed=3)
    by_state, by_input = model.jacobians(x, u)
    scale = np.maximum(np.abs(x), 1e-2)
    slopes = approx_derivative(lambda z: model.drift(z * scale, u), x / scale, method="3-point")
    np.testing.assert_allclose(by_state * scale, slopes, rtol=1e-6, atol=1e-6 * np.abs(slopes).max())
    slopes = approx_derivative(lambda v: model.drift(x, v), u, method="3-point")
    np.testing.assert_allclose(by_input, slopes, rtol=1e-6, atol=1e-6 * np.abs(slopes).max())
    p = model.parameters.values
    scale = np.maximum(np.abs(p), 1e-6)
    slopes = approx_derivative(lambda q: model.drift(x, u, q * scale), p / scale, method="3-point")
    by_parameters = model.parameter_jacobian(x, u) * scale
    np.testing.assert_allclose(by_parameters, slopes, rtol=1e-5, atol=1e-6 * np.abs(slopes).max())


@pytest.mark.parametrize("name", MODELS)
def test_rows_have_the_bits_of_single_points(name):
    model = ahv.model(name)
    x, u = points(model, 37, seed=1)
    # Where no lane has a result, a single point has.
    x[5] *= 40.0
    together = model.drift(x, u)
    alone = np.array([model.drift(one, other) for one, other in zip(x, u, strict=True)])
    np.testing.assert_array_equal(together, alone)
    own = np.broadcast_to(model.parameters.values, (37, len(model.parameters)))
    np.testing.assert_array_equal(model.drift(x, u, own), alone)


def test_leading_dimensions_are_broadcast():
    model = ahv.sdcom
    x, u = points(model, 12)
    grid = model.drift(x.reshape(3, 4, -1), u[0])
    assert grid.shape == (3, 4, 8)
    np.testing.assert_array_equal(grid.reshape(12, 8), model.drift(x, np.broadcast_to(u[0], u.shape)))
    both = model.drift(x[:, None, :], u[None, :5, :])
    assert both.shape == (12, 5, 8)
    np.testing.assert_array_equal(both[7, 3], model.drift(x[7], u[3]))
    assert model.drift(np.empty((0, 8)), u[0]).shape == (0, 8)
    assert model.diffusion(x, u).shape == (12, 8, 6)
    by_state, by_input = model.jacobians(x.reshape(2, 6, 8), u.reshape(2, 6, 3))
    assert (by_state.shape, by_input.shape) == ((2, 6, 8, 8), (2, 6, 8, 3))
    assert ahv.com.diffusion([1.0] * 9, [0.0, 0.0]).shape == (9, 0)


def test_parameters_of_ones_own():
    model = ahv.dcom
    x, u = (rows[0] for rows in points(model, 1))
    heavier = model.parameters.replace(m=1.5 * model.parameters.m)
    assert model.drift(x, u, heavier)[0] != model.drift(x, u)[0]
    names = ("m", "i_yy")
    halved = np.stack([model.parameters.values, model.parameters.replace(**dict.fromkeys(names, 7.0)).values])
    np.testing.assert_array_equal(model.drift(x, u, halved)[0], model.drift(x, u))


def test_results_are_written_where_it_is_asked():
    model = ahv.dcom
    x, u = points(model, 10)
    out = np.empty((10, 11))
    assert model.drift(x, u, out=out) is out
    np.testing.assert_array_equal(out, model.drift(x, u))
    np.testing.assert_array_equal(model.drift(x[::2], u[::2]), out[::2])
    np.testing.assert_allclose(model.drift(x.astype(np.float32), u), out, rtol=1e-3, atol=10.0)


def test_vectors_by_name():
    model = ahv.sdcom
    trim = model.trim()
    named = model.drift(dict(trim.state), dict(trim.input))
    np.testing.assert_array_equal(named, model.drift(trim.state, trim.input))
    assert trim.state["alpha"] == trim.state.alpha
    assert np.abs(named[[0, 2, 4]]).max() < 1e-9


def test_python_goes_on_meanwhile():
    x, u = points(ahv.dcom, 100_000)
    ended, turns = threading.Event(), []

    def count():
        while not ended.is_set():
            turns.append(None)
            ended.wait(1e-4)

    beside = threading.Thread(target=count)
    beside.start()
    for _ in range(5):
        ahv.dcom.jacobians(x[:10_000], u[:10_000])
        ahv.dcom.drift(x, u)
    ended.set()
    beside.join()
    assert len(turns) > 5
