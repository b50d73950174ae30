"""Reads and checks a table; every fault is tied to the key it stands at. What a table holds, its family says."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from . import emit, family_file, names, units
from .contents import Contents, ParameterSet, TableParameter
from .diagnostics import Faults, TableError, suggestion
from .entries import Entries, Provenance
from .family import Family, Outline
from .family_file import FamilyFile, Place
from .joined import JOINED, PARTS
from .joins import Joins, JoinText
from .model import Model
from .polynomial import MonomialError, Polynomial, Powers, Term, monomial_name, parse_monomial
from .schema import Choice, Parameter, Quantity, Rule, Schema, Variable

_HEADER_KEYS = ("name", "family", "models", "units", "set", "source", "status", "uncertainty")
_BOX_KEYS = ("min", "max", "unit")
CHOICES = "choices"


@dataclass(frozen=True)
class Table(Contents):
    """A checked table: what it holds, and what it says of its models.

    `schemas` are what a table of one of the models by itself holds.
    """

    name: str
    models: tuple[str, ...]
    file: FamilyFile
    family: Family
    schemas: Mapping[str, Schema]
    sets: tuple[ParameterSet, ...]
    joins: tuple[JoinText, ...]

    @property
    def audited(self) -> tuple[str, ...]:
        """Those of its models with which the audit of the printed equations comes."""
        return tuple(name for name in self.models if self.family.models[name].audited)

    def build(self) -> list[Model]:
        """The models that it lists."""
        return [self.model(name) for name in self.models]

    def model(self, name: str) -> Model:
        """One of the models that it lists.

        Raises:
            TableError: with what the family's file states wrongly.
        """
        is_joined = bool(self.family.models[name].instances)
        with self.file.faults(Place(self.path.name, (JOINED, name)) if is_joined else None):
            return self.family.build(name, self)

    def only_for(self, section: str, key: str) -> list[str]:
        """The models whose tables have this entry; none if all have it."""
        models = [name for name, schema in self.schemas.items() if schema.holds(section, key)]
        return [] if len(models) == len(self.models) else models


def load(path: Path) -> Table:
    """Read and check the table at `path`.

    Raises:
        TableError: with every fault found.
    """
    faults = Faults(path.name)
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError, RecursionError) as error:
        # A ValueError is text that is not UTF-8, not TOML, or an integer of thousands of digits.
        faults.key("unreadable", (), f"cannot read the table: {error}")
        faults.raise_any()
        raise AssertionError("unreachable") from error
    table = _Reader(document, faults, path).read()
    faults.raise_any()
    return table


class Texts(Protocol):
    """Symbol, unit and text of something declared."""

    @property
    def symbol(self) -> str:
        """In LaTeX."""

    @property
    def unit(self) -> str:
        """In either system."""

    @property
    def doc(self) -> str:
        """In words."""


@dataclass(frozen=True)
class _Coefficient:
    symbol: str
    unit: str
    doc: str


class _Reader:
    def __init__(self, document: Mapping[str, object], faults: Faults, path: Path) -> None:
        self.document = document
        self.path = path
        self.faults = faults
        self.entries = Entries(document, faults)
        self.header = self.entries.section("table")
        self.parameters: dict[str, TableParameter] = {}
        self.box: dict[str, tuple[float, float]] = {}

    def read(self) -> Table:
        name, system, own_set = self._identity()
        self.entries.system = system
        self._sources()
        file, family = self._family()
        joins = Joins(self.entries, self.path.parent).read(family)
        models = self._models(family)
        schema = family.schema(models)
        self.known = (*schema.parameters, *(q.key for q in schema.quantities))
        known = ("table", "sources", CHOICES, "validity", "sets", PARTS, JOINED, emit.SECTION, *self.known)
        self.entries.only((), self.document, [k for k in known if k != CHOICES or schema.choices], "section")
        for section, specs in schema.parameters.items():
            self._group(section, specs)
        if schema.choices:
            self._choices(schema.choices)
        polynomials = {q.key: _Polynomial(self, q).read() for q in schema.quantities}
        self._validity(schema.validity)
        emitted = emit.read(self.entries)
        sets = (ParameterSet(own_set, ()), *self._sets(own_set, schema))
        self._rules(schema.rules(), sets)
        schemas = {model: family.schema((model,)) for model in models}
        parameters = tuple(self.parameters.values())
        return Table(
            self.path,
            system,
            schema,
            parameters,
            polynomials,
            emitted,
            self.entries.values,
            self.box,
            name,
            models,
            file,
            family,
            schemas,
            sets,
            joins,
        )

    def add(self, parameter: TableParameter) -> None:
        """Takes up a parameter of the table."""
        other = self.parameters.setdefault(parameter.name, parameter)
        if other is not parameter:
            places = ["`" + "` in `".join(reversed(p.path)) + "`" for p in (parameter, other)]
            message = f"{places[0]} and {places[1]} would both be called `{parameter.name}`"
            self.faults.key("duplicate-name", parameter.path, message)

    def parameter(
        self, path: tuple[str, ...], name: str, texts: Texts, of: Provenance, kind: str = "parameter"
    ) -> TableParameter:
        """The parameter of a checked entry."""
        unit = units.converted(texts.unit, self.entries.system)
        return TableParameter(name, path, texts.symbol, unit, texts.doc, of.source, of.status, of.uncertainty, kind)

    def _identity(self) -> tuple[str, str, str]:
        self.entries.only(("table",), self.header, _HEADER_KEYS)
        for key in _HEADER_KEYS:
            if self.entries.has("table") and key not in self.header:
                self.faults.key("missing", ("table",), f"`{key}` is missing in `[table]`")
        name = self.header.get("name", "table")
        fault = names.fault_of_table(name)
        if fault is not None:
            self.faults.value("table-name", ("table", "name"), fault)
        system = self.header.get("units", units.IMPERIAL)
        if system not in units.SYSTEMS:
            help_line = suggestion(str(system), units.SYSTEMS)
            self.faults.value("unit-system", ("table", "units"), f"unknown unit system `{system}`", help_line)
            system = units.IMPERIAL
        own_set = self.header.get("set", "")
        if "set" in self.header and not (isinstance(own_set, str) and names.SET_NAME.fullmatch(own_set)):
            message = f"`set` must name the table's own parameter set, in {names.SET_LETTERS}"
            self.faults.value("set-name", ("table", "set"), message)
        self.entries.defaults = self.entries.provenance(self.header, ("table",))
        return str(name), str(system), str(own_set)

    def _sources(self) -> None:
        for key, text in self.entries.section("sources").items():
            if not isinstance(text, str) or not key.isprintable() or set('"\\') & set(key):
                message = "a source is a plain key with a text that says what it is"
                self.faults.key("source", ("sources", key), message)

    def _family(self) -> tuple[FamilyFile, Family]:
        """The family that the table names, and its file; what it should hold is not known without it."""
        path, named = ("table", "family"), self.header.get("family")
        try:
            if named is not None:
                file = family_file.find_family(named, self.path.parent)
                return file, file.family(Outline(tuple(self.document)))
        except family_file.NotFoundError as error:
            self.faults.value("unknown-family", path, str(error), error.help)
        except TableError as error:
            self.faults.found += error.diagnostics
        self.faults.raise_any()
        raise AssertionError("unreachable: a family that is missing is a fault")

    def _models(self, family: Family) -> tuple[str, ...]:
        """The models of the family that the table lists."""
        path, known = ("table", "models"), tuple(family.models)
        listed = self.header.get("models", [])
        models = tuple(str(m) for m in listed) if isinstance(listed, list) else ()
        unknown = [m for m in models if m not in known]
        for model in unknown:
            message = f"`{model}` is not a model of the family"
            self.faults.value("unknown-model", path, message, suggestion(model, known))
        ordered = tuple(m for m in known if m in models)
        if "models" in self.header and not unknown and (not models or ordered != models):
            message = "`models` must list models of the family, each once, in this order"
            self.faults.value("models", path, message, ", ".join(f"`{m}`" for m in known))
        if not ordered:
            self.faults.raise_any()  # What such a table should hold is not known.
        return ordered

    def _group(self, section: str, specs: Iterable[Parameter]) -> None:
        """The parameters of a section."""
        content = self.entries.section(section)
        by_key = {spec.key: spec for spec in specs}
        self.entries.only((section,), content, by_key)
        for key, spec in by_key.items():
            path = (section, key)
            if key in content:
                provenance = self.entries.entry(path, spec.unit)
                if provenance is not None:
                    self.add(self.parameter(path, spec.name, spec, provenance))
            elif self.entries.has(section):
                self.faults.key("missing", (section,), f"`{key}` ({spec.doc}) is missing in `[{section}]`")

    def _choices(self, choices: Iterable[Choice]) -> None:
        content = self.entries.section(CHOICES)
        by_name = {choice.name: choice for choice in choices}
        self.entries.only((CHOICES,), content, by_name, "choice")
        for name, choice in by_name.items():
            path, options = (CHOICES, name), [option.name for option in choice.options]
            chosen = content.get(name)
            if name not in content:
                if self.entries.has(CHOICES):
                    known = ", ".join(f"`{option}`" for option in options)
                    message = f"`{name}` is missing in `[{CHOICES}]`"
                    self.faults.key("missing", (CHOICES,), message, f"choose one of {known}")
            elif chosen not in options:
                help_line = suggestion(str(chosen), options)
                self.faults.value("unknown-option", path, f"`{chosen}` is not an option of `{name}`", help_line)
            for spec in choice.switches:
                self.add(self.parameter(path, spec.name, spec, Provenance(CHOICES, "assumed", 0.0), "switch"))

    def _validity(self, specs: Iterable[Variable]) -> None:
        content = self.entries.section("validity")
        by_name = {spec.name: spec for spec in specs}
        self.entries.only(("validity",), content, by_name)
        for name, spec in by_name.items():
            if name in content:
                self._box(("validity", name), spec, content[name])
            elif self.entries.has("validity"):
                self.faults.key("missing", ("validity",), f"`{name}` ({spec.doc}) is missing in `[validity]`")

    def _box(self, path: tuple[str, ...], spec: Variable, box: object) -> None:
        if not isinstance(box, dict):
            self.faults.value("shape", path, 'a range is a table like { min = -5.0, max = 5.0, unit = "deg" }')
            return
        self.entries.only(path, box, _BOX_KEYS)
        missing = [key for key in _BOX_KEYS if key not in box]
        for key in missing:
            self.faults.key("missing", path, f"`{key}` is missing")
        if missing:
            return
        low, high = (self.entries.number(box[key], (*path, key)) for key in ("min", "max"))
        if low is not None and high is not None and low >= high:
            self.faults.value("range", (*path, "min"), "`min` must be below `max`")
        expected = units.converted(spec.unit, self.entries.system)
        scale = self.entries.unit(box["unit"], (*path, "unit"), expected)
        if low is not None and high is not None and not self.faults.found:
            self.box[spec.name] = (low * scale, high * scale)

    def _sets(self, own: str, schema: Schema) -> Iterable[ParameterSet]:
        """The sets of `[sets]`."""
        content = self.document.get("sets", {})
        if not isinstance(content, dict):
            self.faults.value("shape", ("sets",), '`sets` must hold sections like `[sets."section5.3".vehicle]`')
            content = {}
        taken: frozenset[str] = frozenset()
        for name, sections in content.items():
            fault = names.fault_of_set(name, taken)
            if name == own:
                fault = f"a set has a name of its own; `{own}` is that of the table's own values"
            if fault is not None:
                self.faults.key("set-name", ("sets", name), fault)
                continue
            taken |= names.constants(name)
            yield ParameterSet(name, tuple(self._replacements(("sets", name), sections, schema)))

    def _replacements(self, path: tuple[str, ...], sections: object, schema: Schema) -> Iterable[TableParameter]:
        if not isinstance(sections, dict):
            self.faults.value("shape", path, "a set holds sections like those of the table")
            return
        known = {p.path: p for p in self.parameters.values()}
        for section, entries in sections.items():
            place = (*path, section)
            if section not in self.known or not isinstance(entries, dict):
                message = f"`{section}` is no section of parameters"
                self.faults.key("unknown-section", place, message, suggestion(section, self.known))
                continue
            listed = self.document.get(section)
            keys = [spec.key for spec in schema.parameters.get(section, ())]
            keys = list(dict.fromkeys([*keys, *(listed if isinstance(listed, dict) else ())]))
            for key in entries:
                parameter = known.get((section, key))
                if parameter is not None:
                    yield from self._replacement((*place, key), parameter)
                elif key not in keys:  # What is wrong with one of these in the table is told there.
                    message = f"`[{section}]` of the table has no `{key}` to replace"
                    self.faults.key("nothing-to-replace", (*place, key), message, suggestion(key, keys))

    def _replacement(self, path: tuple[str, ...], parameter: TableParameter) -> Iterable[TableParameter]:
        provenance = self.entries.entry(path, parameter.unit)
        if provenance is not None:
            yield self.parameter(path, parameter.name, parameter, provenance, parameter.kind)

    def _rules(self, rules: Iterable[Rule], sets: Iterable[ParameterSet]) -> None:
        """Holds the table, and every set that says something of a rule, against the rules."""
        own = {name: p.path for name, p in self.parameters.items()}
        replaced = [{p.name: p.path for p in one.parameters} for one in sets]
        for rule in rules:
            for paths in [own, *replaced]:
                named = [paths[name] for name in rule.parameters() if name in paths]
                places = own | paths
                values = {name: self.entries.values.get(places.get(name, ())) for name in rule.parameters()}
                known = {name: value for name, value in values.items() if value is not None}
                if named and len(known) == len(values) and not rule.holds(known):
                    self.faults.value(rule.name, (*named[0], "value"), rule.reason)


class _Polynomial:
    """Reads the polynomial of a quantity."""

    def __init__(self, reader: _Reader, spec: Quantity) -> None:
        self.reader = reader
        self.faults = reader.faults
        self.spec = spec
        self.variables = {variable.name: variable for variable in spec.depends_on}

    def read(self) -> Polynomial:
        """The polynomial; its coefficients become parameters of the table."""
        spec, section = self.spec, (self.spec.key,)
        content = self.reader.entries.section(spec.key)
        terms: list[Term] = []
        seen: dict[Powers, str] = {}
        if not content and self.reader.entries.has(spec.key):
            self.faults.key("no-coefficient", section, f"`[{spec.key}]` has no coefficient")
        for key in content:
            powers = self._monomial(key)
            if powers is None:
                continue
            if powers in seen:
                message = f"`{key}` is the same monomial as `{seen[powers]}`"
                self.faults.key("duplicate-monomial", (*section, key), message)
                continue
            seen[powers] = key
            terms += self._coefficient(key, powers)
        for variable in spec.required:
            if content and ((variable, 1),) not in seen:  # An empty quantity is told as such.
                message = f"the coefficient of `{variable}` is missing in `[{spec.key}]`"
                self.faults.key("missing", section, message, spec.required_by)
        return Polynomial(tuple(terms))

    def _monomial(self, key: str) -> Powers | None:
        spec, path = self.spec, (self.spec.key, key)
        try:
            powers = parse_monomial(key, spec.variables)
        except MonomialError as error:
            advice = suggestion(error.word, spec.variables) if error.word else error.advice
            self.faults.key("monomial", path, str(error), advice)
            return None
        if sum(exponent for name, exponent in powers if name in spec.affine) > 1:
            self.faults.key("affine", path, f"`{key}` is not affine in {spec.affine_by}")
            return None
        return powers

    def _coefficient(self, key: str, powers: Powers) -> list[Term]:
        spec, path = self.spec, (self.spec.key, key)
        provenance = self.reader.entries.entry(path, spec.unit_of(powers))
        if provenance is None:
            return []
        name = f"{spec.key.lower()}_{monomial_name(powers)}"
        doc = f"coefficient of {key} in {spec.key}" if powers else f"constant part of {spec.key}"
        # In the words of the table: `1/rad/s`, where the quotient above says `1/s/rad`.
        written = _Coefficient(self._symbol(powers), self.reader.entries.units[path], doc)
        kind = "required" if powers in [((variable, 1),) for variable in spec.required] else "coefficient"
        self.reader.add(self.reader.parameter(path, name, written, provenance, kind))
        return [Term(name, powers)]

    def _symbol(self, powers: Powers) -> str:
        factors = [(self.variables[name].symbol, exponent) for name, exponent in powers]
        above = " ".join(symbol if k == 1 else f"{symbol}^{k}" for symbol, k in factors) or "0"
        # A symbol may have a superscript of its own.
        base = f"{{{self.spec.symbol}}}" if "^" in self.spec.symbol else self.spec.symbol
        return f"{base}^{{{above}}}"
