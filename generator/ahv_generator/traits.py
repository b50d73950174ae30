"""What is true of a model besides its equations: where it is at rest, its modes, and what commands take as defaults."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import casadi as ca

from .checked import check_fields
from .diagnostics import FamilyError
from .schema import Parameter, Variable, check_number

Named = Variable | str | ca.SX


def name_of(named: Named | Parameter) -> str:
    """The name of what stands for it wherever the API asks for one: a declaration, the name, or the symbol."""
    if isinstance(named, Variable | Parameter):
        return named.name
    if isinstance(named, str):
        return named
    if isinstance(named, ca.SX) and named.is_symbolic():
        return str(named.name()).rpartition(".")[2]
    raise FamilyError(f"`{named}` has no name: it is neither a variable nor a quantity that was defined")


def _check_numbers(of: Named | Parameter, **numbers: object) -> None:
    for word, number in numbers.items():
        check_number(f"`{word}` of `{name_of(of)}`", number)


@dataclass(frozen=True)
class Given:
    """A state or an output that the caller of a trim gives; strictly between `above` and `below`, in its unit.

    An output that is given is an equation: the trim has as many unknowns more as outputs are given.
    """

    what: Named
    default: float
    above: float | None = None
    below: float | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        limits = {word: limit for word, limit in (("above", self.above), ("below", self.below)) if limit is not None}
        _check_numbers(self.what, default=self.default, **limits)
        above, below = limits.get("above", -math.inf), limits.get("below", math.inf)
        if not above < self.default < below:
            raise FamilyError(
                f"`default` of `{self.name}` is {self.default!r}; it must be above {above} and below {below}"
            )

    @property
    def name(self) -> str:
        """Name of the state or output."""
        return name_of(self.what)


@dataclass(frozen=True)
class Sought:
    """An unknown of a trim, a state or an input: where its search starts, and the size of a small change."""

    unknown: Named
    start: float = 0.0
    scale: float = 1.0

    def __post_init__(self) -> None:
        check_fields(self)
        _check_numbers(self.unknown, start=self.start, scale=self.scale)
        if self.scale <= 0:
            raise FamilyError(f"`scale` of `{self.name}` is {self.scale!r}; it must be positive")

    @property
    def name(self) -> str:
        """Name of the state or input."""
        return name_of(self.unknown)


@dataclass(frozen=True)
class Equation:
    """A row of the drift, or an output, that vanishes in a trim.

    Rows are scaled by their largest slope, times `weight`. A row that is `like` another, (row, given state), has the
    scale of that row over the value of the state instead.
    """

    row: Named
    weight: float = 1.0
    like: tuple[Named, Named] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        _check_numbers(self.row, weight=self.weight)

    @property
    def name(self) -> str:
        """Name of the state whose rate it is, or of the output."""
        return name_of(self.row)

    @property
    def like_names(self) -> tuple[str, str] | None:
        """Names of the row and the given state that it is like."""
        return None if self.like is None else (name_of(self.like[0]), name_of(self.like[1]))


@dataclass(frozen=True)
class Trim:
    """A rest of the model: states that are neither given nor sought are 0, inputs that are not sought are held."""

    given: tuple[Given, ...] = ()
    sought: tuple[Sought, ...] = ()
    equations: tuple[Equation, ...] = ()
    moving: tuple[str, ...] = ()  # states whose rate need not vanish
    shown: tuple[str, ...] = ()  # states, inputs and outputs that a trim prints


@dataclass(frozen=True)
class Mode:
    """States whose poles have a name; of an odd number of real poles the slowest may have one of its own."""

    name: str
    states: tuple[str, ...]
    slowest: str | None = None


@dataclass
class Traits:
    """The trim, the modes, the defaults of commands, and the deviations that cost 1 in a regulator.

    Numbers are in the units of the variables; the IR has them in those of the table.
    """

    trim: Trim = field(default_factory=Trim)
    modes: tuple[Mode, ...] = ()
    inputs: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    deviations: Mapping[str, float] = field(default_factory=dict)
    note: str | None = None  # printed before the model is used
