"""`[emit]`: a table says which groups of functions are emitted."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from ahv_generator.derive import derive
from ahv_generator.diagnostics import Diagnostic, TableError
from ahv_generator.emit import NEEDED
from ahv_generator.table import load

TABLES = Path(__file__).parents[1] / "tables"
MODE = (TABLES / "flexible_mode.toml").read_text(encoding="utf-8")
CALM = ("drift", "jacobians", "parameter_jacobian", "outputs")


def document(folder: Path, emit: str) -> dict[str, object]:
    path = folder / "flexible_mode.toml"
    path.write_text(MODE.replace("[validity]", f"{emit}\n[validity]", 1), encoding="utf-8")
    return dict(json.loads(derive([load(path)])["flexible_mode"]))


def faults(folder: Path, emit: str) -> list[Diagnostic]:
    with pytest.raises(TableError) as caught:
        document(folder, emit)
    return caught.value.diagnostics


def listed(*groups: str) -> str:
    return f"[emit]\nfunctions = {json.dumps(groups)}"


def groups(found: dict[str, object]) -> set[str]:
    models = found["models"]
    assert isinstance(models, list)
    return {function["group"] for model in models for function in model["functions"]}


def names(found: dict[str, object]) -> list[str]:
    models = found["models"]
    assert isinstance(models, list)
    return [quantity["name"] for model in models for quantity in model["quantities"]]


def test_all_groups_are_emitted_without_it(tmp_path: Path) -> None:
    assert {"hessian", "moments", *NEEDED} <= groups(document(tmp_path, ""))


def test_what_is_not_listed_is_left_out_with_what_only_it_uses(tmp_path: Path) -> None:
    whole, narrow = document(tmp_path, ""), document(tmp_path, listed(*NEEDED))
    assert groups(narrow) == set(NEEDED)
    assert set(names(narrow)) < set(names(whole))
    assert len(json.dumps(narrow)) < 0.8 * len(json.dumps(whole))


def test_an_unknown_group_is_refused_at_its_place(tmp_path: Path) -> None:
    (fault,) = faults(tmp_path, listed(*NEEDED, "hesian"))
    assert (fault.rule, fault.path, fault.help) == ("unknown-group", ("emit", "functions"), "did you mean `hessian`?")


def test_what_every_program_needs_cannot_be_left_out(tmp_path: Path) -> None:
    (fault,) = faults(tmp_path, listed("drift", "jacobians"))
    assert (fault.rule, fault.path) == ("needed-group", ("emit", "functions"))
    assert "`parameter_jacobian`, `outputs`, `diffusion`, `noise_derivatives`" in fault.message
    assert fault.help is not None
    assert fault.help.startswith(f"always there: {', '.join(NEEDED)}; what may be left out: ")


@pytest.mark.parametrize("emit", ["[emit]", "[emit]\nfunctions = 3", "[emit]\nfunctions = [3]", "emit = 3"])
def test_the_shape_is_checked(tmp_path: Path, emit: str) -> None:
    text = MODE.replace("[validity]", f"{emit}\n[validity]", 1) if "[" in emit[:1] else f"{emit}\n{MODE}"
    path = tmp_path / "flexible_mode.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load(path)
    assert all(fault.rule == "shape" and fault.path[0] == "emit" for fault in caught.value.diagnostics)


def test_a_model_without_noise_needs_no_noise(tmp_path: Path) -> None:
    path = tmp_path / "van_der_pol.toml"
    example = Path(__file__).parents[2] / "examples" / "van-der-pol"
    text = (example / "van_der_pol.toml").read_text(encoding="utf-8")
    path.write_text(text.replace("[validity]", f"{listed(*CALM)}\n[validity]", 1), encoding="utf-8")
    (tmp_path / "van_der_pol.py").write_bytes((example / "van_der_pol.py").read_bytes())
    assert groups(json.loads(derive([load(path)])["van_der_pol"])) == set(CALM)


def test_a_name_that_no_file_can_have_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "flexible_mode.toml"
    path.write_text(MODE.replace('name = "flexible_mode"', f'name = "{"a" * 300}"'), encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load(path)
    (fault,) = caught.value.diagnostics
    assert (fault.rule, fault.path) == ("table-name", ("table", "name"))
    assert "300 letters" in fault.message
