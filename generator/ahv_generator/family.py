"""A family: models that are made from tables of one kind, and what such a table holds."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from . import names, units
from .checked import checked
from .contents import Contents
from .diagnostics import FamilyError, line_of_file, nearest, suggestion
from .joined import JOINED, PARTS, JoinedModel, joined_bases
from .model import Model
from .part import Instance
from .polynomial import powers_of_name
from .schema import Choice, Parameter, Quantity, Rule, Schema, Variable, check_order, check_texts

Equations = Callable[[Model], None]
_T = TypeVar("_T")

# Sections that every table may have.
_RESERVED = ("table", "sources", "choices", "validity", "sets", PARTS, JOINED, "emit")


@dataclass(frozen=True)
class Outline:
    """What a table says of its own size: the names of its sections.

    A family whose tables differ in size is a function of it, see `Family`.
    """

    sections: tuple[str, ...] = ()

    def numbered(self, prefix: str) -> range:
        """Numbers from 1 to the count of sections `prefix1`, `prefix2`, ...; at least 1.

        It is their count, not the highest number: a gap is a section that is missing and one too many.

        >>> list(Outline(("C_L", "C_N_1", "C_N_2")).numbered("C_N_"))
        [1, 2]
        """
        pattern = re.compile(re.escape(prefix) + "[1-9][0-9]*")
        return range(1, max(1, sum(pattern.fullmatch(section) is not None for section in self.sections)) + 1)


@dataclass(frozen=True)
class ModelSpec:
    """A model before it is built: its names, its vectors, the function that states it, and the line of that."""

    name: str
    title: str
    equations: str
    bases: Mapping[str, tuple[Variable, ...]]
    build: Equations
    line: int
    audited: bool = False
    instances: tuple[Instance, ...] = ()
    """The parts that join it."""
    of: str | None = None
    """The model that the parts join, whose tables hold the same."""


@dataclass(frozen=True)
class _Declared:
    """Something that the tables of these models hold; of all models if none is named."""

    section: str
    what: Parameter | Variable | Choice | Quantity | Rule
    models: tuple[str, ...]


class Family:
    r"""Models, in the order in which a table lists them, and what their tables hold.

    A family is a file with a variable `family`; a table names it, `family = "pendulum.py"`. What depends on the
    table's size, such as the number of flexible modes, is declared by a function of the table's `Outline`:

    >>> def family(table: Outline) -> Family:
    ...     made = Family()
    ...     for i in table.numbered("C_N_"):
    ...         made.parameters("modes", Parameter(f"omega_{i}", rf"\omega_{i}", "rad/s", f"frequency of mode {i}"))
    ...     return made
    >>> sorted(family(Outline(("C_N_1", "C_N_2"))).schema(()).parameters)
    ['modes']
    """

    def __init__(self) -> None:
        self.models: dict[str, ModelSpec] = {}
        self._declared: list[_Declared] = []
        self._only: tuple[str, ...] = ()
        self._conditions: list[tuple[str, int]] = []
        # Joined models by what they are made of, and the sections of parts.
        self._joined: dict[str, str] = {}
        self._parts: set[str] = set()

    @checked
    def parameters(self, section: str, *parameters: Parameter) -> None:
        """Numbers that a table has in the section `[section]`, in this order."""
        if section in _RESERVED or section in [q.key for q in self._all(Quantity)]:
            raise FamilyError(f"`[{section}]` has a meaning of its own; choose another section")
        check_order(parameters, [parameter.name for parameter in self._all(Parameter)])
        self._declare(section, parameters, [parameter.name for parameter in parameters])

    @checked
    def bounds(self, *variables: Variable) -> None:
        """The intervals that a table has in `[validity]`; every state and input of a model needs one.

        Variables that share an interval (`Variable.bounds`) need one variable of that name here.
        """
        self._declare("validity", variables, [variable.name for variable in variables], "the interval")

    @checked
    def choices(self, *choices: Choice) -> None:
        """What a table chooses by name in `[choices]`."""
        known = [*self._all(Choice), *choices]
        for names_of in ([choice.name for choice in known], [choice.type_name for choice in known]):
            if len(set(names_of)) != len(names_of):
                raise FamilyError(f"two choices have one name: {', '.join(names_of)}")
        self._declare("choices", choices, [switch.name for choice in choices for switch in choice.switches])

    @checked
    def quantities(self, *quantities: Quantity) -> None:
        """Curve fits: each is a section of the table, whose keys are its monomials."""
        for quantity in quantities:
            if quantity.key in _RESERVED or quantity.key in [d.section for d in self._declared]:
                raise FamilyError(f"`[{quantity.key}]` has a meaning of its own; choose another key")
        self._declare("", quantities, [quantity.key.lower() for quantity in quantities])

    @checked
    def rules(self, *rules: Rule) -> None:
        """Conditions on more than one parameter, or on a coefficient; what they name is declared before."""
        for rule in rules:
            for name in rule.parameters():
                if self._unit_of(name) is None:
                    message = f"the rule `{rule.name}` names `{name}`, which no table has before this line"
                    raise FamilyError(message, self._advice(name))
            rule.check_dimensions(lambda name: self._unit_of(name) or "")
        self._declare("", rules, [])

    def _unit_of(self, name: str) -> str | None:
        """The unit of a parameter, a switch or a coefficient; None of what no table has."""
        for parameter in self._parameters():
            if parameter.name == name:
                return parameter.unit
        for quantity in self._all(Quantity):
            own = f"{quantity.key.lower()}_"
            powers = powers_of_name(name.removeprefix(own), quantity.variables) if name.startswith(own) else None
            if powers is not None:
                return quantity.unit_of(powers)
        return None

    def _advice(self, name: str) -> str:
        """What may have been meant by a name in a rule."""
        known = [parameter.name for parameter in self._parameters()]
        for quantity in self._all(Quantity):
            singles = [f"{quantity.key.lower()}_{variable}" for variable in ("0", *quantity.variables)]
            known += [*singles, *(f"{one}_{exponent}" for one in singles[1:] for exponent in range(2, 5))]
        return nearest(name, known) or "a coefficient is quantity and monomial in lower case, like `c_l_alpha_2`"

    @checked
    @contextlib.contextmanager
    def only_for(self, *models: str) -> Iterator[None]:
        r"""What is declared inside is in the tables of these models alone.

        >>> family = Family()
        >>> with family.only_for("gusty"):
        ...     family.parameters("noise", Parameter("gust_rms", r"\sigma_g", "rad", "rms of the gust"))
        >>> family.schema(("calm",)).parameters
        {}
        """
        outer, self._only = self._only, models
        self._conditions += [(model, line_of_file()) for model in models]
        try:
            yield
        finally:
            self._only = outer

    @checked
    def model(
        self,
        name: str,
        title: str,
        equations: str = "",
        *,
        states: Sequence[Variable],
        inputs: Sequence[Variable],
        noise: Sequence[Variable] = (),
        arguments: Sequence[Variable] = (),
        modes: Sequence[Variable] = (),
        audited: bool = False,
    ) -> Callable[[Equations], Equations]:
        """Add a model; the decorated function states its equations with the `Model` that it is given.

        `equations` are the numbers of the paper's equations, `noise` the Wiener increments, `arguments` are of further
        functions (such as a time), `modes` index a vector by mode. The audit of the paper's printed equations comes
        with the models that are `audited`.

        Raises:
            FamilyError: when a name is taken, or a state or an input has no interval among `bounds`.
        """
        vectors = {"state": states, "input": inputs, "noise": noise, "argument": arguments, "mode": modes}
        bases = {basis: tuple(v) for basis, v in vectors.items() if v or basis in ("state", "input")}
        self._check_model(name, title, equations, bases)

        def added(build: Equations) -> Equations:
            code = getattr(build, "__code__", None)
            line = line_of_file() if code is None else code.co_firstlineno
            self.models[name] = ModelSpec(name, title, equations, bases, build, line, audited)
            return build

        return added

    def join(self, name: str, title: str, of: str, instances: Sequence[Instance]) -> None:
        """Add a model that is another one with parts, and what its tables hold besides.

        Raises:
            FamilyError: when a name is taken, or a part drives what is no input.
        """
        base = self.models[of]
        bases = joined_bases(base.bases, instances)
        own_sections = [one.section for one in self._declared if one.section not in self._parts]
        self._joined[name] = of
        self._parts.update(instance.name for instance in instances)
        for instance in instances:
            if instance.name in (*_RESERVED, *(quantity.key for quantity in self._all(Quantity)), *own_sections):
                raise FamilyError(f"`[{instance.name}]` has a meaning of its own; choose another name for the part")
            for parameter in map(instance.parameter, instance.part.parameters):
                self._declare_for(name, instance.name, parameter)
            for own in (*instance.part.states, *instance.part.inputs):
                if own.bounds is None:
                    self._declare_for(name, "validity", instance.variable(own))
            for rule in map(instance.rule, instance.part.rules):
                self._declare_for(name, "", rule)
        self._check_model(name, title, base.equations, bases)
        self.models[name] = replace(
            base, name=name, title=title, bases=bases, audited=False, instances=tuple(instances), of=of
        )

    def _declare_for(self, model: str, section: str, what: Parameter | Variable | Rule) -> None:
        """Declare something for one model more; parts of the same name share what they declare."""
        for at, known in enumerate(self._declared):
            if known.section == section and known.what == what and known.models:
                self._declared[at] = replace(known, models=(*known.models, model))
                return
        taken = [v.name for v in self._all(Variable)] if isinstance(what, Variable) else self._names()
        if not isinstance(what, Rule) and what.name in taken:
            raise FamilyError(f"the name `{what.name}` is used twice")
        self._declared.append(_Declared(section, what, (model,)))

    def _check_model(self, name: str, title: str, equations: str, bases: Mapping[str, tuple[Variable, ...]]) -> None:
        fault = names.fault_of_model(name)
        if fault is not None:
            raise FamilyError(fault)
        check_texts(title, equations)
        if not bases["state"] or not bases["input"]:
            lacks = "input" if bases["state"] else "state"
            raise FamilyError(f"the model `{name}` has no {lacks}; it needs one at least")
        if name in self.models:
            raise FamilyError(f"the name `{name}` is used twice, for two models")
        variable_names = [variable.name for basis in bases.values() for variable in basis]
        twice = [one for one in variable_names if variable_names.count(one) > 1]
        if twice:
            raise FamilyError(f"the name `{twice[0]}` is used twice in the model `{name}`")
        self._check_bounds(name, bases)

    def _check_bounds(self, model: str, bases: Mapping[str, tuple[Variable, ...]]) -> None:
        """Every state and input has an interval of its dimensions."""
        intervals = {one.name: one for one in self.schema((model,)).validity}
        for kind in ("state", "input"):
            for variable in bases[kind]:
                interval = intervals.get(variable.interval)
                if interval is None:
                    message = f"the {kind} `{variable.name}` of `{model}` has no bounds"
                    advice = "name it in `family.bounds(...)` before the model; the table gives the numbers"
                    raise FamilyError(message, advice)
                if units.dimensions(variable.unit) != units.dimensions(interval.unit):
                    message = f"`{variable.name}` is in `{variable.unit}`, but its bounds are in `{interval.unit}`"
                    raise FamilyError(message)

    def schema(self, models: tuple[str, ...]) -> Schema:
        """What a table of these models holds."""
        chosen = self._of(models)
        sections: dict[str, tuple[Parameter, ...]] = {}
        for one in chosen:
            if isinstance(one.what, Parameter):
                sections[one.section] = (*sections.get(one.section, ()), one.what)
        return Schema(
            parameters=sections,
            validity=tuple(one.what for one in chosen if isinstance(one.what, Variable)),
            choices=tuple(one.what for one in chosen if isinstance(one.what, Choice)),
            quantities=tuple(one.what for one in chosen if isinstance(one.what, Quantity)),
            laws=tuple(one.what for one in chosen if isinstance(one.what, Rule)),
        )

    def check(self) -> None:
        """Raise `FamilyError` when the whole is not a family."""
        if not self.models:
            raise FamilyError("the family has no model; state one with `@family.model(...)`", line=1)
        for model, line in self._conditions:
            if model not in self.models:
                raise FamilyError(f"`{model}` is not a model of the family", suggestion(model, self.models), line)

    def build(self, name: str, table: Contents) -> Model:
        """Derive one of its models from a table."""
        spec = self.models[name]
        common = (spec.name, spec.title, spec.equations, table, dict(spec.bases))
        if spec.instances:
            model: Model = JoinedModel(*common, instances=spec.instances, of=spec.of)
        else:
            model = Model(*common)
        spec.build(model)
        try:
            model.check()
        except FamilyError as error:
            raise FamilyError(str(error), error.help, spec.line) from error
        return model

    def _of(self, models: tuple[str, ...]) -> list[_Declared]:
        named = {*models, *(self._joined[model] for model in models if model in self._joined)}
        return [one for one in self._declared if not one.models or named.intersection(one.models)]

    def _all(self, kind: type[_T]) -> list[_T]:
        return [one.what for one in self._declared if isinstance(one.what, kind)]

    def _names(self) -> list[str]:
        """Names of what becomes a parameter of the generated code."""
        return [p.name for p in self._parameters()] + [q.key.lower() for q in self._all(Quantity)]

    def _parameters(self) -> list[Parameter]:
        """Parameters, and the switches of choices."""
        return [*self._all(Parameter), *(switch for choice in self._all(Choice) for switch in choice.switches)]

    def _declare(
        self,
        section: str,
        declared: tuple[Parameter, ...]
        | tuple[Variable, ...]
        | tuple[Choice, ...]
        | tuple[Quantity, ...]
        | tuple[Rule, ...],
        taking: list[str],
        what: str = "the name",
    ) -> None:
        taken = [v.name for v in self._all(Variable)] if section == "validity" else self._names()
        for position, name in enumerate(taking):
            if name in taken or name in taking[:position]:
                raise FamilyError(f"{what} `{name}` is used twice")
        self._declared += [_Declared(section, one, self._only) for one in declared]
