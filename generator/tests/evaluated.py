"""A model with the numbers of its table, evaluated by CasADi."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path

import casadi as ca
from scipy.optimize import root

from ahv_generator.reference import columns, expanded, labels
from ahv_generator.table import load


class Evaluated:
    """A model with the numbers of its table, evaluated by CasADi."""

    def __init__(self, path: Path, name: str) -> None:
        document = tomllib.loads(path.read_text(encoding="utf-8"))
        table = load(path)
        self.model = table.model(name)
        self.function, self.labels, self.columns = expanded(self.model), labels(self.model), columns(self.model)
        self.parameters = {
            f"parameter.{p.name}": float(document[p.path[0]][p.path[1]]["value"])
            for p in table.parameters
            if p.kind != "switch"
        }

    def at(self, values: Mapping[str, float]) -> dict[str, float]:
        """All functions, by their labels, at states and inputs by name; those not given are 0."""
        point = {c: values.get(c.partition(".")[2], 0.0) for c in self.columns} | self.parameters
        found = self.function.call([ca.DM(point[column]) for column in self.columns])
        return dict(zip(self.labels, (float(v) for v in found), strict=True))

    def drift(self, values: Mapping[str, float]) -> dict[str, float]:
        """The rate of every state."""
        found = self.at(values)
        return {state: found.get(f"drift.{state}", 0.0) for state in self.model.names("state")}

    def trim(self, given: Mapping[str, float]) -> dict[str, float]:
        """The trim that the model states, by a solver that knows nothing of it."""
        problem = self.model.traits.trim
        names = [sought.name for sought in problem.sought]

        def residual(unknowns: Sequence[float]) -> list[float]:
            rates = self.drift({**given, **dict(zip(names, unknowns, strict=True))})
            return [rates[equation.name] for equation in problem.equations]

        found = root(residual, [s.start for s in problem.sought], tol=1e-12)
        assert found.success, found.message
        return dict(zip(names, (float(v) for v in found.x), strict=True))
