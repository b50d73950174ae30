"""Commands by their flags, and what they say."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from os import PathLike, fspath

from ._errors import AhvWarning

# What a flag may be given: True stands for a flag without a value, None and False for none.
Option = str | int | float | bool | PathLike[str] | Sequence[object] | Mapping[str, object] | None


def words(options: Mapping[str, Option]) -> list[str]:
    """The words of a command line: ``{"t_end": 1.0}`` is ``--t-end=1.0``."""
    line = []
    for name, value in options.items():
        flag = f"--{name.replace('_', '-')}"
        if value is None or value is False:
            continue
        line.append(flag if value is True else f"{flag}={_text(value)}")
    return line


def _text(value: Option) -> str:
    if isinstance(value, Mapping):
        return ",".join(f"{name}={_one(it)}" for name, it in value.items())
    if isinstance(value, Sequence) and not isinstance(value, str):
        return ",".join(_one(it) for it in value)
    return _one(value)


def _one(value: object) -> str:
    if isinstance(value, PathLike):
        return str(fspath(value))
    if isinstance(value, str):
        return value
    if isinstance(value, float):
        # Also NumPy's, whose own text names its type.
        return repr(float(value))
    return str(value)


def told(command: Callable[[list[str]], tuple[str, list[str]]], line: list[str]) -> str:
    """What a command prints; its notes are warnings."""
    text, notes = command(line)
    warn(notes)
    return text


def warn(notes: Sequence[str]) -> None:
    """Warns of what a command says beside its outcome."""
    # Of a line of the user's.
    frame, level = sys._getframe(1), 2
    while frame.f_back and frame.f_globals["__name__"].startswith("ahv."):
        frame, level = frame.f_back, level + 1
    for note in notes:
        warnings.warn(note, AhvWarning, stacklevel=level)
