"""The intermediate representation: JSON whose lines are stable, one quantity or entry a line."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import version

from . import __version__, emit, units
from .expression import tree
from .function import Function, Output
from .model import Model
from .schema import Choice, Quantity, Rule, Variable
from .table import Table, TableParameter

SCHEMA_VERSION = 5


class _Line:
    """A value that is written on one line, whatever its depth."""

    def __init__(self, value: object) -> None:
        self.value = value


class _Text:
    """JSON text, as it stands."""

    def __init__(self, text: str) -> None:
        self.text = text


@dataclass(frozen=True)
class Part:
    """The text of a model in the IR, every unit in it, and all groups of its functions: what a process can hand on."""

    text: str
    units: frozenset[str]
    groups: frozenset[str]


def casadi_version() -> str:
    """The version of CasADi that derives."""
    return version("casadi")


def render(table: Table, models: Iterable[Model]) -> str:
    """The IR of a table and its models as JSON text."""
    return assemble(table, map(part, models))


def part(m: Model) -> Part:
    """What the IR says of a model, which loses what its table does not want emitted."""
    groups = emit.groups_of(m)
    emit.narrow(m, m.table.emitted)
    spelling = _spelling(m)
    return Part(_dump(_model(m, spelling), 2), frozenset(spelling.values()), groups)


def _spelling(m: Model) -> dict[str, str]:
    """How each unit is written: as the table, the vectors and the first quantity have it."""
    texts = [p.unit for p in m.table.parameters]
    texts += [m.unit(v.name) for basis in m.bases.values() for v in basis]
    texts += [q.unit for q in m.graph.quantities.values()]
    texts += [o.unit for f in m.functions for o in f.outputs if o.unit is not None]
    return units.spelled(texts)


def assemble(table: Table, parts: Iterable[Part]) -> str:
    """The IR of a table as JSON text, from the parts of its models."""
    parts = list(parts)
    document = {
        "schema_version": SCHEMA_VERSION,
        "provenance": {"table": table.name, "generator": __version__, "casadi": casadi_version()},
        "units": _units(table, parts),
        "choices": [_choice(c) for c in table.schema.choices],
        "joins": [_Line(list(join)) for join in table.joins],
        "sets": [{"name": s.name, "parameters": [_Line(_replacement(p)) for p in s.parameters]} for s in table.sets],
        "parameters": [
            _Line(_parameter(p) | {"kind": p.kind, "models": table.only_for(*p.path)}) for p in table.parameters
        ],
        "validity": [_Line(_interval(v, table)) for v in table.schema.validity],
        "fits": [_Line(_fit(q, table)) for q in table.schema.quantities],
        "rules": [_Line(_rule(r)) for r in table.schema.rules()],
        "models": [_Text(p.text) for p in parts],
    }
    return _dump(document, 0) + "\n"


def _parameter(p: TableParameter) -> dict[str, object]:
    return {
        "name": p.name,
        "path": list(p.path),
        "symbol": p.symbol,
        "unit": p.unit,
        "doc": p.doc,
        "source": p.source,
        "status": p.status,
        "uncertainty": p.uncertainty,
    }


def _interval(v: Variable, table: Table) -> dict[str, object]:
    unit = units.converted(v.unit, table.units)
    return {
        "name": v.name,
        "symbol": v.symbol,
        "unit": unit,
        "doc": v.doc,
        "models": table.only_for("validity", v.name),
    }


def _fit(q: Quantity, table: Table) -> dict[str, object]:
    """What the monomials of a fit may be, whether the table has them or not."""
    intervals = {v.name for v in table.schema.validity}
    return {
        "section": q.key,
        "unit": units.converted(q.unit, table.units),
        "doc": q.doc,
        "variables": [
            {
                "name": v.name,
                "unit": units.converted(v.unit, table.units),
                "doc": v.doc,
                "interval": v.interval if v.interval in intervals else None,
            }
            for v in q.depends_on
        ],
        "required": list(q.required),
        "affine": list(q.affine),
        "models": table.only_for(q.key, ""),
    }


def _replacement(p: TableParameter) -> dict[str, object]:
    whole = _parameter(p)
    return {key: whole[key] for key in ("name", "path", "source", "status", "uncertainty")}


def _rule(r: Rule) -> dict[str, object]:
    terms = [[_plain(factor), list(names)] for factor, names in r.terms]
    return {"name": r.name, "terms": terms, "must": r.must, "reason": r.reason}


def _choice(choice: Choice) -> dict[str, object]:
    keys = [switch.key for switch in choice.switches]
    options = [
        _Line({"name": o.name, "doc": o.doc, "values": dict(zip(keys, map(_plain, o.values), strict=True))})
        for o in choice.options
    ]
    return {"name": choice.name, "type": choice.type_name, "doc": choice.doc, "options": options}


def _units(table: Table, parts: Iterable[Part]) -> dict[str, object]:
    """Every unit of the document, with what it is in the other system."""
    other = units.other(table.units)
    fits = table.schema.quantities
    declared: list[Variable | Quantity] = [*table.schema.validity, *fits, *(v for q in fits for v in q.depends_on)]
    used = {p.unit for p in table.parameters} | {units.converted(it.unit, table.units) for it in declared}
    used = used.union(*(p.units for p in parts))
    factors = {unit: _Line([units.converted(unit, other), units.conversion(unit, other)]) for unit in sorted(used)}
    return {"system": table.units, "other": other, "factors": factors}


def _variable(v: Variable, unit: str, basis: str) -> dict[str, object]:
    interval = v.interval if basis in ("state", "input") else None
    return {"name": v.name, "symbol": v.symbol, "unit": unit, "doc": v.doc, "validity": interval}


def _model(m: Model, spelling: Mapping[str, str]) -> dict[str, object]:
    document = _document(m, spelling)
    if m.noise_structure is not None:
        document["noise"] = {
            "columns": [_Line({"name": name, "class": kind}) for name, kind in m.noise_structure.columns],
            "commuting": [_Line(list(pair)) for pair in m.noise_structure.commuting],
        }
    return document


def _document(m: Model, spelling: Mapping[str, str]) -> dict[str, object]:
    return {
        "name": m.name,
        "title": m.title,
        "equations": m.equations,
        "note": m.traits.note,
        "bases": {name: [_Line(_variable(v, m.unit(v.name), name)) for v in basis] for name, basis in m.bases.items()},
        "quantities": [
            _Line(
                {
                    "name": q.name,
                    "symbol": q.symbol,
                    "unit": spelling[q.unit],
                    "doc": q.doc,
                    "equation": q.equation,
                    "section": q.section,
                    "expr": _plain(tree(q.expr)),
                }
            )
            for q in m.graph.quantities.values()
        ],
        "functions": [_function(f, spelling) for f in m.functions],
    } | _traits(m)


def _traits(m: Model) -> dict[str, object]:
    traits = m.traits

    def value(name: str, number: float | None) -> object:
        """A number in the unit of a state or input, as the table has it."""
        if number is None:
            return None
        return _plain(number * units.conversion(m.variable(name).unit, m.table.units))

    return {
        "trim": {
            "given": [
                _Line(
                    {
                        "name": g.name,
                        "default": value(g.name, g.default),
                        "above": value(g.name, g.above),
                        "below": value(g.name, g.below),
                    }
                )
                for g in traits.trim.given
            ],
            "sought": [
                _Line({"name": s.name, "start": value(s.name, s.start), "scale": value(s.name, s.scale)})
                for s in traits.trim.sought
            ],
            "equations": [
                _Line({"name": e.name, "weight": _plain(e.weight), "like": e.like_names and list(e.like_names)})
                for e in traits.trim.equations
            ],
            "moving": list(traits.trim.moving),
            "shown": list(traits.trim.shown),
        },
        "modes": [
            _Line({"name": mode.name, "states": list(mode.states), "slowest": mode.slowest}) for mode in traits.modes
        ],
        "defaults": {"inputs": list(traits.inputs), "outputs": list(traits.outputs)},
        "deviations": _Line({name: value(name, size) for name, size in traits.deviations.items()}),
    }


def _function(f: Function, spelling: Mapping[str, str]) -> dict[str, object]:
    return {
        "name": f.name,
        "group": f.group,
        "doc": f.doc,
        "equation": f.equation,
        "outputs": [_output(o, spelling) for o in f.outputs],
        "compressed": f.compressed,
    }


def _output(o: Output, spelling: Mapping[str, str]) -> dict[str, object]:
    return {
        "name": o.name,
        "basis": list(o.basis),
        "unit": None if o.unit is None else spelling[o.unit],
        "symmetric": o.symmetric,
        "entries": [_Line({"at": list(e.at), "expr": _plain(tree(e.expr))}) for e in o.entries],
    }


def _plain(node: object) -> object:
    """Whole numbers without a fraction, so that the text is the same on every platform."""
    if isinstance(node, float) and node.is_integer():
        return int(node)
    if isinstance(node, list):
        return [_plain(child) for child in node]
    return node


def _dump(value: object, depth: int) -> str:
    inner, outer = "  " * (depth + 1), "  " * depth
    if isinstance(value, _Line):
        return json.dumps(value.value, ensure_ascii=False, allow_nan=False)
    if isinstance(value, _Text):
        return value.text
    if isinstance(value, dict):
        if not value:
            return "{}"
        items = [f"{inner}{json.dumps(k)}: {_dump(v, depth + 1)}" for k, v in value.items()]
        return "{\n" + ",\n".join(items) + f"\n{outer}}}"
    if isinstance(value, list):
        if not value:
            return "[]"
        if not isinstance(value[0], dict | list | _Line | _Text):
            return json.dumps(value, ensure_ascii=False)
        return "[\n" + ",\n".join(inner + _dump(v, depth + 1) for v in value) + f"\n{outer}]"
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
