"""The page for those who write a family: its examples derive, and its message is the one that appears."""

from __future__ import annotations

import doctest
import re
from pathlib import Path

import pytest

from ahv_generator import family, modelling, schema
from ahv_generator.diagnostics import TableError
from ahv_generator.family_file import FamilyFile
from ahv_generator.modelling import Outline
from ahv_generator.table import load

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "families.md").read_text(encoding="utf-8")
EXAMPLE = ROOT / "examples" / "van-der-pol"
BLOCKS = re.findall(r"(?ms)^```(\w+)\n(.*?)^```$", PAGE)
# A block that begins with the name of its file stands alone.
ALONE = {text.split()[1]: text for _, text in BLOCKS if text.startswith("# ")}
PYTHON = [text for kind, text in BLOCKS if kind == "python" and text not in ALONE.values()]
TOML = [text for kind, text in BLOCKS if kind == "toml" and text not in ALONE.values()]
GLIDER = "".join(PYTHON[1:-1])


def glider(folder: Path, text: str = GLIDER) -> Path:
    (folder / "glider.py").write_text(text, encoding="utf-8")
    path = folder / "glider.toml"
    path.write_text(TOML[1], encoding="utf-8")
    return path


def test_the_smallest_family_is_that_of_the_examples() -> None:
    assert PYTHON[0] == (EXAMPLE / "van_der_pol.py").read_text(encoding="utf-8")
    assert TOML[0] in (EXAMPLE / "van_der_pol.toml").read_text(encoding="utf-8")


def test_the_glider_derives(tmp_path: Path) -> None:
    calm, gusty = load(glider(tmp_path)).build()
    assert (calm.names("output"), calm.noise_structure) == (("theta", "mach", "lift", "drag"), None)
    assert gusty.noise_structure is not None
    assert gusty.noise_structure.columns == (("w", "constant"),)


def test_a_calm_table_needs_no_gust(tmp_path: Path) -> None:
    path = glider(tmp_path)
    text = TOML[1].replace(', "gusty_glider"]', "]")
    path.write_text(re.sub(r"(?s)\[noise\].*?\n\n", "", text), encoding="utf-8")
    assert [m.name for m in load(path).build()] == ["glider"]


def test_a_family_of_tables_of_different_size(tmp_path: Path) -> None:
    path = tmp_path / "flexible.py"
    path.write_text(PYTHON[-1], encoding="utf-8")
    made = FamilyFile("flexible.py", path).family(Outline(("C_N_1", "C_N_2", "C_N_3")))
    assert [p.key for p in made.schema(("flexible",)).parameters["modes"]] == ["omega_1", "omega_2", "omega_3"]


def test_the_fault_is_the_one_that_is_printed(tmp_path: Path) -> None:
    with pytest.raises(TableError) as caught:
        load(glider(tmp_path, GLIDER.replace('"L", "lb"', '"L", "lb*ft"'))).build()
    (fault,) = caught.value.diagnostics
    assert f"error: {fault.message} [family]" in PAGE
    assert f"{fault.file}:{fault.line}:" in PAGE


@pytest.mark.parametrize("module", [family, schema], ids=lambda module: module.__name__)
def test_the_examples_of_the_docstrings_run(module: object) -> None:
    failures, count = doctest.testmod(module)  # type: ignore[arg-type]
    assert (failures, count > 0) == (0, True)


def test_the_docstring_of_the_module_is_a_family(tmp_path: Path) -> None:
    code = "".join(re.findall(r"(?m)^    .*\n|^\n", modelling.__doc__ or ""))
    path = tmp_path / "oscillator.py"
    path.write_text(re.sub(r"(?m)^    ", "", code), encoding="utf-8")
    assert list(FamilyFile("oscillator.py", path).family(Outline()).models) == ["oscillator"]
