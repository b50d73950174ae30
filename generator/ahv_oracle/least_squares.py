"""Least squares by NumPy and SciPy, for the tests of `ahv-fit`.

`numpy.linalg.lstsq` (singular values) and `scipy.optimize.lsq_linear` (bounds) on the whole design at once; ahv-fit
reflects blocks of rows and never has the whole. Line 1 of the vectors is a comment, the rest is JSON.
"""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

SEED = 20261201
ROWS = 700
FOLDS = 7
MONOMIALS = ((0, 0), (1, 0), (2, 0), (0, 1), (1, 1))
TRUE = (0.7, -1.3, 0.4, 2.1, 0.02)
MASK = (1 << 64) - 1

Array = NDArray[np.float64]


def mixed(counter: int) -> int:
    """Return SplitMix64 of a counter: the fold of a row is its remainder."""
    bits = (counter + 1) * 0x9E3779B97F4A7C15 & MASK
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9 & MASK
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EB & MASK
    return bits ^ (bits >> 31)


def least_squares_lines() -> Iterator[str]:
    """Yield the lines of the file."""
    yield f"# ahv reference values of least squares, NumPy and SciPy, seed {SEED}"
    draw = random.Random(SEED)
    points = np.array([[draw.uniform(-1.5, 1.0), draw.uniform(0.2, 2.0)] for _ in range(ROWS)])
    weights = np.array([draw.uniform(0.2, 3.0) for _ in range(ROWS)])
    design = np.array([[x**i * y**j for i, j in MONOMIALS] for x, y in points])
    noise = np.array([draw.gauss(0.0, 0.3) for _ in range(ROWS)])
    wanted = design @ np.array(TRUE) + noise / np.sqrt(weights)
    folds = np.array([mixed(row) % FOLDS for row in range(ROWS)])
    cases = [_case(design, wanted, w, folds) for w in (np.ones(ROWS), weights)]
    text = {
        "variables": points.T.tolist(),
        "response": wanted.tolist(),
        "weights": weights.tolist(),
        "monomials": MONOMIALS,
        "folds": FOLDS,
        "plain": cases[0],
        "weighted": cases[1],
        "fixed": _reduced(design, wanted, {3: 2.0}),
        "tied": _tied(design, wanted, 4, 0, 0.5),
        "signed": _signed(design, wanted),
    }
    yield json.dumps(text)


def _solve(design: Array, wanted: Array) -> Array:
    found: NDArray[np.floating[Any]] = np.linalg.lstsq(design, wanted, rcond=None)[0]
    return found.astype(np.float64)


def _case(design: Array, wanted: Array, weights: Array, folds: Array) -> dict[str, Any]:
    root: Array = np.sqrt(weights)
    scaled, aim = design * root[:, None], wanted * root
    found = _solve(scaled, aim)
    left = aim - scaled @ found
    degrees = len(aim) - len(found)
    covariance = np.linalg.inv(scaled.T @ scaled) * (left @ left) / degrees
    mean = np.average(wanted, weights=weights)
    spread = float(weights @ (wanted - mean) ** 2)
    out = 0.0
    for fold in range(FOLDS):
        inside = folds == fold
        trained = _solve(scaled[~inside], aim[~inside])
        out += float(np.sum((aim[inside] - scaled[inside] @ trained) ** 2))
    return {
        "values": found.tolist(),
        "covariance": covariance.tolist(),
        "residual": float(np.sqrt(left @ left / weights.sum())),
        "r_squared": 1 - float(left @ left) / spread,
        "cross_validated": float(np.sqrt(out / weights.sum())),
        "condition": float(np.linalg.cond(scaled / np.linalg.norm(scaled, axis=0))),
    }


def _reduced(design: Array, wanted: Array, fixed: dict[int, float]) -> list[float]:
    free = [it for it in range(design.shape[1]) if it not in fixed]
    values = np.zeros(design.shape[1])
    for index, value in fixed.items():
        values[index] = value
    values[free] = _solve(design[:, free], wanted - design @ values)
    return [float(it) for it in values]


def _tied(design: Array, wanted: Array, coefficient: int, other: int, factor: float) -> list[float]:
    """Least squares where one coefficient is a multiple of another, by a Lagrange multiplier."""
    count = design.shape[1]
    row = np.zeros(count)
    row[coefficient], row[other] = 1.0, -factor
    system = np.block([[design.T @ design, row[:, None]], [row[None, :], np.zeros((1, 1))]])
    found = np.linalg.solve(system, np.append(design.T @ wanted, 0.0))
    return [float(it) for it in found[:count]]


def _signed(design: Array, wanted: Array) -> list[float]:
    """Coefficient 1 is not negative, coefficient 2 is not positive, coefficient 3 is not negative."""
    low = [-np.inf, 0.0, -np.inf, 0.0, -np.inf]
    high = [np.inf, np.inf, 0.0, np.inf, np.inf]
    found = lsq_linear(design, wanted, (low, high), method="bvls", tol=1e-14)
    return [float(it) for it in found.x]
