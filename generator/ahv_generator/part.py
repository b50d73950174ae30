"""A part: dynamics with states of their own that join a model by the names of its inputs and states."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Protocol

import casadi as ca

from . import names, units
from .checked import check_fields, checked
from .diagnostics import FamilyError, Once, suggestion
from .schema import Parameter, Rule, Variable, check_order, check_texts
from .traits import Named, name_of


@dataclass(frozen=True)
class Join:
    """What an argument of a function `part` stands for: a `state` or an `input` of the model, in such a unit."""

    kind: str | None = None
    unit: str | None = None

    @property
    def kinds(self) -> tuple[str, ...]:
        """The bases that it may be of."""
        return ("state", "input") if self.kind is None else (self.kind,)

    def words(self, system: str) -> str:
        """As a message says it, with the unit of a table's system."""
        what = {"state": "a state", "input": "an input"}.get(self.kind or "", "a state or an input")
        return what if self.unit is None else f"{what} in `{units.converted(self.unit, system)}`"


State = Annotated[Variable, Join("state")]
Input = Annotated[Variable, Join("input")]


class Host(Protocol):
    """The joined model, as its parts see it."""

    def __getitem__(self, named: Named | Parameter) -> ca.SX:
        """The symbol of a quantity, a state, an input or a parameter."""

    def section(self, title: str, equation: str = "") -> contextlib.AbstractContextManager[None]:
        """A section of the generated code."""

    def define(self, name: Named, expr: ca.SX | float, symbol: str = "", unit: str = "", doc: str = "") -> ca.SX:
        """Name a quantity."""

    def names(self, basis: str) -> tuple[str, ...]:
        """Names of the entries of a basis, in order."""

    def unit(self, name: str) -> str:
        """The unit of a variable, in the system of the table."""

    def check_dimensions(self, what: str, expr: ca.SX, unit: str) -> None:
        """Refuse an expression of other dimensions than those of the unit."""

    def noted(self, of: Noted) -> None:
        """Take up what a part states."""


@dataclass
class Noted:
    """What the equations of a part state, by the names of the joined model."""

    rates: dict[str, ca.SX] = field(default_factory=dict)
    gains: dict[tuple[str, str], ca.SX] = field(default_factory=dict)
    driven: dict[str, ca.SX] = field(default_factory=dict)
    added: dict[str, ca.SX] = field(default_factory=dict)
    outputs: list[str] = field(default_factory=list)


@dataclass
class Part:
    """A part before it joins: its own variables and parameters, and the inputs of the model that it drives.

    A part is a file with a function `part`. Its arguments are what the part joins, variables of the model; a table
    names them by the names of the arguments, whose annotations say what fits: `State`, `Input`, or, with a unit,
    `Annotated[Variable, Join("state", "ft/s")]`. Names of the part's own are local: in the joined model the name of the
    part's instance and `_` stand before them. Each state and input that shares no interval has one in `[validity]`.
    """

    title: str
    states: Sequence[Variable]
    inputs: Sequence[Variable] = ()
    noise: Sequence[Variable] = ()
    parameters: Sequence[Parameter] = ()
    rules: Sequence[Rule] = ()
    drives: Sequence[Variable] = ()
    build: Callable[[PartModel], None] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        self._once = Once()
        check_texts(self.title)
        own = [one.name for one in self.variables] + [one.name for one in self.parameters]
        twice = [name for name in own if own.count(name) > 1]
        if twice:
            raise FamilyError(f"the name `{twice[0]}` is used twice in the part")
        if not self.states:
            raise FamilyError("a part has one state at least")
        check_order(self.parameters)
        known = {one.name: one.unit for one in self.parameters}
        for rule in self.rules:
            for name in rule.parameters():
                if name not in known:
                    message = f"the rule `{rule.name}` names `{name}`, which the part does not have"
                    raise FamilyError(message, suggestion(name, known))
            rule.check_dimensions(known.__getitem__)

    @property
    def variables(self) -> tuple[Variable, ...]:
        """States, inputs and Wiener increments."""
        return (*self.states, *self.inputs, *self.noise)

    @checked
    def equations(self, build: Callable[[PartModel], None]) -> Callable[[PartModel], None]:
        """Decorates the function that states the equations, with the `PartModel` that it is given."""
        self._once("equations")
        self.build = build
        return build


@dataclass(frozen=True)
class Instance:
    """A part under the name that a table gives it; `faults` reports what its file does wrong."""

    name: str
    part: Part
    faults: Callable[[], contextlib.AbstractContextManager[None]]

    def variable(self, own: Variable) -> Variable:
        """A variable of the part, as the joined model has it."""
        return replace(own, name=self.full(own.name))

    def parameter(self, own: Parameter) -> Parameter:
        """A parameter of the part, as the joined model has it: its key is the part's, its name the instance's."""
        return replace(own, prefix=f"{self.name}_")

    def rule(self, own: Rule) -> Rule:
        """A rule of the part, as the joined model has it."""
        terms = tuple((factor, tuple(self.full(name) for name in names)) for factor, names in own.terms)
        return replace(own, terms=terms)

    def full(self, name: str) -> str:
        """A name of the part, as the joined model has it."""
        return f"{self.name}_{name}"

    @property
    def states(self) -> tuple[str, ...]:
        """Names of its states in the joined model."""
        return tuple(self.full(one.name) for one in self.part.states)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of its inputs in the joined model."""
        return tuple(self.full(one.name) for one in self.part.inputs)

    def state(self, model: Host) -> None:
        """Run the equations of the part, which the joined model takes up.

        Raises:
            TableError: with what the part's file states wrongly.
        """
        with self.faults(), model.section(f"{self.part.title}: {self.name}"):
            if self.part.build is None:
                raise FamilyError("the part has no equations; state them with `@made.equations`", line=1)
            view = PartModel(self, model)
            self.part.build(view)
            model.noted(view.checked())


class PartModel:
    """What the equations of a part are given: the joined model, with the names of the part."""

    def __init__(self, instance: Instance, model: Host) -> None:
        self._instance, self._part, self._model = instance, instance.part, model
        self._noted = Noted()
        self._quantities: set[str] = set()
        self._once = Once()

    @checked
    def __getitem__(self, named: Named | Parameter) -> ca.SX:
        """The symbol of a variable, a parameter or a quantity of the part, or of a variable of the model."""
        if isinstance(named, Parameter):
            return self._model[self._instance.parameter(named)]
        name = name_of(named)
        own = name in self._quantities or name in [one.name for one in self._part.variables]
        return self._model[self._instance.full(name) if own else name]

    @checked
    def symbols(self, *named: Named | Parameter) -> tuple[ca.SX, ...]:
        """Several symbols at once."""
        return tuple(self[one] for one in named)

    @checked
    @contextlib.contextmanager
    def section(self, title: str, equation: str = "") -> Iterator[None]:
        """A section of the generated code."""
        with self._model.section(title, equation):
            yield

    @checked
    def define(self, name: str, expr: ca.SX | float, symbol: str, unit: str, doc: str) -> ca.SX:
        """Name a quantity of the part, and return its symbol."""
        fault = names.fault_of_identifier(name)
        if fault is not None:
            raise FamilyError(fault)
        quantity = self._model.define(self._instance.full(name), expr, symbol, unit, doc)
        self._quantities.add(name)
        return quantity

    @checked
    def motion(self, rates: Mapping[Variable, ca.SX | float]) -> None:
        """The time derivative of every state of the part."""
        self._once("model.motion")
        named = {name_of(state): ca.SX(rate) for state, rate in rates.items()}
        states = [state.name for state in self._part.states]
        self._refuse_unknown("states", named, states)
        missing = [state for state in states if state not in named]
        if missing:
            raise FamilyError(f"the rate of `{'`, `'.join(missing)}` is missing in the part")
        self._noted.rates = {self._instance.full(state): named[state] for state in states}
        for state, rate in self._noted.rates.items():
            self._model.check_dimensions(f"the rate of `{state}`", rate, f"{self._model.unit(state)}/s")

    @checked
    def diffusion(self, gains: Mapping[tuple[Variable, Variable], ca.SX | float]) -> None:
        """The diffusion of the part, by (state, Wiener increment), read in the Itô sense."""
        self._once("model.diffusion")
        named = {(name_of(row), name_of(column)): ca.SX(gain) for (row, column), gain in gains.items()}
        self._refuse_unknown("states", [row for row, _ in named], [one.name for one in self._part.states])
        self._refuse_unknown("Wiener increments", [name for _, name in named], [one.name for one in self._part.noise])
        full = self._instance.full
        self._noted.gains = {(full(row), full(column)): gain for (row, column), gain in named.items()}
        for (row, column), gain in self._noted.gains.items():
            unit = units.quotient(self._model.unit(row), self._model.unit(column))
            self._model.check_dimensions(f"the gain of `{column}` in the rate of `{row}`", gain, unit)

    @checked
    def drive(self, driven: Variable, expr: ca.SX | float) -> None:
        """What the model has in the place of an input that the part drives."""
        self._once(f"model.drive({driven.name}, ...)")
        self._refuse_unknown("inputs that it drives", [driven.name], [one.name for one in self._part.drives])
        self._model.check_dimensions(f"what drives `{driven.name}`", ca.SX(expr), driven.unit)
        self._noted.driven[driven.name] = ca.SX(expr)

    @checked
    def add(self, state: Variable, expr: ca.SX | float) -> None:
        """What is added to a state of the model where curve fits see it, such as the incidence of a gust."""
        self._once(f"model.add({state.name}, ...)")
        if state.name not in self._model.names("state"):
            message = f"a part adds to a state; `{state.name}` is not a state of the model that it joins"
            raise FamilyError(message, suggestion(state.name, self._model.names("state")))
        self._model.check_dimensions(f"what is added to `{state.name}`", ca.SX(expr), self._model.unit(state.name))
        self._noted.added[state.name] = ca.SX(expr)

    @checked
    def outputs(self, *named: Named) -> None:
        """Quantities of the part that commands print beside the states."""
        stated = [name_of(one).removeprefix(f"{self._instance.name}_") for one in named]
        self._refuse_unknown("quantities", stated, sorted(self._quantities))
        self._noted.outputs += map(self._instance.full, stated)

    def checked(self) -> Noted:
        """What was stated, when nothing is missing."""
        if not self._noted.rates:
            raise FamilyError("the part has no equations of motion; state them with `model.motion(...)`", line=1)
        idle = [
            one.name
            for one in self._part.noise
            if self._instance.full(one.name) not in [name for _, name in self._noted.gains]
        ]
        if idle:
            raise FamilyError(
                f"the Wiener increment `{idle[0]}` of the part has no gain: `model.diffusion(...)`", line=1
            )
        for driven in self._part.drives:
            if driven.name not in self._noted.driven:
                raise FamilyError(f"the part does not say what drives `{driven.name}`: `model.drive(...)`", line=1)
        return self._noted

    def _refuse_unknown(self, what: str, stated: Sequence[str] | Mapping[str, ca.SX], known: Sequence[str]) -> None:
        for name in stated:
            if name not in known:
                raise FamilyError(f"{what} of the part: there is no `{name}`", suggestion(name, known))
