"""Checks of single entries of a table: their keys, numbers, units and provenance."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from . import units
from .diagnostics import Faults, suggestion
from .schema import STATUSES

KEYS = ("value", "unit", "source", "status", "uncertainty")

Path = tuple[str, ...]


@dataclass(frozen=True)
class Provenance:
    """Where a number comes from, and how far it can be trusted."""

    source: str
    status: str
    uncertainty: float


@dataclass
class Entries:
    """The document of a table with its faults; checked values and the texts of their units, by their paths."""

    document: Mapping[str, object]
    faults: Faults
    system: str = units.IMPERIAL
    defaults: Provenance = field(default_factory=lambda: Provenance("", "", math.nan))
    values: dict[Path, float] = field(default_factory=dict)
    units: dict[Path, str] = field(default_factory=dict)

    def section(self, name: str) -> Mapping[str, object]:
        """A section that must be there."""
        section = self.document.get(name)
        if section is None:
            self.faults.key("missing", (), f"the section `[{name}]` is missing")
            return {}
        if not isinstance(section, dict):
            self.faults.value("shape", (name,), f"`{name}` must be a section")
            return {}
        return section

    def has(self, name: str) -> bool:
        """Whether there is such a section, so that what it lacks can be told."""
        return isinstance(self.document.get(name), dict)

    def only(self, path: Path, content: Iterable[str], known: Iterable[str], what: str = "key") -> None:
        """Faults of the keys that are not known."""
        known = tuple(known)
        for key in content:
            if key not in known:
                self.faults.key(f"unknown-{what}", (*path, key), f"unknown {what} `{key}`", suggestion(key, known))

    def entry(self, path: Path, expected: str) -> Provenance | None:
        """The provenance of the entry at `path`, whose value goes to `values`; None if it is no entry."""
        entry: object = self.document
        for key in path:
            entry = entry.get(key) if isinstance(entry, dict) else None
        if not isinstance(entry, dict):
            self.faults.value("shape", path, 'an entry is a table like { value = 1.0, unit = "1/rad" }')
            return None
        self.only(path, entry, KEYS)
        for key in ("value", "unit"):
            if key not in entry:
                self.faults.key("missing", path, f"`{key}` is missing")
        value = self.number(entry["value"], (*path, "value")) if "value" in entry else None
        if "unit" in entry:
            scale = self.unit(entry["unit"], (*path, "unit"), units.converted(expected, self.system))
            value = None if value is None else value * scale
        provenance = self.provenance(entry, path)
        if value is None:
            return None
        self.values[path], self.units[path] = value, units.in_radians(str(entry.get("unit", expected)))
        return provenance

    def number(self, value: object, path: Path) -> float | None:
        """A finite number; TOML's integers have no end here."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.faults.value("not-a-number", path, f"`{path[-1]}` must be a number")
            return None
        try:
            number = float(value)
        except OverflowError:
            self.faults.value("not-finite", path, f"`{path[-1]}` must be finite; this integer is too large")
            return None
        if not math.isfinite(number):
            self.faults.value("not-finite", path, f"`{path[-1]}` must be finite, not {number}")
            return None
        return number

    def unit(self, text: object, path: Path, expected: str) -> float:
        """What turns a value into one in the expected unit: 1, or degrees into rad; other units are faults."""
        if not isinstance(text, str):
            self.faults.value("unit", path, "`unit` must be a text")
            return 1.0
        try:
            scale = units.factor(text, expected)
        except units.UnitError as error:
            self.faults.value("unit", path, str(error), f"the unit here is `{expected}`")
            return 1.0
        if not math.isclose(units.factor(units.in_radians(text), expected), 1.0, rel_tol=1e-9) or not units.whole(text):
            self.faults.value(
                "unit",
                path,
                f"`{text}` measures the right thing, but the table is in {self.system}",
                f"write the value in `{expected}`",
            )
        return scale

    def provenance(self, entry: Mapping[str, object], path: Path) -> Provenance:
        """Source, status and uncertainty of an entry, the table's own where it has none."""
        sources = self.document.get("sources")
        sources = sources if isinstance(sources, dict) else {}
        source, status = entry.get("source", self.defaults.source), entry.get("status", self.defaults.status)
        if "source" in entry and not (isinstance(source, str) and source in sources):
            help_line = suggestion(str(source), sources)
            self.faults.value("unknown-source", (*path, "source"), f"unknown source `{source}`", help_line)
        if "status" in entry and status not in STATUSES:
            help_line = suggestion(str(status), STATUSES)
            self.faults.value("unknown-status", (*path, "status"), f"unknown status `{status}`", help_line)
        uncertainty = self.defaults.uncertainty
        if "uncertainty" in entry:
            number = self.number(entry["uncertainty"], (*path, "uncertainty"))
            uncertainty = math.nan if number is None else number
            if uncertainty < 0:
                self.faults.value("uncertainty", (*path, "uncertainty"), "a relative uncertainty is not negative")
        return Provenance(str(source), str(status), uncertainty)
