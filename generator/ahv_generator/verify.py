"""Checks a model at points: CasADi's values and sixth-order differences against 50 digits; writes these."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import casadi as ca
import mpmath

from .drawing import draw
from .exact import DIGITS, Exact, Number, Value
from .model import Model
from .reference import columns, expanded, labels, outputs
from .table import load

SEED = 1
_EPSILON = 2.0**-52
# Of the sixth order: weights at one, two and three steps. At 50 digits a small step costs nothing.
_WEIGHTS, _DIVISOR = {1: 45, 2: -9, 3: 1}, 60
_STEP = 2.0**-20
# Functions whose entries are derivatives of the drift, and the leaves by which.
_DERIVATIVES = {
    "jacobians.state": ("state", "x"),
    "jacobians.input": ("input", "u"),
    "parameter_jacobian": ("parameter", "p"),
}


@dataclass
class Worst:
    """The worst error of a function, in units of 2^-52 K, and the entry."""

    error: float = 0.0
    label: str = ""

    def take(self, error: float, label: str) -> None:
        """Keep the larger."""
        if not error <= self.error:
            self.error, self.label = error, label


@dataclass
class Verified:
    """The worst of each function: of CasADi's values, and of differences of the drift."""

    casadi: dict[str, Worst] = field(default_factory=dict)
    differences: dict[str, Worst] = field(default_factory=dict)

    def as_json(self) -> dict[str, object]:
        """As the driver reads it; an error that is not finite is null."""
        return {
            name: {key: [_finite(one.error), one.label] for key, one in worst.items()}
            for name, worst in (("casadi", self.casadi), ("differences", self.differences))
        }


def _finite(number: float) -> float | None:
    return number if number < float("inf") else None


def verify_all(paths: Iterable[Path], points: int, out: Path) -> dict[str, object]:
    """Check the models of tables; the worst of each, as the driver reads it.

    Raises:
        TableError: for a table that cannot be derived.
    """
    models = [model for path in paths for model in load(path).build()]
    return {model.name: verify(model, points, out / f"{model.name}.txt").as_json() for model in models}


def verify(model: Model, points: int, out: Path) -> Verified:
    """Check a model at points, and write them with the values at 50 digits to `out`."""
    found, names = Verified(), labels(model, together=True)
    function = expanded(model, together=True)
    exact = Exact(model, (expr for _, expr in outputs(model, together=True)))
    order = [name for name in model.graph.symbols if name not in model.graph.quantities]
    drift = _Drift(model)
    lines = [f"# ahv vectors, model {model.name}, seed {SEED}, points {points}; inputs|outputs, an output is hi;lo;K"]
    lines.append(f"{','.join(columns(model))}|{','.join(names)}")
    for index in range(points):
        point = draw(model, SEED, index)
        values = dict(zip(names, exact.at(point), strict=True))
        theirs = function.call([ca.DM(point[name]) for name in order])
        for label, value in zip(names, theirs, strict=True):
            worst = found.casadi.setdefault(label.partition(".")[0], Worst())
            worst.take(_error(float(value), values[label]), label)
        for label, error in drift.errors(point, values):
            found.differences.setdefault(label.partition(".")[0], Worst()).take(error, label)
        row = ",".join(repr(point[name]) for name in order)
        lines.append(f"{row}|{','.join(_text(values[label]) for label in names)}")
    out.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    return found


class _Drift:
    """Slopes of the drift by differences, which know nothing of the derivation."""

    def __init__(self, model: Model) -> None:
        self.rows = model.names("state")
        rates = model.rates or {}
        self.exact = Exact(model, (rates[row] for row in self.rows))
        self.leaves = {key: model.leaves(basis) for key, (basis, _) in _DERIVATIVES.items()}

    def errors(self, point: Mapping[str, float], values: Mapping[str, Value]) -> Iterator[tuple[str, float]]:
        """Each entry of a derivative, and how far it is from differences in the measure."""
        own = self.exact.at(point)
        for key, leaves in self.leaves.items():
            for column, leaf in leaves.items():
                slopes = self.slopes(point, leaf)
                for row, slope, (_, size) in zip(self.rows, slopes, own, strict=True):
                    label = f"{key}.{row}.{column}"
                    # An entry that is not there is 0; its measure is that of the drift by the size of the variable.
                    nothing = (mpmath.mpf(0), size / max(abs(point[leaf]), _STEP))
                    value, measure = values.get(label, nothing)
                    yield label, _error(slope, (value, measure))

    def slopes(self, point: Mapping[str, float], leaf: str) -> list[Number]:
        """The slope of every rate by a leaf."""
        with mpmath.workdps(DIGITS):
            here = mpmath.mpf(point[leaf])
            step = _STEP * max(abs(here), 1)
            totals = [mpmath.mpf(0) for _ in self.rows]
            for count, weight in _WEIGHTS.items():
                for sign in (1, -1):
                    moved = self.exact.at({**point, leaf: here + sign * count * step})
                    totals = [
                        total + sign * weight * value / (_DIVISOR * step)
                        for total, (value, _) in zip(totals, moved, strict=True)
                    ]
            return totals


def _error(value: Number, exact: Value) -> float:
    """The error of a value in the measure; none where the exact value is not a number, for there any will do."""
    number, size = exact
    if mpmath.isnan(number):
        return 0.0
    with mpmath.workdps(DIGITS):
        difference = float(abs(mpmath.mpf(value) - number))
    if difference == 0.0:
        return 0.0
    return difference / (_EPSILON * size) if size and difference < float("inf") else float("inf")


def _text(value: Value) -> str:
    with mpmath.workdps(DIGITS):
        high = float(value[0])
        low = float(value[0] - mpmath.mpf(high))
    return f"{high!r};{low:.3e};{value[1]:.3e}"
