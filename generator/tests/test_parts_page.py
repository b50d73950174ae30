"""The page of parts: its table joins, and its part does what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from evaluated import Evaluated

from ahv_generator.family_file import PartFile, built_in
from ahv_generator.schema import Variable

PAGE = (Path(__file__).parents[2] / "docs" / "parts.md").read_text(encoding="utf-8")
DCOM = (Path(__file__).parents[1] / "tables" / "dcom.toml").read_text(encoding="utf-8")
MODELS = 'models = ["dcom", "sdcom", "sdcom_printed", "sdcom_gust"]'
FILTER = 'elevator = { part = "second_order_actuator", input = "delta_e" }'


def joined(folder: Path, *changes: tuple[str, str]) -> Path:
    """The table of DCOM with what the page joins."""
    _, rest = re.findall("```toml\n(.*?)```", PAGE, re.DOTALL)[0].split("\n\n", 1)
    # DCOM's table has the gust of another model, which the page leaves out.
    text = DCOM.replace(MODELS, 'models = ["dcom", "sdcom_gust", "servoed"]').replace("[validity]", rest.rstrip(), 1)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = folder / "dcom.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_table_of_the_page_joins(tmp_path: Path) -> None:
    model = Evaluated(joined(tmp_path), "servoed").model
    assert model.names("state")[-4:] == ("elevator_position", "elevator_rate", "gust_first", "gust_second")
    assert model.names("input") == ("phi", "elevator_command", "delta_c")


def test_the_page_lists_every_part_with_its_names() -> None:
    rows = re.findall(r"^\| `(\w+)` \| (.*?) \| (.*?) \| (.*?) \|$", PAGE, re.MULTILINE)
    assert sorted(name for name, *_ in rows) == built_in("parts")
    for name, joins, names, parameters in rows:
        path = Path(__file__).parents[1] / "ahv_generator" / "parts" / f"{name}.py"
        keys, made = PartFile(name, path).part()
        part = made({key: Variable(key, "x", "rad", "something") for key in keys}, None)
        assert re.findall("`(.*?)`", joins) == list(keys)
        own = [one.name for one in (*part.states, *part.inputs)]
        assert [one for one in re.findall("`(.*?)`", names.partition("output")[0])] == own
        assert re.findall("`(.*?)`", parameters) == [one.key for one in part.parameters]


def test_the_part_of_the_page_is_a_washout(tmp_path: Path) -> None:
    (code,) = re.findall("```python\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "washout.py").write_text(code, encoding="utf-8")
    path = joined(
        tmp_path,
        (FILTER, 'elevator = { part = "washout.py", input = "delta_e" }'),
        (
            'omega = { value = 20.0, unit = "rad/s" }\nzeta = { value = 0.7, unit = "1" }',
            'tau = { value = 0.5, unit = "s" }',
        ),
        ('elevator_rate = { min = -100.0, max = 100.0, unit = "deg/s" }\n', ""),
    )
    found = Evaluated(path, "servoed").at({"velocity": 7800.0, "elevator_command": 0.3, "elevator_mean": 0.1})
    assert found["drift.elevator_mean"] == pytest.approx(0.4, rel=1e-14)
    slopes = [
        found[f"jacobians.{kind}.pitch_rate.elevator_{name}"]
        for kind, name in (("state", "mean"), ("input", "command"))
    ]
    assert slopes[0] == pytest.approx(-slopes[1], rel=1e-12)
