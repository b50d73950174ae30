"""CasADi functions as Python source: a statement an instruction, for scalars and for arrays alike."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca

_BINARY = {ca.OP_ADD: "+", ca.OP_SUB: "-", ca.OP_MUL: "*", ca.OP_DIV: "/", ca.OP_POW: "**", ca.OP_CONSTPOW: "**"}
_UNARY = {
    ca.OP_ASSIGN: "{0}",
    ca.OP_NEG: "-{0}",
    ca.OP_SIN: "lib.sin({0})",
    ca.OP_COS: "lib.cos({0})",
    ca.OP_EXP: "lib.exp({0})",
    ca.OP_SQRT: "lib.sqrt({0})",
    ca.OP_SQ: "{0} * {0}",
    ca.OP_TWICE: "{0} + {0}",
    ca.OP_INV: "1.0 / {0}",
}


def _computed(function: ca.Function, index: int) -> str:
    """What an instruction computes."""
    op = function.instruction_id(index)
    inputs = function.instruction_input(index)
    if op == ca.OP_CONST:
        return repr(function.instruction_constant(index))
    if op == ca.OP_INPUT:
        return f"a{inputs[0]}[{inputs[1]}]"
    arguments = [f"w{argument}" for argument in inputs]
    return f" {_BINARY[op]} ".join(arguments) if op in _BINARY else _UNARY[op].format(*arguments)


def source(function: ca.Function, *, stores: bool) -> str:
    """The function `f`, which takes the arguments of CasADi's.

    With `stores` it also takes arrays, into which it stores the outputs; without it gives lists of their elements.
    """
    names = [f"a{index}" for index in range(function.n_in())]
    results = [f"r{index}" for index in range(function.n_out())]
    lines = [f"def f({', '.join(names + results if stores else names)}):"]
    if not stores:
        lines += [f"    {name} = [None] * {function.nnz_out(index)}" for index, name in enumerate(results)]
    for index in range(function.n_instructions()):
        outputs = function.instruction_output(index)
        if function.instruction_id(index) == ca.OP_OUTPUT:
            (value,) = function.instruction_input(index)
            lines.append(f"    r{outputs[0]}[{outputs[1]}] = w{value}")
        else:
            lines.append(f"    w{outputs[0]} = {_computed(function, index)}")
    if not stores:
        lines.append(f"    return {', '.join(results)}")
    return "\n".join(lines) + "\n"


def compiled(function: ca.Function, lib: Any, *, stores: bool) -> Callable[..., Any]:  # noqa: ANN401 (a module)
    """The printed function, with elementary functions of the module `lib`."""
    names: dict[str, Any] = {"lib": lib}
    exec(compile(source(function, stores=stores), function.name(), "exec"), names)
    found: Callable[..., Any] = names["f"]
    return found
