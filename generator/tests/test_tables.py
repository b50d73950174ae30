"""Faults of a table: each one message, at the key where it stands, with a suggestion where one exists."""

from __future__ import annotations

from pathlib import Path

import pytest

from ahv_generator.diagnostics import Diagnostic, TableError
from ahv_generator.table import load

TABLES = Path(__file__).parents[1] / "tables"


def faults(tmp_path: Path, old: str, new: str, table: str = "dcom") -> list[Diagnostic]:
    text = (TABLES / f"{table}.toml").read_text(encoding="utf-8")
    assert old in text, f"the table has no {old!r}"
    path = tmp_path / f"{table}.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load(path)
    return caught.value.diagnostics


CL_ALPHA = '[C_L]\n"alpha" = { value = 4.6773, unit = "1/rad" }'

CASES = [
    # what is replaced, by what, path, part of the message, part of the help
    ('"alpha" = { value = 4.6773', '"alpah" = { value = 4.6773', ("C_L", "alpah"), "not a variable", "`alpha`"),
    ("[C_L]", "[C_l]", ("C_l",), "unknown section", "`C_L`"),
    (CL_ALPHA, CL_ALPHA.replace("value", "vlaue"), ("C_L", "alpha", "vlaue"), "unknown key", "`value`"),
    (CL_ALPHA, CL_ALPHA.replace(', unit = "1/rad"', ""), ("C_L", "alpha"), "`unit` is missing", None),
    (CL_ALPHA, CL_ALPHA.replace("4.6773", "nan"), ("C_L", "alpha", "value"), "finite", None),
    (CL_ALPHA, CL_ALPHA.replace("4.6773", "inf"), ("C_L", "alpha", "value"), "finite", None),
    (CL_ALPHA, CL_ALPHA.replace("4.6773", '"4.6"'), ("C_L", "alpha", "value"), "number", None),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "1/s"), ("C_L", "alpha", "unit"), "does not fit", "`1/rad`"),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "1/deg"), ("C_L", "alpha", "unit"), "right thing", "`1/rad`"),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "furlong"), ("C_L", "alpha", "unit"), "not a unit", None),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "rad^9**9**9**9"), ("C_L", "alpha", "unit"), "is not a unit", None),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "1/\\nrad"), ("C_L", "alpha", "unit"), "is not a unit", None),
    ('source = "plate"', 'source = ["plate"]', ("C_L", "delta_c", "source"), "unknown source", None),
    ("[C_N_3]", '["C_N_²"]', ("C_N_²",), "unknown section", None),
    ("plate = ", "plate = 3 # ", ("sources", "plate"), "a source is", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"alpha^x"'), ("C_L", "alpha^x"), "not a monomial", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"phi"'), ("C_L", "phi"), "not a variable", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"eta_1*eta_2"'), ("C_L", "eta_1*eta_2"), "affine", None),
    (CL_ALPHA, CL_ALPHA + '\n"delta_e*alpha" = { value = 1.0, unit = "1/rad^2" }\n'
     '"alpha*delta_e" = { value = 1.0, unit = "1/rad^2" }', ("C_L", "alpha*delta_e"), "same monomial", None),
    ("m = { value = 300.0", "mass = { value = 300.0", ("vehicle", "mass"), "unknown key", None),
    ("m = { value = 300.0", "m = { value = -300.0", ("vehicle", "m", "value"), "positive", None),
    ("value = 0.44838", "value = 0.0", ("C_L", "delta_c", "value"), "divides", None),
    ('models = ["dcom", "sdcom"]', 'models = ["dcm"]', ("table", "models"), "unknown model", "`dcom`"),
    ('status = "published"', 'status = "publshed"', ("table", "status"), "unknown status", "`published`"),
    ('source = "plate"', 'source = "plat"', ("C_L", "delta_c", "source"), "unknown source", "`plate`"),
    ("uncertainty = 0.4", "uncertainty = -0.4", ("table", "uncertainty"), "not negative", None),
    ("min = -5.0, max = 5.0", "min = 5.0, max = -5.0", ("validity", "gamma", "min"), "below", None),
    ('gamma = { min = -5.0, max = 5.0, unit = "deg" }', 'gamma = { min = -5.0, max = 5.0, unit = "ft" }',
     ("validity", "gamma", "unit"), "does not fit", None),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "path", "message", "help"), CASES)
def test_fault_is_named_where_it_stands(
    tmp_path: Path, old: str, new: str, path: tuple[str, ...], message: str, help: str | None
) -> None:
    found = [d for d in faults(tmp_path, old, new) if d.path == path]
    assert found, f"no fault at {path}"
    assert any(message in d.message for d in found), [d.message for d in found]
    assert help is None or any(help in (d.help or "") for d in found), [d.help for d in found]


def test_missing_coefficient_of_the_canard_law(tmp_path: Path) -> None:
    line = next(x for x in (TABLES / "dcom.toml").read_text(encoding="utf-8").splitlines() if "0.44838" in x)
    (fault,) = faults(tmp_path, line + "\n", "")
    assert fault.path == ("C_L",)
    assert "`delta_c` is missing" in fault.message


def test_missing_parameter_and_quantity_are_named(tmp_path: Path) -> None:
    (fault,) = faults(tmp_path, 'm = { value = 300.0, unit = "slug/ft" }\n', "")
    assert "`m` (vehicle mass) is missing" in fault.message
    text = (TABLES / "com.toml").read_text(encoding="utf-8")
    section = text[text.index("[C_D]") : text.index("[C_M]")]
    (fault,) = faults(tmp_path, section, "", "com")
    assert "`[C_D]` is missing" in fault.message


def test_all_faults_are_told_at_once(tmp_path: Path) -> None:
    text = (TABLES / "com.toml").read_text(encoding="utf-8")
    path = tmp_path / "com.toml"
    path.write_text(text.replace("4.6773", "nan").replace("[C_D]", "[C_d]"), encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load(path)
    assert {d.path for d in caught.value.diagnostics} >= {("C_L", "alpha", "value"), ("C_d",)}
