"""Linear systems, poles, zeros and regulators against python-control and SciPy."""

import numpy as np
import pytest
from scipy.linalg import solve_continuous_are

import ahv

MODELS = tuple(ahv.models())


def sides(roots: list[complex]) -> list[complex]:
    return sorted(roots, key=lambda it: (round(it.real, 6), it.imag))


@pytest.mark.parametrize("name", MODELS)
def test_poles_are_those_of_python_control(name):
    system = ahv.model(name).linearize()
    own = sides([pole.value for pole in system.poles()])
    theirs = sides(list(system.to_control().poles()))
    # A multiple pole at 0 is found to the root of the rounding by who does not look for it.
    np.testing.assert_allclose(own, theirs, rtol=1e-6, atol=1e-5)


def test_signals_have_names():
    system = ahv.dcom.linearize(inputs=["delta_e"], outputs=["gamma", "lift"])
    theirs = system.to_control()
    assert theirs.state_labels == list(ahv.dcom.states)
    assert theirs.input_labels == ["delta_e"]
    assert theirs.output_labels == ["gamma", "lift"]
    assert system.outputs.unit("lift") == "lb/ft"


def test_the_response_of_an_output_is_its_own():
    """The slope of an output over a frequency is the one that follows from states and a difference."""
    model = ahv.com_rigid
    trim = model.trim()
    system = model.linearize(trim, inputs=["delta_e"], outputs=["lift", "alpha"])
    step = 1e-6
    ends = [model.output(trim.state.replace(alpha=trim.state.alpha + it), trim.input) for it in (step, -step)]
    slope = (ends[0] - ends[1])[model.outputs.index("lift")] / (2 * step)
    np.testing.assert_allclose(system.C[0, 3], slope, rtol=1e-6)
    response = system.to_control()(2.0j)
    by_hand = system.C @ np.linalg.solve(2.0j * np.eye(5) - system.A, system.B) + system.D
    np.testing.assert_allclose(np.squeeze(response), np.squeeze(by_hand), rtol=1e-9)


def test_zeros_are_those_of_python_control():
    system = ahv.dcom.linearize(inputs=["phi", "delta_e"], outputs=["velocity", "gamma"])
    zeros = system.zeros()
    finite = sides([zero.value for zero in zeros.finite if abs(zero.value) > 1e-3])
    theirs = sides([it for it in system.to_control().zeros() if 1e-3 < abs(it) < 1e6])
    np.testing.assert_allclose(finite, theirs, rtol=1e-6, atol=1e-6)
    assert zeros.normal_rank == 2
    assert any(zero.value.real > 0 for zero in zeros.finite)


def test_modes_are_named():
    modes = {pole.mode for pole in ahv.dcom.poles()}
    assert {"phugoid", "height", "short period", "flexible 1", "flexible 2", "flexible 3"} == modes
    flexible = [pole for pole in ahv.dcom.poles() if pole.mode == "flexible 1"]
    assert flexible[0].frequency == pytest.approx(19.7437, rel=1e-2)
    assert flexible[0].damping == pytest.approx(0.7, rel=2e-2)


def test_a_regulator_of_matrices_is_that_of_scipy():
    system = ahv.com_rigid.linearize()
    q, r = np.diag([1e-2, 1e-4, 1e4, 2.5e3, 4e2]), np.diag([25.0, 400.0])
    own = system.lqr(q, r)
    x = solve_continuous_are(system.A, system.B, q, r)
    np.testing.assert_allclose(own.K, np.linalg.solve(r, system.B.T @ x), rtol=1e-6, atol=1e-9)
    closed = np.linalg.eigvals(system.A - system.B @ own.K)
    np.testing.assert_allclose(sides(own.poles), sides(closed), rtol=1e-6)
    named = ahv.com_rigid.lqr(state_deviation={"velocity": 10.0}, input_deviation={"delta_e": "2deg"})
    assert named.inputs.names == ("phi", "delta_e")
    assert max(named.poles.real) < 0


def test_refusals_say_what_is_wrong():
    system = ahv.com_rigid.linearize()
    with pytest.raises(ahv.NumericError, match="R is 1 x 1; it must be 2 x 2"):
        system.lqr(np.eye(5), np.eye(1))
    with pytest.raises(ahv.NumericError, match="the weight R must be symmetric"):
        system.lqr(np.eye(5), -np.eye(2))
    with pytest.raises(ahv.RequestError, match="inputs: unknown input `phy`; did you mean `phi`"):
        ahv.com_rigid.linearize(inputs=["phy"])
