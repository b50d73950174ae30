"""The scripts of examples/python run, and leave what they say."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

PLACE = Path(__file__).parents[3] / "examples/python"
SCRIPTS = sorted(PLACE.glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda it: it.stem)
def test_a_script_runs(script, tmp_path):
    done = subprocess.run([sys.executable, script, tmp_path], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) > 3
    if script.stem == "trim_and_poles":
        assert {file.name for file in tmp_path.iterdir()} == {"poles.png", "trims.csv"}


def test_the_notebook_runs():
    cells = json.loads((PLACE / "tour.ipynb").read_text())["cells"]
    cells = [cell for cell in cells if cell["cell_type"] == "code"]
    # It is there with its pictures.
    assert sum("image/png" in output.get("data", {}) for cell in cells for output in cell["outputs"]) == 3
    code = ["".join(cell["source"]) for cell in cells]
    script = "import matplotlib; matplotlib.use('agg')\n" + "\n".join(code)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
