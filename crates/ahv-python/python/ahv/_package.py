"""Packages of models: that of the repository, and those of a user's own tables."""

from __future__ import annotations

from functools import cache
from os import PathLike
from typing import Any

from ._command import Option
from ._model import Model
from ._module import Module, Native
from ._names import unknown


class Package:
    """Compiled models of some tables, by name: ``package.model("dcom")``, ``package.dcom``."""

    def __init__(self, native: Native) -> None:
        self._module = Module(native)
        self._titles = dict(native.models())

    def models(self) -> dict[str, str]:
        """Names of the models, with what they are."""
        return dict(self._titles)

    def model(
        self,
        name: str,
        *,
        table: str | PathLike[str] | None = None,
        set: str | None = None,
        units: str | None = None,
        **choices: str,
    ) -> Model:
        """A model in a condition of its own.

        Parameters
        ----------
        name
            Its name.
        table
            File whose values, choices, sets and validity box take the place of those that the model was generated with.
        set
            Set of parameters; the table's own where none is named.
        units
            ``"si"`` or ``"ft-slug-s-rad"``; those of the table where none are named.
        **choices
            What the table lets choose, such as ``canard="free"``.

        Raises
        ------
        RequestError
            There is no such model, set, choice or unit, or the table has a fault.
        """
        if name not in self._titles:
            raise unknown("model", name, tuple(self._titles))
        options: dict[str, Option] = {"table": table, "set": set, "units": units, **choices}
        return Model(self._module, name, {key: value for key, value in options.items() if value is not None})

    def command(self, command: str, **options: Option) -> dict[str, Any]:
        """What a command of ``ahv`` prints with ``--json``, by its flags: ``command("reduce", runs=100)``."""
        return self._module.command(command, **options)

    def __getattr__(self, name: str) -> Model:
        if name.startswith("_") or name not in self._titles:
            raise AttributeError(f"there is no model {name!r}; there are {', '.join(self._titles)}")
        return self.model(name)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._titles]

    def __repr__(self) -> str:
        return "\n".join(f"{name}: {title}" for name, title in self._titles.items())


@cache
def built_in() -> Package:
    """The models that ahv comes with."""
    from . import _models

    return Package(_models)


def models() -> dict[str, str]:
    """Names of the models that ahv comes with, and what they are."""
    return built_in().models()


def model(
    name: str,
    *,
    table: str | PathLike[str] | None = None,
    set: str | None = None,
    units: str | None = None,
    **choices: str,
) -> Model:
    """A model that ahv comes with, in a condition of its own: see `Package.model`."""
    return built_in().model(name, table=table, set=set, units=units, **choices)
