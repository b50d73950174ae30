"""A family: models that are made from tables of one kind. Whatever module of `models` has one is found."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .schema import Schema

if TYPE_CHECKING:
    from .model import Model
    from .table import Table

    Builder = Callable[[Table], Model]


@dataclass(frozen=True)
class Family:
    """Models, in the order in which a table lists them, with what builds each; and what their tables hold.

    `schema` is given the models that a table lists, any of the family, and the keys of the table's sections: how many
    flexible modes there are, a table itself may say. It is given no values, because `ahv generate` does not derive
    again when only values changed. The audit of the printed equations comes with the models `audited`.
    """

    name: str
    builders: Mapping[str, Builder]
    schema: Callable[[tuple[str, ...], Mapping[str, tuple[str, ...]]], Schema]
    audited: tuple[str, ...] = ()

    @property
    def models(self) -> tuple[str, ...]:
        """Names of the models."""
        return tuple(self.builders)


def families() -> tuple[Family, ...]:
    """The `FAMILY` or the `FAMILIES` of every module in the package `models`, by the names of the modules."""
    from . import models

    found: list[Family] = []
    for name in sorted(module.name for module in pkgutil.iter_modules(models.__path__)):
        module = importlib.import_module(f"{models.__name__}.{name}")
        own = getattr(module, "FAMILY", None)
        found += [own] if own is not None else getattr(module, "FAMILIES", [])
    names = [model for family in found for model in family.models]
    twice = sorted({model for model in names if names.count(model) > 1})
    if twice:
        raise ValueError(f"more than one family has the model {', '.join(twice)}")
    return tuple(found)


def builders() -> dict[str, Builder]:
    """What builds each model, by its name."""
    return {name: build for family in families() for name, build in family.builders.items()}
