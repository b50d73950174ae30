"""The checked-in reference vectors are what the oracle gives today."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from ahv_oracle import MODELS, Oracle, sample, write_vectors
from ahv_oracle.elementary import elementary_lines
from ahv_oracle.flights import SETS, SOLVERS, START, Flight, heading_lines
from ahv_oracle.normals import chacha8, normal_lines
from ahv_oracle.transcendental import transcendental_lines
from ahv_oracle.vectors import heading, vector_row

ROOT = Path(__file__).parents[2]
FILES = sorted((ROOT / "tests/vectors").glob("*.sympy.txt"))
HEADING = re.compile(
    r"# ahv reference vectors, model (\w+), table (\w+), seed (\d+), points (\d+), "
    r"(?:all functions|functions ([\w ]+));"
)
ROWS = 25  # of each file are computed again; a row depends on no other


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_checked_in_vectors_are_up_to_date(path: Path) -> None:
    comment, columns, *rows = path.read_text(encoding="utf-8").splitlines()
    match = HEADING.match(comment)
    assert match, "run `cargo xtask vectors`"
    model, table, functions = match[1], match[2], match[5]
    seed, points = int(match[3]), int(match[4])
    oracle = Oracle(ROOT / f"generator/tables/{table}.toml", model, functions and functions.split(" "))
    assert (comment, columns) == heading(oracle, points, seed), "run `cargo xtask vectors`"
    assert len(rows) == points
    for index in {points * k // ROWS for k in range(ROWS)} | {points - 1}:
        assert rows[index] == vector_row(oracle, sample(oracle.model, seed, index)), "run `cargo xtask vectors`"


def test_every_model_has_vectors() -> None:
    assert set(MODELS) <= {path.name.partition(".")[0] for path in FILES}


def test_a_changed_value_changes_no_vector(tmp_path: Path) -> None:
    text = (ROOT / "generator/tables/dcom.toml").read_text(encoding="utf-8")
    changed = tmp_path / "dcom.toml"
    changed.write_text(text.replace("value = 4.6773", "value = 4.7773"), encoding="utf-8")
    written = []
    for table in (ROOT / "generator/tables/dcom.toml", changed):
        write_vectors(Oracle(table, "dcom", ["drift", "hessian"]), 20, 1, tmp_path / "fresh.txt")
        written.append((tmp_path / "fresh.txt").read_text(encoding="utf-8"))
    assert written[0] == written[1]


@pytest.mark.parametrize("parameters", SETS)
def test_checked_in_flights_are_up_to_date(parameters: str) -> None:
    lines = (ROOT / "tests/vectors/dcom.flights.txt").read_text(encoding="utf-8").splitlines()
    flight = Flight(ROOT / "generator/tables/dcom.toml", parameters)
    assert lines[:2] == heading_lines(flight.states), "run `cargo xtask vectors`"
    fields = [line.split(",") for line in lines[2:]]
    rows = {solver: [float(value) for value in state] for name, solver, *state in fields if name == parameters}
    assert list(rows) == ["start", *SOLVERS]
    assert rows["start"] == [START.get(name, 0.0) for name in flight.states], "run `cargo xtask vectors`"
    assert rows["DOP853"] == pytest.approx(flight.end("DOP853"), rel=1e-10), "run `cargo xtask vectors`"


@pytest.mark.parametrize(
    ("name", "lines"),
    [("elementary", elementary_lines), ("transcendental", transcendental_lines), ("normals", normal_lines)],
)
def test_checked_in_numbers_are_up_to_date(name: str, lines: Callable[[], Iterator[str]]) -> None:
    path = ROOT / f"tests/vectors/{name}.txt"
    assert path.read_text(encoding="utf-8").splitlines() == list(lines()), "run `cargo xtask vectors`"


def test_chacha8_has_the_published_stream() -> None:
    """Key and nonce zero: TC1 of draft-strombergson-chacha-test-vectors, 8 rounds, 256 bits."""
    words = chacha8([0, 0, 0], 0)
    stream = b"".join(word.to_bytes(4, "little") for word in words)
    assert stream[:16].hex() == "3e00ef2f895f40d67f5bb8e81f09a5a1"
