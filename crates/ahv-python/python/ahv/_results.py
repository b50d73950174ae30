"""What analyses give: named numbers with units, that become pandas or xarray where they are asked to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from ._module import Known
from ._names import Array, Names, Point, Vector


def _vector(values: Mapping[str, float], basis: Names) -> Vector:
    return basis.vector([values[name] for name in basis.names])


def _number(value: float | None) -> float:
    # JSON has no number for what is not finite.
    return np.nan if value is None else value


@dataclass(frozen=True, repr=False)
class Trim:
    """A steady state.

    Attributes
    ----------
    state, input, outputs : Vector
        Where it is.
    residuals : Vector
        What is left of each row of the drift, per second.
    iterations
        Steps of the search.
    in_validity_box
        Whether the point lies where the model is meant to be used.
    data
        All that the command says.
    """

    state: Vector
    input: Vector
    outputs: Vector
    residuals: Vector
    iterations: int
    in_validity_box: bool
    data: Mapping[str, Any] = field(repr=False)

    @classmethod
    def of(cls, model: Known, data: Mapping[str, Any]) -> Self:
        """From what the command says."""
        return cls(
            state=_vector(data["state"], model.states),
            input=_vector(data["input"], model.inputs),
            outputs=_vector(data["outputs"], model.outputs),
            residuals=_vector(data["residuals"], model.states),
            iterations=data["iterations"],
            in_validity_box=data["in_validity_box"],
            data=data,
        )

    @property
    def point(self) -> Point:
        """State, input and outputs."""
        return Point(self.state, self.input, self.outputs)

    def __repr__(self) -> str:
        return repr(self.point)

    def _repr_html_(self) -> str:
        return self.point._repr_html_()


@dataclass(frozen=True, repr=False)
class Trajectory:
    """A flight.

    Attributes
    ----------
    time : (t,)
        In s.
    x : (t, n)
        States.
    states : Names
        Their names and units.
    input : Vector
        The inputs that were held.
    """

    time: Array
    x: Array
    states: Names
    input: Vector

    def __getitem__(self, name: str) -> Array:
        column: Array = self.x[:, self.states.index(name)]
        return column

    def to_pandas(self) -> Any:
        """A pandas ``DataFrame`` by time; units are in its ``attrs``."""
        import pandas as pd

        frame = pd.DataFrame(self.x, index=pd.Index(self.time, name="time"), columns=list(self.states))
        frame.attrs["units"] = dict(zip(self.states.names, self.states.units, strict=True))
        return frame

    def to_xarray(self) -> Any:
        """An xarray ``Dataset`` with a variable for each state and its unit."""
        return _dataset(self.time, {name: self[name] for name in self.states}, self.states)

    def plot(self, *names: str) -> Any:
        """Draws states, all where none are named, and gives the axes of matplotlib."""
        from ._plot import lines

        shown = names or self.states.names
        return lines(self.time, {name: (self[name], None) for name in shown}, self.states)

    def __repr__(self) -> str:
        return f"{len(self.time)} points from {self.time[0]:g} s to {self.time[-1]:g} s of {self.states!r}"


def _dataset(time: Array, columns: Mapping[str, Array], basis: Names) -> Any:
    import xarray as xr

    variables = {
        name: ("time", values, {} if basis.unit(name) == "1" else {"units": basis.unit(name)})
        for name, values in columns.items()
    }
    return xr.Dataset(variables, {"time": ("time", time, {"units": "s"})})


@dataclass(frozen=True, repr=False)
class Report:
    """What a command says of a model: ``report["members"]``, or all of it in ``report.data``."""

    data: Mapping[str, Any]
    states: Names

    @classmethod
    def of(cls, model: Known, data: Mapping[str, Any]) -> Self:
        """From what the command says."""
        return cls(data, model.states)

    def __getitem__(self, name: str) -> Any:
        return self.data[name]

    def keys(self) -> Sequence[str]:
        """What it has."""
        return list(self.data)


class _OverTime(Report):
    """A report at several times."""

    _rows: str
    _estimates: tuple[str, ...]

    @property
    def time(self) -> Array:
        """Times in s."""
        return np.array([row["time"] for row in self.data[self._rows]])

    def _estimate(self, kind: str, end: str = "value") -> Array:
        """An estimate of each state at each time, (t, n), or an end of its interval of 95 %."""

        def number(row: Mapping[str, Any], name: str) -> float:
            found = row[kind][name]
            return _number(found[end] if isinstance(found, Mapping) else found)

        return np.array([[number(row, name) for name in self.states] for row in self.data[self._rows]])

    def to_pandas(self) -> Any:
        """A pandas ``DataFrame`` by time, whose columns are (estimate, state)."""
        import pandas as pd

        parts = {kind: pd.DataFrame(self._estimate(kind), columns=list(self.states)) for kind in self._estimates}
        frame = pd.concat(parts, axis=1)
        frame.index = pd.Index(self.time, name="time")
        frame.attrs["units"] = dict(zip(self.states.names, self.states.units, strict=True))
        return frame

    def to_xarray(self) -> Any:
        """An xarray ``Dataset`` with a variable (time, state) for each estimate."""
        import xarray as xr

        variables = {kind: (("time", "state"), self._estimate(kind)) for kind in self._estimates}
        units = ("state", list(self.states.units))
        return xr.Dataset(variables, {"time": self.time, "state": list(self.states), "unit": units})


class MonteCarlo(_OverTime):
    """What many flights show: spread at several times, and how many were lost or left the validity box."""

    _rows = "snapshots"
    _estimates = ("mean", "std")

    @property
    def members(self) -> int:
        """Members that were flown."""
        return int(self.data["members"])

    @property
    def digest(self) -> str:
        """SHA-256 of the bits of the members' last states."""
        return str(self.data["digest"])

    @property
    def mean(self) -> Array:
        """Mean of each state at each time, (t, n)."""
        return self._estimate("mean")

    @property
    def std(self) -> Array:
        """Standard deviation of each state at each time, (t, n)."""
        return self._estimate("std")

    @property
    def covariance(self) -> Array:
        """Covariance of the states at each time, (t, n, n)."""
        return np.array([row["covariance"] for row in self.data["snapshots"]], dtype=np.float64)

    def plot(self, *names: str) -> Any:
        """Draws mean and standard deviation of states over time, and gives the axes of matplotlib."""
        from ._plot import lines

        mean, std = self.mean, self.std
        columns = {name: self.states.index(name) for name in names or self.states.names}
        bands = {name: (mean[:, at], std[:, at]) for name, at in columns.items()}
        return lines(self.time, bands, self.states)

    def __repr__(self) -> str:
        rate = self.data["member_steps_per_second"]
        head = f"{self.members} members, {self.data['lost']} lost, {rate:.3g} member-steps per second; at the end"
        rows = zip(self.states, self.mean[-1], self.std[-1], self.states.units, strict=True)
        lines = [
            f"{name:<12} {mean:.6g} ± {std:.3g}" + ("" if unit == "1" else f" {unit}") for name, mean, std, unit in rows
        ]
        return "\n".join([head, *lines])


class Covariance(_OverTime):
    """Standard deviations about a flight, to first order (``linear_std``) and of an ensemble (``sampled_std``)."""

    _rows = "times"
    _estimates = ("linear_std", "sampled_std", "ratio")

    @property
    def linear(self) -> Array:
        """Covariance to first order at each time, (t, n, n)."""
        return np.array([row["linear_covariance"] for row in self.data["times"]], dtype=np.float64)

    @property
    def stationary(self) -> Array | None:
        """Covariance at rest, (n, n), with ``stationary=True``; None if the linear system does not come to rest."""
        found = self.data["stationary_covariance"]
        return None if found is None else np.array(found)

    def __repr__(self) -> str:
        worst = self.data["worst_ratio"]
        return f"{len(self.time)} times to {self.time[-1]:g} s, {self.data['members']} members; worst ratio {worst}"


class Dispersion(Report):
    """Trims and roots of vehicles whose parameters are drawn, and what parameters matter."""

    def to_pandas(self) -> Any:
        """A pandas ``DataFrame`` with a row for each quantity: nominal, spread, unit."""
        import pandas as pd

        rows = [
            {
                **{key: it[key] for key in ("kind", "name", "part", "unit", "nominal", "linear_std")},
                **(it["spread"] or {}),
            }
            for it in self.data["quantities"]
        ]
        return pd.DataFrame(rows)

    def sensitivities(self) -> Any:
        """A pandas ``DataFrame`` with a row for each quantity and parameter: slope and effect."""
        import pandas as pd

        rows = [
            {"name": it["name"], "part": it["part"], **one}
            for it in self.data["quantities"]
            for one in it["sensitivities"]
        ]
        return pd.DataFrame(rows)

    def __repr__(self) -> str:
        shares = self.data["shares"]
        lines = [
            f"{name}: {share['value']:.3g} ({share['low']:.3g} to {share['high']:.3g})"
            for name, share in shares.items()
        ]
        return "\n".join([f"{self.data['members']} vehicles", *lines])


class Rare(Report):
    """The probability that a state passes a limit."""

    @property
    def probability(self) -> float:
        """The estimate."""
        return float(self.data["probability"]["value"])

    @property
    def interval(self) -> tuple[float, float]:
        """Its interval of 95 %."""
        return self.data["probability"]["low"], self.data["probability"]["high"]

    def __repr__(self) -> str:
        low, high = self.interval
        state, limit, unit = (self.data[key] for key in ("state", "limit", "unit"))
        event = f"{state} passes {limit:.6g} {unit} by {self.data['time']:g} s"
        return f"P({event}) = {self.probability:.4g} ({low:.3g} to {high:.3g})"
