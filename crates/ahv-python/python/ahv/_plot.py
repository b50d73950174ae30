"""Pictures in the style of the house: thin lines, light grids, units on the axes, angles in degrees."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._names import Array, Names

_COLOURS = ("#1f5f99", "#c2452d", "#3a7d44", "#8a5a9e", "#b8860b", "#3d8f8f", "#7f4f3a")


def _readable(unit: str) -> tuple[str, float]:
    """A unit as pictures show it, with what numbers are multiplied with."""
    return (unit.replace("rad", "deg"), float(np.degrees(1.0))) if unit.startswith("rad") else (unit, 1.0)


def _style(axes: Any) -> None:
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=8)


def lines(time: Array, columns: Mapping[str, tuple[Array, Array | None]], basis: Names) -> Any:
    """One axis a quantity over time, with a band where there is one."""
    import matplotlib.pyplot as plt

    figure, grid = plt.subplots(len(columns), 1, sharex=True, squeeze=False, figsize=(6.4, 0.6 + 1.3 * len(columns)))
    for axes, (name, (middle, band)) in zip(grid[:, 0], columns.items(), strict=True):
        unit, factor = _readable(basis.unit(name))
        axes.plot(time, factor * middle, color=_COLOURS[0], linewidth=1.1)
        if band is not None:
            low, high = factor * (middle - band), factor * (middle + band)
            axes.fill_between(time, low, high, color=_COLOURS[0], alpha=0.2, linewidth=0)
        label = name.replace("_", " ")
        axes.set_ylabel(label if unit == "1" else f"{label}\n{unit}", fontsize=8)
        _style(axes)
    grid[-1, 0].set_xlabel("time, s", fontsize=8)
    figure.tight_layout()
    return grid[:, 0]


def pole_map(poles: Sequence[tuple[complex, str | None]], zeros: Sequence[complex], axes: Any = None) -> Any:
    """Poles with their modes, and zeros."""
    import matplotlib.pyplot as plt

    if axes is None:
        axes = plt.subplots(figsize=(5.0, 4.2))[1]
    for index, mode in enumerate(dict.fromkeys(mode for _, mode in poles)):
        values = np.array([value for value, own in poles if own == mode])
        colour = _COLOURS[index % len(_COLOURS)]
        axes.plot(values.real, values.imag, "x", color=colour, markersize=6, label=mode or "other")
    if zeros:
        axes.plot(np.real(zeros), np.imag(zeros), "o", color="#555555", markersize=5, fillstyle="none", label="zeros")
    axes.axvline(0.0, color="#999999", linewidth=0.8)
    axes.set_xlabel("real part, 1/s", fontsize=8)
    axes.set_ylabel("imaginary part, rad/s", fontsize=8)
    axes.legend(fontsize=7, frameon=False)
    _style(axes)
    return axes
