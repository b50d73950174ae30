"""The derivation: byte-identical output, values kept out of it, and agreement with the oracle."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import casadi as ca
import mpmath
import pytest
from oracle_support import TABLE_OF

from ahv_generator import audit, ir
from ahv_generator import derive as derive_module
from ahv_generator.__main__ import main
from ahv_generator.diagnostics import TableError
from ahv_generator.expression import ExpressionError
from ahv_generator.reference import columns, expanded, labels
from ahv_generator.table import load
from ahv_oracle import Oracle, sample

GENERATOR = Path(__file__).parents[1]
TABLES = GENERATOR / "tables"
NAMES = ("com", "dcom", "flexible_mode")


def derive(out: Path, hash_seed: str) -> dict[str, bytes]:
    out.mkdir()
    command = [sys.executable, "-m", "ahv_generator", "derive", "--out", str(out)]
    tables = [str(TABLES / f"{name}.toml") for name in NAMES]
    environment = os.environ | {"PYTHONHASHSEED": hash_seed, "PYTHONPATH": str(GENERATOR)}
    subprocess.run(command + tables, check=True, env=environment)
    return {path.name: path.read_bytes() for path in out.iterdir()}


def test_ir_is_byte_identical_whatever_the_hash_seed(tmp_path: Path) -> None:
    runs = [derive(tmp_path / seed, seed) for seed in ("0", "1", "4242")]
    assert sorted(runs[0]) == ["audit.json", *(f"{name}.json" for name in NAMES)]
    assert runs[0] == runs[1] == runs[2]


def test_what_is_known_is_not_derived_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tables = [str(TABLES / f"{name}.toml") for name in NAMES]
    options = ["--out", str(tmp_path), "--known", "dcom", "--known", "com", "--audit-known"]
    monkeypatch.setattr(sys, "argv", ["ahv_generator", "derive", *options, *tables])
    assert main() == 0
    found = {path.name: path.read_text(encoding="utf-8") for path in tmp_path.iterdir()}
    table = load(TABLES / "flexible_mode.toml")
    # That there is to be an audit is said for a table that is known, too.
    assert found == {"flexible_mode.json": ir.render(table, table.build()), "audit.json": ""}


def test_one_process_derives_the_same_as_many(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tables = [load(TABLES / f"{name}.toml") for name in NAMES]
    many = derive_module.derive(tables)
    monkeypatch.setattr(derive_module, "ProcessPoolExecutor", unavailable)
    assert derive_module.derive(tables) == many


@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")
def test_no_process_outlives_a_derivation_that_is_killed(tmp_path: Path) -> None:
    tables = [str(TABLES / f"{name}.toml") for name in NAMES]
    command = [sys.executable, "-m", "ahv_generator", "derive", "--out", str(tmp_path), *tables]
    main_process = subprocess.Popen(command, cwd=GENERATOR, stderr=subprocess.DEVNULL)
    children = Path(f"/proc/{main_process.pid}/task/{main_process.pid}/children")
    workers: list[str] = []
    while not workers and main_process.poll() is None:
        workers = children.read_text(encoding="ascii").split()
    main_process.kill()
    main_process.wait()
    # With one processor there are none.
    wait_for(lambda: not any(is_running(worker) for worker in workers))


def is_running(process: str) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def wait_for(done: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 30
    while not done():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def unavailable(*_: object, **__: object) -> None:
    raise NotImplementedError("this platform lacks a functioning sem_open implementation")


def broken(*_: object) -> str:
    raise OverflowError("too large")


def test_a_derivation_that_breaks_down_is_a_fault_of_its_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["derive", "--out", str(tmp_path), str(TABLES / "com.toml")]
    monkeypatch.setattr(sys, "argv", ["ahv_generator", *arguments])
    monkeypatch.setattr(ir, "part", broken)
    assert main() == 2
    (fault,) = json.loads(capsys.readouterr().out)["diagnostics"]
    assert (fault["file"], fault["path"], fault["part"]) == ("com.toml", ["table", "models"], "value")
    assert "OverflowError: too large (test_derivation.py, line " in fault["message"]


def test_no_exception_leaves_as_a_traceback(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "dcom.toml"
    table.write_text((TABLES / "dcom.toml").read_text(encoding="utf-8"), encoding="utf-8")
    monkeypatch.setattr(sys, "argv", ["ahv_generator", "derive", "--out", str(tmp_path), str(table)])
    monkeypatch.setattr(ir, "part", lambda _: ir.Part("", frozenset(), frozenset()))
    monkeypatch.setattr(audit, "render", broken)
    assert main() == 1
    assert re.fullmatch(r"error: OverflowError: too large \(.*\)\n", capsys.readouterr().err)


@pytest.mark.parametrize("value", ["1e308", "-1e308", "1e-320", "9223372036854775807"])
@pytest.mark.parametrize("name", NAMES)
def test_no_value_is_too_much_for_the_checks(tmp_path: Path, name: str, value: str) -> None:
    text = (TABLES / f"{name}.toml").read_text(encoding="utf-8")
    path = tmp_path / f"{name}.toml"
    for place in re.finditer(r"(?<=value = )[-+.\de]+", text):
        path.write_text(text[: place.start()] + value + text[place.end() :], encoding="utf-8")
        try:
            load(path)
        except TableError:
            pass


def test_a_monomial_of_the_highest_degree_has_all_its_derivatives(tmp_path: Path) -> None:
    text = (TABLES / "com.toml").read_text(encoding="utf-8")
    path = tmp_path / "com.toml"
    monomial = '"alpha^5*delta_e^4" = { value = 1.0, unit = "1/rad^9" }'
    path.write_text(re.sub(r"(?m)^(\[C_[LDM]\])$", rf"\1\n{monomial}", text), encoding="utf-8")
    table = load(path)
    text = ir.render(table, table.build())
    assert "c_m_alpha_5_delta_e_4" in text


def test_a_value_does_not_reach_the_ir(tmp_path: Path) -> None:
    text = (TABLES / "dcom.toml").read_text(encoding="utf-8")
    changed = tmp_path / "dcom.toml"
    changed.write_text(text.replace("value = 4.6773", "value = 0.0"), encoding="utf-8")

    def render(path: Path) -> str:
        table = load(path)
        return ir.render(table, table.build())

    assert render(changed) == render(TABLES / "dcom.toml")


@pytest.mark.parametrize("name", TABLE_OF)
def test_casadi_agrees_with_the_oracle(name: str) -> None:
    path = TABLES / f"{TABLE_OF[name]}.toml"
    model = load(path).model(name)
    oracle = Oracle(path, name)
    function, order, outputs = expanded(model), columns(model), labels(model)
    assert set(outputs) <= set(oracle.labels), set(outputs) - set(oracle.labels)
    for index in range(12):
        point = sample(oracle.model, 7, index)
        values = function.call([ca.DM(point[column]) for column in order])
        reference = oracle.evaluate(point)
        # What is not derived is a structural zero.
        assert not [label for label in set(oracle.labels) - set(outputs) if reference[label][0] != 0]
        for label, value in zip(outputs, values, strict=True):
            exact, magnitude = reference[label]
            if not mpmath.isnan(exact):  # outside the domain of a function of one damping regime
                assert abs(float(value) - exact) <= 8 * 2.0**-52 * magnitude, f"{name} {label} at point {index}"


def test_new_monomials_reach_the_split(tmp_path: Path) -> None:
    """Powers and cross terms of the canard, which (4) moves with the elevator, keep the sum of the parts whole."""
    text = (TABLES / "dcom.toml").read_text(encoding="utf-8")
    extra = (
        '[C_M]\n"delta_c^2" = { value = 0.3, unit = "1/rad^2" }\n'
        '"alpha*delta_c" = { value = 0.2, unit = "1/rad^2" }\n'
        '"delta_e^2" = { value = -0.4, unit = "1/rad^2" }\n'
        '"alpha*eta_1" = { value = 0.01, unit = "1/rad/(ft*slug)^0.5" }\n'
    )
    path = tmp_path / "dcom.toml"
    path.write_text(text.replace("[C_M]\n", extra), encoding="utf-8")
    model = load(path).model("sdcom")
    oracle = Oracle(path, "sdcom")
    function, order, outputs = expanded(model), columns(model), labels(model)
    for index in range(20):
        point = sample(oracle.model, 11, index)
        found = function.call([ca.DM(point[column]) for column in order])
        values = dict(zip(outputs, (float(v) for v in found), strict=True))
        reference = oracle.evaluate(point)
        for label in ("f_Q", "g_Q", "f_Q_eta", "h_Q.0", "drift.pitch_rate", "g_Q_total"):
            exact, magnitude = reference[label]
            assert abs(values[label] - exact) <= 8 * 2.0**-52 * magnitude, f"{label} at point {index}"


def test_a_wrong_unit_in_the_derivation_is_refused() -> None:
    model = load(TABLES / "com.toml").model("com")
    with pytest.raises(ExpressionError, match="declared in"):
        model.define("wrong", model["lift"] * 2, "", "ft/s", "a speed")
    with pytest.raises(ExpressionError, match="unlike dimensions"):
        model.define("sum", model["lift"] + model["velocity"], "", "lb/ft", "a force")


def test_a_polynomial_may_have_many_terms(tmp_path: Path) -> None:
    """The depth of the IR does not grow with the number of monomials."""
    monomials = [f"alpha^{a}*delta_e^{e}*delta_c^{c}" for a in range(1, 6) for e in range(1, 6) for c in range(1, 5)]
    entries = "".join(
        f'"{m}" = {{ value = 0.1, unit = "1/rad^{sum(int(p[-1]) for p in m.split("*"))}" }}\n'
        for m in monomials
        if sum(int(p[-1]) for p in m.split("*")) <= 9
    )
    text = (TABLES / "dcom.toml").read_text(encoding="utf-8")
    path = tmp_path / "dcom.toml"
    path.write_text(text.replace("[C_M]\n", f"[C_M]\n{entries}"), encoding="utf-8")
    table = load(path)
    assert len(table.polynomials["C_M"].terms) > 60
    text = ir.render(table, table.build())
    depth = deepest = 0
    for character in text:
        depth += (character in "[{") - (character in "]}")
        deepest = max(deepest, depth)
    assert deepest < 60
