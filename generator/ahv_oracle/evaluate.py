"""Evaluates all functions of a model at 50 digits."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import mpmath
import sympy

from .feedback import CHANNELS
from .functions import Entries, all_functions
from .magnitude import Magnitude
from .model import build_model
from .table import Table, load_table

DIGITS = 50
"""Decimal digits of the arithmetic."""

Number = Any
"""An ``mpmath.mpf``, a float or an int (mpmath 1.3 has no types)."""

Evaluation = dict[str, tuple[Number, Number]]
"""Value and K, both ``mpf``, by label."""

_ROUNDING = 1e-45  # relative to K; below it a value is the rounding of an exact zero


class Oracle:
    """All functions of one model of one table, ready to be evaluated."""

    def __init__(self, table: Table | Path | str, model: str) -> None:
        """Derive and compile the functions; SDCOM takes about a second."""
        self.table = table if isinstance(table, Table) else load_table(table)
        self.model = build_model(self.table, model)
        self.functions: dict[str, Entries] = all_functions(self.model)
        entries = [entry for function in self.functions.values() for entry in function]
        self.labels = tuple(label for label, _ in entries)
        arguments = self.model.arguments()
        self.names = tuple(arguments)
        self._values, self._magnitudes = _compile(list(arguments.values()), [expr for _, expr in entries])

    def nominal(self) -> dict[str, float]:
        """Return the table's values as the parameter part of a point."""
        return {f"parameter.{name}": value for name, value in self.table.values.items()}

    def evaluate(self, point: Mapping[str, Number]) -> Evaluation:
        """Return value and K of every entry at `point`, whose keys are the qualified names in ``names``."""
        with mpmath.workdps(DIGITS):
            arguments = [mpmath.mpf(point[name]) for name in self.names]
            floats = [float(argument) for argument in arguments]
            values = self._values(*arguments)
            magnitudes = self._magnitudes(*floats, *map(abs, floats))
            return {
                label: (_settle(value, magnitude), mpmath.mpf(magnitude))
                for label, value, magnitude in zip(self.labels, values, magnitudes, strict=True)
            }

    def identity_residuals(self, point: Mapping[str, Number]) -> dict[str, Number]:
        """Return (f + g u + h chi - drift) / K(drift) of the four strict-feedback channels of SDCOM.

        Zero for a table linear in eta; what is of higher order in chi no h can carry.
        """
        with mpmath.workdps(DIGITS):
            value = {label: pair[0] for label, pair in self.evaluate(point).items()}
            scale = {label: pair[1] for label, pair in self.evaluate(point).items()}
            residuals = {}
            for suffix, (row, kind, name) in CHANNELS.items():
                total = value[f"f_{suffix}"] + value[f"g_{suffix}"] * mpmath.mpf(point[f"{kind}.{name}"])
                for i, mode in enumerate(self.table.modes):
                    total += value[f"h_{suffix}.{i}"] * mpmath.mpf(point[f"state.chi_{mode}"])
                error = total - value[f"drift.{row}"]
                residuals[suffix] = error / scale[f"drift.{row}"] if error else error
            return residuals


def _settle(value: Number, magnitude: float) -> Number:
    return mpmath.mpf(0) if abs(value) <= _ROUNDING * magnitude else value


def _compile(
    symbols: list[sympy.Symbol], exprs: list[sympy.Expr]
) -> tuple[Callable[..., list[Number]], Callable[..., list[float]]]:
    """Functions for the values (mpmath) and for K (floats: sums of positive terms keep their digits)."""
    build = Magnitude()
    absolutes = [build.absolute(symbol) for symbol in symbols]
    values = sympy.lambdify(symbols, exprs, modules="mpmath", cse=True)
    magnitudes = sympy.lambdify(symbols + absolutes, [build.of(expr) for expr in exprs], modules="math", cse=True)
    return values, magnitudes
