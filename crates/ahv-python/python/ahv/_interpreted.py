"""Models whose equations are evaluated by NumPy from the IR: no compiler is needed."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

import numpy as np

from . import _models
from ._errors import NumericError, RequestError
from ._ir import Source, numpy_result
from ._names import Array, unknown

_DEGREES = re.compile(r"(/?)\s*\bdeg\b(?:\^(-?[0-9.]+))?")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_MOST_STEPS = 50
# A residual, over the largest change that a step of an unknown makes, that counts as none.
_SETTLED = 1e-13

_Named = tuple[list[str], list[str]]
_Pair = tuple[float, float]


def _options(words: Iterable[str]) -> dict[str, str]:
    """Flags and values of a command line."""
    split = (word.removeprefix("--").partition("=") for word in words)
    return {name: value for name, _, value in split}


class Interpreted:
    """The models of a table from its IR, with the interface of a compiled module."""

    def __init__(self, table: str, documents: list[str]) -> None:
        self.table = tomllib.loads(table)
        self._texts = documents
        self.irs = [json.loads(text) for text in documents]
        self.Vehicle: Any = partial(_Vehicle, self)

    def models(self) -> list[tuple[str, str]]:
        """Names and titles."""
        return [(model["name"], model["title"]) for ir in self.irs for model in ir["models"]]

    def documents(self) -> list[str]:
        """Texts of the IR."""
        return self._texts

    def zeros(self, a: Array, b: Array, c: Array, d: Array) -> Any:
        """Zeros of a linear system."""
        return _models.zeros(a, b, c, d)

    def regulator(self, a: Array, b: Array, q: Array, r: Array) -> Any:
        """The regulator of a linear system."""
        return _models.regulator(a, b, q, r)

    def command(self, words: list[str]) -> tuple[str, list[str]]:
        """Of the commands there is ``trim``."""
        command, *flags = words
        if command != "trim":
            raise RequestError(f"{command} needs compiled models: load them with compiled=True")
        options = _options(flag for flag in flags if flag != "--json")
        condition = {"model", "set", "units", "table", *(choice["name"] for ir in self.irs for choice in ir["choices"])}
        vehicle = _Vehicle(self, [f"--{name}={value}" for name, value in options.items() if name in condition])
        options = {name: value for name, value in options.items() if name not in condition}
        return json.dumps(_trim(vehicle, options)), []


class _Vehicle:
    """A model in its condition."""

    notes: tuple[str, ...] = ()

    def __init__(self, package: Interpreted, words: list[str]) -> None:
        options = _options(words)
        self.name = options.pop("model")
        self.ir = next(ir for ir in package.irs if any(it["name"] == self.name for it in ir["models"]))
        self.source = Source([self.ir], self.name)
        self.title = self.source.model["title"]
        self.unit_system = self.ir["units"]["system"]
        if "table" in options or options.get("units", self.unit_system) != self.unit_system:
            raise RequestError("table, units: a model that is not compiled has those that it was loaded with")
        options.pop("units", None)
        self.sets = [one["name"] for one in self.ir["sets"]]
        self.set = options.pop("set", self.sets[0])
        if self.set not in self.sets:
            raise RequestError(f"set: {unknown('set of parameters', self.set, tuple(self.sets))}")
        self._table = package.table
        self._chosen = {it["name"]: package.table.get("choices", {}).get(it["name"]) for it in self.ir["choices"]}
        for name, option in options.items():
            known = tuple(one for choice, _, all_of in self.choices for one in all_of if choice == name)
            if option not in known:
                raise RequestError(f"{name}: {unknown(name, option, known)}")
            self._chosen[name] = option
        self.parameter_values = self._values()
        self.uncertainty = [one["uncertainty"] for one in self.ir["parameters"]]
        self.given = [one["name"] for one in self.source.model["trim"]["given"]]

    @property
    def choices(self) -> list[tuple[str, str | None, list[str]]]:
        """As of a compiled model."""
        return [
            (it["name"], self._chosen[it["name"]], [option["name"] for option in it["options"]])
            for it in self.ir["choices"]
        ]

    @property
    def states(self) -> _Named:
        """Names and units."""
        return self._basis("state")

    @property
    def inputs(self) -> _Named:
        """Names and units."""
        return self._basis("input")

    @property
    def outputs(self) -> _Named:
        """Names and units."""
        return self._basis("output")

    @property
    def increments(self) -> _Named:
        """Names and units."""
        return self._basis("noise")

    @property
    def parameters(self) -> _Named:
        """Names and units."""
        return [one["name"] for one in self.ir["parameters"]], [one["unit"] for one in self.ir["parameters"]]

    @property
    def state_bounds(self) -> list[_Pair]:
        """The validity box."""
        return self._bounds("state")

    @property
    def input_bounds(self) -> list[_Pair]:
        """The validity box."""
        return self._bounds("input")

    def evaluate(self, kind: str, x: Array, u: Array, p: Array, out: Array) -> None:
        """As of a compiled model."""
        points = len(out)
        leaves = {
            f"{prefix}.{name}": rows[:, index]
            for prefix, rows, names in zip("xup", (x, u, p), (self.states, self.inputs, self.parameters), strict=True)
            for index, name in enumerate(names[0])
        }
        with np.errstate(all="ignore"):
            if kind == "jacobians":
                parts = [numpy_result(self.source, it, leaves, points) for it in ("state_jacobian", "input_jacobian")]
                result = np.concatenate(parts, axis=2)
            else:
                result = numpy_result(self.source, kind, leaves, points)
        out[:] = result.reshape(points, -1)
        if not np.isfinite(out).all():
            for name, rows in zip("xup", (x, u, p), strict=True):
                for row, column in np.argwhere(~np.isfinite(rows)):
                    raise RequestError(f"{name}: number {column} of row {row} is not finite")

    def at(self, kind: str, x: Array, u: Array) -> Array:
        """A result at one point."""
        shape = self.source.shape(kind)
        out = np.empty((1, math.prod(shape)))
        self.evaluate(kind, x[None], u[None], np.array([self.parameter_values]), out)
        return out.reshape(shape)

    def linearize(
        self, x: Array, u: Array, inputs: list[str], outputs: list[str]
    ) -> tuple[list[Array], list[str], list[str]]:
        """As of a compiled model; the slopes of outputs that are no states are central differences."""
        defaults = self.source.model["defaults"]
        inputs = inputs or defaults["inputs"] or self.inputs[0]
        outputs = outputs or defaults["outputs"] or self.states[0]
        for option, names, known in (
            ("inputs", inputs, self.inputs[0]),
            ("outputs", outputs, [*self.states[0], *self.outputs[0]]),
        ):
            for name in names:
                if name not in known:
                    raise RequestError(f"{option}: {unknown(option.rstrip('s'), name, tuple(known))}")
        moved = [self.inputs[0].index(name) for name in inputs]
        a = self.at("state_jacobian", x, u)
        b = self.at("input_jacobian", x, u)[:, moved]
        slopes = _slopes(lambda x, u: np.concatenate([x, self.at("outputs", x, u)]), x, u)
        seen = [[*self.states[0], *self.outputs[0]].index(name) for name in outputs]
        n = len(x)
        return [a, b, slopes[seen, :n], slopes[seen][:, [n + at for at in moved]]], list(inputs), list(outputs)

    def poles(self, a: Array) -> list[tuple[_Pair, str | None, float]]:
        """Poles by rising frequency, without their modes."""
        values = np.linalg.eigvals(a)
        ordered = sorted(values.tolist(), key=lambda it: (abs(it), -complex(it).imag))
        return [((complex(it).real, complex(it).imag), None, 0.0) for it in ordered]

    def _basis(self, kind: str) -> _Named:
        basis = self.source.model["bases"].get(kind, [])
        return [one["name"] for one in basis], [one["unit"] for one in basis]

    def _bounds(self, kind: str) -> list[_Pair]:
        bounds = []
        for one in self.source.model["bases"].get(kind, []):
            entry = self._table.get("validity", {}).get(one["validity"], {})
            factor = _radians(entry.get("unit", "1"))
            bounds.append((entry.get("min", -math.inf) * factor, entry.get("max", math.inf) * factor))
        return bounds

    def _values(self) -> list[float]:
        replaced = next(one for one in self.ir["sets"] if one["name"] == self.set)["parameters"]
        paths = {one["name"]: one["path"] for one in replaced}
        switches = {
            name: value
            for choice in self.ir["choices"]
            for option in choice["options"]
            if option["name"] == self._chosen[choice["name"]]
            for name, value in option["values"].items()
        }
        return [
            float(switches[one["name"]])
            if one["name"] in switches
            else self._number(paths.get(one["name"], one["path"]))
            for one in self.ir["parameters"]
        ]

    def _number(self, path: list[str]) -> float:
        entry: Any = self._table
        for key in path:
            entry = entry.get(key, {}) if isinstance(entry, Mapping) else {}
        if isinstance(entry, Mapping):
            # A coefficient that the table does not list is 0.
            return float(entry.get("value", 0.0)) * _radians(entry.get("unit", "1"))
        return float(entry)


def _radians(unit: str) -> float:
    """What a number in a unit with degrees is multiplied with."""
    powers = ((-1.0 if over else 1.0) * float(power or 1.0) for over, power in _DEGREES.findall(unit))
    return math.radians(1.0) ** sum(powers)


def _slopes(function: Any, x: Array, u: Array) -> Array:
    """Central differences of a function of (x, u), its rows by the columns of both."""
    both, columns = np.concatenate([x, u]), []
    for index, value in enumerate(both):
        step = 6e-6 * max(abs(value), 1e-3)
        ends = []
        for sign in (1.0, -1.0):
            moved = both.copy()
            moved[index] += sign * step
            ends.append(function(moved[: len(x)], moved[len(x) :]))
        columns.append((ends[0] - ends[1]) / (2.0 * step))
    return np.array(columns).T


def _trim(vehicle: _Vehicle, options: Mapping[str, str]) -> dict[str, Any]:
    """The steady state that is asked for, by Newton's method without bounds, in the words of the command."""
    problem = vehicle.source.model["trim"]
    states, inputs, outputs = vehicle.states[0], vehicle.inputs[0], vehicle.outputs[0]
    names = [*states, *inputs]
    point = dict.fromkeys(names, 0.0)
    goal = {it["name"]: it["default"] for it in problem["given"]}
    for name, text in options.items():
        if name == "input":
            point.update((key, _real(key, value)) for key, value in (it.split("=") for it in text.split(",")))
            continue
        name = name.replace("-", "_")
        if name not in goal:
            raise RequestError(
                f"{name}: a steady state of {vehicle.name} does not take it; given are {', '.join(goal)}"
            )
        goal[name] = _real(name, text)
    point.update((name, value) for name, value in goal.items() if name in states)
    sought = [it["name"] for it in problem["sought"]]
    point.update((it["name"], it["start"]) for it in problem["sought"])
    rows = [it["name"] for it in problem["equations"]] + [name for name in goal if name not in states]
    places = [names.index(name) for name in sought]

    def residuals(values: Array) -> tuple[Array, Array, Array]:
        x, u = values[: len(states)], values[len(states) :]
        drift, seen = vehicle.at("drift", x, u), vehicle.at("outputs", x, u)
        found = [
            drift[states.index(it)] if it in states else seen[outputs.index(it)] - goal.get(it, 0.0) for it in rows
        ]
        by_state, by_input = vehicle.at("state_jacobian", x, u), vehicle.at("input_jacobian", x, u)
        exact = np.concatenate([by_state, by_input], axis=1)
        outer = None if all(it in states for it in rows) else _slopes(partial(vehicle.at, "outputs"), x, u)
        slopes = [exact[states.index(it)] if it in states else outer[outputs.index(it)] for it in rows]  # type: ignore[index]
        return np.array(found), np.array(slopes)[:, places], drift

    values = np.array([point[name] for name in names])
    scales = np.array([it["scale"] for it in problem["sought"]])
    for iteration in range(_MOST_STEPS):
        found, slopes, drift = residuals(values)
        weights = 1.0 / np.maximum(np.abs(slopes * scales).max(axis=1), np.finfo(float).tiny)
        step = np.linalg.lstsq(slopes * scales * weights[:, None], -found * weights, rcond=None)[0]
        if not np.isfinite(step).all():
            break
        values[places] += step * scales
        if np.abs(step).max() < _SETTLED:
            found, _, drift = residuals(values)
            if np.abs(found * weights).max() < 1e3 * _SETTLED:
                return _told(vehicle, values, drift, problem["moving"], iteration)
    raise NumericError(f"{vehicle.name}: no trim was found")


def _told(vehicle: _Vehicle, values: Array, drift: Array, moving: list[str], iterations: int) -> dict[str, Any]:
    states, inputs = vehicle.states[0], vehicle.inputs[0]
    x, u = values[: len(states)], values[len(states) :]
    bounds = [*vehicle.state_bounds, *vehicle.input_bounds]
    return {
        "model": vehicle.name,
        "set": vehicle.set,
        "state": dict(zip(states, x.tolist(), strict=True)),
        "input": dict(zip(inputs, u.tolist(), strict=True)),
        "outputs": dict(zip(vehicle.outputs[0], vehicle.at("outputs", x, u).tolist(), strict=True)),
        "residuals": {name: 0.0 if name in moving else rate for name, rate in zip(states, drift.tolist(), strict=True)},
        "iterations": iterations,
        "in_validity_box": all(low <= value <= high for value, (low, high) in zip(values, bounds, strict=True)),
    }


def _real(name: str, text: str) -> float:
    number = _NUMBER.match(text)
    if number is None:
        raise RequestError(f"{name}: `{text}` is not a number")
    return float(number.group())
