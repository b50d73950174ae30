"""The audit as JSON text: stable order, one equation field or difference a line."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

from . import checks, dimensions, latex
from .compare import MISPRINT, TRUNCATION, Comparison, Difference, compare, real_form
from .corrected import correct, in_shape_of
from .derived import Key, derive
from .printed import EQUATIONS, TABLE_2, Printed
from .terms import collect, expand

SCHEMA_VERSION = 1


def render(equations: tuple[Printed, ...] = EQUATIONS) -> str:
    """The whole audit as JSON text."""
    derived = derive(equations)
    printed = {e.key: e for e in equations}
    comparisons = {e.key: compare(e, derived[e.key]) for e in equations if e.role == "result"}
    real = {key: real_form(e.right)[0] for key, e in printed.items()}
    found = checks.run(printed, derived, comparisons, real)
    items = [_equation(e, comparisons.get(e.key)) for e in equations]
    rows = [_row(row) for row in dimensions.check_table(TABLE_2)]
    lists: dict[str, list[str]] = {
        "equations": [_object(item) for item in items],
        "table": [json.dumps(row, ensure_ascii=False) for row in rows],
        "checks": [json.dumps(_check(check), ensure_ascii=False) for check in found],
    }
    body = ",\n".join(
        f'  "{name}": [\n' + ",\n".join(f"    {i}" for i in lines) + "\n  ]" for name, lines in lists.items()
    )
    return f'{{\n  "schema_version": {SCHEMA_VERSION},\n{body}\n}}\n'


def _object(item: Mapping[str, object]) -> str:
    """An equation: a field a line, a difference a line."""
    fields = []
    for name, value in item.items():
        if isinstance(value, list) and value:
            inner = ",\n".join(f"        {json.dumps(v, ensure_ascii=False)}" for v in value)
            fields.append(f'"{name}": [\n{inner}\n      ]')
        else:
            fields.append(f'"{name}": {json.dumps(value, ensure_ascii=False)}')
    return "{\n      " + ",\n      ".join(fields) + "\n    }"


def _equation(printed: Printed, comparison: Comparison | None) -> dict[str, object]:
    checked = dimensions.check(printed)

    def written(text: str) -> str:
        # The derived and the corrected form are equal to their left-hand side, also where the printed one is not.
        return latex.equation(printed.left, text, printed.mode)

    relation = r"\approx" if printed.approximate else "="
    as_printed = latex.equation(printed.left, printed.right, printed.mode, relation)
    derived = corrected = None
    differences: list[Difference] = []
    if comparison is not None:
        differences = list(comparison.differences)
        same = not differences and not comparison.rewritten
        derived = as_printed if same else written(in_shape_of(printed, comparison.derived()))
        corrected = written(correct(printed, comparison)) if comparison.of(MISPRINT) else None
    return {
        "number": printed.number,
        "name": printed.name,
        "symbol": latex.expression(printed.left, printed.mode),
        "section": _section(printed.number),
        "verdict": _verdict(printed, comparison),
        "printed": as_printed,
        "derived": derived,
        "corrected": corrected,
        "notes": _notes(printed, comparison),
        "dimension": checked.dimension,
        "terms": checked.terms,
        "clashes": [{"term": dimensions.latex_of(c, printed.mode), "dimension": c.dimension} for c in checked.clashes],
        "differences": [_difference(d, printed, checked) for d in differences],
    }


def _section(number: str) -> str:
    digits = int(re.sub(r"\D", "", number))
    return "2" if digits <= 4 else "3" if digits <= 26 else "4"


def _verdict(printed: Printed, comparison: Comparison | None) -> str:
    if comparison is None:
        return printed.role
    if comparison.of(MISPRINT):
        return "misprinted"
    return "truncated" if comparison.of(TRUNCATION) else "as derived"


def _notes(printed: Printed, comparison: Comparison | None) -> list[str]:
    notes = []
    if comparison is not None and comparison.rewritten:
        argument = r"\omega_1 \sqrt{\zeta_1^2 - 1}\, t"
        notes.append(
            rf"for $\zeta_1 < 1$ the argument ${argument}$ is imaginary: $\cosh$ is $\cos$ and "
            r"$\sinh / \sqrt{\zeta_1^2 - 1}$ is $\sin / \sqrt{1 - \zeta_1^2}$ of its size, the derived real form"
        )
    terms = expand(printed.right)
    if len(terms) > 1 and not collect(terms):
        notes.append("as printed the terms cancel: the right-hand side is zero whatever the coefficients are")
    return notes


def _difference(difference: Difference, printed: Printed, checked: dimensions.Dimensions) -> dict[str, object]:
    clashing = [c.term for c in checked.clashes]
    return {
        "class": difference.of,
        "kind": difference.kind,
        "printed": None if difference.printed is None else latex.term(difference.printed, printed.mode),
        "derived": None if difference.derived is None else latex.term(difference.derived, printed.mode),
        "reason": difference.reason,
        "dimension_betrays": difference.printed in clashing,
    }


def _row(row: dimensions.TableRow) -> dict[str, object]:
    mode = row.printed.mode
    reasons = {
        "": "",
        "normalisation": "a length goes with mode shapes without dimension; the equations here take modes of unit mass",
        "unit missing": "no unit is printed, and as a pure number it would be in radians",
    }
    if row.swapped_with:
        reason = f"the printed unit is that of ${latex.name(row.swapped_with)}$, whose row has the unit of this one"
    else:
        reason = reasons[row.finding]
    return {
        "symbol": latex.name(row.printed.name, mode),
        "value": row.printed.value,
        "unit": row.printed.unit,
        "dimension": row.dimension,
        "unit_dimension": row.unit_dimension,
        "finding": row.finding,
        "reason": reason,
    }


def _check(check: checks.Check) -> dict[str, object]:
    return {
        "equation": check.equation,
        "statement": check.statement,
        "holds": check.holds,
        "left_over": check.left_over or None,
    }


def by_key(equations: tuple[Printed, ...] = EQUATIONS) -> dict[Key, Comparison]:
    """The comparison of every printed result, by number and name."""
    derived = derive(equations)
    return {e.key: compare(e, derived[e.key]) for e in equations if e.role == "result"}
