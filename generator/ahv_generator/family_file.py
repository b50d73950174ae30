"""Finding and running the file of a family or a part: one that comes along, or one beside the table."""

from __future__ import annotations

import contextlib
import inspect
import os
import sys
import traceback
import typing
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from types import ModuleType
from typing import NoReturn

from .checked import DECLARATIONS
from .diagnostics import MODULE, Diagnostic, FamilyError, TableError, suggestion
from .expression import ExpressionError
from .family import Family, Outline
from .part import Join, Part
from .schema import Variable
from .units import UnitError

_HERE = Path(__file__).parent

# Their texts say all that there is to say; of another exception its type is said, too.
_OURS = (FamilyError, ExpressionError, UnitError)


def _refuse_exit(status: int) -> NoReturn:
    """In the place of `os._exit`, after which nobody could say where it was."""
    raise FamilyError(f"`os._exit({status})` would end the derivation without a word")


class NotFoundError(Exception):
    """A table names a family or a part that there is not."""

    def __init__(self, message: str, help: str | None = None) -> None:
        super().__init__(message)
        self.help = help


@dataclass(frozen=True)
class Place:
    """A key of a table."""

    table: str
    path: tuple[str, ...]


@dataclass(frozen=True)
class SourceFile:
    """A file of Python: as tables and messages name it, and where it is."""

    shown: str
    path: Path

    def run(self) -> ModuleType:
        """Run the file, and return its module.

        Nothing is written beside the file, and its folder is not searched for modules.

        Raises:
            NotFoundError: when it cannot be read.
            TableError: with what it states wrongly.
        """
        try:
            text = self.path.read_bytes()
        except OSError as error:
            raise NotFoundError(f"cannot read `{self.shown}`: {error.strerror}") from error
        module = ModuleType(f"{MODULE}{self.path.stem}")
        module.__file__ = str(self.path)
        with self.faults():
            # Dataclasses of the file look for their module there.
            sys.modules[module.__name__] = module
            exec(compile(text, str(self.path), "exec", dont_inherit=True), module.__dict__)
        return module

    @contextlib.contextmanager
    def faults(self, at: Place | None = None) -> Iterator[None]:
        """Report what the file's code raises inside, at its line; what it prints goes to standard error.

        What a file that comes along refuses is a fault of the table that has it do so, at a place, if there is one.
        """
        leave, os._exit = os._exit, _refuse_exit
        try:
            with contextlib.redirect_stdout(sys.stderr):
                yield
        except (TableError, MemoryError):
            raise
        except BaseException as error:
            raise TableError([self._fault(error, at if self.path.is_relative_to(_HERE) else None)]) from error
        finally:
            os._exit = leave

    def _fault(self, error: BaseException, at: Place | None) -> Diagnostic:
        message, help_line = str(error), getattr(error, "help", None)
        if not isinstance(error, _OURS):
            message = f"{type(error).__name__}: {error}".removesuffix(": ")
        if at is not None:
            message = f"`{self.path.stem}` does not fit here: {message}"
            return Diagnostic("joined", at.table, at.path, "key", message, help_line)
        frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename == str(self.path)]
        line = frames[-1].lineno if frames else None
        if isinstance(error, FamilyError) and error.line is not None:
            line = error.line
        if isinstance(error, SyntaxError) and error.filename == str(self.path):
            message, line = f"SyntaxError: {error.msg}", error.lineno
        if isinstance(error, TypeError) and any(f"'{name}'" in message for name in DECLARATIONS):
            help_line = "in equations its symbol stands for a variable or a parameter: `model[...]`"
        if isinstance(error, ModuleNotFoundError):
            help_line = "a family is one file: files beside it are not imported"
        return Diagnostic("family", self.shown, (), "key", message, help_line, line)


class FamilyFile(SourceFile):
    """The file of a family."""

    def family(self, outline: Outline) -> Family:
        """Run the file, and return its family for a table of this outline.

        Raises:
            NotFoundError: when it cannot be read.
            TableError: with what it states wrongly.
        """
        module = self.run()
        with self.faults():
            family = getattr(module, "family", None)
            if callable(family):
                family = family(outline)
            if not isinstance(family, Family):
                message = "the file has no family; state one with `family = Family()`, or with a function `family`"
                raise FamilyError(message, line=1)
            family.check()
        return family


class PartFile(SourceFile):
    """The file of a part."""

    def part(self) -> tuple[dict[str, Join], Callable[[dict[str, Variable], Place | None], Part]]:
        """Run the file, and return what its part joins by name, and what makes the part of the variables joined.

        Raises:
            NotFoundError: when it cannot be read.
            TableError: with what it states wrongly; the same when the part is made.
        """
        function = getattr(self.run(), "part", None)
        with self.faults():
            if not callable(function):
                raise FamilyError("the file has no part; state one with a function `part`", line=1)
            hints = typing.get_type_hints(function, include_extras=True)
            joins = {name: _join(hints.get(name)) for name in inspect.signature(function).parameters}

        def made(joined: dict[str, Variable], at: Place | None) -> Part:
            with self.faults(at):
                part = function(**joined)
                if not isinstance(part, Part):
                    raise FamilyError("the function `part` returns no part", line=1)
            return part

        return joins, made


def _join(annotation: object) -> Join:
    """What the annotation of an argument says that it joins."""
    said = [one for one in getattr(annotation, "__metadata__", ()) if isinstance(one, Join)]
    return said[0] if said else Join()


def built_in(kind: str) -> list[str]:
    """Names of the `families` or the `parts` that come along."""
    return sorted(path.stem for path in (_HERE / kind).glob("*.py") if not path.name.startswith("_"))


def find_family(named: object, folder: Path) -> FamilyFile:
    """The file of the family that a table in `folder` names.

    Raises:
        NotFoundError: when no family comes along by that name, or there is no such file.
    """
    return FamilyFile(*_find(named, folder, "families", "family"))


def find_part(named: object, folder: Path) -> PartFile:
    """The file of the part that a table in `folder` names.

    Raises:
        NotFoundError: when no part comes along by that name, or there is no such file.
    """
    return PartFile(*_find(named, folder, "parts", "part"))


def _find(named: object, folder: Path, kind: str, what: str) -> tuple[str, Path]:
    if isinstance(named, str) and named.endswith(".py"):
        if PurePosixPath(named).is_absolute() or Path(named).is_absolute():
            raise NotFoundError(f"`{named}` is not relative to the folder of the table")
        if not (folder / named).is_file():
            raise NotFoundError(f"there is no file `{named}` in the folder of the table")
        return named, folder / named
    known = built_in(kind)
    if named not in known:
        help_line = f"{suggestion(str(named), known)}; a file beside the table is named like `pendulum.py`"
        raise NotFoundError(f"unknown {what} `{named}`", help_line)
    return f"ahv_generator/{kind}/{named}.py", _HERE / kind / f"{named}.py"
