"""Models as functions of CasADi, beside those that are compiled; an optimisation and a predictive controller."""

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ahv
from test_functions import points

MODELS = tuple(ahv.models())


@pytest.mark.parametrize("name", MODELS)
def test_all_results_to_rounding(name):
    model = ahv.model(name)
    function = model.casadi()
    assert function.name_in() == ["x", "u"]
    for x, u in zip(*points(model, 20, seed=2), strict=True):
        found = {key: np.array(value) for key, value in function(x=x, u=u).items()}
        by_state, by_input = model.jacobians(x, u)
        compiled = {
            "drift": model.drift(x, u)[:, None],
            "state_jacobian": by_state,
            "input_jacobian": by_input,
            "outputs": model.output(x, u)[:, None],
            "diffusion": model.diffusion(x, u),
        }
        assert set(found) <= set(compiled)
        for key, value in found.items():
            # Terms cancel: rounding is that of the largest entry of a row.
            scale = np.abs(compiled[key]).max(axis=-1, keepdims=True)
            np.testing.assert_allclose(value, compiled[key], rtol=1e-9, atol=1e-9 * scale.max(), err_msg=key)


def test_derivatives_of_casadi_are_the_generated_ones():
    model = ahv.sdcom
    x, u = ca.MX.sym("x", 8), ca.MX.sym("u", 3)
    drift = model.casadi("drift")
    slopes = ca.Function("slopes", [x, u], [ca.jacobian(drift(x, u), x), ca.jacobian(drift(x, u), u)])
    (at,), (held,) = points(model, 1, seed=7)
    for own, theirs in zip(slopes(at, held), model.jacobians(at, held), strict=True):
        np.testing.assert_allclose(np.array(own), theirs, rtol=1e-10, atol=1e-12 * np.abs(theirs).max())


def test_parameters_as_an_argument():
    model = ahv.dcom
    function = model.casadi("parameter_jacobian", parameters=True)
    (x,), (u,) = points(model, 1)
    p = model.parameters.replace(m=200.0).values
    found = np.array(function(x, u, p))
    np.testing.assert_allclose(found, model.parameter_jacobian(x, u, p), rtol=1e-9, atol=1e-9)


def rk4(drift, x, u, dt):
    """A step of the classical method."""
    one = drift(x, u)
    two = drift(x + dt / 2 * one, u)
    three = drift(x + dt / 2 * two, u)
    return x + dt / 6 * (one + 2 * two + 2 * three + drift(x + dt * three, u))


def test_least_time_to_climb_and_accelerate():
    """The DCOM to 30 ft/s more and 60 ft higher in the least time, by multiple shooting.

    SciPy flies pieces of what was found, on the compiled model, and comes to the same places.
    """
    model = ahv.dcom
    start = model.trim(velocity=7700.0, altitude=85_000.0)
    end = model.trim(velocity=7730.0, altitude=85_060.0)
    steps, drift = 80, model.casadi("drift")
    size = np.array([10.0, 100.0, 0.01, 0.02, 0.05, 0.5, 5.0, 0.1, 2.0, 0.1, 4.0])
    opti = ca.Opti()
    time, z, u = opti.variable(), opti.variable(11, steps + 1), opti.variable(2, steps)
    x = [start.state.values + size * z[:, k] for k in range(steps + 1)]
    for k in range(steps):
        # Five steps each: the third flexible mode turns at 95 rad/s.
        held, reached = ca.vertcat(u[:, k], 0.0), x[k]
        for _ in range(5):
            reached = rk4(drift, reached, held, time / steps / 5)
        opti.subject_to((reached - x[k + 1]) / size == 0)
    opti.subject_to(z[:, 0] == 0)
    opti.subject_to(z[:, -1] == (end.state.values - start.state.values) / size)
    for row, name in enumerate(("phi", "delta_e")):
        opti.subject_to(opti.bounded(model.input_bounds[name][0], u[row, :], model.input_bounds[name][1]))
    alpha = model.state_bounds["alpha"]
    opti.subject_to(opti.bounded(alpha[0], start.state.alpha + size[3] * z[3, :], alpha[1]))
    opti.subject_to(opti.bounded(1.0, time, 10.0))
    # Inputs that do not chatter.
    opti.minimize(time + 0.1 * ca.sumsqr(u[:, 1:] - u[:, :-1]))
    share = np.linspace(0.0, 1.0, steps + 1)
    opti.set_initial(z, np.outer((end.state.values - start.state.values) / size, share))
    opti.set_initial(u, np.outer(start.input.values[:2], 1 - share[1:]) + np.outer(end.input.values[:2], share[1:]))
    opti.set_initial(time, 4.0)
    opti.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes", "max_iter": 1000})
    found = opti.solve()
    assert found.stats()["success"]
    least, held = float(found.value(time)), found.value(u)
    places = start.state.values + (size[:, None] * found.value(z)).T
    # Full thrust alone would need longer than this for the energy.
    excess = model.drift(start.state, [model.input_bounds["phi"][1], start.input.delta_e, 0.0])[0]
    assert 30.0 / excess < least < 8.0
    for k in range(0, steps, 10):
        flown = fly(model, places[k], [*held[:, k], 0.0], least / steps)
        np.testing.assert_allclose(flown / size, places[k + 1] / size, atol=5e-3)


def fly(model, x, u, dt):
    """The compiled model, by SciPy."""
    flown = solve_ivp(lambda _, it: model.drift(it, u), (0.0, dt), x, method="DOP853", rtol=1e-10, atol=1e-10)
    return flown.y[:, -1]


def test_a_predictive_controller_holds_the_unstable_vehicle():
    """A nonlinear MPC step by step on the rigid COM: off its trim by 1 deg, it comes back; without, it diverges."""
    model = ahv.com_rigid
    trim = model.trim()
    size = np.array([10.0, 100.0, 0.01, 0.02, 0.05])
    steps, dt = 20, 0.1
    drift = model.casadi("drift")
    opti = ca.Opti()
    z, v, first = opti.variable(5, steps + 1), opti.variable(2, steps), opti.parameter(5)
    box = np.array(list(model.input_bounds.values()))

    def rate(at, u):
        return drift(trim.state.values + size * at, trim.input.values + u) / size

    for k in range(steps):
        opti.subject_to(z[:, k + 1] == rk4(rate, z[:, k], v[:, k], dt))
        for row in range(2):
            opti.subject_to(opti.bounded(box[row, 0], trim.input.values[row] + v[row, k], box[row, 1]))
    opti.subject_to(z[:, 0] == first)
    opti.minimize(ca.sumsqr(z) + 25.0 * ca.sumsqr(v[0, :]) + 400.0 * ca.sumsqr(v[1, :]) + 100.0 * ca.sumsqr(z[:, -1]))
    opti.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes"})
    x = trim.state.replace(alpha=trim.state.alpha + np.radians(1.0)).values
    alone = x.copy()
    for _ in range(50):
        opti.set_value(first, (x - trim.state.values) / size)
        found = opti.solve()
        u = trim.input.values + found.value(v)[:, 0]
        opti.set_initial(z, found.value(z))
        opti.set_initial(v, found.value(v))
        x = fly(model, x, u, dt)
        alone = fly(model, alone, trim.input.values, dt) if abs(alone[3]) < 0.5 else alone
    assert abs(x[3] - trim.state.alpha) < np.radians(0.2)
    assert abs(x[4]) < np.radians(0.1)
    assert abs(alone[3] - trim.state.alpha) > np.radians(10.0)
