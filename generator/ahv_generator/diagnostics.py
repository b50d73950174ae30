"""Faults of a table, each tied to its key path, and of a family file, each tied to its line."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from types import FrameType

_LONGEST = 60


def shortened(text: str) -> str:
    """A text of a table for a message: its start, where it is long."""
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


def _visible(text: str) -> str:
    """A message in one line, without characters that act on a terminal."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


@dataclass(frozen=True)
class Diagnostic:
    """One fault: the rule that is broken, where, what is wrong, what to do.

    A fault of a table stands at a key path, at the key or the value; one of a family file stands at a line.
    """

    rule: str
    file: str
    path: tuple[str, ...]
    part: str
    message: str
    help: str | None = None
    line: int | None = None

    def as_json(self) -> dict[str, object]:
        """The diagnostic as the driver reads it."""
        return {
            "rule": self.rule,
            "file": self.file,
            "path": list(self.path),
            "part": self.part,
            "message": _visible(self.message),
            "help": None if self.help is None else _visible(self.help),
            "line": self.line,
        }


class FamilyError(Exception):
    """A family file states something wrong. The fault is reported at the line that called, or at `line` if given."""

    def __init__(self, message: str, help: str | None = None, line: int | None = None) -> None:
        super().__init__(message)
        self.help = help
        self.line = line


# So begin the names of modules that are files of families and parts.
MODULE = "ahv_file_"


def line_of_file() -> int:
    """The line of the file of a family or a part that runs; 0 if none does."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and not str(frame.f_globals.get("__name__")).startswith(MODULE):
        frame = frame.f_back
    return 0 if frame is None else frame.f_lineno


@dataclass
class Once:
    """What may be stated once, and the lines on which it was."""

    lines: dict[str, int] = field(default_factory=dict)

    def __call__(self, what: str) -> None:
        """Raise `FamilyError` for what is stated a second time."""
        line = line_of_file()
        if what in self.lines:
            raise FamilyError(f"`{what}` is called twice, on line {self.lines[what]} and on line {line}; call it once")
        self.lines[what] = line


class TableError(Exception):
    """A table that cannot be used; carries every fault found in it."""

    def __init__(self, diagnostics: list[Diagnostic]) -> None:
        super().__init__("; ".join(d.message for d in diagnostics))
        self.diagnostics = diagnostics


@dataclass
class Faults:
    """Collects the faults of one file, so that a user sees all of them at once."""

    file: str
    found: list[Diagnostic] = field(default_factory=list)

    def key(self, rule: str, path: Iterable[str], message: str, help: str | None = None) -> None:
        """Record a fault of the key at `path`."""
        self.found.append(Diagnostic(rule, self.file, tuple(path), "key", message, help))

    def value(self, rule: str, path: Iterable[str], message: str, help: str | None = None) -> None:
        """Record a fault of the value at `path`."""
        self.found.append(Diagnostic(rule, self.file, tuple(path), "value", message, help))

    def raise_any(self) -> None:
        """Raise `TableError` when a fault was recorded."""
        if self.found:
            raise TableError(list(dict.fromkeys(self.found)))


def nearest(word: str, known: Iterable[str]) -> str | None:
    """A help line: the nearest of the known words, if one is near."""
    folded = {w.lower(): w for w in known}
    near = difflib.get_close_matches(word.lower(), folded, n=1, cutoff=0.75)
    return f"did you mean `{folded[near[0]]}`?" if near else None


def suggestion(word: str, known: Iterable[str]) -> str | None:
    """A help line: the nearest of the known words, or all of them; none where nothing is known."""
    words = list(known)
    return nearest(word, words) or ("known here: " + ", ".join(f"`{w}`" for w in words) if words else None)
