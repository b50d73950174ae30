"""The independent oracle against the literature's trims, and against its own definitions."""

import dataclasses
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import mpmath
import pytest

from ahv_oracle import Number, Oracle, load_table, sample, write_vectors
from ahv_oracle.evaluate import DIGITS

GENERATOR = Path(__file__).resolve().parents[1]
TABLES = {name: GENERATOR / "tables" / f"{name}.toml" for name in ("com", "dcom")}
TABLE_OF = {"com": "com", "dcom": "dcom", "sdcom": "dcom"}
DEGREE = mpmath.pi / 180
POINTS = range(20)

NOISE_OF = {"gamma": "w_gamma", "alpha": "w_alpha", "pitch_rate": "w_q"}
ROW_OF = {"V": "velocity", "gamma": "gamma", "alpha": "alpha", "Q": "pitch_rate"}
POWERS = ("", "_alpha", "_alpha_2", "_alpha_3")

Values = dict[str, Number]


@pytest.fixture(scope="module")
def oracles() -> dict[str, Oracle]:
    return {model: Oracle(TABLES[table], model) for model, table in TABLE_OF.items()}


def values(oracle: Oracle, point: Values) -> Values:
    return {label: pair[0] for label, pair in oracle.evaluate(point).items()}


def level_flight(oracle: Oracle, **changes: float) -> Values:
    point: Values = dict.fromkeys(oracle.names, 0) | oracle.nominal()
    point |= {"state.velocity": 7702.0808, "state.altitude": 85000}
    return point | {f"parameter.{name}": value for name, value in changes.items()}


def trim(oracle: Oracle, point: Values) -> Values:
    """Level trim at 50 digits: alpha, phi, delta_e and, for DCOM, the deflections."""
    free = ["state.alpha", "input.phi", "input.delta_e"]
    rows = ["drift.velocity", "drift.gamma", "drift.pitch_rate"]
    if oracle.model.name == "dcom":
        free += [f"state.eta_{i}" for i in (1, 2, 3)]
        rows += [f"drift.eta_dot_{i}" for i in (1, 2, 3)]

    def residual(*unknowns: Number) -> list[Number]:
        result = values(oracle, point | dict(zip(free, unknowns, strict=True)))
        return [result[row] for row in rows]

    with mpmath.workdps(DIGITS):
        start = [0.03, 0.28, 0.2, 0.5, 0.0, 0.0][: len(free)]
        solution = mpmath.findroot(residual, start, tol=1e-60, maxsteps=30)
        return point | dict(zip(free, solution, strict=True))


def shown(point: Values, name: str) -> float:
    return float(point[name] / DEGREE)


def poles(oracle: Oracle, point: Values) -> list[Number]:
    result, states = values(oracle, point), oracle.model.states
    matrix = mpmath.matrix(len(states))
    for i, row in enumerate(states):
        for j, column in enumerate(states):
            matrix[i, j] = result.get(f"jacobians.state.{row}.{column}", 0)
    return list(mpmath.eig(matrix, left=False, right=False))


def test_com_trims_where_science_says(oracles: dict[str, Oracle]) -> None:
    point = trim(oracles["com"], level_flight(oracles["com"]))
    assert shown(point, "state.alpha") == pytest.approx(1.64457, abs=5.1e-6)
    assert float(point["input.phi"]) == pytest.approx(0.26809, abs=5.1e-6)
    assert shown(point, "input.delta_e") == pytest.approx(12.53998, abs=5.1e-6)
    real = [float(pole.real) for pole in poles(oracles["com"], point)]
    assert max(real) == pytest.approx(1.694, abs=5.1e-4)
    assert min(real) == pytest.approx(-1.764, abs=5.1e-4)


def test_com_trims_where_science_says_on_the_spherical_earth(oracles: dict[str, Oracle]) -> None:
    point = trim(oracles["com"], level_flight(oracles["com"], spherical_earth=1.0))
    assert shown(point, "state.alpha") == pytest.approx(1.4056, abs=5.1e-5)
    assert float(point["input.phi"]) == pytest.approx(0.2505, abs=5.1e-5)
    assert shown(point, "input.delta_e") == pytest.approx(11.984, abs=5.1e-4)


SLAVING = {0.0: (1.5018, 0.2821, 13.1006), 1.0: (3.6558, 0.2957, 7.1364)}


@pytest.mark.parametrize("slaving", SLAVING)
def test_dcom_and_sdcom_trim_where_science_says(oracles: dict[str, Oracle], slaving: float) -> None:
    names = ("state.alpha", "input.phi", "input.delta_e")
    dcom, sdcom = (
        trim(oracles[model], level_flight(oracles[model], canard_slaving=slaving)) for model in ("dcom", "sdcom")
    )
    found = (shown(dcom, names[0]), float(dcom[names[1]]), shown(dcom, names[2]))
    assert found == pytest.approx(SLAVING[slaving], abs=5.1e-5)
    assert all(abs(dcom[name] - sdcom[name]) < mpmath.mpf("1e-30") for name in names)
    if slaving == 0.0:
        eta = [float(dcom[f"state.eta_{i}"]) for i in (1, 2, 3)]
        assert eta == pytest.approx([0.6276, -0.0137, -0.0372], abs=5.1e-5)


def test_dcom_poles_with_the_lightly_damped_modes(oracles: dict[str, Oracle]) -> None:
    modal = {"omega_1": 20.5, "omega_2": 52.5, "omega_3": 105.0} | {f"zeta_{i}": 0.02 for i in (1, 2, 3)}
    point = trim(oracles["dcom"], level_flight(oracles["dcom"], **modal))
    assert shown(point, "state.alpha") == pytest.approx(1.5115, abs=5.1e-5)
    assert float(point["input.phi"]) == pytest.approx(0.2811, abs=5.1e-5)
    assert shown(point, "input.delta_e") == pytest.approx(13.063, abs=5.1e-4)
    found = poles(oracles["dcom"], point)
    real = [float(pole.real) for pole in found if abs(pole.imag) < 1e-9]
    assert min(real) == pytest.approx(-1.742, abs=5.1e-4)
    assert max(real) == pytest.approx(1.673, abs=6e-4)  # 1.67248; the note rounds it up
    flexible = sorted((float(pole.imag), float(pole.real)) for pole in found if pole.imag > 1)
    assert flexible == [pytest.approx(pair, abs=0.1) for pair in ((20.5, -0.41), (52.5, -1.05), (105, -2.1))]


def central(function: Callable[[Number], Values], at: float) -> Values:
    """Fourth-order central difference of every entry."""
    step = mpmath.mpf("1e-9") * max(1, abs(at))
    far, near, after, last = (function(mpmath.mpf(at) + k * step) for k in (-2, -1, 1, 2))
    return {k: (8 * (after[k] - near[k]) - (last[k] - far[k])) / (12 * step) for k in near}


def assert_close(expected: Number, result: tuple[Number, Number], what: str) -> None:
    assert abs(expected - result[0]) <= mpmath.mpf("1e-20") * (result[1] + abs(expected)), what


@pytest.mark.parametrize("model", TABLE_OF)
def test_derivatives_are_central_differences(oracles: dict[str, Oracle], model: str) -> None:
    oracle = oracles[model]
    columns = [("state", name) for name in oracle.model.states] + [("input", name) for name in oracle.model.inputs]
    for index in POINTS:
        point: Values = dict(sample(oracle.model, 1, index))
        for kind, column in columns:
            check_column(oracle, point, kind, column)


def check_column(oracle: Oracle, point: Values, kind: str, column: str) -> None:
    name, noise = f"{kind}.{column}", NOISE_OF.get(column)
    result = oracle.evaluate(point)
    with mpmath.workdps(DIGITS):
        slopes = central(lambda x: values(oracle, point | {name: x}), point[name])
        for row in oracle.model.states:
            label, slope = f"jacobians.{kind}.{row}.{column}", slopes[f"drift.{row}"]
            if label not in result:
                assert abs(slope) <= mpmath.mpf("1e-25") * result[f"drift.{row}"][1], label
                continue
            assert_close(slope, result[label], label)
            if oracle.model.noises and noise:
                intensity = mpmath.mpf(point[f"parameter.{noise}"])
                assert_close(slope * intensity, result[f"diffusion.{row}.{noise}"], label)


def test_sdcom_is_dcom_at_the_reduced_deflections(oracles: dict[str, Oracle]) -> None:
    """Equation (25), with N_i read off DCOM's own modes; also what f_eta is made of."""
    dcom, sdcom = oracles["dcom"], oracles["sdcom"]
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point: Values = {k: mpmath.mpf(x) for k, x in sample(sdcom.model, 14, index).items()}
            point |= {f"state.{name}_{i}": 0 for name in ("eta", "eta_dot") for i in (1, 2, 3)}
            at_rest = values(dcom, point)
            static = [at_rest[f"drift.eta_dot_{i}"] / point[f"parameter.omega_{i}"] ** 2 for i in (1, 2, 3)]
            for i, deflection in enumerate(static, 1):
                point[f"state.eta_{i}"] = deflection + point[f"state.chi_{i}"]
            expected, result = values(dcom, point), sdcom.evaluate(point)
            for row in ROW_OF.values():
                assert_close(expected[f"drift.{row}"], result[f"drift.{row}"], row)
            for suffix, row in ROW_OF.items():
                slopes = [expected.get(f"jacobians.state.{row}.eta_{i}", 0) for i in (1, 2, 3)]
                flexible = sum(a * b for a, b in zip(slopes, static, strict=True))
                assert_close(flexible, result[f"f_{suffix}_eta"], suffix)


def test_strict_feedback_sum_is_the_drift(oracles: dict[str, Oracle]) -> None:
    oracle = oracles["sdcom"]
    for index in POINTS:
        residuals = oracle.identity_residuals(sample(oracle.model, 2, index))
        assert set(residuals) == {"V", "gamma", "alpha", "Q"}
        assert all(abs(residual) < mpmath.mpf("1e-45") for residual in residuals.values())


def test_h_and_big_h_are_derivatives(oracles: dict[str, Oracle]) -> None:
    oracle = oracles["sdcom"]
    for index in POINTS:
        result = values(oracle, sample(oracle.model, 3, index))
        for suffix, row in ROW_OF.items():
            assert result[f"H_{suffix}"] == result[f"jacobians.state.{row}.alpha"]
            for i in range(3):
                expected = result[f"jacobians.state.{row}.chi_{i + 1}"]
                assert abs(result[f"h_{suffix}.{i}"] - expected) <= mpmath.mpf("1e-45") * abs(expected)
        assert abs(result["H_alpha"] + result["H_gamma"]) <= mpmath.mpf("1e-45") * abs(result["H_alpha"])
        assert result["g_Q_total"] == result["jacobians.input.pitch_rate.delta_e"]
        assert result["g_alpha"] == 1


def test_g_is_the_coefficient_and_not_the_derivative(oracles: dict[str, Oracle]) -> None:
    """With all that is nonlinear in the drive switched off, g is the paper's (28), (30) and (33)."""
    oracle = oracles["sdcom"]
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            p: Values = {k: mpmath.mpf(x) for k, x in sample(oracle.model, 4, index).items()}
            c = {k.removeprefix("parameter."): x for k, x in p.items()}
            alpha, phi, speed = p["state.alpha"], p["input.phi"], p["state.velocity"]
            density = c["rho_0"] * mpmath.exp((c["h_0"] - p["state.altitude"]) / c["h_s"])
            force = density * speed**2 / 2 * c["s"]
            slope = sum(c["c_t_phi" + tail] * alpha**n for n, tail in enumerate(POWERS))
            turn = c["c_l_alpha"] + mpmath.sin(alpha) * (c["c_t_phi_alpha"] * phi + c["c_t_alpha"])
            ratio = c["canard_slaving"] * c["c_l_delta_e"] / c["c_l_delta_c"]
            pitch = c["c_bar"] * (c["c_m_delta_e"] - ratio * c["c_m_delta_c"])
            expected = {
                "g_V": force / c["m"] * mpmath.cos(alpha) * slope,
                "g_gamma": force / (c["m"] * speed) * turn,
                "g_Q": force / c["i_yy"] * pitch,
            }
            result = oracle.evaluate(p)
            for label, value in expected.items():
                assert abs(result[label][0] - value) <= mpmath.mpf("1e-45") * result[label][1], label


def test_chi_is_the_ornstein_uhlenbeck_process_of_the_paper(oracles: dict[str, Oracle]) -> None:
    """Equation (23): a = zeta omega, b = zeta sigma / omega, and the drift holds its chi."""
    oracle = oracles["sdcom"]
    point = level_flight(oracle) | {"state.chi_1": 0.5}
    result = values(oracle, point)
    assert float(result["drift.chi_1"]) == pytest.approx(-0.7 * 19.7437 * 0.5)
    assert float(result["diffusion.chi_1.xi_1"]) == pytest.approx(0.7 * 17 / 19.7437)
    assert float(result["diffusion.chi_3.xi_3"]) == pytest.approx(0.5 * 10 / 94.8203)


def test_noise_increment_is_diffusion_times_increments(oracles: dict[str, Oracle]) -> None:
    oracle = oracles["sdcom"]
    assert {f"diffusion.chi_{i}.xi_{i}" for i in (1, 2, 3)} <= set(oracle.labels)
    assert "diffusion.altitude.w_gamma" in oracle.labels
    with mpmath.workdps(DIGITS):
        for index in POINTS:
            point = sample(oracle.model, 6, index)
            result = oracle.evaluate(point)
            for row in oracle.model.states:
                total = mpmath.mpf(0)
                for noise in oracle.model.noises:
                    entry = result.get(f"diffusion.{row}.{noise}", (0, 0))[0]
                    total += entry * mpmath.mpf(point[f"noise.{noise}"])
                assert_close(total, result[f"noise_increment.{row}"], row)


@pytest.mark.parametrize("model", TABLE_OF)
def test_k_bounds_the_value(oracles: dict[str, Oracle], model: str) -> None:
    oracle = oracles[model]
    for index in POINTS:
        for label, (value, magnitude) in oracle.evaluate(sample(oracle.model, 7, index)).items():
            assert abs(value) <= magnitude * (1 + 1e-12), label


def test_k_is_the_sum_of_absolute_summands(oracles: dict[str, Oracle]) -> None:
    oracle = oracles["com"]
    point = sample(oracle.model, 8, 0) | {"parameter.spherical_earth": 0.0}
    p = {k.partition(".")[2]: abs(x) for k, x in point.items()}
    sine = abs(mpmath.sin(point["state.gamma"]))
    assert float(oracle.evaluate(point)["drift.altitude"][1]) == pytest.approx(float(p["velocity"] * sine))
    density = p["rho_0"] * mpmath.exp((point["parameter.h_0"] - point["state.altitude"]) / point["parameter.h_s"])
    force = density * p["velocity"] ** 2 / 2 * p["s"]
    drag = p["c_d_alpha_2"] * p["alpha"] ** 2 + p["c_d_alpha"] * p["alpha"] + p["c_d_0"]
    drag += p["c_d_delta_e_2"] * p["delta_e"] ** 2 + p["c_d_delta_e"] * p["delta_e"]
    thrust = sum(
        (p["t_phi" + tail] * p["phi"] + p["t" + (tail or "_0")]) * p["alpha"] ** n for n, tail in enumerate(POWERS)
    )
    cosine = abs(mpmath.cos(point["state.alpha"]))
    expected = (thrust * cosine + force * drag) / p["m"] + p["g"] * sine
    assert float(oracle.evaluate(point)["drift.velocity"][1]) == pytest.approx(float(expected))


def test_sampling_ignores_coefficient_values(tmp_path: Path) -> None:
    text = TABLES["dcom"].read_text(encoding="utf-8")
    changed = tmp_path / "dcom.toml"
    changed.write_text(text.replace("4.6773", "0.0").replace("300.0", "17.0"), encoding="utf-8")
    assert load_table(changed).values["c_l_alpha"] == 0.0
    lines = []
    for table in (TABLES["dcom"], changed):
        write_vectors(Oracle(table, "sdcom"), 3, 9, tmp_path / "out.txt")
        lines.append((tmp_path / "out.txt").read_text(encoding="utf-8"))
    assert lines[0] == lines[1]


def test_a_new_coefficient_moves_no_other_draw(oracles: dict[str, Oracle], tmp_path: Path) -> None:
    text = TABLES["dcom"].read_text(encoding="utf-8")
    longer = tmp_path / "dcom.toml"
    entry = '"alpha*delta_c^2" = { value = 0.1, unit = "1/rad^3" }'
    longer.write_text(text.replace("[C_L]", f"[C_L]\n{entry}"), encoding="utf-8")
    oracle = Oracle(longer, "sdcom")
    point = sample(oracle.model, 10, 0)
    assert point.pop("parameter.c_l_alpha_delta_c_2") != 0
    assert point == sample(oracles["sdcom"].model, 10, 0)
    residuals = oracle.identity_residuals(sample(oracle.model, 10, 0))
    assert all(abs(residual) < mpmath.mpf("1e-45") for residual in residuals.values())


def test_sampling_keeps_to_the_box_and_includes_zeros(oracles: dict[str, Oracle]) -> None:
    oracle = oracles["dcom"]
    points = [sample(oracle.model, 11, index) for index in range(400)]
    for name in ("velocity", "altitude", "gamma", "alpha", "pitch_rate"):
        low, high = oracle.table.validity[name]
        drawn = [point[f"state.{name}"] for point in points]
        assert all(low <= x <= high for x in drawn)
        assert 0.01 < drawn.count(0.0) / len(drawn) < 0.1 or low > 0.0
    assert all(point["state.velocity"] and point["parameter.c_l_delta_c"] for point in points)
    slaving = [point["parameter.canard_slaving"] for point in points]
    assert {0.0, 1.0} <= set(slaving)
    assert any(0 < x < 1 for x in slaving)
    assert all(float(f"{x:.7g}") == x for point in points for x in point.values())


def test_an_exact_zero_is_written_as_zero(oracles: dict[str, Oracle]) -> None:
    oracle = oracles["dcom"]
    point = sample(oracle.model, 12, 0) | {"parameter.canard_slaving": 1.0}
    point |= {name: 0.0 for name in oracle.names if name.startswith("parameter.c_t_")}
    point |= {name: 0.0 for name in oracle.names if "_l_eta_" in name}
    assert values(oracle, point)["jacobians.input.gamma.delta_e"] == 0


def test_command_line_is_deterministic(tmp_path: Path) -> None:
    texts = []
    for hash_seed in ("1", "2"):
        out = tmp_path / hash_seed
        command = [sys.executable, "-m", "ahv_oracle", "vectors", "--table", str(TABLES["com"])]
        command += ["--model", "com", "--points", "5", "--seed", "13", "--out", str(out)]
        environment = {"PYTHONPATH": str(GENERATOR), "PYTHONHASHSEED": hash_seed}
        subprocess.run(command, check=True, env=environment)
        texts.append(out.read_text(encoding="utf-8"))
    assert texts[0] == texts[1]
    comment, header, *rows = texts[0].splitlines()
    assert comment.startswith("# ahv reference vectors, model com,")
    inputs, outputs = (part.split(",") for part in header.split("|"))
    assert inputs[0] == "state.velocity"
    assert outputs[0] == "drift.velocity"
    assert len(rows) == 5
    for row in rows:
        numbers, triples = (part.split(",") for part in row.split("|"))
        assert len(numbers) == len(inputs)
        assert len(triples) == len(outputs)
        assert all(len(triple.split(";")) == 3 for triple in triples)


def test_a_failed_run_leaves_no_file(oracles: dict[str, Oracle], tmp_path: Path) -> None:
    table = dataclasses.replace(oracles["com"].table, validity={})
    with pytest.raises(ValueError, match=r"validity\.velocity is missing"):
        write_vectors(Oracle(table, "com"), 1, 1, tmp_path / "out.txt")
    assert list(tmp_path.iterdir()) == []
