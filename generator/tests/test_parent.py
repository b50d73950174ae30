"""A process that ends with the one that started it, however that ends."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
import os
from ahv_generator.parent import end_with_standard_input
end_with_standard_input()
try:
    input()
except EOFError:
    print("nothing to read", flush=True)
os._exit = None
while True:
    pass
"""


@pytest.fixture(name="process")
def _process() -> subprocess.Popen[str]:
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    return subprocess.Popen(
        [sys.executable, "-c", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    )


def test_it_ends_with_the_pipe_and_not_before(process: subprocess.Popen[str]) -> None:
    assert process.stdin is not None
    assert process.stdout is not None
    with process:
        assert process.stdout.readline() == "nothing to read\n"
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(0.3)
        process.stdin.close()
        assert process.wait(30) == 1
