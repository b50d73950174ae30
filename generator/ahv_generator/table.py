"""Reads and checks a table; every fault is tied to the key it stands at."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from . import units
from .diagnostics import Faults, suggestion
from .polynomial import MonomialError, Polynomial, Powers, Term, monomial_name, parse_monomial
from .schema import (
    COM_FAMILY,
    FAMILIES,
    MODE_FAMILY,
    STATUSES,
    Choice,
    ParameterSpec,
    QuantitySpec,
    Schema,
    VariableSpec,
    com_schema,
    dcom_schema,
    mode_schema,
)

_HEADER_KEYS = ("name", "models", "units", "set", "source", "status", "uncertainty")
_ENTRY_KEYS = ("value", "unit", "source", "status", "uncertainty")
_BOX_KEYS = ("min", "max", "unit")
_MODELS = tuple(model for family in FAMILIES for model in family)
CHOICES = "choices"
# Flexible modes of a DCOM: a number has one digit.
MOST_MODES = 9
_OTHER_MODES = re.compile(r"C_N_(?:0[0-9]*|[1-9][0-9]+)")

_SET_NAME = re.compile(r"[a-z][a-z0-9._-]*")
_SET_LETTERS = "lower-case letters, digits, `.`, `_`, `-`"
# A set becomes a constant of the generated code; these stand beside it.
_CONSTANTS = ("nominal", "provenance", "sets", "unit_system", "validity", "state_bounds", "input_bounds")
# Of this name is the file beside the IRs that holds the audit of the printed equations.
_AUDIT = "audit"
# What law (4) divides by.
_DIVISOR = "c_l_delta_c"


@dataclass(frozen=True)
class Parameter:
    """A parameter or coefficient of a table; its value stays in the table."""

    name: str
    path: tuple[str, ...]
    symbol: str
    unit: str
    doc: str
    source: str
    status: str
    uncertainty: float


@dataclass(frozen=True)
class ParameterSet:
    """A named set: the parameters that it replaces, with the places of their new values."""

    name: str
    parameters: tuple[Parameter, ...]


@dataclass(frozen=True)
class Table:
    """A checked table: parameters in order, and the polynomial of each quantity."""

    name: str
    models: tuple[str, ...]
    units: str
    schema: Schema
    parameters: tuple[Parameter, ...]
    polynomials: dict[str, Polynomial]
    validity: tuple[VariableSpec, ...]
    sets: tuple[ParameterSet, ...]


def load(path: Path) -> Table:
    """Read and check the table at `path`.

    Raises:
        TableError: with every fault found.
    """
    faults = Faults(path.name)
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        faults.key((), f"cannot read the table: {error}")
        faults.raise_any()
        raise AssertionError("unreachable") from error
    table = _Reader(document, faults).read()
    faults.raise_any()
    return table


class _Reader:
    def __init__(self, document: Mapping[str, object], faults: Faults) -> None:
        self.document = document
        self.faults = faults
        self.header = self._section("table")
        self.sources = self._section("sources")

    def read(self) -> Table:
        name, models = self._identity()
        system = str(self.header.get("units", units.IMPERIAL))
        self.system = system if system in units.SYSTEMS else units.IMPERIAL
        for key, text in self.sources.items():
            if not isinstance(text, str) or not key.isprintable() or set('"\\') & set(key):
                self.faults.key(("sources", key), "a source is a plain key with a text that says what it is")
        schema = self._schema(models)
        self.known = (*schema.parameters, *(q.key for q in schema.quantities))
        known = ("table", "sources", CHOICES, "validity", "sets", *self.known)
        for section in self.document:
            if section not in known:
                if _OTHER_MODES.fullmatch(section) and "C_N_1" in known:
                    self.faults.key((section,), f"`{section}`: flexible modes are numbered from 1 to {MOST_MODES}")
                else:
                    self.faults.key((section,), f"unknown section `{section}`", suggestion(section, known))
        parameters: list[Parameter] = []
        for section, specs in schema.parameters.items():
            parameters += self._parameters(section, specs)
        parameters += self._choices(schema.choices)
        polynomials: dict[str, Polynomial] = {}
        for quantity in schema.quantities:
            polynomials[quantity.key], found = self._quantity(quantity, schema.variable_units())
            parameters += found
        self._validity(schema.validity)
        sets = self._sets(schema, parameters)
        self._inertia(("vehicle", "I_yy", "value"))
        return Table(name, models, self.system, schema, tuple(parameters), polynomials, schema.validity, sets)

    def _section(self, name: str) -> Mapping[str, object]:
        section = self.document.get(name)
        if section is None:
            self.faults.key((), f"the section `[{name}]` is missing")
            return {}
        if not isinstance(section, dict):
            self.faults.value((name,), f"`{name}` must be a section")
            return {}
        return section

    def _identity(self) -> tuple[str, tuple[str, ...]]:
        for key in self.header:
            if key not in _HEADER_KEYS:
                self.faults.key(("table", key), f"unknown key `{key}`", suggestion(key, _HEADER_KEYS))
        for key in _HEADER_KEYS:
            if self.header and key not in self.header:
                self.faults.key(("table",), f"`{key}` is missing in `[table]`")
        name = self.header.get("name", "table")
        if not (isinstance(name, str) and name.isidentifier() and name == name.lower()) or name == _AUDIT:
            message = f"`name` must be a lower-case identifier other than `{_AUDIT}`"
            self.faults.value(("table", "name"), message)
        system = self.header.get("units", units.IMPERIAL)
        if system not in units.SYSTEMS:
            help_line = suggestion(str(system), units.SYSTEMS)
            self.faults.value(("table", "units"), f"unknown unit system `{system}`", help_line)
        if "set" in self.header and not _SET_NAME.fullmatch(str(self.header["set"])):
            message = f"`set` must name the table's own parameter set, in {_SET_LETTERS}"
            self.faults.value(("table", "set"), message)
        self._provenance(self.header, ("table",))
        return str(name), self._models()

    def _models(self) -> tuple[str, ...]:
        path = ("table", "models")
        listed = self.header.get("models", [])
        models = tuple(str(m) for m in listed) if isinstance(listed, list) else ()
        unknown = [m for m in models if m not in _MODELS]
        for model in unknown:
            self.faults.value(path, f"unknown model `{model}`", suggestion(model, _MODELS))
        if "models" in self.header and not unknown:
            chosen = [[m for m in family if m in models] for family in FAMILIES]
            if not models or tuple(next((c for c in chosen if c), ())) != models:
                families = "; ".join(", ".join(f"`{m}`" for m in family) for family in FAMILIES)
                message = "`models` must list models of one family, each once, in this order"
                self.faults.value(path, message, f"the families are: {families}")
        return models

    def _schema(self, models: tuple[str, ...]) -> Schema:
        if set(models) & set(COM_FAMILY):
            return com_schema(models)
        if set(models) & set(MODE_FAMILY):
            return mode_schema()
        numbered = [int(s[4:]) for s in self.document if re.fullmatch(rf"C_N_[1-{MOST_MODES}]", s)]
        return dcom_schema(models, max(numbered, default=1))

    def _entry(self, path: tuple[str, ...], expected: str) -> tuple[float, Mapping[str, object]] | None:
        entry: object = self.document
        for key in path:
            entry = entry.get(key) if isinstance(entry, dict) else None
        if not isinstance(entry, dict):
            self.faults.value(path, 'an entry is a table like { value = 1.0, unit = "1/rad" }')
            return None
        for key in entry:
            if key not in _ENTRY_KEYS:
                self.faults.key((*path, key), f"unknown key `{key}`", suggestion(key, _ENTRY_KEYS))
        for key in ("value", "unit"):
            if key not in entry:
                self.faults.key(path, f"`{key}` is missing")
        value = self._number(entry, (*path, "value")) if "value" in entry else None
        if "unit" in entry:
            self._unit(entry["unit"], (*path, "unit"), units.converted(expected, self.system))
        self._provenance(entry, path)
        return None if value is None else (value, entry)

    def _number(self, entry: Mapping[str, object], path: tuple[str, ...]) -> float | None:
        value = entry[path[-1]]
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.faults.value(path, f"`{path[-1]}` must be a number")
            return None
        if not math.isfinite(value):
            self.faults.value(path, f"`{path[-1]}` must be finite, not {value}")
            return None
        return float(value)

    def _unit(self, text: object, path: tuple[str, ...], expected: str) -> None:
        if not isinstance(text, str):
            self.faults.value(path, "`unit` must be a text")
            return
        try:
            scale = units.factor(text, expected)
        except units.UnitError as error:
            self.faults.value(path, str(error), f"the unit here is `{expected}`")
            return
        if scale != 1.0:
            self.faults.value(
                path,
                f"`{text}` measures the right thing, but the table is in {self.system}",
                f"write the value in `{expected}`",
            )

    def _provenance(self, entry: Mapping[str, object], path: tuple[str, ...]) -> None:
        source = entry.get("source")
        if "source" in entry and not (isinstance(source, str) and source in self.sources):
            self.faults.value((*path, "source"), f"unknown source `{source}`", suggestion(str(source), self.sources))
        status = entry.get("status")
        if "status" in entry and status not in STATUSES:
            self.faults.value((*path, "status"), f"unknown status `{status}`", suggestion(str(status), STATUSES))
        if "uncertainty" in entry:
            number = self._number(entry, (*path, "uncertainty"))
            if number is not None and number < 0:
                self.faults.value((*path, "uncertainty"), "a relative uncertainty is not negative")

    def _parameter(
        self, path: tuple[str, ...], name: str, symbol: str, unit: str, doc: str, entry: Mapping[str, object]
    ) -> Parameter:
        def inherited(key: str) -> object:
            return entry.get(key, self.header.get(key))

        uncertainty = inherited("uncertainty")
        return Parameter(
            name,
            path,
            symbol,
            units.converted(unit, self.system),
            doc,
            str(inherited("source")),
            str(inherited("status")),
            float(uncertainty) if isinstance(uncertainty, int | float) else math.nan,
        )

    def _parameters(self, section: str, specs: Iterable[ParameterSpec]) -> list[Parameter]:
        content = self._section(section)
        by_key = {spec.key: spec for spec in specs}
        for key in content:
            if key not in by_key:
                self.faults.key((section, key), f"unknown key `{key}`", suggestion(key, by_key))
        found: list[Parameter] = []
        for key, spec in by_key.items():
            if key not in content:
                if content:
                    self.faults.key((section,), f"`{key}` ({spec.doc}) is missing in `[{section}]`")
                continue
            entry = self._ranged((section, key), spec)
            if entry is not None:
                found.append(self._parameter((section, key), key.lower(), spec.symbol, spec.unit, spec.doc, entry))
        return found

    def _ranged(self, path: tuple[str, ...], spec: ParameterSpec) -> Mapping[str, object] | None:
        """The entry at `path` if it is one, its value held against what `spec` allows."""
        checked = self._entry(path, spec.unit)
        if checked is None:
            return None
        value, entry = checked
        if (spec.positive and value <= 0) or value < spec.lowest:
            bound = "positive" if spec.positive else f"at least {spec.lowest:g}"
            self.faults.value((*path, "value"), f"`{spec.key}` ({spec.doc}) must be {bound}")
        return entry

    def _choices(self, choices: Iterable[Choice]) -> list[Parameter]:
        content = self._section(CHOICES)
        by_name = {choice.name: choice for choice in choices}
        for key in content:
            if key not in by_name:
                self.faults.key((CHOICES, key), f"unknown choice `{key}`", suggestion(key, by_name))
        found: list[Parameter] = []
        for name, choice in by_name.items():
            options = [option.name for option in choice.options]
            chosen = content.get(name)
            if name not in content:
                if content:
                    known = ", ".join(f"`{option}`" for option in options)
                    self.faults.key((CHOICES,), f"`{name}` is missing in `[{CHOICES}]`", f"choose one of {known}")
            elif chosen not in options:
                self.faults.value((CHOICES, name), f"`{chosen}` is no {choice.doc}", suggestion(str(chosen), options))
            for spec in choice.switches:
                place = (CHOICES, name)
                found.append(Parameter(spec.key, place, spec.symbol, spec.unit, spec.doc, CHOICES, "assumed", 0.0))
        return found

    def _sets(self, schema: Schema, parameters: Iterable[Parameter]) -> tuple[ParameterSet, ...]:
        """The table's own set, which replaces nothing, and those of `[sets]`."""
        own = str(self.header.get("set", ""))
        content = self.document.get("sets", {})
        if not isinstance(content, dict):
            self.faults.value(("sets",), '`sets` must hold sections like `[sets."section5.3".vehicle]`')
            content = {}
        known = {p.path: p for p in parameters}
        specs = {(section, spec.key): spec for section, group in schema.parameters.items() for spec in group}
        found = [ParameterSet(own, ())]
        taken = set(_CONSTANTS)
        for name, sections in content.items():
            constant = re.sub("[._-]", "_", name)
            constants = {constant, f"{constant}_provenance"}
            if not _SET_NAME.fullmatch(name) or name == own or constants & taken:
                self.faults.key(("sets", name), f"a set has a name of its own, of {_SET_LETTERS}")
                continue
            taken |= constants
            found.append(ParameterSet(name, tuple(self._replacements(name, sections, known, specs))))
            self._inertia(("sets", name), name)
        return tuple(found)

    def _replacements(
        self,
        name: str,
        sections: object,
        known: Mapping[tuple[str, ...], Parameter],
        specs: Mapping[tuple[str, str], ParameterSpec],
    ) -> Iterable[Parameter]:
        if not isinstance(sections, dict):
            self.faults.value(("sets", name), "a set holds sections like those of the table")
            return
        for section, entries in sections.items():
            place = ("sets", name, section)
            if section not in self.known or not isinstance(entries, dict):
                self.faults.key(place, f"`{section}` is no section of parameters", suggestion(section, self.known))
                continue
            own = self.document.get(section)
            listed = list(own) if isinstance(own, dict) else []
            keys = list(dict.fromkeys([*(path[1] for path in specs if path[0] == section), *listed]))
            for key in entries:
                parameter = known.get((section, key))
                if parameter is None and key in keys:
                    continue  # What is wrong with it in the table is told there.
                if parameter is None:
                    help_line = suggestion(key, keys)
                    self.faults.key((*place, key), f"`[{section}]` of the table has no `{key}` to replace", help_line)
                    continue
                # A coefficient may have any value, but for what law (4) divides by.
                spec = specs.get((section, key), ParameterSpec(key, "", parameter.unit, parameter.doc))
                entry = self._ranged((*place, key), spec)
                if entry is not None:
                    self._divisor((*place, key), parameter.name, entry)
                    yield self._parameter(
                        (*place, key), parameter.name, parameter.symbol, parameter.unit, parameter.doc, entry
                    )

    def _inertia(self, path: tuple[str, ...], replacing: str = "") -> None:
        """The mass matrix of pitch and cantilever modes must be positive definite."""
        inertia, *couplings = numbers = self._masses(replacing)
        if replacing and numbers == self._masses(""):
            return  # Told of the table itself.
        # A product overflows to infinity, a power to an exception.
        if any(couplings) and inertia <= sum(coupling * coupling for coupling in couplings):
            message = "`I_yy` must exceed the sum of the squares of `psi_i`: no mass matrix is like this"
            self.faults.value(path, message)

    def _masses(self, replacing: str) -> list[float]:
        return [self._value(replacing, "vehicle", "I_yy")] + [
            self._value(replacing, "modes", f"psi_{i}") for i in (1, 2)
        ]

    def _value(self, replacing: str, section: str, key: str) -> float:
        """A value as a set has it, or the table where the set does not; 0 where there is none."""
        for path in (("sets", replacing, section, key, "value"), (section, key, "value")):
            entry: object = self.document
            for step in path:
                entry = entry.get(step) if isinstance(entry, dict) else None
            if isinstance(entry, int | float):
                return float(entry)
        return 0.0

    def _quantity(self, spec: QuantitySpec, variable_units: Mapping[str, str]) -> tuple[Polynomial, list[Parameter]]:
        content = self._section(spec.key)
        terms: list[Term] = []
        found: list[Parameter] = []
        seen: dict[Powers, str] = {}
        if not content and spec.key in self.document:
            self.faults.key((spec.key,), f"`[{spec.key}]` has no coefficient")
        for key in content:
            powers = self._monomial(spec, key)
            if powers is None:
                continue
            if powers in seen:
                self.faults.key((spec.key, key), f"`{key}` is the same monomial as `{seen[powers]}`")
                continue
            seen[powers] = key
            parameter = self._coefficient(spec, key, powers, variable_units)
            if parameter is not None:
                found.append(parameter)
                terms.append(Term(parameter.name, powers))
        for variable in spec.required:
            if content and ((variable, 1),) not in seen:
                message = f"the coefficient of `{variable}` is missing in `[{spec.key}]`"
                self.faults.key((spec.key,), message, "law (4) needs it")
        return Polynomial(tuple(terms)), found

    def _coefficient(
        self, spec: QuantitySpec, key: str, powers: Powers, variable_units: Mapping[str, str]
    ) -> Parameter | None:
        unit = spec.unit
        for variable, exponent in powers:
            for _ in range(exponent):
                unit = units.quotient(unit, variable_units[variable])
        checked = self._entry((spec.key, key), unit)
        if checked is None:
            return None
        _, entry = checked
        name = f"{spec.key.lower()}_{monomial_name(powers)}"
        self._divisor((spec.key, key), name, entry)
        doc = f"coefficient of {key} in {spec.key}" if powers else f"constant part of {spec.key}"
        symbol = _coefficient_symbol(spec, powers)
        return self._parameter((spec.key, key), name, symbol, str(entry.get("unit", unit)), doc, entry)

    def _divisor(self, path: tuple[str, ...], name: str, entry: Mapping[str, object]) -> None:
        if name == _DIVISOR and entry["value"] == 0:
            self.faults.value((*path, "value"), f"law (4) divides by the {path[-2]} of `{path[-1]}`")

    def _monomial(self, spec: QuantitySpec, key: str) -> Powers | None:
        try:
            powers = parse_monomial(key, spec.variables)
        except MonomialError as error:
            advice = suggestion(error.word, spec.variables) if error.word else None
            self.faults.key((spec.key, key), str(error), advice)
            return None
        if sum(exponent for name, exponent in powers if name.startswith("eta_")) > 1:
            self.faults.key((spec.key, key), f"`{key}` is not affine in the flexible coordinates, as (27) needs it")
            return None
        return powers

    def _validity(self, specs: Iterable[VariableSpec]) -> None:
        content = self._section("validity")
        by_name = {spec.name: spec for spec in specs}
        for key in content:
            if key not in by_name:
                self.faults.key(("validity", key), f"unknown key `{key}`", suggestion(key, by_name))
        for name, spec in by_name.items():
            if name not in content:
                if content:
                    self.faults.key(("validity",), f"`{name}` ({spec.doc}) is missing in `[validity]`")
                continue
            self._box(name, spec, content[name])

    def _box(self, name: str, spec: VariableSpec, box: object) -> None:
        path = ("validity", name)
        if not isinstance(box, dict):
            self.faults.value(path, 'a range is a table like { min = -5.0, max = 5.0, unit = "deg" }')
            return
        for key in box:
            if key not in _BOX_KEYS:
                self.faults.key((*path, key), f"unknown key `{key}`", suggestion(key, _BOX_KEYS))
        missing = [key for key in _BOX_KEYS if key not in box]
        for key in missing:
            self.faults.key(path, f"`{key}` is missing")
        if missing:
            return
        low, high = self._number(box, (*path, "min")), self._number(box, (*path, "max"))
        if low is not None and high is not None and low >= high:
            self.faults.value((*path, "min"), "`min` must be below `max`")
        expected = units.converted(spec.unit, self.system)
        # An angle may be in degrees here; nothing else is converted.
        radians = re.sub(r"\bdeg\b", "rad", str(box["unit"]))
        self._unit(radians, (*path, "unit"), expected)


def _coefficient_symbol(spec: QuantitySpec, powers: Powers) -> str:
    latex = {"phi": r"\phi", "alpha": r"\alpha", "delta_e": r"\delta_e", "delta_c": r"\delta_c"}

    def factor(name: str, exponent: int) -> str:
        base = latex.get(name) or rf"\eta_{name.removeprefix('eta_')}"
        return base if exponent == 1 else f"{base}^{exponent}"

    above = " ".join(factor(n, k) for n, k in powers) or "0"
    return f"{spec.symbol}^{{{above}}}"
