"""Trims and flights against SciPy, closed forms, and the command line."""

import json
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm, solve_continuous_lyapunov
from scipy.optimize import root

import ahv

COMMAND = Path(sysconfig.get_path("scripts")) / "ahv"


def told(*words: str) -> dict:
    return json.loads(subprocess.check_output([COMMAND, *words, "--json"]))


def test_a_trim_is_a_root_for_scipy():
    model = ahv.dcom
    trim = model.trim(velocity=7850.0, altitude=86_000.0, gamma=0.01)
    assert (trim.state.velocity, trim.state.altitude, trim.state.gamma) == (7850.0, 86_000.0, 0.01)
    free, held = [3, *range(5, 11)], trim.state.values
    rows = [0, 2, 4, *range(5, 11)]

    def rates(z):
        x, u = held.copy(), np.array([z[0], z[1], 0.0])
        x[free] = z[2:]
        return model.drift(x, u)[rows]

    start = np.concatenate([[0.25, 0.2], np.zeros(7)])
    found = root(rates, start, method="hybr", options={"xtol": 1e-13})
    np.testing.assert_allclose(found.x[:2], trim.input.values[:2], rtol=1e-8)
    np.testing.assert_allclose(found.x[2:], held[free], rtol=1e-7, atol=1e-9)


def test_angles_are_in_rad():
    assert ahv.com.trim(gamma=np.radians(1.0)).data["gamma_deg"] == pytest.approx(1.0, abs=1e-14)
    free = ahv.model("dcom", canard="free")
    held = free.trim(input={"delta_c": 0.05})
    assert held.input.delta_c == 0.05
    assert free.trim(input={"delta_c": "0.05rad"}).data == held.data


def test_units_of_choice():
    feet, metres = ahv.dcom.trim(), ahv.model("dcom", units="si").trim()
    assert metres.state.velocity == pytest.approx(0.3048 * feet.state.velocity, rel=1e-15)
    assert metres.state.alpha == pytest.approx(feet.state.alpha, rel=1e-9)
    assert metres.state.units[0] == "m/s"


@pytest.mark.parametrize(("scheme", "bound"), [("rk4", 1e-7), ("dormand-prince853", 1e-10)])
def test_a_flight_is_that_of_scipy(scheme, bound):
    model = ahv.dcom
    flight = model.simulate(0.5, 0.002, scheme=scheme, initial={"alpha": 0.03})
    trim = model.trim()
    start = trim.state.replace(alpha=0.03)
    theirs = solve_ivp(
        lambda _, x: model.drift(x, trim.input), (0.0, 0.5), start.values, method="DOP853", rtol=1e-12, atol=1e-12
    )
    np.testing.assert_allclose(flight.x[-1], theirs.y[:, -1], rtol=bound, atol=bound)
    assert flight.time[-1] == 0.5
    np.testing.assert_array_equal(flight["alpha"], flight.x[:, 3])


def test_moments_of_a_mode_in_closed_form():
    """χ of an Ornstein–Uhlenbeck process from rest: variance b² (1 − exp(−2 a t)) / 2a."""
    model = ahv.flexible_mode
    p = model.parameters
    flown = model.montecarlo(members=20_000, t_end=0.2, dt=0.001, seed=5, snapshots=4)
    decay, noise = p.zeta * p.omega, p.zeta * p.sigma / p.omega
    at = model.states.index("chi")
    for time, std, row in zip(flown.time[1:], flown.std[1:, at], flown["snapshots"][1:], strict=True):
        exact = np.sqrt(noise**2 * (1 - np.exp(-2 * decay * time)) / (2 * decay))
        spread = row["std"]["chi"]
        # Four times the half width of the interval of 95 %.
        assert abs(std - exact) < 2 * (spread["high"] - spread["low"])


def test_covariance_to_first_order():
    """dP/dt = A P + P Aᵀ + G Gᵀ from P(0) = 0, by the exponential of a block matrix (Van Loan)."""
    model = ahv.flexible_mode
    trim = model.trim()
    system = model.linearize(trim, outputs=["eta"])
    noise = model.diffusion(trim.state, trim.input)
    spread = model.covariance(t_end=0.3, dt=0.0005, members=30, stationary=True)
    n, intensity = len(model.states), noise @ noise.T
    for time, own in zip(spread.time, spread.linear, strict=True):
        block = expm(np.block([[-system.A, intensity], [np.zeros((n, n)), system.A.T]]) * time)
        exact = block[n:, n:].T @ block[:n, n:]
        np.testing.assert_allclose(own, exact, rtol=1e-6, atol=1e-9 * np.abs(exact).max())
    rest = solve_continuous_lyapunov(system.A, -intensity)
    np.testing.assert_allclose(spread.stationary, rest, rtol=1e-9, atol=1e-12 * np.abs(rest).max())


def test_flights_have_the_bits_of_the_command():
    flags = {"t_end": 0.1, "dt": 0.005, "seed": 3}
    one, two = (ahv.sdcom.montecarlo(members=500, threads=threads, **flags) for threads in (1, 2))
    assert one.digest == two.digest
    asked = ["montecarlo", "--model", "sdcom", "--members", "500", "--t-end", "0.1", "--dt", "0.005", "--seed", "3"]
    assert told(*asked)["digest"] == one.digest
    assert ahv.sdcom.montecarlo(members=500, **{**flags, "seed": 4}).digest != one.digest


def test_limits_dispersions_and_levels():
    flown = ahv.sdcom.montecarlo(
        members=64,
        t_end=0.05,
        dt=0.005,
        disperse=True,
        state_std={"alpha": 0.01, "altitude": 50.0},
        limit={"alpha": (-0.02, 0.06)},
    )
    assert flown["dispersed"]
    assert "left_limits" in flown["snapshots"][-1]
    rare = ahv.sdcom.rare(passes={"alpha": 0.0267}, t_end=0.1, dt=0.01, effort=200)
    low, high = rare.interval
    assert 0.0 <= low < rare.probability < high
    drawn = ahv.com_rigid.disperse(members=30)
    assert drawn["members"] == 30


def test_gains_fly(tmp_path):
    file = tmp_path / "gains.json"
    regulator = ahv.sdcom.lqr(out=file)
    flown = ahv.sdcom.montecarlo(members=32, t_end=0.5, dt=0.005, feedback=file)
    assert flown["feedback"] is not False
    assert regulator.K.shape == (2, 8)


def test_results_become_tables():
    flight = ahv.sdcom.simulate(0.05, 0.005)
    frame = flight.to_pandas()
    assert list(frame.columns) == list(ahv.sdcom.states)
    assert frame.attrs["units"]["velocity"] == "ft/s"
    data = flight.to_xarray()
    assert data.alpha.attrs["units"] == "rad"
    np.testing.assert_array_equal(data.alpha, flight["alpha"])
    flown = ahv.sdcom.montecarlo(members=16, t_end=0.05, dt=0.005, snapshots=5)
    assert flown.to_pandas()["std"].shape == (6, 8)
    assert flown.to_xarray()["mean"].sel(state="alpha").shape == (6,)
    assert flown.covariance.shape == (6, 8, 8)
    spread = ahv.sdcom.covariance(t_end=0.05, dt=0.005, members=30)
    assert set(spread.to_xarray().data_vars) == {"linear_std", "sampled_std", "ratio"}
    drawn = ahv.com_rigid.disperse(members=30)
    assert "alpha" in set(drawn.to_pandas()["name"])
    assert {"parameter", "slope"} <= set(drawn.sensitivities().columns)
    assert set(ahv.com_rigid.linearize().to_pandas()) == {"A", "B", "C", "D"}
    assert ahv.com_rigid.trim().state.to_pandas()["altitude"] == 85_000.0
    for shown in (flight, flown, spread, drawn, ahv.sdcom, ahv.sdcom.trim(), ahv.com_rigid.linearize()):
        assert "alpha" in repr(shown) or len(repr(shown)) > 20
    for shown in (ahv.sdcom, ahv.sdcom.trim()):
        assert "<table>" in shown._repr_html_()


def test_pictures_are_drawn(tmp_path):
    script = (
        "import matplotlib; matplotlib.use('agg'); import ahv, sys\n"
        "ahv.sdcom.simulate(0.1, 0.005).plot('alpha', 'velocity')[0].figure.savefig(sys.argv[1] + '/flight.png')\n"
        "flown = ahv.sdcom.montecarlo(members=16, t_end=0.05, dt=0.005)\n"
        "flown.plot('alpha', 'gamma')[0].figure.savefig(sys.argv[1] + '/spread.png')\n"
        "ahv.dcom.linearize().plot_poles().figure.savefig(sys.argv[1] + '/poles.png')\n"
    )
    subprocess.run([sys.executable, "-c", script, tmp_path], check=True)
    for name in ("flight", "spread", "poles"):
        assert (tmp_path / f"{name}.png").stat().st_size > 5_000
