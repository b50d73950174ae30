"""Reads `[parts]` and `[joined]` of a table: parts by their names, and the models that they join."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from . import family_file, names, units
from .diagnostics import FamilyError, TableError, nearest, suggestion
from .entries import Entries
from .family import Family, ModelSpec
from .family_file import PartFile, Place
from .joined import JOINED, PARTS, joined_bases
from .part import Instance, Join, Part
from .schema import Variable

_JOINED_KEYS = ("model", "title", "parts")

# Section, name and key of an entry, and the text that stands there.
JoinText = tuple[str, str, str, str]


@dataclass(frozen=True)
class _Listed:
    """An entry of `[parts]`: the file of the part, what it joins, and what that is called in the model."""

    file: PartFile
    made: Callable[[dict[str, Variable], Place | None], Part]
    joins: Mapping[str, Join]
    names: Mapping[str, str]


class Joins:
    """Adds the joined models of a table to its family."""

    def __init__(self, entries: Entries, folder: Path) -> None:
        self.entries, self.faults, self.folder = entries, entries.faults, folder

    def read(self, family: Family) -> tuple[JoinText, ...]:
        """Add the models of `[joined]`; a table may have none. What the two sections say, without titles."""
        before = len(self.faults.found)
        parts = {name: listed for name, entry in self._section(PARTS) if (listed := self._part(name, entry))}
        self._stop(before)
        used: set[str] = set()
        for name, entry in self._section(JOINED):
            used.update(self._join(family, name, entry, parts))
        self._stop(before)
        for name in parts:
            if name not in used:
                self.faults.key("unused-part", (PARTS, name), f"no model of `[{JOINED}]` has the part `{name}`")
        self._stop(before)
        entries = [(section, *entry) for section in (PARTS, JOINED) for entry in self._section(section)]
        return tuple(
            (section, name, key, ", ".join(map(str, text)) if isinstance(text, list) else str(text))
            for section, name, entry in entries
            for key, text in (entry.items() if isinstance(entry, dict) else ())
            if key != "title"
        )

    def _stop(self, before: int) -> None:
        """Raise what was found since; what a table with other parts should hold is not known."""
        if len(self.faults.found) > before:
            self.faults.raise_any()

    def _section(self, name: str) -> Iterable[tuple[str, object]]:
        return self.entries.section(name).items() if name in self.entries.document else ()

    def _part(self, name: str, entry: object) -> _Listed | None:
        """An entry of `[parts]`."""
        path = (PARTS, name)
        fault = names.fault_of_identifier(name)
        if fault is not None:
            self.faults.key("part", path, fault)
            return None
        if not isinstance(entry, dict) or not all(isinstance(text, str) for text in entry.values()):
            message = 'a part is a table of names like { part = "first_order_actuator", input = "delta_e" }'
            self.faults.value("shape", path, message)
            return None
        if "part" not in entry:
            self.faults.key("missing", path, "`part` is missing", f"parts: {', '.join(family_file.built_in(PARTS))}")
            return None
        try:
            file = family_file.find_part(entry["part"], self.folder)
            joins, made = file.part()
        except family_file.NotFoundError as error:
            self.faults.value("unknown-part", (*path, "part"), str(error), error.help)
            return None
        except TableError as error:
            self.faults.found += error.diagnostics
            return None
        self.entries.only(path, entry, ("part", *joins))
        missing = [key for key in joins if key not in entry]
        for key in missing:
            self.faults.key("missing", path, f"`{key}` is missing: what of the model the part joins")
        return None if missing else _Listed(file, made, joins, {key: entry[key] for key in joins})

    def _join(self, family: Family, name: str, entry: object, parts: Mapping[str, _Listed]) -> list[str]:
        """Add a model of `[joined]`; the names of its parts."""
        path = (JOINED, name)
        if not isinstance(entry, dict):
            self.faults.value("shape", path, f"`[{JOINED}.{name}]` holds {', '.join(_JOINED_KEYS)}")
            return []
        self.entries.only(path, entry, _JOINED_KEYS)
        missing = [key for key in _JOINED_KEYS if key not in entry]
        for key in missing:
            self.faults.key("missing", path, f"`{key}` is missing in `[{JOINED}.{name}]`")
        listed = entry.get("parts", [])
        listed = [str(part) for part in listed] if isinstance(listed, list) else []
        known = [part for part in self._names(PARTS) if isinstance(part, str)]
        unknown = [part for part in listed if part not in known]
        if unknown or not listed or len(set(listed)) != len(listed):
            message = f"`parts` lists parts of `[{PARTS}]`, each once"
            if not missing:
                self.faults.value("unknown-part", (*path, "parts"), message, suggestion((*unknown, "")[0], known))
            return listed
        own = {model: spec for model, spec in family.models.items() if not spec.instances}
        if not missing and entry["model"] not in own:
            message = f"`{entry['model']}` is not a model of the family"
            self.faults.value("unknown-model", (*path, "model"), message, suggestion(str(entry["model"]), own))
        elif not missing and not isinstance(entry["title"], str):
            self.faults.value("shape", (*path, "title"), "`title` must be a text")
        elif not missing and all(part in parts for part in listed):
            self._add(family, name, entry, {part: parts[part] for part in listed})
        return listed

    def _names(self, section: str) -> Iterable[object]:
        return [name for name, _ in self._section(section)]

    def _add(self, family: Family, name: str, entry: Mapping[str, str], parts: Mapping[str, _Listed]) -> None:
        try:
            instances = self._instances(family.models[entry["model"]], parts)
            if len(instances) == len(parts):
                family.join(name, entry["title"], entry["model"], instances)
        except TableError as error:
            self.faults.found += error.diagnostics
        except FamilyError as error:
            self.faults.key("joined", (JOINED, name), str(error), error.help)

    def _instances(self, of: ModelSpec, parts: Mapping[str, _Listed]) -> list[Instance]:
        """The parts, made of the variables that they join; a part may join one before it.

        There are no more after one that does not fit.
        """
        bases = of.bases
        drivers: dict[str, str] = {}
        instances: list[Instance] = []
        for name, listed in parts.items():
            joined = self._joined(of.name, name, listed, bases, drivers)
            if len(joined) < len(listed.joins):
                break
            place = Place(self.faults.file, (PARTS, name))
            part = listed.made(joined, place)
            instance = Instance(name, part, partial(listed.file.faults, place))
            bases = joined_bases(bases, [instance])
            drivers |= {driven.name: name for driven in part.drives}
            instances.append(instance)
        return instances

    def _joined(
        self, model: str, name: str, listed: _Listed, bases: Mapping[str, tuple[Variable, ...]], drivers: dict[str, str]
    ) -> dict[str, Variable]:
        """The variables that a part joins; `drivers` are parts before it, by the inputs that they drive."""
        found: dict[str, Variable] = {}
        for key, wanted in listed.names.items():
            join, known = listed.joins[key], {one.name: one for kind in ("state", "input") for one in bases[kind]}
            fitting = {one.name: one for kind in join.kinds for one in bases[kind] if _has_unit(one, join)}
            if wanted in fitting:
                found[key] = fitting[wanted]
                continue
            what = f"`{key}` of `{listed.file.path.stem}` is {join.words(self.entries.system)}"
            if wanted in drivers:
                message = f"`{wanted}` is driven by `{drivers[wanted]}` already"
            elif wanted not in known:
                message = f"`{wanted}` is neither a state nor an input of `{model}`"
            else:
                kind = "a state" if known[wanted] in bases["state"] else "an input"
                unit = units.converted(known[wanted].unit, self.entries.system)
                message = f"`{wanted}` is {kind} in `{unit}`; {what}"
            advice = None if wanted in known or wanted in drivers else nearest(wanted, fitting)
            advice = advice or "; ".join([what, suggestion("", fitting) or "there is none here"])
            self.faults.value("unknown-join", (PARTS, name, key), message, advice)
        return found


def _has_unit(variable: Variable, join: Join) -> bool:
    return join.unit is None or units.dimensions(variable.unit) == units.dimensions(join.unit)
