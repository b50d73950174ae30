"""Units: exact conversion between the two systems, and tables that are written in SI."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import casadi as ca
import pytest

from ahv_generator import ir, units
from ahv_generator.reference import columns, expanded, labels
from ahv_generator.table import Table, load

TABLES = Path(__file__).parents[1] / "tables"
NAMES = ("com", "dcom", "flexible_mode")
POUND, FOOT = 4.4482216152605, 0.3048

FACTORS = [
    ("ft", "m", FOOT),
    ("lb", "N", POUND),
    ("lb/ft", "N/m", 14.593902937206364),
    ("slug", "kg", 14.593902937206364),
    ("slug/ft", "kg/m", 47.88025898033584),
    ("slug*ft", "kg*m", POUND),
    ("slug/ft^3", "kg/m^3", 515.3788183931961),
    ("(ft*slug)^0.5", "(m*kg)^0.5", POUND**0.5),
    ("(ft/slug)^0.5/rad^2", "(m/kg)^0.5/rad^2", FOOT / POUND**0.5),
    ("rad*s^0.5", "rad*s^0.5", 1.0),
    ("deg", "deg", 1.0),
    ("1", "1", 1.0),
]


@pytest.mark.parametrize(("imperial", "si", "expected"), FACTORS)
def test_factors_are_exact_in_both_directions(imperial: str, si: str, expected: float) -> None:
    assert (units.converted(imperial, units.SI), units.converted(si, units.IMPERIAL)) == (si, imperial)
    there, back = units.conversion(imperial, units.SI), units.conversion(si, units.IMPERIAL)
    assert there == pytest.approx(expected, rel=1e-13, abs=0)
    assert abs(there * back - 1) <= 2.0**-52
    # A unit that is in the system already stays as it is.
    assert (units.converted(si, units.SI), units.conversion(si, units.SI)) == (si, 1.0)
    assert (units.converted(imperial, units.IMPERIAL), units.conversion(imperial, units.IMPERIAL)) == (imperial, 1.0)


def test_the_definitions_are_met_to_the_last_bit() -> None:
    assert units.conversion("ft", units.SI) == FOOT
    assert units.conversion("lb", units.SI) == POUND
    assert units.conversion("m", units.IMPERIAL) == 3.2808398950131235
    assert units.conversion("N", units.IMPERIAL) == 0.22480894309971047
    assert units.conversion("slug*ft/s^2", units.SI) == POUND
    assert units.conversion("ft*ft", units.SI) == units.conversion("ft^2", units.SI) == 0.09290304
    # Also as pint sees it, by another way.
    assert units.factor("slug/ft^3", "kg/m^3") == pytest.approx(515.3788183931961, rel=1e-14)


@pytest.mark.parametrize("text", ["furlong", "", "ft**2", "ft^-1", "__import__('os')", "ft^9.9999", "kg m"])
def test_what_is_no_unit_is_rejected(text: str) -> None:
    with pytest.raises(units.UnitError):
        units.conversion(text, units.SI)


def test_both_readers_of_units_have_one_grammar() -> None:
    cases = (Path(__file__).parent / "units.txt").read_text(encoding="utf-8").splitlines()
    for case in cases:
        taken, text = case[:1], case[1:].removeprefix(" ")
        if taken == "+":
            assert units.factor(text, text) == 1.0, text
        elif taken == "-":
            with pytest.raises(units.UnitError):
                units.factor(text, text)


@pytest.mark.parametrize("depth", [2, 40_000])
def test_brackets_are_not_too_deep(depth: int) -> None:
    with pytest.raises(units.UnitError) as caught:
        units.factor("(" * depth + "ft" + ")" * depth, "ft")
    assert len(str(caught.value)) < 200


def in_si(text: str) -> str:
    """A table with every number and unit turned into SI."""

    def entry(match: re.Match[str]) -> str:
        unit = match["unit"]
        factor = units.conversion(unit, units.SI)
        numbers = re.sub(
            r"(value|min|max) = ([-+.\de]+)", lambda n: f"{n[1]} = {float(n[2]) * factor!r}", match["numbers"]
        )
        return f'{numbers}unit = "{units.converted(unit, units.SI)}"'

    text = text.replace(f'units = "{units.IMPERIAL}"', f'units = "{units.SI}"')
    return re.sub(r'(?P<numbers>\{ (?:value|min)[^}]*?)unit = "(?P<unit>[^"]*)"', entry, text)


def loaded_in_si(tmp_path: Path, name: str) -> Table:
    path = tmp_path / f"{name}.toml"
    path.write_text(in_si((TABLES / f"{name}.toml").read_text(encoding="utf-8")), encoding="utf-8")
    return load(path)


def rendered(table: Table) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(ir.render(table, table.build()))
    return document


def unit_texts(node: object) -> list[str]:
    """All units of a document in the order in which they stand; they are taken out of it."""
    found: list[str] = []
    if isinstance(node, dict):
        unit = node.pop("unit", None)
        found += [unit] if unit is not None else []
        for child in node.values():
            found += unit_texts(child)
    if isinstance(node, list):
        for child in node:
            found += unit_texts(child)
    return found


def numbers_of(model: dict[str, Any], factors: dict[str, float]) -> dict[str, float]:
    """The numbers of a model's trim and deviations times a factor for each variable; they are taken out of it."""
    found = {f"deviation of {name}": size * factors[name] for name, size in model.pop("deviations").items()}
    for kind in ("given", "sought"):
        for line in model["trim"][kind]:
            for key in set(line) - {"name"}:
                number = line.pop(key)
                if number is not None:
                    found[f"{key} of {line['name']}"] = number * factors[line["name"]]
    return found


@pytest.mark.parametrize("name", NAMES)
def test_a_table_in_si_derives_to_the_same_but_for_units(tmp_path: Path, name: str) -> None:
    imperial, si = rendered(load(TABLES / f"{name}.toml")), rendered(loaded_in_si(tmp_path, name))
    assert (imperial["units"]["system"], imperial["units"]["other"]) == (units.IMPERIAL, units.SI)
    assert (si["units"]["system"], si["units"]["other"]) == (units.SI, units.IMPERIAL)
    blocks = (imperial.pop("units"), si.pop("units"))
    for ours, theirs in zip(imperial["models"], si["models"], strict=True):
        units_of = {v["name"]: v["unit"] for basis in ("state", "input") for v in ours["bases"][basis]}
        expected = numbers_of(ours, {name: units.conversion(unit, units.SI) for name, unit in units_of.items()})
        assert numbers_of(theirs, dict.fromkeys(units_of, 1.0)) == pytest.approx(expected, rel=1e-15)
    found = [unit_texts(document) for document in (imperial, si)]
    assert imperial == si
    assert len(found[0]) == len(found[1])
    for ours, theirs in zip(*found, strict=True):
        # The text of a derivative's unit may order its factors otherwise.
        assert units.factor(units.converted(ours, units.SI), theirs) == 1.0
        assert not re.search(r"\b(ft|slug|lb)\b", theirs)
    for texts, block in zip(found, blocks, strict=True):
        # Every unit can be converted, and no other is listed.
        assert set(texts) == set(block["factors"])
        for unit, (other, factor) in block["factors"].items():
            assert other == units.converted(unit, block["other"])
            assert factor == units.conversion(unit, block["other"])
            assert factor == 1.0 or unit != other


POINT = {
    "x.velocity": 7846.4,
    "x.altitude": 86000.0,
    "x.gamma": 0.01,
    "x.alpha": 0.03,
    "x.eta_1": 1.2,
    "x.eta_dot_2": -3.0,
    "u.phi": 0.3,
    "u.delta_e": 0.1,
}
PREFIXES = {"state": "x", "input": "u", "noise": "w", "parameter": "p", "argument": "t"}


def results(path: Path, name: str) -> dict[str, float]:
    """The functions of a model at the point above, in the units of the table."""
    table = load(path)
    model = table.model(name)
    document = tomllib.loads(path.read_text(encoding="utf-8"))
    values = {f"p.{p.name}": float(document[p.path[0]][p.path[1]]["value"]) for p in table.parameters if p.unit != "1"}
    arguments = []
    for column in columns(model):
        kind, plain = column.split(".", 1)
        leaf = f"{PREFIXES[kind]}.{plain}"
        unit = units.converted(model.graph.units[leaf], units.IMPERIAL)
        factor = units.conversion(unit, units.SI) if table.units == units.SI else 1.0
        arguments.append(ca.DM(values.get(leaf, POINT.get(leaf, 0.5) * factor)))
    found = expanded(model).call(arguments)
    return dict(zip(labels(model), (float(v) for v in found), strict=True))


@pytest.mark.parametrize(("table", "name"), [("com", "com"), ("dcom", "sdcom_printed")])
def test_the_rates_of_a_table_in_si_are_those_in_si(tmp_path: Path, table: str, name: str) -> None:
    source = TABLES / f"{table}.toml"
    ours = results(source, name)
    loaded_in_si(tmp_path, table)
    theirs = results(tmp_path / f"{table}.toml", name)
    assert list(ours) == list(theirs)
    model = load(source).model(name)
    for row, variable in zip(model.names("state"), model.bases["state"], strict=True):
        factor = units.conversion(variable.unit, units.SI)
        assert theirs[f"drift.{row}"] == pytest.approx(ours[f"drift.{row}"] * factor, rel=1e-11, abs=1e-11), row
        for column in model.bases["state"]:
            label = f"jacobians.state.{row}.{column.name}"
            if label in ours:
                slope = ours[label] * factor / units.conversion(column.unit, units.SI)
                assert theirs[label] == pytest.approx(slope, rel=1e-11, abs=1e-13), label


def test_one_unit_has_one_spelling() -> None:
    texts = ["ft/s^2", "ft/s/s", "(ft*slug)^0.5", "slug^0.5*ft^0.5", "1/rad", "1"]
    assert list(units.spelled(texts).values()) == [
        "ft/s^2",
        "ft/s^2",
        "(ft*slug)^0.5",
        "(ft*slug)^0.5",
        "1/rad",
        "1",
    ]
