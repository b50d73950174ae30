"""Dimensional analysis of the printed equations, term by term, with pint."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass

from pint.util import UnitsContainer

from .. import units
from . import latex, symbols
from .printed import Printed, PrintedValue
from .terms import Term, expand, parse

_NUMBER = UnitsContainer({})
_TIME = UnitsContainer({"[time]": 1.0})
_LETTERS = (("[mass]", "M"), ("[length]", "L"), ("[time]", "T"))


@dataclass(frozen=True)
class Clash:
    """A printed term whose dimension is not that of the left-hand side."""

    term: Term
    dimension: str


@dataclass(frozen=True)
class Dimensions:
    """The dimension of the left-hand side, how many terms were compared with it, and those that differ."""

    dimension: str
    terms: int
    clashes: tuple[Clash, ...]


@dataclass(frozen=True)
class TableRow:
    """A row of Table 2 and what its unit says."""

    printed: PrintedValue
    dimension: str
    unit_dimension: str
    finding: str  # empty where the unit fits
    swapped_with: str  # name of the symbol that the value belongs to, or empty


def of_term(term: Term) -> UnitsContainer:
    """The dimension of a term."""
    result = _NUMBER
    for name in term.above:
        result = result * _of_factor(name)
    for name in term.below:
        result = result / _of_factor(name)
    return result


def check(printed: Printed) -> Dimensions:
    """Compare every term of both sides with the first of the left-hand side."""
    first, *others = expand(printed.left)
    wanted = of_term(first)
    terms = [*others, *expand(printed.right)]
    clashes = tuple(Clash(t, text(of_term(t))) for t in terms if of_term(t) != wanted)
    return Dimensions(text(wanted), len(terms), clashes)


def check_table(rows: Sequence[PrintedValue]) -> list[TableRow]:
    """Compare the unit of every row with the dimension of its symbol; find the row that it would fit."""

    def of_unit(unit: str) -> UnitsContainer:
        return UnitsContainer(units.dimensions(unit))

    own = [of_unit(symbols.unit(row.name)) for row in rows]
    there = [of_unit(row.unit) for row in rows]
    clashing = [k for k, row in enumerate(rows) if own[k] != there[k]]
    found: list[TableRow] = []
    for k, row in enumerate(rows):
        partner = next((j for j in clashing if k in clashing and own[j] == there[k] and own[k] == there[j]), None)
        finding = "" if k not in clashing else "swapped" if partner is not None else "normalisation"
        if not finding and _lacks_angle(row):
            finding = "unit missing"
        swapped = rows[partner].name if partner is not None else ""
        found.append(TableRow(row, text(own[k]), text(there[k]), finding, swapped))
    return found


def _lacks_angle(row: PrintedValue) -> bool:
    try:
        units.factor(row.unit, symbols.unit(row.name))
    except units.UnitError:
        return True
    return False


def text(dimension: UnitsContainer) -> str:
    """The LaTeX of a dimension in mass, length and time."""
    parts = []
    for name, letter in _LETTERS:
        twice = round(2 * float(str(dict(dimension).get(name, 0.0))))
        if twice:
            exponent = str(twice // 2) if twice % 2 == 0 else f"{twice}/2"
            parts.append(rf"\mathsf{{{letter}}}" + (f"^{{{exponent}}}" if exponent != "1" else ""))
    return r"\,".join(parts) or "1"


def _of_factor(factor: str) -> UnitsContainer:
    return _of_node(parse(factor))


def _of_node(node: ast.expr) -> UnitsContainer:
    match node:
        case ast.Name(id=name):
            return UnitsContainer(units.dimensions(symbols.unit(name)))
        case ast.Call(func=ast.Name(id=function), args=[inner]):
            return _of_call(function, inner)
    return _of_sum(node)


def _of_call(function: str, inner: ast.expr) -> UnitsContainer:
    argument = _of_sum(inner)
    if function in ("integral", "inverse_laplace", "sqrt"):
        over_time: UnitsContainer = argument * _TIME if function == "integral" else argument / _TIME
        root: UnitsContainer = argument**0.5
        return root if function == "sqrt" else over_time
    if function in ("sin", "cos", "sinh", "cosh", "exp"):
        if argument != _NUMBER:
            raise units.UnitError(f"{function} of a quantity with dimensions: {ast.unparse(inner)}")
        return _NUMBER
    if argument != _TIME:
        raise units.UnitError(f"{function} is a function of time, not of {ast.unparse(inner)}")
    return UnitsContainer(units.dimensions(symbols.unit(function)))


def _of_sum(node: ast.expr) -> UnitsContainer:
    """The dimension that all terms of a sum share."""
    first, *others = [of_term(term) for term in expand(ast.unparse(node))]
    if any(other != first for other in others):
        raise units.UnitError(f"a sum of unlike dimensions: {ast.unparse(node)}")
    return first


def latex_of(clash: Clash, mode: str) -> str:
    """The LaTeX of the term that clashes."""
    return latex.term(clash.term, mode)
