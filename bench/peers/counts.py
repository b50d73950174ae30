"""Counts the instructions of CasADi functions."""

from __future__ import annotations

import casadi as ca

_ADDITIONS = {ca.OP_ADD, ca.OP_SUB}
_MULTIPLICATIONS = {ca.OP_MUL, ca.OP_SQ, ca.OP_TWICE}
_DIVISIONS = {ca.OP_DIV, ca.OP_INV}
_NOT_COMPUTED = {ca.OP_INPUT, ca.OP_OUTPUT, ca.OP_CONST, ca.OP_PARAMETER}


def count(function: ca.Function) -> dict[str, int]:
    """Operations by kind, as CasADi has them: no inputs, outputs and constants."""
    found = dict.fromkeys(("additions", "multiplications", "divisions", "sin", "cos", "exp", "negations", "other"), 0)
    names = {ca.OP_SIN: "sin", ca.OP_COS: "cos", ca.OP_EXP: "exp", ca.OP_NEG: "negations"}
    for index in range(function.n_instructions()):
        op = function.instruction_id(index)
        if op in _NOT_COMPUTED:
            continue
        if op in _ADDITIONS:
            found["additions"] += 1
        elif op in _MULTIPLICATIONS:
            found["multiplications"] += 1
        elif op in _DIVISIONS:
            found["divisions"] += 1
        else:
            found[names.get(op, "other")] += 1
    return found
