"""Finding and running the file of a family: one that comes along, by name, or one beside the table, by its path."""

from __future__ import annotations

import contextlib
import sys
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from types import ModuleType

from .diagnostics import Diagnostic, FamilyError, TableError, suggestion
from .expression import ExpressionError
from .family import Family, Outline
from .units import UnitError

FOLDER = Path(__file__).parent / "families"

# Their texts say all that there is to say; of another exception its type is said, too.
_OURS = (FamilyError, ExpressionError, UnitError)


class NotFoundError(Exception):
    """A table names a family that there is not."""

    def __init__(self, message: str, help: str | None = None) -> None:
        super().__init__(message)
        self.help = help


@dataclass(frozen=True)
class FamilyFile:
    """The file of a family: as tables and messages name it, and where it is."""

    shown: str
    path: Path

    def family(self, outline: Outline) -> Family:
        """Run the file, and return its family for a table of this outline.

        Nothing is written beside the file, and its folder is not searched for modules.

        Raises:
            NotFoundError: when it cannot be read.
            TableError: with what it states wrongly.
        """
        try:
            text = self.path.read_bytes()
        except OSError as error:
            raise NotFoundError(f"cannot read the family `{self.shown}`: {error.strerror}") from error
        module = ModuleType(f"ahv_family_{self.path.stem}")
        module.__file__ = str(self.path)
        with self.faults():
            # Dataclasses of the file look for their module there.
            sys.modules[module.__name__] = module
            exec(compile(text, str(self.path), "exec", dont_inherit=True), module.__dict__)
            family = getattr(module, "family", None)
            if callable(family):
                family = family(outline)
            if not isinstance(family, Family):
                message = "the file has no family; state one with `family = Family()`, or with a function `family`"
                raise FamilyError(message, line=1)
            family.check()
        return family

    @contextlib.contextmanager
    def faults(self) -> Iterator[None]:
        """Report what the family's code raises inside, at its line; what it prints goes to standard error."""
        try:
            with contextlib.redirect_stdout(sys.stderr):
                yield
        except (TableError, MemoryError):
            raise
        except (Exception, SystemExit) as error:
            raise TableError([self._fault(error)]) from error

    def _fault(self, error: BaseException) -> Diagnostic:
        message, help_line = str(error), getattr(error, "help", None)
        if not isinstance(error, _OURS):
            message = f"{type(error).__name__}: {error}"
        frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename == str(self.path)]
        line = frames[-1].lineno if frames else None
        if isinstance(error, FamilyError) and error.line is not None:
            line = error.line
        if isinstance(error, SyntaxError) and error.filename == str(self.path):
            message, line = f"SyntaxError: {error.msg}", error.lineno
        if isinstance(error, ModuleNotFoundError):
            help_line = "a family is one file: files beside it are not imported"
        return Diagnostic("family", self.shown, (), "key", message, help_line, line)


def built_in() -> list[str]:
    """Names of the families that come along."""
    return sorted(path.stem for path in FOLDER.glob("*.py") if not path.name.startswith("_"))


def find(named: object, folder: Path) -> FamilyFile:
    """The file of the family that a table in `folder` names.

    Raises:
        NotFoundError: when no family comes along by that name, or there is no such file.
    """
    if isinstance(named, str) and named.endswith(".py"):
        if PurePosixPath(named).is_absolute() or Path(named).is_absolute():
            raise NotFoundError(f"`{named}` is not relative to the folder of the table")
        if not (folder / named).is_file():
            raise NotFoundError(f"there is no file `{named}` in the folder of the table")
        return FamilyFile(named, folder / named)
    known = built_in()
    if named not in known:
        help_line = f"{suggestion(str(named), known)}; a file beside the table is named like `pendulum.py`"
        raise NotFoundError(f"unknown family `{named}`", help_line)
    return FamilyFile(f"ahv_generator/families/{named}.py", FOLDER / f"{named}.py")
