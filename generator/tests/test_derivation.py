"""The derivation: byte-identical output, values kept out of it, and agreement with the oracle."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import casadi as ca
import mpmath
import pytest
from oracle_support import TABLE_OF

from ahv_generator import ir
from ahv_generator.expression import ExpressionError
from ahv_generator.models import BUILDERS
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


def test_a_value_does_not_reach_the_ir(tmp_path: Path) -> None:
    text = (TABLES / "dcom.toml").read_text(encoding="utf-8")
    changed = tmp_path / "dcom.toml"
    changed.write_text(text.replace("value = 4.6773", "value = 0.0"), encoding="utf-8")

    def render(path: Path) -> str:
        table = load(path)
        return ir.render(table, [BUILDERS[name](table) for name in table.models])

    assert render(changed) == render(TABLES / "dcom.toml")


@pytest.mark.parametrize("name", BUILDERS)
def test_casadi_agrees_with_the_oracle(name: str) -> None:
    path = TABLES / f"{TABLE_OF[name]}.toml"
    model = BUILDERS[name](load(path))
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
    model = BUILDERS["sdcom"](load(path))
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
    model = BUILDERS["com"](load(TABLES / "com.toml"))
    with pytest.raises(ExpressionError, match="declared in"):
        model.graph.define("wrong", model["lift"] * 2, symbol="", unit="ft/s", doc="", equation="", section="")
    with pytest.raises(ExpressionError, match="unlike dimensions"):
        model.graph.define(
            "sum", model["lift"] + model["velocity"], symbol="", unit="lb/ft", doc="", equation="", section=""
        )


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
    text = ir.render(table, [BUILDERS[name](table) for name in table.models])
    depth = deepest = 0
    for character in text:
        depth += (character in "[{") - (character in "]}")
        deepest = max(deepest, depth)
    assert deepest < 60
