"""The printed equations with exactly their misprints put right; what is truncated stays truncated."""

from __future__ import annotations

import functools
import re

from .compare import MISPRINT, Comparison, compare
from .derived import derive
from .printed import EQUATIONS, Printed
from .terms import Term, compact, summed

_FUNCTION = re.compile(r"[fghH]_(?:V|gamma|alpha|Q)(?:_eta|_i)?")


def correct(printed: Printed, comparison: Comparison) -> str:
    """The right-hand side as it should read; the printed text itself where nothing is misprinted."""
    if not comparison.of(MISPRINT):
        return printed.right
    return in_shape_of(printed, comparison.corrected())


def in_shape_of(printed: Printed, terms: list[Term]) -> str:
    """Terms as text with brackets; a sum over the modes where the printed equation has one."""
    return summed(terms) if "modes(" in printed.right else compact(terms)


@functools.cache
def corrected_expressions() -> dict[str, str]:
    """The functions of (28)-(35) by name, as Python text over the names of parameters and states.

    `h_*` and `f_*_eta` are those of one mode (`c_t_eta`, `n`, `omega` being of that mode); `f_*` names `f_*_eta`,
    the sum over the modes.
    """
    derived = derive(EQUATIONS)
    found: dict[str, str] = {}
    for printed in EQUATIONS:
        if _FUNCTION.fullmatch(printed.name) and printed.role == "result":
            text = correct(printed, compare(printed, derived[printed.key]))
            found[printed.name] = text.replace("modes(", "(")  # one mode of the sum
    elements = {name: found.pop(name) for name in list(found) if name.endswith("_i")}
    for name, element in elements.items():
        whole = name.removesuffix("_i")
        found[whole] = found[whole].replace(name, f"({element})")
    return found
