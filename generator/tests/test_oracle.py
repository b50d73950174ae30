"""The independent oracle against the literature's trims, and against its own definitions."""

import dataclasses
import subprocess
import sys
from pathlib import Path

import mpmath
import pytest
from oracle_support import (
    GENERATOR,
    ROW_OF,
    TABLE_OF,
    TABLES,
    Values,
    assert_close,
    level_flight,
    oracle_of,
    trim,
    values,
)

from ahv_oracle import Number, Oracle, Table, TableError, load_table, sample, write_vectors
from ahv_oracle.evaluate import DIGITS
from ahv_oracle.table import Term

DEGREE = mpmath.pi / 180
POINTS = range(10)
POWERS = ("", "_alpha", "_alpha_2", "_alpha_3")


def shown(point: Values, name: str) -> float:
    return float(point[name] / DEGREE)


def poles(oracle: Oracle, point: Values) -> list[Number]:
    result, states = values(oracle, point), oracle.model.states
    matrix = mpmath.matrix(len(states))
    for i, row in enumerate(states):
        for j, column in enumerate(states):
            matrix[i, j] = result.get(f"jacobians.state.{row}.{column}", 0)
    return list(mpmath.eig(matrix, left=False, right=False))


def test_rigid_com_trims_where_science_says() -> None:
    point = trim(oracle_of("com_rigid"), level_flight(oracle_of("com_rigid")))
    assert shown(point, "state.alpha") == pytest.approx(1.64457, abs=5.1e-6)
    assert float(point["input.phi"]) == pytest.approx(0.26809, abs=5.1e-6)
    assert shown(point, "input.delta_e") == pytest.approx(12.53998, abs=5.1e-6)
    real = [float(pole.real) for pole in poles(oracle_of("com_rigid"), point)]
    assert max(real) == pytest.approx(1.694, abs=5.1e-4)
    assert min(real) == pytest.approx(-1.764, abs=5.1e-4)


def test_rigid_com_trims_where_science_says_on_the_spherical_earth() -> None:
    point = trim(oracle_of("com_rigid"), level_flight(oracle_of("com_rigid"), spherical_earth=1.0))
    assert shown(point, "state.alpha") == pytest.approx(1.4056, abs=5.1e-5)
    assert float(point["input.phi"]) == pytest.approx(0.2505, abs=5.1e-5)
    assert shown(point, "input.delta_e") == pytest.approx(11.984, abs=5.1e-4)


SLAVING = {0.0: (1.5018, 0.2821, 13.1006), 1.0: (3.6558, 0.2957, 7.1364)}


@pytest.mark.parametrize("slaving", SLAVING)
def test_dcom_and_sdcom_trim_where_science_says(slaving: float) -> None:
    names = ("state.alpha", "input.phi", "input.delta_e")
    dcom, sdcom = (
        trim(oracle_of(model), level_flight(oracle_of(model), canard_slaving=slaving)) for model in ("dcom", "sdcom")
    )
    found = (shown(dcom, names[0]), float(dcom[names[1]]), shown(dcom, names[2]))
    assert found == pytest.approx(SLAVING[slaving], abs=5.1e-5)
    assert all(abs(dcom[name] - sdcom[name]) < mpmath.mpf("1e-30") for name in names)
    if slaving == 0.0:
        eta = [float(dcom[f"state.eta_{i}"]) for i in (1, 2, 3)]
        assert eta == pytest.approx([0.6276, -0.0137, -0.0372], abs=5.1e-5)


def test_dcom_poles_with_the_lightly_damped_modes() -> None:
    modal = {"omega_1": 20.5, "omega_2": 52.5, "omega_3": 105.0} | {f"zeta_{i}": 0.02 for i in (1, 2, 3)}
    point = trim(oracle_of("dcom"), level_flight(oracle_of("dcom"), **modal))
    assert shown(point, "state.alpha") == pytest.approx(1.5115, abs=5.1e-5)
    assert float(point["input.phi"]) == pytest.approx(0.2811, abs=5.1e-5)
    assert shown(point, "input.delta_e") == pytest.approx(13.063, abs=5.1e-4)
    found = poles(oracle_of("dcom"), point)
    real = [float(pole.real) for pole in found if abs(pole.imag) < 1e-9]
    assert min(real) == pytest.approx(-1.742, abs=5.1e-4)
    assert max(real) == pytest.approx(1.673, abs=6e-4)  # 1.67248; the note rounds it up
    flexible = sorted((float(pole.imag), float(pole.real)) for pole in found if pole.imag > 1)
    assert flexible == [pytest.approx(pair, abs=0.1) for pair in ((20.5, -0.41), (52.5, -1.05), (105, -2.1))]


def test_dcom_with_the_parameters_of_section_5_3() -> None:
    """Its own mass and modes; what the note checked for that set."""
    oracle = oracle_of("dcom", "drift", "jacobians")
    table = load_table(TABLES["dcom"], set="section5.3")
    assert (table.values["m"], table.values["zeta_3"], table.values["s"]) == (191.3, 0.02, 17.0)
    point = trim(oracle, level_flight(oracle, **table.values))
    assert shown(point, "state.alpha") == pytest.approx(0.606, abs=5.1e-4)
    assert float(point["input.phi"]) == pytest.approx(0.2216, abs=5.1e-5)
    assert shown(point, "input.delta_e") == pytest.approx(10.996, abs=5.1e-4)
    real = [float(pole.real) for pole in poles(oracle, point)]
    assert min(real) == pytest.approx(-3.9694, abs=5.1e-5)
    assert max(real) == pytest.approx(3.8612, abs=5.1e-5)


def test_sdcom_is_dcom_at_the_reduced_deflections() -> None:
    """Equation (25), with N_i read off DCOM's own modes; also what f_eta is made of."""
    dcom, sdcom = oracle_of("dcom"), oracle_of("sdcom")
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


def test_strict_feedback_sum_is_the_drift() -> None:
    oracle = oracle_of("sdcom")
    for index in POINTS:
        residuals = oracle.identity_residuals(sample(oracle.model, 2, index))
        assert set(residuals) == {"V", "gamma", "alpha", "Q"}
        assert all(abs(residual) < mpmath.mpf("1e-45") for residual in residuals.values())


def test_h_and_big_h_are_derivatives() -> None:
    oracle = oracle_of("sdcom")
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


def test_g_is_the_coefficient_and_not_the_derivative() -> None:
    """With all that is nonlinear in the drive switched off, g is the paper's (28), (30) and (33)."""
    oracle = oracle_of("sdcom")
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


def test_chi_is_the_ornstein_uhlenbeck_process_of_the_paper() -> None:
    """Equation (23): a = zeta omega, b = zeta sigma / omega, and the drift holds its chi."""
    oracle = oracle_of("sdcom")
    point = level_flight(oracle) | {"state.chi_1": 0.5}
    result = values(oracle, point)
    assert float(result["drift.chi_1"]) == pytest.approx(-0.7 * 19.7437 * 0.5)
    assert float(result["diffusion.chi_1.xi_1"]) == pytest.approx(0.7 * 17 / 19.7437)
    assert float(result["diffusion.chi_3.xi_3"]) == pytest.approx(0.5 * 10 / 94.8203)


@pytest.mark.parametrize("model", TABLE_OF)
def test_k_bounds_the_value(model: str) -> None:
    oracle = oracle_of(model)
    for index in POINTS:
        for label, (value, magnitude) in oracle.evaluate(sample(oracle.model, 7, index)).items():
            assert mpmath.isnan(value) or abs(value) <= magnitude * (1 + 1e-12), label


def test_k_is_the_sum_of_absolute_summands() -> None:
    oracle = oracle_of("com_rigid")
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


def test_a_new_coefficient_moves_no_other_draw(tmp_path: Path) -> None:
    text = TABLES["dcom"].read_text(encoding="utf-8")
    longer = tmp_path / "dcom.toml"
    entry = '"alpha*delta_c^2" = { value = 0.1, unit = "1/rad^3" }'
    longer.write_text(text.replace("[C_L]", f"[C_L]\n{entry}"), encoding="utf-8")
    oracle = Oracle(longer, "sdcom")
    point = sample(oracle.model, 10, 0)
    assert point.pop("parameter.c_l_alpha_delta_c_2") != 0
    assert point == sample(oracle_of("sdcom").model, 10, 0)
    residuals = oracle.identity_residuals(sample(oracle.model, 10, 0))
    assert all(abs(residual) < mpmath.mpf("1e-45") for residual in residuals.values())


def test_sampling_keeps_to_the_box_and_includes_zeros() -> None:
    oracle = oracle_of("dcom")
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


def test_sampling_of_reductions_couplings_and_arguments() -> None:
    kinds = set()
    for index in range(60):
        point = sample(oracle_of("sdcom").model, 15, index)
        pair = (point["parameter.variance_matching"], point["parameter.moment_matching"])
        assert 0.0 in pair
        kinds.add(tuple(0 if x == 0 else 1 if x == 1 else 0.5 for x in pair))
        point = sample(oracle_of("com").model, 15, index)
        coupling = sum(point[f"parameter.psi_{i}"] ** 2 for i in (1, 2))
        assert 0 < coupling < 0.6 * point["parameter.i_yy"]
        point = sample(oracle_of("flexible_mode").model, 15, index)
        assert 0.1 <= point["argument.frequency"] <= 300.0
        assert point["argument.time"] == 0.0 or 1e-3 <= point["argument.time"] <= 2.0
    assert kinds == {(0, 0), (0, 0.5), (0, 1), (0.5, 0), (1, 0)}


SIZES = [("com", 1), ("com", 4), ("dcom", 1), ("sdcom", 1), ("sdcom", 9), ("sdcom_printed", 1), ("sdcom_gust", 1)]


@pytest.mark.parametrize(("model", "count"), SIZES)
def test_any_number_of_modes(model: str, count: int) -> None:
    """The terms of each mode are those of mode 1."""
    oracle = Oracle(modes_like_the_first(oracle_of(model).table, count), model)
    point = sample(oracle.model, 16, 0)
    result = values(oracle, dict(point))
    assert f"drift.{'eta_dot' if model in ('com', 'dcom') else 'chi'}_{count}" in result
    if model in ("sdcom", "sdcom_printed"):
        residuals = oracle.identity_residuals(point)
        assert all(abs(residual) < mpmath.mpf("1e-45") for residual in residuals.values())


def modes_like_the_first(table: Table, count: int) -> Table:
    modes = range(1, count + 1)
    forces = "C_N" if "C_N_1" in table.quantities else "N"
    quantities: dict[str, tuple[Term, ...]] = {}
    for quantity, terms in table.quantities.items():
        if not quantity.startswith(forces):
            plain = [term for term in terms if not any(name.startswith("eta") for name, _ in term.powers)]
            etas = [Term(f"{quantity.lower()}_eta_{i}", ((f"eta_{i}", 1),)) for i in modes]
            quantities[quantity] = (*plain, *etas)
    for i in modes:
        terms = table.quantities[f"{forces}_1"]
        quantities[f"{forces}_{i}"] = tuple(Term(t.parameter.replace("n_1", f"n_{i}"), t.powers) for t in terms)
    modal = ("omega", "zeta", "psi" if forces == "N" else "sigma")
    kept = {name: x for name, x in table.values.items() if not name.startswith((*modal, forces.lower()))}
    kept = {name: x for name, x in kept.items() if "_eta_" not in name}
    kept |= {f"{name}_{i}": 1.0 for name in modal for i in modes}
    kept |= {term.parameter: 1.0 for terms in quantities.values() for term in terms}
    return dataclasses.replace(table, values=kept, quantities=quantities)


def test_what_a_table_lacks_is_named() -> None:
    table = oracle_of("dcom").table
    values_without = {name: value for name, value in table.values.items() if name != "canard_command"}
    with pytest.raises(TableError, match="no parameter canard_command"):
        Oracle(dataclasses.replace(table, values=values_without), "dcom")
    with pytest.raises(TableError, match="no model 'com'"):
        Oracle(table, "com")
    with pytest.raises(TableError, match="no parameter set 'section9'"):
        load_table(TABLES["dcom"], set="section9")


def test_choices_give_switches_their_values(tmp_path: Path) -> None:
    text = TABLES["dcom"].read_text(encoding="utf-8")
    changed = tmp_path / "dcom.toml"
    for old, new in (("canard", "slaved"), ("earth", "spherical"), ("noise", "shared"), ("reduction", "moment")):
        line = next(line for line in text.splitlines() if line.startswith(f"{old} ="))
        text = text.replace(line, f'{old} = "{new}"')
    changed.write_text(text, encoding="utf-8")
    table = load_table(changed)
    switches = {"canard_command": 0, "canard_slaving": 1, "spherical_earth": 1, "shared_noise": 1}
    switches |= {"variance_matching": 0, "moment_matching": 1}
    assert {name: table.values[name] for name in switches} == switches
    changed.write_text(text.replace('"spherical"', '"hollow"'), encoding="utf-8")
    with pytest.raises(TableError, match="'hollow' is none of flat, spherical"):
        load_table(changed)


def test_only_some_functions(tmp_path: Path) -> None:
    oracle, whole = oracle_of("sdcom", "drift", "h_V"), oracle_of("sdcom")
    point = sample(oracle.model, 17, 0)
    result, expected = oracle.evaluate(point), whole.evaluate(point)
    assert list(result) == [f"drift.{row}" for row in oracle.model.states] + [f"h_V.{i}" for i in range(3)]
    assert all(result[label] == expected[label] for label in result)
    write_vectors(oracle, 1, 17, tmp_path / "out.txt")
    assert ", functions drift h_V;" in (tmp_path / "out.txt").read_text(encoding="utf-8").splitlines()[0]
    with pytest.raises(ValueError, match="no function 'drft'"):
        Oracle(oracle.table, "sdcom", ["drft"])


def test_an_exact_zero_is_written_as_zero() -> None:
    oracle = oracle_of("dcom")
    point = sample(oracle.model, 12, 0) | {"parameter.canard_slaving": 1.0}
    point |= {name: 0.0 for name in oracle.names if name.startswith("parameter.c_t_")}
    point |= {name: 0.0 for name in oracle.names if "_l_eta_" in name}
    assert values(oracle, point)["jacobians.input.gamma.delta_e"] == 0


def test_command_line_is_deterministic(tmp_path: Path) -> None:
    texts = []
    for hash_seed in ("1", "2"):
        out = tmp_path / hash_seed
        command = [sys.executable, "-m", "ahv_oracle", "vectors", "--table", str(TABLES["com"])]
        command += ["--model", "com_rigid", "--points", "5", "--seed", "13", "--out", str(out)]
        environment = {"PYTHONPATH": str(GENERATOR), "PYTHONHASHSEED": hash_seed}
        subprocess.run(command, check=True, env=environment)
        texts.append(out.read_text(encoding="utf-8"))
    assert texts[0] == texts[1]
    comment, header, *rows = texts[0].splitlines()
    assert comment.startswith("# ahv reference vectors, model com_rigid,")
    inputs, outputs = (part.split(",") for part in header.split("|"))
    assert inputs[0] == "state.velocity"
    assert outputs[0] == "drift.velocity"
    assert len(rows) == 5
    for row in rows:
        numbers, triples = (part.split(",") for part in row.split("|"))
        assert len(numbers) == len(inputs)
        assert len(triples) == len(outputs)
        assert all(len(triple.split(";")) == 3 for triple in triples)


def test_a_failed_run_leaves_no_file(tmp_path: Path) -> None:
    table = dataclasses.replace(oracle_of("com_rigid").table, validity={})
    with pytest.raises(ValueError, match=r"validity\.velocity is missing"):
        write_vectors(Oracle(table, "com"), 1, 1, tmp_path / "out.txt")
    assert list(tmp_path.iterdir()) == []
