"""Evaluates all functions of a model at 50 digits."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import mpmath
from sympy import Expr

from .derivatives import Entries
from .functions import all_functions
from .model import build_model
from .printed import DRIVES
from .program import Number, Program
from .table import Table, load_table

DIGITS = 50
"""Decimal digits of the arithmetic."""

Evaluation = dict[str, tuple[Number, Number]]
"""Value and K, both ``mpf``, by label; where a function has no real value, NaN and 0."""

_ROUNDING = 1e-45  # relative to K; below it a value is the rounding of an exact zero


@dataclass(frozen=True)
class _Group:
    """Functions that have values at the same points: where `condition` (if any) is positive."""

    labels: tuple[str, ...]
    program: Program
    condition: Program | None


class Oracle:
    """All functions of one model of one table, ready to be evaluated."""

    def __init__(self, table: Table | Path | str, model: str, functions: Iterable[str] | None = None) -> None:
        """Derive and compile the functions (all of them, or those named); SDCOM takes some seconds."""
        self.table = table if isinstance(table, Table) else load_table(table)
        self.model = build_model(self.table, model)
        found = all_functions(self.model)
        self.restricted = functions is not None
        chosen = list(found.entries) if functions is None else list(functions)
        for name in chosen:
            if name not in found.entries:
                raise ValueError(f"{model}: no function {name!r}")
        self.functions: dict[str, Entries] = {name: found.entries[name] for name in found.entries if name in chosen}
        self.labels = tuple(label for function in self.functions.values() for label, _ in function)
        self.names = tuple(self.model.arguments())
        self._groups = self._compile(found.positive)

    def nominal(self) -> dict[str, float]:
        """Return the table's values as the parameter part of a point."""
        return {f"parameter.{name}": value for name, value in self.table.values.items()}

    def evaluate(self, point: Mapping[str, Number]) -> Evaluation:
        """Return value and K of every entry at `point`, whose keys are the qualified names in ``names``."""
        with mpmath.workdps(DIGITS):
            arguments = [mpmath.mpf(point[name]) for name in self.names]
            results: Evaluation = {}
            for group in self._groups:
                if group.condition is not None and group.condition(arguments)[0][0] <= 0:
                    results |= dict.fromkeys(group.labels, (mpmath.mpf("nan"), mpmath.mpf(0)))
                    continue
                for label, (value, magnitude) in zip(group.labels, group.program(arguments), strict=True):
                    results[label] = (_settle(value, magnitude), mpmath.mpf(magnitude))
            return {label: results[label] for label in self.labels}

    def identity_residuals(self, point: Mapping[str, Number]) -> dict[str, Number]:
        """Return (f + g u + h chi - drift) / K(drift) of the four channels of SDCOM, exact or printed.

        Zero for a table linear in eta; what is of higher order in chi no h can carry.
        """
        with mpmath.workdps(DIGITS):
            results = self.evaluate(point)
            residuals = {}
            for suffix, (row, kind, name) in DRIVES.items():
                total = results[f"f_{suffix}"][0] + results[f"g_{suffix}"][0] * mpmath.mpf(point[f"{kind}.{name}"])
                for i, mode in enumerate(self.table.modes):
                    total += results[f"h_{suffix}.{i}"][0] * mpmath.mpf(point[f"state.chi_{mode}"])
                error = total - results[f"drift.{row}"][0]
                residuals[suffix] = error / results[f"drift.{row}"][1] if error else error
            return residuals

    def _compile(self, positive: Mapping[str, Expr]) -> list[_Group]:
        conditions = list(dict.fromkeys(positive.get(name) for name in self.functions))
        groups = []
        for condition in conditions:
            names = [name for name in self.functions if positive.get(name) == condition]
            entries = [entry for name in names for entry in self.functions[name]]
            program = self._program([expr for _, expr in entries])
            guard = None if condition is None else self._program([condition])
            groups.append(_Group(tuple(label for label, _ in entries), program, guard))
        return groups

    def _program(self, outputs: list[Expr]) -> Program:
        arguments = list(self.model.arguments().values())
        # omega t reaches hundreds; elsewhere the arguments of sin, cos and exp are of order 1
        conditioned = self.model.name == "flexible_mode"
        return Program(arguments, self.model.names.definitions, outputs, conditioned)


def _settle(value: Number, magnitude: float) -> Number:
    return mpmath.mpf(0) if abs(value) <= _ROUNDING * magnitude else mpmath.mpf(value)
