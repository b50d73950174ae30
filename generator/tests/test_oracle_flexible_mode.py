"""Closed forms of section 3 against matrix exponentials, integrals and transfer functions."""

from __future__ import annotations

import mpmath
import pytest
from oracle_support import TABLES, Values, oracle_of, values

from ahv_oracle import Number, Oracle, load_table, sample
from ahv_oracle.evaluate import DIGITS
from ahv_oracle.sampling import Point
from ahv_oracle.vectors import vector_row

REGIMES = {0.02: "underdamped", 0.7: "underdamped", 1.0: "critical", 1.4: "overdamped"}
STATES = ("eta", "eta_dot", "chi")


def point_of(zeta: float, index: int = 0, **changes: float) -> Point:
    point = sample(oracle_of("flexible_mode").model, 31, index) | {"parameter.zeta": zeta}
    return point | {name.replace("__", "."): x for name, x in changes.items()}


def known(point: Point) -> Values:
    """Parameters, arguments and inputs without their kind, as mpf."""
    return {name.partition(".")[2]: mpmath.mpf(x) for name, x in point.items()}


def system(c: Values) -> Number:
    """The paper's A of (9) with the reduced mode beside it."""
    decay = values(oracle_of("flexible_mode"), {k: c[k.partition(".")[2]] for k in oracle_of("flexible_mode").names})
    a = -decay["jacobians.state.chi.chi"]
    return mpmath.matrix([[0, 1, 0], [-(c["omega"] ** 2), -2 * c["zeta"] * c["omega"], 0], [0, 0, -a]])


def impulse(c: Values, time: Number) -> Number:
    """Response of eta to a unit impulse, from the roots of the characteristic polynomial."""
    if c["zeta"] == 1:
        return time * mpmath.exp(-c["omega"] * time)
    root = mpmath.sqrt(mpmath.mpc(c["zeta"] ** 2 - 1))
    first, second = (c["omega"] * (-c["zeta"] + sign * root) for sign in (1, -1))
    return ((mpmath.exp(first * time) - mpmath.exp(second * time)) / (first - second)).real


@pytest.mark.parametrize("zeta", REGIMES)
def test_transition_is_the_matrix_exponential(zeta: float) -> None:
    oracle, regime = oracle_of("flexible_mode"), REGIMES[zeta]
    with mpmath.workdps(DIGITS):
        for index in range(3):
            point = point_of(zeta, index)
            c, result = known(point), values(oracle, dict(point))
            whole = mpmath.matrix(4)
            whole[:3, :3] = system(c)
            whole[1, 3] = c["force"]
            flow = mpmath.expm(whole * c["time"], method="taylor")
            for i, row in enumerate(STATES):
                for j, column in enumerate(STATES):
                    entry = result.get(f"transition_{regime}.{row}.{column}", mpmath.mpf(0))
                    assert abs(entry - flow[i, j]) <= mpmath.mpf("1e-30") * (1 + abs(flow[i, j])), (row, column)
                response = sum(flow[i, j] * c[column] for j, column in enumerate(STATES)) + flow[i, 3]
                assert abs(result[f"response_{regime}.{row}"] - response) <= mpmath.mpf("1e-30") * (1 + abs(response))


@pytest.mark.parametrize("zeta", REGIMES)
def test_variance_and_correlation_are_integrals_of_the_impulse_response(zeta: float) -> None:
    oracle, regime = oracle_of("flexible_mode"), REGIMES[zeta]
    point = point_of(zeta, parameter__omega=12.5, argument__time=0.3)
    with mpmath.workdps(DIGITS):
        c, result = known(point), values(oracle, dict(point))
    with mpmath.workdps(25):
        time, scale = c["time"], c["sigma"] ** 2

        def squared(s: Number) -> Number:
            return impulse(c, s) ** 2

        def lagged(s: Number) -> Number:
            return impulse(c, s) * impulse(c, s + time)

        variance = scale * mpmath.quad(squared, mpmath.linspace(0, time, 4))
        assert abs(result[f"eta_variance_at_{regime}"] / variance - 1) < mpmath.mpf("1e-18")
        if zeta > 0.1:  # the integral to infinity is slow for a mode that rings
            pieces = mpmath.linspace(0, 8, 33)
            correlation = scale * mpmath.quad(lagged, pieces)
            size = result["eta_variance"]
            assert abs(result[f"eta_autocorrelation_{regime}"] - correlation) < mpmath.mpf("1e-15") * size


@pytest.mark.parametrize("zeta", REGIMES)
def test_at_time_zero_and_late(zeta: float) -> None:
    oracle, regime = oracle_of("flexible_mode"), REGIMES[zeta]
    start = values(oracle, dict(point_of(zeta, argument__time=0.0)))
    assert start[f"eta_variance_at_{regime}"] == start["chi_variance_at"] == 0
    assert abs(start[f"eta_autocorrelation_{regime}"] / start["eta_variance"] - 1) < mpmath.mpf("1e-45")
    assert start["chi_autocorrelation"] == start["chi_variance"]
    late = values(oracle, dict(point_of(zeta, argument__time=200.0)))
    assert abs(late[f"eta_variance_at_{regime}"] / late["eta_variance"] - 1) < mpmath.mpf("1e-15")
    assert (
        abs(late[f"response_{regime}.eta"] * known(point_of(zeta))["omega"] ** 2 - point_of(zeta)["input.force"]) < 1e-6
    )


def test_stationary_covariance_solves_the_lyapunov_equation() -> None:
    oracle = oracle_of("flexible_mode")
    with mpmath.workdps(DIGITS):
        for index in range(3):
            point = sample(oracle.model, 32, index)
            c, result = known(point), values(oracle, dict(point))
            matrix = system(c)
            noise = mpmath.matrix([0, result["diffusion.eta_dot.xi"], result["diffusion.chi.xi"]])
            covariance = mpmath.diag([result[f"{name}_variance"] for name in STATES])
            left = matrix[:2, :2] * covariance[:2, :2] + covariance[:2, :2] * matrix[:2, :2].T
            left += noise[:2] * noise[:2].T
            assert mpmath.mnorm(left) < mpmath.mpf("1e-40") * c["sigma"] ** 2
            assert abs(2 * matrix[2, 2] * covariance[2, 2] + noise[2] ** 2) < mpmath.mpf("1e-40") * noise[2] ** 2


def test_spectra_are_those_of_the_transfer_functions() -> None:
    oracle = oracle_of("flexible_mode")
    with mpmath.workdps(DIGITS):
        for index in range(5):
            point = sample(oracle.model, 33, index)
            c, result = known(point), values(oracle, dict(point))
            s = mpmath.mpc(0, c["frequency"])
            eta = c["sigma"] / (s**2 + 2 * c["zeta"] * c["omega"] * s + c["omega"] ** 2)
            chi = result["diffusion.chi.xi"] / (s - result["jacobians.state.chi.chi"])
            assert abs(result["eta_spectrum"] / abs(eta) ** 2 - 1) < mpmath.mpf("1e-40")
            assert abs(result["chi_spectrum"] / abs(chi) ** 2 - 1) < mpmath.mpf("1e-40")


SWITCHES = {"printed": (0.0, 0.0), "variance": (1.0, 0.0), "moment": (0.0, 1.0)}


@pytest.mark.parametrize("kind", SWITCHES)
def test_what_each_reduction_matches(kind: str) -> None:
    oracle = oracle_of("flexible_mode")
    variance, moment = SWITCHES[kind]
    with mpmath.workdps(DIGITS):
        for index in range(3):
            point = sample(oracle.model, 34, index)
            point |= {"parameter.variance_matching": variance, "parameter.moment_matching": moment}
            c, result = known(point), values(oracle, dict(point))
            decay, intensity = result[f"reduction_{kind}.decay"], result[f"reduction_{kind}.diffusion"]
            same = {
                "chosen decay": -result["jacobians.state.chi.chi"] / decay,
                "chosen intensity": result["diffusion.chi.xi"] / intensity,
                "chosen variance": result["chi_variance"] / result[f"chi_variance_{kind}"],
            }
            ratio = result[f"chi_variance_{kind}"] / result["eta_variance"]
            same["variance"] = ratio / (2 * c["zeta"] ** 2) if kind == "printed" else ratio
            if kind != "variance":
                same["gain"] = intensity / decay * c["omega"] ** 2 / c["sigma"]
            if kind != "moment":
                same["decay"] = decay / (c["zeta"] * c["omega"])
            assert all(abs(x - 1) < mpmath.mpf("1e-45") for x in same.values()), same


MAXIMA = {"mode1": 0.3074, "mode2": 0.0664, "mode3": 0.0225}


@pytest.mark.parametrize("mode", MAXIMA)
def test_table_1_as_the_note_recomputed_it(mode: str) -> None:
    """Largest difference of the standard deviations over time, white noise of intensity 100^2, printed reduction."""
    table = load_table(TABLES["flexible_mode"], set=mode)
    oracle = Oracle(table, "flexible_mode", ["eta_variance_at_underdamped", "chi_variance_at"])
    point: Values = dict.fromkeys(oracle.names, 0) | oracle.nominal() | {"parameter.sigma": 100}
    worst = 0.0
    for step in range(1, 400):
        time = mpmath.mpf(step) / (40 * mpmath.mpf(table.values["omega"]))
        result = values(oracle, point | {"argument.time": time})
        deviations = [mpmath.sqrt(result[name]) for name in ("eta_variance_at_underdamped", "chi_variance_at")]
        worst = max(worst, float(abs(deviations[0] - deviations[1])))
    assert worst == pytest.approx(MAXIMA[mode], abs=1e-4)


@pytest.mark.parametrize("zeta", REGIMES)
def test_a_regime_that_does_not_hold_has_no_value(zeta: float) -> None:
    oracle = oracle_of("flexible_mode")
    point = point_of(zeta)
    result = oracle.evaluate(point)
    there = {label.split(".")[0].rsplit("_", 1)[1] for label, pair in result.items() if mpmath.isnan(pair[0])}
    assert there == {"underdamped", "overdamped"} - {REGIMES[zeta]}
    outputs = vector_row(oracle, point).split("|")[1].split(",")
    empty = [label for label, output in zip(oracle.labels, outputs, strict=True) if output == "nan;0;0"]
    assert all(label.split(".")[0].endswith(tuple(there)) for label in empty)
    assert len(empty) == 10 * len(there)


def test_k_counts_large_arguments() -> None:
    """A rounding of omega t is felt as e^(-zeta omega t) feels it."""
    oracle = oracle_of("flexible_mode")
    point = point_of(0.5, parameter__omega=100.0, argument__time=2.0)
    value, magnitude = oracle.evaluate(point)["chi_autocorrelation"]
    decay = -oracle.evaluate(point)["jacobians.state.chi.chi"][0]
    assert float(magnitude / value) > 1 + float(decay) * 2.0 * 0.99
