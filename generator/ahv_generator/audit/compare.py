"""Printed terms paired with derived ones; every difference classed by rule as misprint or truncation."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import sympy

from . import latex, symbols
from .derived import Part, read
from .printed import Printed
from .terms import Monomial, Term, collect, expand, of_monomial, product

MISPRINT, TRUNCATION = "misprint", "truncation"


@dataclass(frozen=True)
class Difference:
    """One difference: the printed term, the derived one it stands for, or the derived one that is not printed."""

    of: str  # `misprint` or `truncation`
    kind: str
    printed: Term | None
    derived: Term | None
    reason: str


@dataclass(frozen=True)
class Comparison:
    """The printed terms in order, each with the derived one that it stands for; and how they differ."""

    matched: tuple[tuple[Term, Term | None], ...]
    differences: tuple[Difference, ...]
    rewritten: bool

    def of(self, which: str) -> list[Difference]:
        """The differences of one class."""
        return [d for d in self.differences if d.of == which]

    def derived(self) -> list[Term]:
        """The derived terms: first those that are printed, then the others."""
        unprinted = [d.derived for d in self.differences if d.printed is None and d.derived is not None]
        return [derived for _, derived in self.matched if derived is not None] + unprinted

    def corrected(self) -> list[Term]:
        """The printed terms with the misprints put right."""
        truncated = {id(d.printed) for d in self.of(TRUNCATION) if d.printed is not None}
        kept = [printed if id(printed) in truncated else derived for printed, derived in self.matched]
        missing = [d.derived for d in self.of(MISPRINT) if d.printed is None]
        return [term for term in kept + missing if term is not None]


@dataclass(frozen=True)
class _Derived:
    term: Term
    origin: str


def compare(printed: Printed, parts: Sequence[Part]) -> Comparison:
    """Compare a printed equation with its derived right-hand side."""
    right, rewritten = real_form(printed.right)
    terms = expand(right)
    left_over = [
        _Derived(of_monomial(number, monomial), part.origin)
        for part in parts
        for monomial, number in collect(expand(part.text)).items()
    ]
    pairs: dict[int, _Derived] = {}
    for rule in (_equal, _same_monomial, _same_coefficients, _same_fits):
        for k, term in enumerate(terms):
            if k not in pairs and (found := rule(term, left_over)) is not None:
                pairs[k] = found
                left_over.remove(found)
    differences: list[Difference] = []
    matched: list[tuple[Term, Term | None]] = []
    for k, term in enumerate(terms):
        partner = pairs[k].term if k in pairs else None
        difference = None if partner is not None and _agree(term, partner) else _unlike(term, partner, terms, printed)
        if difference is not None:
            differences.append(difference)
        matched.append((term, partner))
    left_over.sort(key=lambda d: (_ORIGINS.index(d.origin), _order(d.term), product(d.term)))
    differences += [_not_printed(d, printed) for d in left_over]
    return Comparison(tuple(matched), tuple(differences), rewritten)


_ORIGINS = ("direct", "trigonometric", "force", "noise")


def real_form(text: str) -> tuple[str, bool]:
    """The real form for ζ < 1: cosh and sinh of an imaginary argument are cos and sin."""
    if "cosh(" not in text and "sinh(" not in text:
        return text, False
    root, real = read("sqrt(zeta**2 - 1)"), read("sqrt(1 - zeta**2)")
    return str(read(text).subs(root, sympy.I * real).expand()), True


# ---------------------------------------------------------------- pairing


def _agree(printed: Term, derived: Term) -> bool:
    whole = not any(symbols.curve_fit(name) for name in printed.shared)
    return whole and printed.monomial == derived.monomial and printed.number == derived.number


def _equal(printed: Term, candidates: list[_Derived]) -> _Derived | None:
    return next((c for c in candidates if _agree(printed, c.term)), None)


def _same_monomial(printed: Term, candidates: list[_Derived]) -> _Derived | None:
    if any(symbols.curve_fit(name) for name in printed.shared):
        return None
    return next((c for c in candidates if c.term.monomial == printed.monomial), None)


def _same_coefficients(printed: Term, candidates: list[_Derived]) -> _Derived | None:
    """The nearest derived term with the same curve-fit coefficients, or near enough where there are none."""
    if any(symbols.curve_fit(name) for name in printed.shared):
        return None
    wanted = _coefficients(printed)
    near = [c for c in candidates if _coefficients(c.term) == wanted and (wanted or _distance(printed, c.term) <= 3)]
    return min(near, key=lambda c: (_distance(printed, c.term), product(c.term)), default=None)


def _same_fits(printed: Term, candidates: list[_Derived]) -> _Derived | None:
    """The derived term that has coefficients of the same curve fits in the same places."""
    places = _fits(printed)
    if not any(places):
        return None
    near = [c for c in candidates if _fits(c.term) == places and not _others(printed, c.term)]
    return min(near, key=lambda c: product(c.term), default=None)


def _coefficients(term: Term) -> Monomial:
    return tuple((name, power) for name, power in term.monomial if symbols.curve_fit(name))


def _fits(term: Term) -> tuple[list[str], list[str]]:
    def of(names: tuple[str, ...]) -> list[str]:
        return sorted(fit for name in names if (fit := symbols.curve_fit(name)))

    return of(term.above), of(term.below)


def _ratio(printed: Term, derived: Term) -> Term:
    """What the printed term must be multiplied by."""
    found = derived.times(printed.inverse())
    return of_monomial(found.number, found.monomial)


def _distance(printed: Term, derived: Term) -> int:
    ratio = _ratio(printed, derived)
    return sum(abs(power) for _, power in ratio.monomial) + (ratio.number != 1)


def _others(printed: Term, derived: Term) -> bool:
    """Whether the two differ in more than coefficients and sign."""
    ratio = _ratio(printed, derived)
    return abs(ratio.number) != 1 or any(not symbols.curve_fit(name) for name, _ in ratio.monomial)


# ---------------------------------------------------------------- classing

_PARAMETERS = {"dynamic_pressure", "s", "m", "velocity", "i_yy", "c_bar", "z_t", "omega", "zeta", "g"}


def _unlike(term: Term, partner: Term | None, terms: list[Term], printed: Printed) -> Difference | None:
    """The difference of a printed term from the derived one that it stands for."""
    mode = printed.mode
    if partner is None:
        return Difference(MISPRINT, "surplus term", term, None, "nothing derived has this term")
    if any(symbols.curve_fit(name) for name in term.shared):
        shared = ", ".join(f"${latex.name(name, mode)}$" for name in sorted(term.shared))
        reason = f"{shared} stands above and below and cancels: a superscript is repeated where another belongs"
        return Difference(MISPRINT, "repeated superscript", term, partner, reason)
    ratio = _ratio(term, partner)
    if _leading(ratio, terms):
        reason = f"${latex.term(ratio, mode)} \\to 1$, its value to leading order"
        return Difference(TRUNCATION, "leading order", term, partner, reason)
    return Difference(MISPRINT, _kind(ratio), term, partner, _reason(ratio, mode))


def _leading(ratio: Term, terms: list[Term]) -> bool:
    """Whether a cosine was taken as 1 throughout the equation; where another term keeps it, it was forgotten."""
    if ratio.number != 1 or len(ratio.monomial) != 1:
        return False
    (name, power) = ratio.monomial[0]
    return power == 1 and name.startswith("cos(") and not any(name in other.above for other in terms)


def _kind(ratio: Term) -> str:
    names = {name for name, _ in ratio.monomial}
    if not names:
        return "sign" if ratio.number == -1 else "factor"
    if any(symbols.curve_fit(name) for name in names):
        return "coefficient"
    kind = "prefactor" if names <= _PARAMETERS else "factor"
    return f"sign and {kind}" if ratio.number < 0 else kind


def _reason(ratio: Term, mode: str) -> str:
    if not ratio.monomial and ratio.number == -1:
        return "the sign is the opposite of the derived one"
    size = Term(abs(ratio.number), ratio.above, ratio.below)
    minus = " and the sign is the opposite" if ratio.number < 0 else ""
    if not size.below:
        return f"the factor ${latex.term(size, mode)}$ is missing{minus}"
    if not size.above and size.number == 1:
        return f"the factor ${latex.term(size.inverse(), mode)}$ is one too many{minus}"
    return f"the printed term must be multiplied by ${latex.term(size, mode)}${minus}"


_HIGH_ORDER = {"f": 2, "g": 2, "H": 1}
_SMALL = ("alpha", "delta_e", "sin(alpha)")


def _order(term: Term) -> int:
    """The order of a term in the small quantities α and δ_e; sin α counts once."""
    return sum(term.powers.get(name, 0) for name in _SMALL)


def _not_printed(found: _Derived, printed: Printed) -> Difference:
    """The difference that a derived term makes that is not printed."""
    term, order = found.term, _order(found.term)
    lowest = (
        _HIGH_ORDER.get(printed.name.partition("_")[0]) if re.match(r"[fgH]_(V|gamma|alpha|Q)$", printed.name) else None
    )

    def truncation(kind: str, reason: str) -> Difference:
        return Difference(TRUNCATION, kind, None, term, reason)

    if lowest is not None and found.origin == "direct" and order >= lowest:
        small = f"order {order} in $\\alpha$, $\\sin\\alpha$, $\\delta_e$"
        return truncation("high order", f"{small}; the paper omits high-order and cross terms")
    if found.origin == "trigonometric":
        reason = "from differentiating $\\sin\\alpha$ or $\\cos\\alpha$, which section 4 treats as constant"
        return truncation("constant sin and cos", reason)
    if found.origin == "force":
        return truncation("constant force", "from differentiating $N_i$, which the paper treats as constant")
    if found.origin == "noise":
        return truncation("noise column", _column_reason(term))
    if any(name.startswith("exp(") for name in term.powers):
        return truncation("transient", "decays exponentially; (25) keeps the steady value that (15) converges to")
    reason = "nothing printed stands for it, and no omission that the paper states covers it"
    if lowest is not None:
        reason += f": it is of order {order} in $\\alpha$, $\\sin\\alpha$, $\\delta_e$"
    return Difference(MISPRINT, "missing term", None, term, reason)


def _column_reason(term: Term) -> str:
    noise = next(name for name in term.powers if name.startswith("w_"))
    return (
        f"part of the column of ${latex.name(noise)}$ in $\\mathbf G$, which the paper keeps in the row of $h$ alone "
        "without saying so"
    )


def residual(comparison: Comparison, parts: Sequence[Part]) -> dict[Monomial, Fraction]:
    """What the classed differences leave between printed and derived: nothing, or the audit is at fault."""
    terms = [printed for printed, _ in comparison.matched]
    for difference in comparison.differences:
        terms += [difference.printed.negative()] if difference.printed is not None else []
        terms += [difference.derived] if difference.derived is not None else []
    derived = [term.negative() for part in parts for term in expand(part.text)]
    return collect(terms + derived)
