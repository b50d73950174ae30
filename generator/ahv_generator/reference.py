"""CasADi's own evaluation of every function of a model, at points that the oracle drew."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import casadi as ca

from .ir import casadi_version
from .model import Model

_COLUMNS = {"x": "state", "u": "input", "w": "noise", "p": "parameter", "t": "argument"}


def expanded(model: Model, *, together: bool = False) -> ca.Function:
    """All outputs of a model as one CasADi function of its leaves; outputs that are structurally zero are left out.

    `together` has the vector of outputs besides, whose entries other functions may have, too.
    """
    values: dict[str, ca.SX] = {}
    for name, symbol in model.graph.symbols.items():
        quantity = model.graph.quantities.get(name)
        values[name] = symbol if quantity is None else _substituted(quantity.expr, model, values)
    leaves = [name for name in model.graph.symbols if name not in model.graph.quantities]
    results = [_substituted(expr, model, values) for _, expr in outputs(model, together=together)]
    return ca.Function(
        model.name,
        [model.graph.symbols[name] for name in leaves],
        results,
        [name.replace(".", "_") for name in leaves],
        [f"y{i}" for i in range(len(results))],
    )


def labels(model: Model, *, together: bool = False) -> list[str]:
    """Names of the outputs of `expanded`: function, output and entry, joined by dots."""
    return [label for label, _ in outputs(model, together=together)]


def columns(model: Model) -> list[str]:
    """Names of the inputs of `expanded`, as the oracle writes them."""
    leaves = (name for name in model.graph.symbols if name not in model.graph.quantities)
    return [f"{_COLUMNS[prefix]}.{rest}" for prefix, rest in (name.split(".", 1) for name in leaves)]


def write(model: Model, points: Path, out: Path) -> None:
    """Evaluate the model at the points of an oracle file and write one line of values a point."""
    function, names = expanded(model), labels(model)
    with points.open(encoding="utf-8") as lines:
        next(lines)
        header = next(lines).split("|")[0].split(",")
        order = [header.index(column) for column in columns(model)]
        rows = [[float(text) for text in line.split("|")[0].split(",")] for line in lines]
    texts = [f"# CasADi {casadi_version()}, model {model.name}, points of {points.name}", ",".join(names)]
    for row in rows:
        found = function.call([ca.DM(row[k]) for k in order])
        texts.append(",".join(repr(float(value)) for value in found))
    partial = out.with_name(out.name + ".partial")
    partial.write_text("\n".join(texts) + "\n", encoding="utf-8", newline="\n")
    os.replace(partial, out)


def _substituted(expr: ca.SX, model: Model, values: dict[str, ca.SX]) -> ca.SX:
    inner = [s for s in ca.symvar(expr) if s.name() in model.graph.quantities]
    if not inner:
        return expr
    return ca.substitute(expr, ca.vertcat(*inner), ca.vertcat(*(values[s.name()] for s in inner)))


def outputs(model: Model, *, together: bool) -> Iterator[tuple[str, ca.SX]]:
    """The outputs of `expanded` with their names."""
    for function in model.functions:
        if function.name.startswith("drift_and_") or (function.name == "outputs" and not together):
            continue  # the same expressions once more
        for output in function.outputs:
            for entry in output.entries:
                parts = [function.name, *([output.name] if len(function.outputs) > 1 else [])]
                if output.basis == ("mode",):
                    parts.append(str(model.names("mode").index(entry.at[0])))
                else:
                    parts += entry.at
                yield ".".join(parts), entry.expr
