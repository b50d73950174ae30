"""What is true of a model besides its equations: where it is at rest, its modes, and what commands take as defaults."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Given:
    """A state that whoever asks for a trim gives; strictly between `above` and `below`."""

    name: str
    default: float
    above: float | None = None
    below: float | None = None


@dataclass(frozen=True)
class Sought:
    """An unknown of a trim, a state or an input: where its search starts, and what is a small change of it."""

    name: str
    start: float = 0.0
    scale: float = 1.0


@dataclass(frozen=True)
class Equation:
    """A row of the drift that must vanish in a trim.

    Rows are scaled by their largest slope, times `weight`. A row that is `like` another, (row, given state), has the
    scale of that row over the value of the state instead.
    """

    name: str
    weight: float = 1.0
    like: tuple[str, str] | None = None


@dataclass(frozen=True)
class Trim:
    """A rest of the model: states that are neither given nor sought are 0, inputs that are not sought are held."""

    given: tuple[Given, ...] = ()
    sought: tuple[Sought, ...] = ()
    equations: tuple[Equation, ...] = ()
    moving: tuple[str, ...] = ()  # states whose rate need not vanish
    shown: tuple[str, ...] = ()  # states, inputs and outputs of a trim that people look at


@dataclass(frozen=True)
class Mode:
    """States whose poles have a name; of an odd number of real poles the slowest may have one of its own."""

    name: str
    states: tuple[str, ...]
    slowest: str | None = None


@dataclass(frozen=True)
class Traits:
    """The trim, the modes, the defaults of commands, and the deviations that cost 1 in a regulator.

    Numbers are in the foot-slug units of the variables; the IR has them in those of the table.
    """

    trim: Trim
    modes: tuple[Mode, ...] = ()
    inputs: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    deviations: Mapping[str, float] = field(default_factory=dict)
    note: str | None = None  # printed before the model is used

    def faults(self, states: Iterable[str], inputs: Iterable[str]) -> list[str]:
        """What does not fit a model with these states and inputs; for whoever writes one."""
        states, inputs = tuple(states), tuple(inputs)
        trim = self.trim
        sought = [unknown.name for unknown in trim.sought]
        rows = [equation.name for equation in trim.equations]
        given = [state.name for state in trim.given]
        likes = [equation.like for equation in trim.equations if equation.like]
        in_modes = [state for mode in self.modes for state in mode.states]
        found = []
        for what, names, known in (
            ("given states", given, states),
            ("unknowns", sought, (*states, *inputs)),
            ("equations", rows, states),
            ("moving states", trim.moving, states),
            ("rows that others are like", [row for row, _ in likes], rows),
            ("values that others are like", [state for _, state in likes], given),
            ("states of modes", in_modes, states),
            ("inputs", self.inputs, inputs),
            ("outputs", self.outputs, states),
            ("deviations", self.deviations, (*states, *inputs)),
        ):
            unknown = [name for name in names if name not in known]
            if unknown or len(set(names)) != len(tuple(names)):
                found.append(f"{what}: {', '.join(unknown) or 'one stands twice'}")
        if len(rows) != len(sought):
            found.append(f"{len(rows)} equations for {len(sought)} unknowns")
        if set(given) & set(sought):
            found.append("a state is given and sought")
        return found
