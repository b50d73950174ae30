"""The checked-in reference vectors are what the oracle gives today."""

from __future__ import annotations

from pathlib import Path

import pytest

from ahv_oracle import Oracle, write_vectors

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(("table", "model"), [("com", "com"), ("dcom", "dcom"), ("dcom", "sdcom")])
def test_checked_in_vectors_are_up_to_date(table: str, model: str, tmp_path: Path) -> None:
    oracle = Oracle(ROOT / f"generator/tables/{table}.toml", model)
    write_vectors(oracle, 200, 1, tmp_path / "fresh.txt")
    fresh = (tmp_path / "fresh.txt").read_text(encoding="utf-8")
    kept = (ROOT / f"tests/vectors/{model}.sympy.txt").read_text(encoding="utf-8")
    assert fresh == kept, "run `cargo xtask vectors`"


def test_a_changed_value_changes_no_vector(tmp_path: Path) -> None:
    text = (ROOT / "generator/tables/dcom.toml").read_text(encoding="utf-8")
    changed = tmp_path / "dcom.toml"
    changed.write_text(text.replace("value = 4.6773", "value = 4.7773"), encoding="utf-8")
    write_vectors(Oracle(changed, "dcom"), 200, 1, tmp_path / "fresh.txt")
    kept = (ROOT / "tests/vectors/dcom.sympy.txt").read_text(encoding="utf-8")
    assert (tmp_path / "fresh.txt").read_text(encoding="utf-8") == kept
