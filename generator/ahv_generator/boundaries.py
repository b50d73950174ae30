"""Where equations of motion have a kink: the functions by which choices, minima, maxima and absolute values switch."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping

import casadi as ca

from .derivation import Derivation
from .expression import dimensions_of, tree
from .function import Entry, Output
from .schema import Variable

_OF_TWO = (ca.OP_LT, ca.OP_LE, ca.OP_FMIN, ca.OP_FMAX)
_OF_ONE = (ca.OP_FABS, ca.OP_SIGN)


def add_boundaries(m: Derivation, rates: Mapping[str, ca.SX]) -> None:
    """The function `boundaries`, if there are any: each is 0 where the drift goes over to another formula."""
    found: dict[str, tuple[str, str, str, ca.SX]] = {}
    for owner, what, expr in _parts(m, rates):
        for left, right in _compared(expr):
            moves = any(not leaf.startswith("p.") for leaf in m.graph.leaves_in(left - right))
            # The same comparison the other way round is the same boundary.
            key = json.dumps(sorted([json.dumps(tree(left)), json.dumps(tree(right))]))
            if moves:
                found.setdefault(key, (owner, what, _unit(m, left, right), left - right))
    if not found:
        return
    owners = [owner for owner, *_ in found.values()]
    variables, entries = [], []
    for position, (owner, what, unit, expr) in enumerate(found.values()):
        several = owners.count(owner) > 1
        number = f"_{owners[: position + 1].count(owner)}" if several else ""
        name = f"{owner}_boundary{number}"
        variables.append(Variable(name, "", unit, f"0 where {what} goes over to another formula"))
        entries.append(Entry((name,), expr))
    m.bases["boundary"] = tuple(variables)
    doc = "Functions that are 0 where the drift has a kink or jumps, for events of adaptive steppers"
    m.add("boundaries", "boundaries", doc, "", [Output("", ("boundary",), tuple(entries))])


def _unit(m: Derivation, *sides: ca.SX) -> str:
    """The unit in which two sides are compared: that of a name on one of them, which may be an angle's."""
    plain = [side.dep(0) if not side.is_constant() and side.op() == ca.OP_NEG else side for side in sides]
    named = [side.name() for side in plain if side.is_symbolic()]
    return m.graph.units[named[0]] if named else m.graph.unit_of(dimensions_of(sides[0] - sides[1], m.graph.units))


def _parts(m: Derivation, rates: Mapping[str, ca.SX]) -> Iterator[tuple[str, str, ca.SX]]:
    """The quantities that the rates depend on, in their order, and the rates: name, what it is, and expression."""
    needed: set[str] = set()
    waiting = [symbol.name() for rate in rates.values() for symbol in ca.symvar(rate)]
    while waiting:
        name = waiting.pop()
        if name in m.graph.quantities and name not in needed:
            needed.add(name)
            waiting += [symbol.name() for symbol in ca.symvar(m.graph.quantities[name].expr)]
    yield from ((name, name, quantity.expr) for name, quantity in m.graph.quantities.items() if name in needed)
    yield from ((f"{name}_rate", f"the rate of {name}", rate) for name, rate in rates.items())


def _compared(expr: ca.SX) -> Iterator[tuple[ca.SX, ca.SX]]:
    """The two sides of each comparison in an expression, first to last."""
    if expr.is_constant() or expr.is_symbolic():
        return
    parts = [expr.dep(i) for i in range(expr.n_dep())]
    for part in parts:
        yield from _compared(part)
    if expr.op() in _OF_TWO:
        yield parts[0], parts[1]
    elif expr.op() in _OF_ONE:
        yield parts[0], ca.SX(0)
