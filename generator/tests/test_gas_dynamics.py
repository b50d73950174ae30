"""The oracle of gas dynamics against printed tables, each number to its last printed digit."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import mpmath as mp
import pytest

from ahv_oracle import gas_dynamics as gas

PRINTED = Path(__file__).parents[2] / "tests" / "vectors" / "gas_tables.csv"


@pytest.fixture(autouse=True)
def digits() -> Iterator[None]:
    with mp.workdps(gas.DIGITS):
        yield


def rows() -> list[dict[str, str]]:
    lines = [line for line in PRINTED.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def check(row: dict[str, str], column: str, value: mp.mpf) -> None:
    printed = row[column]
    digits = len(printed.partition(".")[2])
    assert abs(float(value) - float(printed)) <= 0.5001 * 10.0**-digits, (row["mach"], column, printed, float(value))


def test_each_relation_has_twenty_points() -> None:
    assert len(rows()) >= 20


@pytest.mark.parametrize("row", rows(), ids=lambda row: row["mach"])
def test_the_oracle_has_the_printed_digits(row: dict[str, str]) -> None:
    mach = mp.mpf(row["mach"])
    total = 1 / gas._stagnation(mach)
    check(row, "t_tt", total)
    check(row, "p_pt", total ** mp.mpf("3.5"))
    check(row, "a_a", gas.area_ratio(mach))
    check(row, "nu", mp.degrees(gas.prandtl_meyer(mach)))
    for column, value in zip(("m2", "p2_p1", "rho2_rho1", "t2_t1"), gas.normal_shock(mach), strict=True):
        check(row, column, value)
    heating, pressure, temperature = gas._heated(mp.mpf(1), mach)
    for column, value in (("heat_p", pressure), ("heat_t", temperature), ("heat_tt", heating)):
        check(row, column, value)


def test_shocks_of_the_charts() -> None:
    """Angles that textbooks print beside the charts of the report: in deg, to a hundredth."""
    for mach, turn, angle in ((2, 10, 39.31), (2, 20, 53.42), (3, 20, 37.76), (5, 20, 29.80)):
        found = gas.shock(mp.mpf(mach), mp.radians(turn))[3]
        assert abs(mp.degrees(found) - angle) < 0.0051, (mach, turn, float(mp.degrees(found)))


def test_vacuum_is_at_130_degrees() -> None:
    assert abs(mp.degrees(gas.vacuum_angle()) - mp.mpf("130.4541")) < 1e-4
