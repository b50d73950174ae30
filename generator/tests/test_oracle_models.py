"""COM's structure, the printed SDCOM and the gust model against what defines them."""

from __future__ import annotations

import mpmath
import pytest
from oracle_support import ROW_OF, Values, assert_close, level_flight, oracle_of, trim, values

from ahv_oracle import Number, Oracle, sample
from ahv_oracle.evaluate import DIGITS

TIGHT = "1e-45"
POINTS = range(5)


def exact_point(oracle: Oracle, seed: int, index: int) -> Values:
    return {name: mpmath.mpf(x) for name, x in sample(oracle.model, seed, index).items()}


def parameters(point: Values) -> Values:
    return {name.removeprefix("parameter."): x for name, x in point.items()}


def test_com_obeys_lagrange_and_balances_power() -> None:
    """Mass matrix times accelerations is the load; the energy changes by the power of loads and dampers."""
    oracle = oracle_of("com")
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point = exact_point(oracle, 21, index)
            c, result = parameters(point), oracle.evaluate(point)
            rate = {i: point[f"state.eta_dot_{i}"] for i in (1, 2)}
            force = {i: result[f"generalized_force_{i}"][0] for i in rate}
            turn, moment = point["state.pitch_rate"], result["pitching_moment"][0]
            turning = result["drift.pitch_rate"][0]
            bending = {i: result[f"drift.eta_dot_{i}"][0] for i in rate}
            total = c["i_yy"] * turning + sum(c[f"psi_{i}"] * bending[i] for i in rate)
            assert abs(total - moment) <= mpmath.mpf(TIGHT) * c["i_yy"] * result["drift.pitch_rate"][1]
            power = moment * turn
            for i in rate:
                stiffness = c[f"omega_{i}"] ** 2 * point[f"state.eta_{i}"]
                damping = 2 * c[f"zeta_{i}"] * c[f"omega_{i}"] * rate[i]
                load = bending[i] + c[f"psi_{i}"] * turning
                expected = force[i] - damping - stiffness
                assert abs(load - expected) <= mpmath.mpf(TIGHT) * result[f"drift.eta_dot_{i}"][1]
                power += (force[i] - damping) * rate[i]

            def energy(x: Values, c: Values = c, point: Values = point) -> Number:
                still = sum((c[f"omega_{i}"] * x[f"eta_{i}"]) ** 2 + x[f"eta_dot_{i}"] ** 2 for i in (1, 2)) / 2
                mixed = x["pitch_rate"] * sum(c[f"psi_{i}"] * x[f"eta_dot_{i}"] for i in (1, 2))
                return still + mixed + c["i_yy"] * x["pitch_rate"] ** 2 / 2

            states = {name: point[f"state.{name}"] for name in oracle.model.states}
            flow = {name: result[f"drift.{name}"][0] for name in states}
            # the energy is quadratic, so this difference is its derivative
            ahead, behind = ({k: x + sign * flow[k] for k, x in states.items()} for sign in (1, -1))
            gained = (energy(ahead) - energy(behind)) / 2
            size = abs(energy(ahead)) + abs(energy(behind))
            assert abs(gained - power) <= mpmath.mpf("1e-40") * size


def test_com_mass_matrix_is_symmetric() -> None:
    """A unit of one load moves another coordinate as much as the other way round."""
    oracle = oracle_of("com")
    with mpmath.workdps(DIGITS):
        point = exact_point(oracle, 22, 0)
        c = parameters(point)
        results = [values(oracle, point | {f"parameter.n_{i}_0": c[f"n_{i}_0"] + 1}) for i in (1, 2)]
        rest = values(oracle, point)
        moved = [{k: result[f"drift.{k}"] - rest[f"drift.{k}"] for k in ROWS} for result in results]
        assert abs(moved[0]["eta_dot_2"] - moved[1]["eta_dot_1"]) <= mpmath.mpf("1e-40")
        assert moved[0]["eta_dot_1"] > 1 < moved[1]["eta_dot_2"]
        pushed = values(oracle, point | {"parameter.c_m_0": c["c_m_0"] + 1})
        moment = pushed["pitching_moment"] - rest["pitching_moment"]
        for i in (1, 2):
            bent = (pushed[f"drift.eta_dot_{i}"] - rest[f"drift.eta_dot_{i}"]) / moment
            assert abs(bent - moved[i - 1]["pitch_rate"]) <= mpmath.mpf("1e-40")


ROWS = ("pitch_rate", "eta_dot_1", "eta_dot_2")


def test_com_without_coupling_is_rigid_and_trims_alike() -> None:
    com, rigid = oracle_of("com"), oracle_of("com_rigid")
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point = exact_point(com, 23, index) | {"parameter.psi_1": 0, "parameter.psi_2": 0}
            result, expected = com.evaluate(point), rigid.evaluate(point)
            for row in rigid.model.states:
                assert_close(expected[f"drift.{row}"][0], result[f"drift.{row}"], row, TIGHT)
        point, bare = trim(com, level_flight(com)), trim(rigid, level_flight(rigid))
        for name in ("state.alpha", "input.phi", "input.delta_e"):
            assert abs(point[name] - bare[name]) < mpmath.mpf("1e-30")
        assert all(abs(point[f"state.eta_{i}"]) > 0.1 for i in (1, 2))


def test_printed_is_the_sum_of_its_parts_and_what_is_missing() -> None:
    printed, exact = oracle_of("sdcom_printed"), oracle_of("sdcom")
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point = exact_point(printed, 24, index)
            assert all(abs(x) < mpmath.mpf(TIGHT) for x in printed.identity_residuals(point).values())
            result, whole = printed.evaluate(point), exact.evaluate(point)
            for suffix, row in ROW_OF.items():
                for missing, part, total in (("delta_f", f"drift.{row}", f"drift.{row}"), ("delta_H", None, None)):
                    label = f"{missing}_{suffix}"
                    difference = whole[total or f"H_{suffix}"][0] - result[part or f"H_{suffix}"][0]
                    assert_close(difference, result[label], label, "1e-40")
            assert result["drift.altitude"] == whole["drift.altitude"]
            assert result["H_alpha"][0] == -result["H_gamma"][0]
            assert all(result[f"h_alpha.{i}"][0] == -result[f"h_gamma.{i}"][0] for i in range(3))
            assert result["g_alpha"][0] == 1


TRUNCATED: tuple[str, ...] = ("c_t_phi_alpha_3", "c_t_phi_alpha_2", "c_t_alpha_3", "c_t_alpha_2")
TRUNCATED += ("c_d_alpha_2", "c_d_delta_e_2", "c_d_delta_c_2")


def test_printed_is_exact_where_nothing_is_truncated() -> None:
    """No powers but those that (28)-(35) keep, and a canard that takes the elevator's lift away."""
    oracle = oracle_of("sdcom_printed")
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point = exact_point(oracle, 25, index)
            point |= {f"parameter.{name}": 0 for name in (*TRUNCATED, "canard_command")}
            result = oracle.evaluate(point | {"parameter.canard_slaving": 1})
            for suffix in ROW_OF:
                assert abs(result[f"delta_f_{suffix}"][0]) <= mpmath.mpf(TIGHT) * result[f"delta_f_{suffix}"][1]
            lifting = {"parameter.canard_slaving": 0.5, "parameter.c_l_delta_e": 1, "input.delta_e": 0.1}
            result = oracle.evaluate(point | lifting)
            assert all(result[f"delta_f_{suffix}"][0] for suffix in ("gamma", "alpha"))


def test_printed_perturbations() -> None:
    """H of (28), (30), (32) and (34), corrected; the columns of noise are made of them."""
    oracle = oracle_of("sdcom_printed")
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point = exact_point(oracle, 26, index)
            c, result = parameters(point), oracle.evaluate(point)
            alpha, phi, speed = point["state.alpha"], point["input.phi"], point["state.velocity"]
            force = result["dynamic_pressure"][0] * c["s"]
            thrust = c["c_t_alpha"] + c["c_t_phi_alpha"] * phi
            turn = force / (c["m"] * speed) * (c["c_l_alpha"] + mpmath.sin(alpha) * thrust)
            expected = {
                "V": force / c["m"] * (mpmath.cos(alpha) * thrust - c["c_d_alpha"]),
                "gamma": turn,
                "alpha": -turn,
                "Q": force / c["i_yy"] * (c["c_bar"] * c["c_m_alpha"] + c["z_t"] * thrust),
            }
            for suffix, row in ROW_OF.items():
                assert_close(expected[suffix], result[f"H_{suffix}"], suffix, TIGHT)
                column = expected[suffix] * c["w_alpha"]
                assert_close(column, result[f"diffusion.{row}.w_alpha"], row, TIGHT)
            gamma = [label for label in result if label.startswith("diffusion.") and label.endswith(".w_gamma")]
            assert gamma == ["diffusion.altitude.w_gamma"]
            assert result[gamma[0]][0] == speed * c["w_gamma"]
            assert result["diffusion.alpha.w_q"][0] == c["w_q"]


def test_printed_without_a_coefficient_counts_it_as_zero() -> None:
    table = oracle_of("sdcom_printed").table
    names = {"c_t_phi_alpha", "c_m_alpha_2", "c_d_delta_e", "c_l_0"}
    quantities = {k: tuple(t for t in terms if t.parameter not in names) for k, terms in table.quantities.items()}
    kept = {name: value for name, value in table.values.items() if name not in names}
    less = Oracle(type(table)(table.name, table.models, kept, quantities, table.validity), "sdcom_printed")
    point = sample(oracle_of("sdcom_printed").model, 27, 0) | {f"parameter.{name}": 0.0 for name in names}
    expected, result = oracle_of("sdcom_printed").evaluate(point), less.evaluate(point)
    for row in (*(f"drift.{row}" for row in ROW_OF.values()), "g_Q", "f_V", "H_alpha"):
        assert_close(expected[row][0], result[row], row, "1e-40")


def test_a_gust_is_felt_by_the_fits_alone() -> None:
    gust, calm = oracle_of("sdcom_gust"), oracle_of("sdcom")
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point = exact_point(gust, 28, index)
            felt = values(gust, point)
            calm_point = point | {f"noise.{name}": 0 for name in ("w_gamma", "w_alpha")}
            still = values(gust, point | {"state.alpha_gust": 0})
            expected = values(calm, calm_point)
            for row in calm.model.states:
                assert still[f"drift.{row}"] == expected[f"drift.{row}"], row
            moved = calm_point | {"state.alpha": point["state.alpha"] + point["state.alpha_gust"]}
            shifted = calm.evaluate(moved)
            for name in ("c_l", "c_d", "c_m", "c_t", "c_n_2", "eta_3", "pitching_moment", "drift.pitch_rate"):
                assert_close(felt[name], shifted[name], name, "1e-40")
            # the sum of the lateral rows is free of forces, as in (1)
            assert_close(felt["drift.alpha"], (point["state.pitch_rate"] - felt["drift.gamma"], 1), "alpha", "1e-40")


def test_a_gust_has_the_rms_and_the_time_of_the_table() -> None:
    oracle = oracle_of("sdcom_gust")
    assert oracle.model.noises == ("w_q", "xi_1", "xi_2", "xi_3", "w_gust")
    with mpmath.workdps(DIGITS):
        point = exact_point(oracle, 29, 0)
        result, c = values(oracle, point), parameters(point)
        decay = -result["jacobians.state.alpha_gust.alpha_gust"]
        variance = result["diffusion.alpha_gust.w_gust"] ** 2 / (2 * decay)
        assert abs(decay * c["gust_time"] - 1) < mpmath.mpf(TIGHT)
        assert abs(variance / c["gust_rms"] ** 2 - 1) < mpmath.mpf(TIGHT)


@pytest.mark.parametrize("model", ["sdcom", "sdcom_printed", "sdcom_gust"])
def test_reduced_modes_are_those_of_the_single_mode(model: str) -> None:
    """Decay and intensity of each mode, for any state of the switches."""
    oracle, single = oracle_of(model), oracle_of("flexible_mode")
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point = exact_point(oracle, 30, index) | {"parameter.shared_noise": 0}
            result, c = values(oracle, point), parameters(point)
            for i in (1, 2, 3):
                mode: Values = dict.fromkeys(single.names, mpmath.mpf(1))
                mode |= {f"parameter.{name}": c[f"{name}_{i}"] for name in ("omega", "zeta", "sigma")}
                mode |= {f"parameter.{name}": c[name] for name in ("variance_matching", "moment_matching")}
                expected = values(single, mode)
                decay = result[f"jacobians.state.chi_{i}.chi_{i}"]
                assert abs(decay - expected["jacobians.state.chi.chi"]) <= mpmath.mpf("1e-40")
                assert abs(result[f"diffusion.chi_{i}.xi_{i}"] - expected["diffusion.chi.xi"]) <= mpmath.mpf("1e-40")
