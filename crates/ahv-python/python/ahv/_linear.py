"""Linear systems: poles with their modes, zeros, regulators."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import RequestError
from ._module import Known
from ._names import Array, Names, Point


@dataclass(frozen=True)
class Pole:
    """An eigenvalue of A in 1/s, the mode that it belongs to, and the share of the mode's states in it, 0 to 1."""

    value: complex
    mode: str | None
    participation: float

    @property
    def frequency(self) -> float:
        """Natural frequency in rad/s."""
        return abs(self.value)

    @property
    def damping(self) -> float:
        """Damping ratio: 1 for a real stable pole; 0 for one at 0."""
        return -self.value.real / abs(self.value) if self.value else 0.0


@dataclass(frozen=True)
class Zero:
    """A finite zero in 1/s; ``decoupling`` is ``"input"`` or ``"output"`` where that misses a pole, which cancels."""

    value: complex
    decoupling: str | None


@dataclass(frozen=True)
class Zeros:
    """Zeros of a system: the finite ones, the rank of its transfer matrix, the orders of those at infinity."""

    finite: list[Zero]
    normal_rank: int
    infinite_orders: list[int]


@dataclass(frozen=True, repr=False)
class LinearSystem:
    """dx/dt = A x + B u, y = C x + D u, for deviations from a point, in the units of the model."""

    A: Array
    B: Array
    C: Array
    D: Array
    states: Names
    inputs: Names
    outputs: Names
    point: Point
    model: Known = field(repr=False)

    def poles(self) -> list[Pole]:
        """Poles by rising frequency, with their modes."""
        poles = self.model.vehicle.poles(self.A)
        return [Pole(complex(*value), mode, share) for value, mode, share in poles]

    def zeros(self) -> Zeros:
        """Invariant zeros from the inputs to the outputs."""
        finite, rank, orders = self.model.module.native.zeros(self.A, self.B, self.C, self.D)
        return Zeros([Zero(complex(*value), misses) for value, misses in finite], rank, list(orders))

    def lqr(self, Q: npt.ArrayLike, R: npt.ArrayLike) -> Regulator:
        """The regulator u = −K x that minimises ∫ xᵀQx + uᵀRu dt.

        Parameters
        ----------
        Q : (n, n)
            Positive semidefinite.
        R : (m, m)
            Positive definite.

        Raises
        ------
        NumericError
            A shape or weight that does not fit, a mode that no input moves or no weight sees.
        """
        weights = []
        for name, given in (("Q", Q), ("R", R)):
            matrix = np.ascontiguousarray(given, dtype=np.float64)
            if matrix.ndim != 2:
                raise RequestError(f"{name}: its shape is {matrix.shape}; it must be a matrix")
            weights.append(matrix)
        gain, cost, poles, residual = self.model.module.native.regulator(self.A, self.B, *weights)
        return Regulator(
            K=np.array(gain),
            poles=np.array([complex(*pole) for pole in poles]),
            residual=residual,
            states=self.states,
            inputs=self.inputs,
            X=np.array(cost),
        )

    def to_control(self) -> Any:
        """A ``control.StateSpace`` of python-control, with the names of the signals."""
        import control

        return control.ss(
            self.A,
            self.B,
            self.C,
            self.D,
            name=self.model.name,
            states=list(self.states),
            inputs=list(self.inputs),
            outputs=list(self.outputs),
        )

    def to_pandas(self) -> dict[str, Any]:
        """A, B, C and D as pandas ``DataFrame`` with the names of rows and columns."""
        import pandas as pd

        x, u, y = self.states.names, self.inputs.names, self.outputs.names
        shapes = {"A": (x, x), "B": (x, u), "C": (y, x), "D": (y, u)}
        return {name: pd.DataFrame(getattr(self, name), rows, columns) for name, (rows, columns) in shapes.items()}

    def plot_poles(self, axes: Any = None) -> Any:
        """Poles and zeros in the plane, and gives the axes of matplotlib."""
        from ._plot import pole_map

        poles = [(pole.value, pole.mode) for pole in self.poles()]
        return pole_map(poles, [zero.value for zero in self.zeros().finite], axes)

    def __repr__(self) -> str:
        x, u, y = self.states, self.inputs, self.outputs
        blocks = (("A", x, x), ("B", x, u), ("C", y, x), ("D", y, u))
        return "\n".join(_block(name, getattr(self, name), rows, columns) for name, rows, columns in blocks)


def _block(name: str, matrix: Array, rows: Names, columns: Names) -> str:
    head = f"{name:<11}" + "".join(f" {column:>11}" for column in columns)
    lines = [
        f"{row:<11}" + "".join(f" {value:>11.4e}" for value in values)
        for row, values in zip(rows, matrix.tolist(), strict=True)
    ]
    return "\n".join([head, *lines])


@dataclass(frozen=True)
class Regulator:
    """u = −K x, or about a trim u = input − K (x − state − rate t).

    Attributes
    ----------
    K : (m, n)
        Gain; the unit of an entry is that of its input over that of its state.
    poles : (n,)
        Of the closed loop, in 1/s, rightmost first.
    residual
        Of the Riccati equation, over the largest of its terms.
    X : (n, n), optional
        The cost from x is xᵀXx.
    data
        All that the command says.
    """

    K: Array
    poles: npt.NDArray[np.complex128]
    residual: float
    states: Names
    inputs: Names
    X: Array | None = None
    data: Mapping[str, Any] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, model: Known, data: Mapping[str, Any]) -> Regulator:
        """From what the command says."""
        inputs = tuple(data["inputs"])
        return cls(
            K=np.array(data["gain"]),
            poles=np.array([complex(*pole) for pole in data["poles"]]),
            residual=data["residual"],
            states=model.states,
            inputs=Names(inputs, tuple(model.inputs.unit(name) for name in inputs)),
            data=data,
        )

    def to_pandas(self) -> Any:
        """K as a pandas ``DataFrame``."""
        import pandas as pd

        return pd.DataFrame(self.K, self.inputs.names, self.states.names)
