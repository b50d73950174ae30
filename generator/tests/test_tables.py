"""Faults of a table: each one message, at the key where it stands, with a suggestion where one exists."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from ahv_generator import names
from ahv_generator.diagnostics import Diagnostic, TableError
from ahv_generator.models.flexible import modes_of
from ahv_generator.table import load

TABLES = Path(__file__).parents[1] / "tables"
GENERATED = Path(__file__).parents[2] / "generated" / "src"


def faults(tmp_path: Path, old: str, new: str, table: str = "dcom") -> list[Diagnostic]:
    text = (TABLES / f"{table}.toml").read_text(encoding="utf-8")
    assert old in text, f"the table has no {old!r}"
    path = tmp_path / f"{table}.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load(path)
    return caught.value.diagnostics


CL_ALPHA = '[C_L]\n"alpha" = { value = 4.6773, unit = "1/rad" }'

DCOM_MODELS = 'models = ["dcom", "sdcom", "sdcom_printed", "sdcom_gust"]'
SET_MASS = '[sets."section5.3".vehicle]\nm = { value = 191.3, unit = "slug/ft"'
ORDER = "models of the family, each once, in this order"

CASES = [
    # what is replaced, by what, rule, path, part of the message, part of the help
    ('"alpha" = { value = 4.6773', '"alpah" = { value = 4.6773', "monomial", ("C_L", "alpah"), "not a variable",
     "`alpha`"),
    ("[C_L]", "[C_l]", "unknown-section", ("C_l",), "unknown section", "`C_L`"),
    (CL_ALPHA, CL_ALPHA.replace("value", "vlaue"), "unknown-key", ("C_L", "alpha", "vlaue"), "unknown key", "`value`"),
    (CL_ALPHA, CL_ALPHA.replace(', unit = "1/rad"', ""), "missing", ("C_L", "alpha"), "`unit` is missing", None),
    (CL_ALPHA, CL_ALPHA.replace("4.6773", "nan"), "not-finite", ("C_L", "alpha", "value"), "finite", None),
    (CL_ALPHA, CL_ALPHA.replace("4.6773", "inf"), "not-finite", ("C_L", "alpha", "value"), "finite", None),
    (CL_ALPHA, CL_ALPHA.replace("4.6773", '"4.6"'), "not-a-number", ("C_L", "alpha", "value"), "number", None),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "1/s"), "unit", ("C_L", "alpha", "unit"), "does not fit", "`1/rad`"),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "ft/m/rad"), "unit", ("C_L", "alpha", "unit"), "right thing", "`1/rad`"),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "furlong"), "unit", ("C_L", "alpha", "unit"), "not a unit", None),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "rad^9**9**9**9"), "unit", ("C_L", "alpha", "unit"), "is not a unit", None),
    (CL_ALPHA, CL_ALPHA.replace("1/rad", "1/\\nrad"), "unit", ("C_L", "alpha", "unit"), "is not a unit", None),
    ('source = "plate"', 'source = ["plate"]', "unknown-source", ("C_L", "delta_c", "source"), "unknown source", None),
    ("[C_N_3]", '["C_N_²"]', "unknown-section", ("C_N_²",), "unknown section", None),
    ("plate = ", "plate = 3 # ", "source", ("sources", "plate"), "a source is", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"alpha^x"'), "monomial", ("C_L", "alpha^x"), "not a monomial", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"phi"'), "monomial", ("C_L", "phi"), "not a variable", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"eta_1*eta_2"'), "affine", ("C_L", "eta_1*eta_2"), "affine", None),
    (CL_ALPHA,
     CL_ALPHA + '\n"delta_e*alpha" = { value = 1.0, unit = "1/rad^2" }\n'
     '"alpha*delta_e" = { value = 1.0, unit = "1/rad^2" }',
     "duplicate-monomial", ("C_L", "alpha*delta_e"), "same monomial", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"alpha^5*alpha^6"'), "monomial", ("C_L", "alpha^5*alpha^6"),
     "`alpha^5*alpha^6` is of degree 11; the highest is 9", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"alpha^9*delta_e"'), "monomial", ("C_L", "alpha^9*delta_e"),
     "of degree 10", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"alpha\\n"'), "monomial", ("C_L", "alpha\n"), "not a monomial", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"alpha^10"'), "monomial", ("C_L", "alpha^10"),
     "`alpha^10` is of degree 10; the highest is 9", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', f'"alpha^{"9" * 9999}"'), "monomial", ("C_L", f"alpha^{'9' * 9999}"),
     "is of degree 1000 or more; the highest is 9", None),
    (CL_ALPHA, CL_ALPHA.replace('"alpha"', '"0"'), "monomial", ("C_L", "0"), "not a monomial", "constant part is `1`"),
    (CL_ALPHA, CL_ALPHA.replace("4.6773", "1" + "0" * 400), "not-finite", ("C_L", "alpha", "value"), "too large", None),
    (CL_ALPHA, CL_ALPHA.replace("4.6773", "1" + "0" * 5000), "unreadable", (), "cannot read", None),
    ("uncertainty = 0.4", "uncertainty = 1" + "0" * 400, "not-finite", ("table", "uncertainty"), "too large", None),
    ("min = -5.0, max = 5.0", "min = -5.0, max = 5" + "0" * 400, "not-finite", ("validity", "gamma", "max"),
     "too large", None),
    ('gamma = { min = -5.0, max = 5.0, unit = "deg" }', 'gamma = { min = -5.0, max = 5.0, unit = 1 }', "unit",
     ("validity", "gamma", "unit"), "must be a text", None),
    ("[C_N_3]", "[C_N_4]", "missing", (), "`[C_N_3]` is missing", None),
    ("[C_N_3]", "[C_N_4]", "unknown-section", ("C_N_4",), "unknown section", "`C_N_"),
    ("m = { value = 300.0", "mass = { value = 300.0", "unknown-key", ("vehicle", "mass"), "unknown key", None),
    ("m = { value = 300.0", "m = { value = -300.0", "positive", ("vehicle", "m", "value"), "positive", None),
    ("value = 0.44838", "value = 0.0", "not-zero", ("C_L", "delta_c", "value"), "divides", None),
    (DCOM_MODELS, 'models = ["dcm"]', "unknown-model", ("table", "models"), "not a model of the family",
     "`dcom`"),
    ('status = "published"', 'status = "publshed"', "unknown-status", ("table", "status"), "unknown status",
     "`published`"),
    ('source = "plate"', 'source = "plat"', "unknown-source", ("C_L", "delta_c", "source"), "unknown source",
     "`plate`"),
    ("uncertainty = 0.4", "uncertainty = -0.4", "uncertainty", ("table", "uncertainty"), "not negative", None),
    ("min = -5.0, max = 5.0", "min = 5.0, max = -5.0", "range", ("validity", "gamma", "min"), "below", None),
    ('gamma = { min = -5.0, max = 5.0, unit = "deg" }', 'gamma = { min = -5.0, max = 5.0, unit = "ft" }', "unit",
     ("validity", "gamma", "unit"), "does not fit", None),
    ('name = "dcom"', 'name = "DCOM"', "table-name", ("table", "name"), "lower-case identifier", None),
    ('name = "dcom"', 'name = "audit"', "table-name", ("table", "name"), "other than `audit`", None),
    ('name = "dcom"', 'name = "fn"', "table-name", ("table", "name"), "keyword of Rust", None),
    ('name = "dcom"', 'name = "é"', "table-name", ("table", "name"), "lower-case identifier", None),
    # choices
    ('canard = "none"', 'canrad = "none"', "unknown-choice", ("choices", "canrad"), "unknown choice", "`canard`"),
    ('canard = "none"', "", "missing", ("choices",), "`canard` is missing", "`free`, `slaved`, `none`"),
    ('canard = "none"', 'canard = "slave"', "unknown-option", ("choices", "canard"), "`slave` is not an option",
     "`slaved`"),
    ('reduction = "printed"', 'reduction = "exact"', "unknown-option", ("choices", "reduction"),
     "`exact` is not an option of `reduction`", "`moment`"),
    ('earth = "flat"', "earth = 1", "unknown-option", ("choices", "earth"), "`1` is not an option", "`spherical`"),
    ("[choices]", "[choises]", "missing", (), "`[choices]` is missing", None),
    ("[choices]", "[choises]", "unknown-section", ("choises",), "unknown section", "`choices`"),
    # sets
    ('set = "section5.1"', "", "missing", ("table",), "`set` is missing", None),
    ('set = "section5.1"', "set = 5.1", "set-name", ("table", "set"), "lower-case letters", None),
    ('set = "section5.1"', """set = 'a"b'""", "set-name", ("table", "set"), "lower-case letters", None),
    ('set = "section5.1"', 'set = "section5.3"', "set-name", ("sets", "section5.3"), "name of its own", None),
    (SET_MASS, SET_MASS.replace("section5.3", "Section 5.3"), "set-name", ("sets", "Section 5.3"), "name of its own",
     None),
    (SET_MASS, SET_MASS.replace("section5.3", "nominal"), "set-name", ("sets", "nominal"), "name of its own", None),
    (SET_MASS, SET_MASS.replace("section5.3", "hessian-pattern"), "set-name", ("sets", "hessian-pattern"),
     "HESSIAN_PATTERN", None),
    (SET_MASS, SET_MASS.replace("section5.3", "noise.class"), "set-name", ("sets", "noise.class"), "NOISE_CLASS", None),
    (SET_MASS, SET_MASS.replace("section5.3", "section5_3"), "set-name", ("sets", "section5.3"), "name of its own",
     None),
    (SET_MASS, SET_MASS.replace(".vehicle", ".vehicel"), "unknown-section", ("sets", "section5.3", "vehicel"),
     "no section", "`vehicle`"),
    (SET_MASS, SET_MASS.replace(".vehicle", ".choices"), "unknown-section", ("sets", "section5.3", "choices"),
     "no section", None),
    (SET_MASS, SET_MASS.replace("m =", "mass ="), "nothing-to-replace", ("sets", "section5.3", "vehicle", "mass"),
     "no `mass` to replace", "`m`"),
    (SET_MASS, SET_MASS.replace("slug/ft", "slug"), "unit", ("sets", "section5.3", "vehicle", "m", "unit"),
     "does not fit", "`slug/ft`"),
    (SET_MASS, SET_MASS.replace("slug/ft", "kg/m"), "unit", ("sets", "section5.3", "vehicle", "m", "unit"),
     "right thing", "`slug/ft`"),
    (SET_MASS, SET_MASS.replace(', unit = "slug/ft"', ""), "missing", ("sets", "section5.3", "vehicle", "m"),
     "`unit` is missing", None),
    ("omega_1 = { value = 20.5", "omega_1 = { value = 0.0", "positive",
     ("sets", "section5.3", "modes", "omega_1", "value"), "must be positive", None),
    (SET_MASS, '[sets."section5.3".C_L]\n"delta_c" = { value = 0.0, unit = "1/rad" }\n' + SET_MASS, "not-zero",
     ("sets", "section5.3", "C_L", "delta_c", "value"), "divides", None),
    (SET_MASS, '[sets."section5.3".C_L]\n"alpha^2" = { value = 1.0, unit = "1/rad^2" }\n' + SET_MASS,
     "nothing-to-replace", ("sets", "section5.3", "C_L", "alpha^2"), "no `alpha^2` to replace", "`alpha`"),
    # models
    (DCOM_MODELS, 'models = ["dcom", "com"]', "unknown-model", ("table", "models"), "not a model of the family",
     "`dcom`"),
    ('family = "dcom"', 'family = "dcmo"', "unknown-family", ("table", "family"), "unknown family `dcmo`", "`dcom`"),
    ('family = "dcom"', 'family = 1', "unknown-family", ("table", "family"), "unknown family `1`", "`flexible_mode`"),
    ('family = "dcom"', 'family = "dcom.py"', "unknown-family", ("table", "family"), "no file `dcom.py`", None),
    ('family = "dcom"', 'family = "/dcom.py"', "unknown-family", ("table", "family"), "not relative", None),
    ('family = "dcom"', "", "missing", ("table",), "`family` is missing", None),
    (DCOM_MODELS, 'models = ["sdcom", "dcom"]', "models", ("table", "models"), ORDER, "`dcom`, `sdcom`, "),
    (DCOM_MODELS, 'models = ["dcom", "dcom"]', "models", ("table", "models"), ORDER, None),
    (DCOM_MODELS, "models = []", "models", ("table", "models"), ORDER, None),
    ('gust_rms = { value = 1.7453293e-3, unit = "rad", source = "assumed", status = "assumed" }\n', "", "missing",
     ("noise",), "`gust_rms`", None),
    # units
    ('units = "ft-slug-s-rad"', 'units = "SI"', "unit-system", ("table", "units"), "unknown unit system", "`si`"),
    ('units = "ft-slug-s-rad"', 'units = "si"', "unit", ("vehicle", "m", "unit"), "the table is in si", "`kg/m`"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("value", "unit"), [("0.0816342868", "1/deg"), ("4.6773", "1/rad"), ("0.0816342868", "rad/deg/rad")]
)
def test_a_value_per_degree_is_taken_and_is_the_same_structure(tmp_path: Path, value: str, unit: str) -> None:
    text = (TABLES / "com.toml").read_text(encoding="utf-8")
    assert CL_ALPHA in text
    path = tmp_path / "com.toml"
    given = CL_ALPHA.replace("4.6773", value).replace("1/rad", unit)
    path.write_text(text.replace(CL_ALPHA, given, 1), encoding="utf-8")
    (lift,) = [p for p in load(path).parameters if p.path == ("C_L", "alpha")]
    assert lift.unit == unit.replace("deg", "rad")


@pytest.mark.parametrize(("old", "new", "rule", "path", "message", "help"), CASES, ids=lambda part: str(part)[:40])
def test_fault_is_named_where_it_stands(
    tmp_path: Path, old: str, new: str, rule: str, path: tuple[str, ...], message: str, help: str | None
) -> None:
    found = [d for d in faults(tmp_path, old, new) if d.path == path]
    assert found, f"no fault at {path}"
    assert rule in [d.rule for d in found]
    assert any(message in d.message for d in found), [d.message for d in found]
    assert help is None or any(help in (d.help or "") for d in found), [d.help for d in found]


def test_a_message_shows_no_control_character(tmp_path: Path) -> None:
    key = '"x\\u001b\\u202e\\n"'
    (fault,) = faults(tmp_path, CL_ALPHA, CL_ALPHA + f'\n{key} = {{ value = 1.0, unit = "1" }}')
    message = fault.as_json()["message"]
    assert isinstance(message, str)
    assert r"`x\x1b\u202e\n` is not a monomial" in message


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


def sections_of(text: str) -> list[str]:
    return re.findall(r"(?m)^\[(\w+)\]$", text)


@pytest.mark.parametrize("table", ["com", "dcom", "flexible_mode"])
def test_an_empty_section_lacks_what_it_should_hold(tmp_path: Path, table: str) -> None:
    text = (TABLES / f"{table}.toml").read_text(encoding="utf-8")
    path = tmp_path / f"{table}.toml"
    for section in sections_of(text):
        path.write_text(re.sub(rf"(?ms)^\[{section}\]$.*?(?=^\[)", f"[{section}]\n", text + "[end]"), encoding="utf-8")
        with pytest.raises(TableError) as caught:
            load(path)
        rules = {d.rule for d in caught.value.diagnostics}
        expected = {"sources": "unknown-source"}.get(
            section, "no-coefficient" if section[:2] in ("C_", "N_", "T") else ""
        )
        assert (expected or "missing") in rules, section


def test_no_model_hides_a_crate_or_a_file_of_the_package() -> None:
    manifest = tomllib.loads((GENERATED.parent / "Cargo.toml").read_text(encoding="utf-8"))
    taken = {crate.replace("-", "_") for crate in manifest["dependencies"]} | {"lib"}
    models = {path.name for path in GENERATED.iterdir()}
    pages = {path.stem.lower() for path in (GENERATED.parent / "docs").glob("*.md") if not path.stem.endswith("-table")}
    for name in taken | (pages - models):
        assert "choose another name" in (names.fault_of_model(name) or ""), name
    for name in ("core", "std", "alloc", "f64", "models", "main", "test"):
        assert names.fault_of_model(name) is None, name


def test_the_reserved_constants_are_those_that_are_emitted() -> None:
    """No set makes a constant that stands in a generated module already, whatever functions the models have."""
    modules = "\n".join(path.read_text(encoding="utf-8") for path in GENERATED.rglob("*.rs"))
    before = r"pub const|pub static|    pub struct [A-Za-z]+(?: in [a-z_]+)?,"
    found = set(re.findall(rf"(?m)^(?:{before}) ([A-Z][A-Z0-9_]*):", modules))
    of_sets = {c.upper() for name in ("section5.3", "mode2", "mode3") for c in names.constants(name)}
    assert {"NOMINAL", "HESSIAN_PATTERN", "SECTION5_3"} <= found
    free = {name for name in found - of_sets if names.fault_of_set(name.lower(), frozenset()) is None}
    assert not free


# What an Iyy at or below the sum of psi squared makes: no mass matrix. That sum is 249944.17 in the table.
LIGHT = [
    ("I_yy = { value = 5.0e5", "I_yy = { value = 249944.0", ("vehicle", "I_yy", "value")),
    ("psi_1 = { value = 401.86", "psi_1 = { value = -650.0", ("vehicle", "I_yy", "value")),
    ("psi_1 = { value = 401.86", "psi_1 = { value = 1e200", ("vehicle", "I_yy", "value")),
    (
        '[sets."section5.3"]',
        '[sets."section5.3".vehicle]\nI_yy = { value = 86723.0, unit = "slug*ft" }',
        ("sets", "section5.3", "vehicle", "I_yy", "value"),
    ),
    (
        '[sets."section5.3"]',
        '[sets."section5.3".modes]\npsi_2 = { value = 600.0, unit = "(ft*slug)^0.5" }',
        ("sets", "section5.3", "modes", "psi_2", "value"),
    ),
]


@pytest.mark.parametrize(("old", "new", "path"), LIGHT)
def test_inertia_that_the_modes_use_up_is_refused(tmp_path: Path, old: str, new: str, path: tuple[str, ...]) -> None:
    (fault,) = faults(tmp_path, old, new, "com")
    assert fault.path == path
    assert "must exceed the sum of the squares" in fault.message


def test_inertia_and_couplings_of_a_set_count_together(tmp_path: Path) -> None:
    light = (
        '[sets."section5.3".vehicle]\nI_yy = { value = 86723.0, unit = "slug*ft" }\n'
        '[sets."section5.3".modes]\npsi_1 = { value = 0.0, unit = "(ft*slug)^0.5" }\n'
        'psi_2 = { value = -100.0, unit = "(ft*slug)^0.5" }'
    )
    text = (TABLES / "com.toml").read_text(encoding="utf-8")
    path = tmp_path / "com.toml"
    path.write_text(text.replace('[sets."section5.3"]', light), encoding="utf-8")
    table = load(path)
    assert [s.name for s in table.sets] == ["section5.1", "section5.3"]
    assert [p.name for p in table.sets[1].parameters] == ["i_yy", "psi_1", "psi_2"]


def test_a_set_keeps_what_it_does_not_say(tmp_path: Path) -> None:
    table = load(TABLES / "dcom.toml")
    own, other = table.sets
    assert (own.name, own.parameters, other.name) == ("section5.1", (), "section5.3")
    replaced = {p.name: p for p in other.parameters}
    assert list(replaced) == ["m", "i_yy", *(f"omega_{i}" for i in (1, 2, 3)), *(f"zeta_{i}" for i in (1, 2, 3))]
    assert replaced["m"].path == ("sets", "section5.3", "vehicle", "m")
    assert (replaced["m"].source, replaced["m"].status, replaced["m"].uncertainty) == ("ahv-quoted", "unverified", 0.4)


def without(text: str, *sections: str) -> str:
    """The table without these sections."""
    parts = re.split(r"(?m)^(?=\[)", text)
    return "".join(part for part in parts if not part.startswith(tuple(f"[{section}]" for section in sections)))


def test_the_rigid_body_alone_needs_no_modes(tmp_path: Path) -> None:
    text = without((TABLES / "com.toml").read_text(encoding="utf-8"), "modes", "N_1", "N_2")
    text = text.replace('models = ["com", "com_rigid"]', 'models = ["com_rigid"]')
    text = re.sub(r"(?m)^eta(_dot)? = .*\n", "", text)
    path = tmp_path / "com.toml"
    path.write_text(text, encoding="utf-8")
    table = load(path)
    assert (table.models, modes_of(table)) == (("com_rigid",), range(1, 1))
    assert not {"omega_1", "psi_1", "n_1_alpha"} & {p.name for p in table.parameters}
    path.write_text(text.replace('["com_rigid"]', '["com"]'), encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load(path)
    told = "\n".join(d.message for d in caught.value.diagnostics)
    for missing in ("`[modes]` is missing", "`[N_1]` is missing", "`[N_2]` is missing", "`eta` (", "`eta_dot` ("):
        assert missing in told


def test_without_the_gust_model_the_table_needs_no_gust(tmp_path: Path) -> None:
    text = (TABLES / "dcom.toml").read_text(encoding="utf-8")
    text = text.replace(DCOM_MODELS, 'models = ["dcom", "sdcom"]')
    text = re.sub(r"(?m)^(gust_rms|gust_time|alpha_gust) = .*\n", "", text)
    path = tmp_path / "dcom.toml"
    path.write_text(text, encoding="utf-8")
    assert load(path).models == ("dcom", "sdcom")


def test_all_faults_are_told_at_once(tmp_path: Path) -> None:
    text = (TABLES / "com.toml").read_text(encoding="utf-8")
    path = tmp_path / "com.toml"
    path.write_text(text.replace("4.6773", "nan").replace("[C_D]", "[C_d]"), encoding="utf-8")
    with pytest.raises(TableError) as caught:
        load(path)
    assert {d.path for d in caught.value.diagnostics} >= {("C_L", "alpha", "value"), ("C_d",)}
