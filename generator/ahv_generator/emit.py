"""`[emit]` of a table: the groups of functions that are emitted."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import casadi as ca

from .derivation import Derivation
from .diagnostics import Faults, suggestion
from .entries import Entries

SECTION, KEY = "emit", "functions"
PATH = (SECTION, KEY)

# What every program calls: simulation, linearisation, dispersion, noise. A model without noise has not all of them.
NEEDED = ("drift", "jacobians", "parameter_jacobian", "outputs", "diffusion", "noise_derivatives")


def read(entries: Entries) -> tuple[str, ...] | None:
    """The groups that a table lists; None if it has no such section, which means all."""
    if SECTION not in entries.document:
        return None
    section = entries.section(SECTION)
    entries.only((SECTION,), section, (KEY,))
    groups = section.get(KEY)
    if not isinstance(groups, list) or not all(isinstance(group, str) for group in groups):
        entries.faults.value("shape", PATH, f'`{KEY}` lists groups of functions, like ["{NEEDED[0]}", "{NEEDED[1]}"]')
        return None
    return tuple(groups)


def groups_of(model: Derivation) -> frozenset[str]:
    """The groups of a model's functions."""
    return frozenset(function.group for function in model.functions)


def check(chosen: tuple[str, ...] | None, groups: frozenset[str], faults: Faults) -> None:
    """Faults of the groups that a table lists, where its models have `groups`."""
    if chosen is None:
        return
    for group in chosen:
        if group not in groups:
            message = f"`{group}` is not a group of functions of these models"
            faults.value("unknown-group", PATH, message, suggestion(group, sorted(groups)))
    needed = [group for group in NEEDED if group in groups]
    missing = [group for group in needed if group not in chosen]
    if missing:
        message = f"`{KEY}` leaves out `{'`, `'.join(missing)}`, which every program needs"
        others = sorted(groups - set(needed))
        advice = f"always there: {', '.join(needed)}; what may be left out: {', '.join(others) or 'nothing'}"
        faults.value("needed-group", PATH, message, advice)


def narrow(model: Derivation, chosen: tuple[str, ...] | None) -> None:
    """Leave out of a model the functions that a table does not list, and the quantities that only they use."""
    if chosen is None:
        return
    model.functions = [function for function in model.functions if function.group in chosen]
    quantities = model.graph.quantities
    roots = (entry.expr for function in model.functions for output in function.outputs for entry in output.entries)
    used: set[str] = set()
    waiting = [name for root in roots for name in _names(root, quantities)]
    while waiting:
        name = waiting.pop()
        if name not in used:
            used.add(name)
            waiting += _names(quantities[name].expr, quantities)
    for name in [name for name in quantities if name not in used]:
        del quantities[name]


def _names(expr: ca.SX, quantities: Mapping[str, object]) -> Iterable[str]:
    return [symbol.name() for symbol in ca.symvar(expr) if symbol.name() in quantities]
