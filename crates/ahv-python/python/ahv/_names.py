"""Vectors whose components have names and units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import RequestError

Array = npt.NDArray[np.float64]


def unknown(kind: str, name: object, known: tuple[str, ...]) -> RequestError:
    """What to raise for a name that is not known."""
    near = get_close_matches(str(name), known, n=1)
    meant = f"; did you mean `{near[0]}`? Known: " if near else "; known: "
    return RequestError(f"unknown {kind} `{name}`{meant}{', '.join(known)}")


@dataclass(frozen=True)
class Names:
    """Names of the components of a vector, in order, with their units (``1`` where there is none)."""

    names: tuple[str, ...]
    units: tuple[str, ...]

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def index(self, name: str, kind: str = "name") -> int:
        """Index of a component."""
        if name not in self.names:
            raise unknown(kind, name, self.names)
        return self.names.index(name)

    def unit(self, name: str) -> str:
        """Unit of a component."""
        return self.units[self.index(name)]

    def vector(self, values: npt.ArrayLike) -> Vector:
        """The vector of these values."""
        return Vector(self, np.asarray(values, dtype=np.float64))

    def __repr__(self) -> str:
        return ", ".join(name if unit == "1" else f"{name} [{unit}]" for name, unit in self._pairs())

    def _pairs(self) -> Iterator[tuple[str, str]]:
        return zip(self.names, self.units, strict=True)


@dataclass(frozen=True, eq=False)
class Vector:
    """Numbers with names and units: ``v["alpha"]``, ``v.alpha``, ``np.asarray(v)``, ``dict(v)``."""

    basis: Names
    values: Array

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the components."""
        return self.basis.names

    @property
    def units(self) -> tuple[str, ...]:
        """Units of the components."""
        return self.basis.units

    def keys(self) -> tuple[str, ...]:
        """Names of the components."""
        return self.basis.names

    def __getitem__(self, name: str) -> float:
        return float(self.values[self.basis.index(name)])

    def __getattr__(self, name: str) -> float:
        if name.startswith("_") or name not in self.basis.names:
            raise AttributeError(f"there is no {name!r} among {', '.join(self.basis.names)}")
        return self[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.basis)

    def __len__(self) -> int:
        return len(self.basis)

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.values, dtype=dtype, copy=copy)

    def __eq__(self, other: object) -> bool:
        same = isinstance(other, Vector) and self.basis == other.basis
        return same and bool(np.array_equal(self.values, other.values))  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash((self.basis, self.values.tobytes()))

    def replace(self, **values: float) -> Vector:
        """The same with other values of these components."""
        new = self.values.copy()
        for name, value in values.items():
            new[self.basis.index(name)] = value
        return Vector(self.basis, new)

    def to_pandas(self) -> Any:
        """A pandas ``Series`` by name."""
        import pandas as pd

        series = pd.Series(self.values, index=list(self.names))
        series.attrs["units"] = dict(zip(self.names, self.units, strict=True))
        return series

    def _rows(self) -> Iterator[tuple[str, float, str]]:
        return zip(self.names, self.values.tolist(), self.units, strict=True)

    def __repr__(self) -> str:
        width = max(map(len, self.names), default=0)
        return "\n".join(f"{name:<{width}} {_shown(value, unit)}" for name, value, unit in self._rows())

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{name}</th><td>{_shown(value, unit)}</td></tr>" for name, value, unit in self._rows())
        return f"<table>{rows}</table>"


def _shown(value: float, unit: str) -> str:
    return f"{value:.7g}" + ("" if unit == "1" else f" {unit}")


@dataclass(frozen=True)
class Point:
    """A state and an input of a model, with the quantities that people look at."""

    state: Vector
    input: Vector
    outputs: Vector

    def __repr__(self) -> str:
        return f"state\n{self.state}\ninput\n{self.input}"

    def _repr_html_(self) -> str:
        return f"<b>state</b>{self.state._repr_html_()}<b>input</b>{self.input._repr_html_()}"


def components(argument: str, given: npt.ArrayLike | Mapping[str, float] | Vector, basis: Names) -> Array:
    """The numbers of a vector, or of many in leading dimensions, in the order of their names."""
    if isinstance(given, Vector):
        if given.basis.names != basis.names or given.basis.units != basis.units:
            raise RequestError(f"{argument}: it has {given.basis!r}; it must have {basis!r}")
        return given.values
    if isinstance(given, Mapping):
        for name in given:
            if name not in basis.names:
                raise RequestError(f"{argument}: {unknown('name', name, basis.names)}")
        return np.array([float(given.get(name, 0.0)) for name in basis.names])
    array = np.asarray(given)
    if array.dtype.kind not in "fiu" and not (array.size == 0 and len(basis) == 0):
        raise RequestError(f"{argument}: its numbers are {array.dtype}; they must be real")
    if array.ndim == 0 or array.shape[-1] != len(basis):
        raise RequestError(
            f"{argument}: its shape is {array.shape}; "
            f"the last dimension must be {len(basis)} ({', '.join(basis.names)})"
        )
    return np.ascontiguousarray(array, dtype=np.float64)
