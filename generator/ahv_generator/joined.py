"""A joined model: the equations of a model of the family, with the states, inputs and noise of parts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import casadi as ca

from .diagnostics import Diagnostic, FamilyError, TableError
from .model import Gains, Model, Rates
from .part import Instance, Noted
from .schema import Parameter, Variable
from .traits import Equation, Given, Named, Sought, name_of

# Sections of a table: the parts, and the models that they join.
PARTS, JOINED = "parts", "joined"

Bases = Mapping[str, tuple[Variable, ...]]


def joined_bases(bases: Bases, instances: Sequence[Instance]) -> dict[str, tuple[Variable, ...]]:
    """The vectors of a model with parts: states and noise of parts follow, their inputs stand for those they drive.

    Raises:
        FamilyError: when a part drives what is no input.
    """
    found = dict(bases)
    for instance in instances:
        own = {kind: tuple(map(instance.variable, of)) for kind, of in _own(instance).items() if of}
        driven = [variable.name for variable in instance.part.drives]
        inputs = [variable.name for variable in found["input"]]
        for name in driven:
            if name not in inputs:
                raise FamilyError(f"`{instance.name}` drives `{name}`, which is not an input or is driven already")
        at = min((inputs.index(name) for name in driven), default=len(inputs))
        kept = [variable for variable in found["input"] if variable.name not in driven]
        found["input"] = (*kept[:at], *own.get("input", ()), *kept[at:])
        for kind in ("state", "noise"):
            if kind in own:
                found[kind] = (*found.get(kind, ()), *own[kind])
    return found


def _own(instance: Instance) -> dict[str, Sequence[Variable]]:
    return {"state": instance.part.states, "input": instance.part.inputs, "noise": instance.part.noise}


@dataclass
class JoinedModel(Model):
    """A model under construction that parts join.

    The equations of the model are stated by its family, which knows nothing of parts: what it asks for as an input is
    what the part gives, and what it states is completed by that of the parts.
    """

    instances: tuple[Instance, ...] = ()
    of: str | None = None
    _parts: dict[str, Noted] = field(default_factory=dict)
    _current: str = ""
    _seen: dict[str, ca.SX] = field(default_factory=dict)
    _reached: set[str] = field(default_factory=set)
    _asked: dict[str, None] = field(default_factory=dict)
    _has_diffusion: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        # A part may drive an input of an earlier one, whose equations follow.
        for instance in reversed(self.instances):
            self._current = instance.name
            instance.state(self)

    def check_dimensions(self, what: str, expr: ca.SX, unit: str) -> None:
        """Raise `ExpressionError` unless an expression has the dimensions of a unit."""
        self.graph.check(what, expr, unit)

    def noted(self, of: Noted) -> None:
        """Take up what the part states whose equations run."""
        self._parts[self._current] = of
        for name, expr in of.driven.items():
            self.define(self._driven(name), expr)

    def check(self) -> None:
        """Raise `FamilyError` when something is missing; state what the family leaves to the parts."""
        if not self._has_diffusion and "noise" in self.bases and self.rates is not None:
            super().diffusion(self._all_gains(), "the columns are those of the parts", "")
        super().check()
        for part, noted in self._parts.items():
            for name in noted.added:
                if name not in self._reached:
                    seen = ", ".join(f"`{one}`" for one in self._asked) or "none"
                    raise self._fault(
                        (PARTS, part),
                        f"no curve fit of `{self.name}` sees `{name}`: what `{part}` adds to it would change nothing",
                        f"states that curve fits see: {seen}",
                    )
        for instance in self.instances:
            self.mode(instance.name.replace("_", " "), *instance.states)

    def seen(self, named: Named, value: ca.SX | None = None) -> ca.SX:
        """A state as curve fits see it: with what the parts add."""
        name, value = name_of(named), super().seen(named, value)
        if name in self.names("state"):
            self._asked[name] = None
        added = [of.added[name] for of in self._parts.values() if name in of.added]
        if not added:
            return value
        self._reached.add(name)
        if not value.is_symbolic() or value.name() != f"x.{name}":
            return sum(added, value)
        if name not in self._seen:
            state = self.variable(name)
            doc = f"{state.doc} as curve fits see it"
            self._seen[name] = self.define(f"{name}_seen", sum(added, value), f"{{{state.symbol}}}^*", state.unit, doc)
        return self._seen[name]

    def derivative(self, expr: ca.SX, named: Named | Parameter) -> ca.SX:
        """The total derivative of an expression; there is none with respect to an input that a part drives."""
        if any(name_of(named) in of.driven for of in self._parts.values()):
            raise self._fault(
                (JOINED, self.name),
                f"`{name_of(named)}` is driven by a part: it is not an input of `{self.name}`, and there is no"
                f" derivative with respect to it, which the equations of `{self.of}` take",
                f"join what drives `{name_of(named)}` to another model",
            )
        return super().derivative(expr, named)

    def motion(self, rates: Rates, equation: str | None = None) -> None:
        """The equations of motion of the family's model, completed by those of the parts."""
        of_parts = {
            state: rate for instance in self.instances for state, rate in self._parts[instance.name].rates.items()
        }
        super().motion({name_of(state): rate for state, rate in rates.items()} | of_parts, equation)

    def diffusion(self, gains: Gains, doc: str, equation: str | None = None) -> None:
        """The diffusion of the family's model, completed by that of the parts."""
        self._has_diffusion = True
        own = {(name_of(row), name_of(column)): gain for (row, column), gain in gains.items()}
        super().diffusion(own | self._all_gains(), doc, equation)

    def outputs(self, *named: Named) -> None:
        """The outputs of the family's model, what the parts drive, and the outputs of the parts."""
        of_parts = [name for i in self.instances for of in [self._parts[i.name]] for name in (*of.driven, *of.outputs)]
        super().outputs(*named, *(name for name in of_parts if name not in map(name_of, named)))

    def trim(
        self,
        *,
        given: Iterable[Given] = (),
        sought: Iterable[Sought],
        equations: Iterable[Equation],
        moving: Iterable[Named] = (),
        shown: Iterable[Named] = (),
    ) -> None:
        """The trim of the family's model, with the parts at rest: their states are sought, their rates vanish.

        Where an input is sought that a part drives, that of the part is sought.
        """
        like = {one.name: one for one in sought}
        extra: list[Sought] = []
        for instance in self.instances:
            noted = self._parts[instance.name]
            driven = {name: like.pop(name) for name in noted.driven if name in like}
            if driven and len(instance.inputs) != len(driven):
                raise self._fault(
                    (JOINED, self.name),
                    f"the trim of `{self.name}` seeks `{next(iter(driven))}`, which `{instance.name}` drives by itself",
                    "a part whose own input stands for the one that it drives can be sought in its place",
                )
            of_state = {
                expr.name(): like_it for name, like_it in driven.items() if (expr := noted.driven[name]).is_symbolic()
            }
            for state in instance.states:
                start = of_state.get(f"x.{state}", Sought(state))
                extra.append(replace(start, unknown=state))
            like |= {
                name: replace(one, unknown=name) for name, one in zip(instance.inputs, driven.values(), strict=False)
            }
        at_rest = [Equation(state) for instance in self.instances for state in instance.states]
        super().trim(
            given=given, sought=[*like.values(), *extra], equations=[*equations, *at_rest], moving=moving, shown=shown
        )

    def defaults(self, *, inputs: Iterable[Named] = (), outputs: Iterable[Named] = ()) -> None:
        """The default inputs and outputs; the inputs of a part stand for those that it drives."""
        super().defaults(inputs=[one for name in inputs for one in self._inputs_for(name_of(name))], outputs=outputs)

    def deviations(self, deviations: Mapping[Variable, float] | Mapping[str, float]) -> None:
        """The deviations that cost 1; the inputs of a part stand for those that it drives."""
        named = {name_of(variable): size for variable, size in deviations.items()}
        super().deviations({one: size for name, size in named.items() for one in self._inputs_for(name)})

    def _fault(self, path: tuple[str, ...], message: str, help: str) -> TableError:
        """What the table joins wrongly."""
        return TableError([Diagnostic("joined", self.table.path.name, path, "key", message, help)])

    def _inputs_for(self, name: str) -> tuple[str, ...]:
        """What stands for an input that a part drives; another name stands for itself."""
        for instance in self.instances:
            if name in self._parts[instance.name].driven:
                return tuple(inner for own in instance.inputs for inner in self._inputs_for(own))
        return (name,)

    def _driven(self, name: str) -> Variable:
        """An input that a part drives, as it was declared."""
        return next(one for i in self.instances for one in i.part.drives if one.name == name)

    def _all_gains(self) -> dict[tuple[str, str], ca.SX]:
        return {at: gain for instance in self.instances for at, gain in self._parts[instance.name].gains.items()}
