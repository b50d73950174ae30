"""A compiled module of models, and what is known of one of them."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING, Any, Protocol

from ._command import Option, told, words
from ._names import Array, Names, Vector

if TYPE_CHECKING:
    # The stubs of what is compiled.
    from ._models import Vehicle


class Native(Protocol):
    """A compiled module of models."""

    Vehicle: type[Vehicle]

    def models(self) -> list[tuple[str, str]]: ...
    def command(self, words: list[str]) -> tuple[str, list[str]]: ...
    def documents(self) -> list[str]: ...
    def zeros(self, a: Array, b: Array, c: Array, d: Array) -> Any: ...
    def regulator(self, a: Array, b: Array, q: Array, r: Array) -> Any: ...


class Module:
    """A compiled module with its commands and its IR as Python has them."""

    def __init__(self, native: Native) -> None:
        self.native = native

    def command(self, command: str, **options: Option) -> dict[str, Any]:
        """What a command of ``ahv`` prints with ``--json``, by its flags."""
        text = told(self.native.command, [command, *words(options), "--json"])
        outcome: dict[str, Any] = json.loads(text)
        return outcome

    @cache  # noqa: B019 - a module lives as long as the program
    def documents(self) -> tuple[dict[str, Any], ...]:
        """The IR of the tables: quantities, functions and names of the models, without values."""
        return tuple(json.loads(text) for text in self.native.documents())


class Known(Protocol):
    """A model as far as results and functions need it."""

    @property
    def name(self) -> str: ...
    @property
    def module(self) -> Module: ...
    @property
    def vehicle(self) -> Vehicle: ...
    @property
    def states(self) -> Names: ...
    @property
    def inputs(self) -> Names: ...
    @property
    def outputs(self) -> Names: ...
    @property
    def parameter_names(self) -> Names: ...
    @property
    def parameters(self) -> Vector: ...
