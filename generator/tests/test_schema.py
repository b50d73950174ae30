"""The JSON Schemas of tables: they take the tables that come along, and find what is wrong while it is typed."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from pathlib import Path

import fastjsonschema
import pytest

ROOT = Path(__file__).parents[2]
TABLES = {
    "com": ("generator/tables", "generated"),
    "dcom": ("generator/tables", "generated"),
    "flexible_mode": ("generator/tables", "generated"),
    "six_dof": ("examples/six-dof", "examples/six-dof/generated"),
    "winged_cone": ("examples/winged-cone", "examples/winged-cone/generated"),
}


def schema(name: str) -> Callable[[object], object]:
    text = (ROOT / TABLES[name][1] / "schema" / f"{name}.json").read_text(encoding="utf-8")
    check: Callable[[object], object] = fastjsonschema.compile(json.loads(text))
    return check


def table(name: str) -> str:
    return (ROOT / TABLES[name][0] / f"{name}.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", TABLES)
def test_the_tables_that_come_along_are_valid(name: str) -> None:
    schema(name)(tomllib.loads(table(name)))


GOOD = [
    ('"alpha" = { value = 4.6773, unit = "1/rad" }', '"alpha" = { value = 0.0816, unit = "1/deg" }'),
    ("[C_L]", '[C_L]\n"alpha^2*delta_e" = { value = 0.1, unit = "1/rad^3" }'),
    ("[C_L]", '[C_L]\n"delta_e * alpha" = { value = 1, unit = "1/rad^2" }'),
    ('[sets."section5.3".vehicle]', '[sets."x"]\n[sets."section5.3".vehicle]'),
    ('earth = "flat"', 'earth = "spherical"'),
    ('I_yy = { value = 5.0e5, unit = "slug*ft"', 'I_yy = { value = 5.0e5, unit = "ft*slug"'),
]

BAD = [
    # what is replaced, by what, the place of the fault
    ("[C_L]", "[C_l]", "data must"),
    ('"alpha" = { value = 4.6773', '"alhpa" = { value = 4.6773', "data.C_L"),
    ('"alpha" = { value = 4.6773', '"alpha^0" = { value = 4.6773', "data.C_L"),
    ('"alpha" = { value = 4.6773', '"alpha" = { value = "4.6773"', "data.C_L.alpha.value"),
    ('"alpha" = { value = 4.6773', '"alpha" = { valeu = 4.6773', "data.C_L.alpha"),
    ('m = { value = 300.0, unit = "slug/ft" }', "m = { value = 300.0 }", "data.vehicle.m"),
    ("[vehicle]\nm", "[vehicle]\nM", "data.vehicle"),
    ('status = "published"', 'status = "guessed"', "data.table.status"),
    ("uncertainty = 0.4", "uncertainty = -0.4", "data.table.uncertainty"),
    ('earth = "flat"', 'earth = "round"', "data.choices.earth"),
    ("velocity = { min = 7000.0", "velocity = { mni = 7000.0", "data.validity.velocity"),
    ('"delta_e" = { value = 0.76224', '# "delta_e" = { value = 0.76224', "data.C_L"),
    ('[sets."section5.3".modes]\nomega_1', '[sets."section5.3".modes]\nomega_9', "data.sets.section5.3.modes"),
]


@pytest.mark.parametrize(("old", "new"), GOOD, ids=[new.splitlines()[-1] for _, new in GOOD])
def test_what_is_right_is_taken(old: str, new: str) -> None:
    text = table("dcom")
    assert old in text
    schema("dcom")(tomllib.loads(text.replace(old, new, 1)))


@pytest.mark.parametrize(("old", "new", "place"), BAD, ids=[new.splitlines()[-1] for _, new, _ in BAD])
def test_what_is_wrong_is_found_at_its_place(old: str, new: str, place: str) -> None:
    text = table("dcom")
    assert old in text
    with pytest.raises(fastjsonschema.JsonSchemaValueException) as caught:
        schema("dcom")(tomllib.loads(text.replace(old, new, 1)))
    assert str(caught.value).startswith(place), caught.value


def test_every_entry_says_what_it_is_and_offers_its_unit() -> None:
    path = ROOT / "generated/schema/dcom.json"
    sections = json.loads(path.read_text(encoding="utf-8"))["definitions"]["sections"]
    alpha = sections["C_L"]["properties"]["alpha"]
    assert alpha["properties"]["unit"]["anyOf"][0]["enum"] == ["1/rad", "1/deg"]
    entries = [entry for section in sections.values() for entry in section["properties"].values()]
    assert len(entries) > 60 and all(entry["description"] for entry in entries)
    assert "Do not edit" in path.read_text(encoding="utf-8").splitlines()[0]
