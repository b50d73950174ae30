"""Checks of the derivation and of the printed solutions: by differentiation, at t = 0, and by adding up the split."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import sympy

from . import latex
from .compare import Comparison, residual
from .derived import CONTROL, ROWS, Derived, Expr, Key, read, substituted, symbol
from .printed import Printed
from .terms import Term, collect, compact, expand, of_monomial


@dataclass(frozen=True)
class Check:
    """A statement about an equation, whether it holds, and in LaTeX what is left over where it does not."""

    equation: str
    statement: str
    holds: bool
    left_over: str = ""


def run(
    printed: Mapping[Key, Printed], derived: Derived, comparisons: Mapping[Key, Comparison], real: Mapping[Key, str]
) -> list[Check]:
    """All checks; `real` holds the printed right-hand sides in the real form for ζ < 1."""
    rights = {key: e.right for key, e in printed.items()}
    derived_texts = {key: " + ".join(f"({part.text})" for part in parts) for key, parts in derived.items()}
    complete = all(not residual(c, derived[key]) for key, c in comparisons.items())
    return [
        Check("all", "the classed differences account for the whole of derived less printed", complete),
        _exponential("the derived", derived_texts),
        _exponential("the printed", real),
        *_solution("(15)", "eta_d", "n_d", "the derived", derived_texts[("(15)", "eta_d")], derived_texts),
        *_solution("(15)", "eta_d", "n_d", "the printed", rights[("(15)", "eta_d")], derived_texts),
        *_solution("(19)", "eta_n", "sigma*c", "the derived", derived_texts[("(19)", "eta_n")], derived_texts),
        *_solution("(19)", "eta_n", "sigma*c", "the printed", rights[("(19)", "eta_n")], derived_texts),
        _first_order(rights[("(21)", "chi")]),
        *_split(rights, derived_texts),
    ]


def vanishes(expr: Expr) -> bool:
    """Whether an expression in ζ, √(1 − ζ²), e^{−ζωt}, cos ω_d t and sin ω_d t is zero.

    Written over one power of the root, it is a polynomial once the root's square is 1 − ζ².
    """
    root = "sqrt(1 - zeta**2)"
    terms = expand(str(expr))
    lowest = max((-t.powers.get(root, 0) for t in terms), default=0)
    raised: list[Term] = []
    for term in terms:
        power = term.powers.get(root, 0) + max(lowest, 0)
        rest = of_monomial(term.number, tuple(p for p in term.monomial if p[0] != root))
        for factor in expand(f"(1 - zeta**2)**{power // 2}"):
            raised.append(rest.times(factor).times(Term(Fraction(1), (root,) * (power % 2))))
    return not collect(raised)


def _exponential(which: str, texts: Mapping[Key, str]) -> Check:
    """Φ′ = AΦ with Φ(0) = I, for Φ of (13) and (14)."""
    t = symbol("t")
    a = sympy.Matrix([[0, 1], [read("-omega**2"), read("-2*zeta*omega")]])
    elements = [[read(texts["(13)", f"e_{i}{j}"]) for j in (1, 2)] for i in (1, 2)]
    matrix = sympy.Matrix(elements) * read("exp(-zeta*omega*t)")
    left_over = matrix.diff(t) - a * matrix
    holds = all(vanishes(e) for e in left_over) and matrix.subs(t, 0) == sympy.eye(2)
    what = (
        r"$e^{\mathbf A t}$ of (13) and (14) has the derivative $\mathbf A e^{\mathbf A t}$ and starts at $\mathbf I$"
    )
    return Check("(14)", f"{which} {what}", holds)


def _solution(number: str, name: str, force: str, which: str, text: str, texts: Mapping[Key, str]) -> list[Check]:
    """Whether a solution satisfies (5) and its initial values."""
    t = symbol("t")
    elements = {symbol(f"e_{ij}"): read(texts["(13)", f"e_{ij}"]) for ij in ("11", "12")}
    eta = read(text).subs(elements)
    rate = eta.diff(t)
    equation = rate.diff(t) + read("2*zeta*omega") * rate + read("omega**2") * eta - read(force)
    start = sympy.expand(eta.subs(t, 0) - symbol(f"{name}_0"))
    slope = sympy.expand(rate.subs(t, 0) - symbol(f"{name}_dot_0"))
    solution = f"{which} {number}"
    found = [Check(number, f"{solution} satisfies (5)", vanishes(equation))]
    for what, left_over in (("value", start), ("rate", slope)):
        holds = vanishes(left_over)
        rest = "" if holds else latex.expression(compact(expand(str(left_over))), "1")
        found.append(Check(number, f"{solution} has the initial {what} that it is given", holds, rest))
    return found


def _first_order(text: str) -> Check:
    t = symbol("t")
    chi = read(text)
    holds = sympy.expand(chi.diff(t) + symbol("a") * chi - read("b*c")) == 0 and chi.subs(t, 0) == 0
    return Check("(21)", "the printed (21) satisfies (20) and starts at zero", bool(holds))


def _split(rights: Mapping[Key, str], texts: Mapping[Key, str]) -> list[Check]:
    """The split adds up to the rows of (1); the rows of γ and α are opposite but for Q."""
    found: list[Check] = []
    by_name = {name: text for (_, name), text in texts.items()}

    def whole(name: str, row: str) -> str:
        text = by_name[f"{name}_{row}"]
        for inner in (f"f_{row}_eta", f"h_{row}_i"):
            text = text.replace(inner, f"({by_name[inner]})")
        return f"({text})"

    for row, (number, name) in ROWS.items():
        total = f"{whole('f', row)} + {whole('g', row)}*{CONTROL[row]} + {whole('h', row)}*chi"
        holds = not collect(expand(f"{total} - ({substituted(name, rights)})"))
        symbol_of = latex.name(name)
        statement = rf"the derived $f + g u + \mathbf h \boldsymbol\chi$ is the whole of ${symbol_of}$ in (1)"
        found.append(Check(number, statement, holds))
    for name in ("h", "H"):
        opposite = not collect(expand(f"{whole(name, 'gamma')} + {whole(name, 'alpha')}"))
        statement = rf"derived: ${name}_\alpha = -{name}_\gamma$, as $\dot\gamma + \dot\alpha = Q$ asks"
        found.append(Check("(32)", statement, opposite))
    return found
