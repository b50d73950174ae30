"""Faults of a table, each tied to its key path, and of a family file, each tied to its line."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass, field

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
            raise TableError(self.found)


def suggestion(word: str, known: Iterable[str]) -> str:
    """A help line: the nearest of the known words, or all of them."""
    words = list(known)
    folded = {w.lower(): w for w in words}
    near = difflib.get_close_matches(word.lower(), folded, n=1, cutoff=0.75)
    if near:
        return f"did you mean `{folded[near[0]]}`?"
    return "known here: " + ", ".join(f"`{w}`" for w in words)
