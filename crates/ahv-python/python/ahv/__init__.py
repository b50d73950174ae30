"""Flight models generated from tables: compiled functions of whole arrays, analyses, flights by the million.

>>> import ahv
>>> trim = ahv.dcom.trim(velocity=7850.0)
>>> system = ahv.dcom.linearize(trim)
>>> poles = system.poles()

A model of the package is an attribute: ``ahv.dcom``, ``ahv.sdcom``; ``ahv.models()`` lists them.
``ahv.model("sdcom", units="si")`` is one with another table, set, choice or system of units.
``ahv.load("my.toml")`` makes those of a table of one's own.

Units are those of the model, as ``model.states.units`` says; angles are in rad.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._errors import AhvError, AhvWarning, NumericError, RequestError

if TYPE_CHECKING:
    from ._campaign import campaign
    from ._linear import LinearSystem, Pole, Regulator, Zero, Zeros
    from ._load import generate, load
    from ._model import Model
    from ._names import Names, Point, Vector
    from ._package import Package, model, models
    from ._results import Covariance, Dispersion, MonteCarlo, Rare, Report, Trajectory, Trim

# Where each name comes from: nothing is loaded before it is asked for.
_HOMES = {
    "_campaign": ("campaign",),
    "_linear": ("LinearSystem", "Pole", "Regulator", "Zero", "Zeros"),
    "_load": ("generate", "load"),
    "_model": ("Model",),
    "_names": ("Names", "Point", "Vector"),
    "_package": ("Package", "model", "models"),
    "_results": ("Covariance", "Dispersion", "MonteCarlo", "Rare", "Report", "Trajectory", "Trim"),
}

__all__ = [
    "AhvError",
    "AhvWarning",
    "Covariance",
    "Dispersion",
    "LinearSystem",
    "Model",
    "MonteCarlo",
    "Names",
    "NumericError",
    "Package",
    "Point",
    "Pole",
    "Rare",
    "Regulator",
    "Report",
    "RequestError",
    "Trajectory",
    "Trim",
    "Vector",
    "Zero",
    "Zeros",
    "campaign",
    "generate",
    "load",
    "model",
    "models",
]


def __getattr__(name: str) -> object:
    from importlib import import_module

    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"ahv.{home}"), name)
    if not name.startswith("_"):
        from ._package import built_in

        if name in built_in().models():
            return built_in().model(name)
    raise AttributeError(f"module 'ahv' has no attribute {name!r}; ahv.models() lists the models")


def __dir__() -> list[str]:
    from ._package import built_in

    return sorted([*__all__, *built_in().models()])
