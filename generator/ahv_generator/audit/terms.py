"""Expressions as lists of terms, each a product of names and of calls like `sin(alpha)`, read from Python text.

Nothing cancels here by itself: a term whose numerator and denominator share a factor still shows it, so that an
equation is judged as it is printed.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction

Monomial = tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class Term:
    """A product: a number, factors above and factors below, each in order."""

    number: Fraction
    above: tuple[str, ...] = ()
    below: tuple[str, ...] = ()

    @property
    def monomial(self) -> Monomial:
        """Factors with their exponents, after cancelling."""
        powers = Counter(self.above)
        powers.subtract(self.below)
        return tuple(sorted((name, power) for name, power in powers.items() if power))

    @property
    def powers(self) -> dict[str, int]:
        """The monomial as a mapping."""
        return dict(self.monomial)

    @property
    def shared(self) -> set[str]:
        """Factors that stand above and below."""
        return set(self.above) & set(self.below)

    def times(self, other: Term) -> Term:
        """The product."""
        return Term(self.number * other.number, self.above + other.above, self.below + other.below)

    def negative(self) -> Term:
        """The term with the other sign."""
        return Term(-self.number, self.above, self.below)

    def inverse(self) -> Term:
        """The reciprocal."""
        return Term(1 / self.number, self.below, self.above)


def of_monomial(number: Fraction, monomial: Monomial) -> Term:
    """The term of a number and a monomial."""
    above = tuple(name for name, power in monomial for _ in range(power))
    below = tuple(name for name, power in monomial for _ in range(-power))
    return Term(number, above, below)


def parse(text: str) -> ast.expr:
    """The syntax tree of an expression."""
    return ast.parse(text, mode="eval").body


def expand(text: str) -> list[Term]:
    """The terms of an expression, multiplied out in the printed order."""
    return _expand(parse(text))


def _expand(node: ast.expr) -> list[Term]:
    match node:
        case ast.Constant(value=int(number)):
            return [Term(Fraction(number))] if number else []
        case ast.Name(id=name):
            return [Term(Fraction(1), (name,))]
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return [t.negative() for t in _expand(inner)]
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
            return _expand(left) + _expand(right if isinstance(op, ast.Add) else ast.UnaryOp(ast.USub(), right))
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            return [a.times(b) for a in _expand(left) for b in _expand(right)]
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            divisor = _as_one(_expand(right)).inverse()
            return [a.times(divisor) for a in _expand(left)]
        case ast.BinOp(left=left, op=ast.Pow(), right=ast.Constant(value=int(power))):
            return _power(_expand(left), power)
        case ast.Call(func=ast.Name(id=function), args=[inner]):
            within = _expand(inner)
            return within if function == "modes" else [Term(Fraction(1), (f"{function}({canonical(within)})",))]
    raise ValueError(f"the audit cannot read `{ast.unparse(node)}`")


def _power(base: list[Term], power: int) -> list[Term]:
    result = [Term(Fraction(1))]
    for _ in range(power):
        result = [a.times(b) for a in result for b in base]
    return result


def _as_one(terms: list[Term]) -> Term:
    return terms[0] if len(terms) == 1 else Term(Fraction(1), (f"({canonical(terms)})",))


def collect(terms: Iterable[Term]) -> dict[Monomial, Fraction]:
    """Terms of one monomial added up; those that vanish are left out."""
    found: dict[Monomial, Fraction] = {}
    for term in terms:
        found[term.monomial] = found.get(term.monomial, Fraction(0)) + term.number
    return {monomial: number for monomial, number in found.items() if number}


def canonical(terms: Iterable[Term]) -> str:
    """One text for equal sums: cancelled, and sorted by the number of factors, then by text."""
    found = [of_monomial(number, monomial) for monomial, number in collect(terms).items()]
    found.sort(key=lambda t: (len(t.above) + len(t.below), t.number < 0, product(t)))
    return total(found)


# Factors stand in this order; what is not listed stands between the two, in the order of the alphabet.
_FIRST = tuple("exp dynamic_pressure s g m velocity i_yy zeta sigma omega n_d c w_ sin cos z_t c_bar c_".split())
_LAST = ("phi", "alpha", "delta_e", "chi", "n", "dt", "dw")
_MIDDLE = len(_FIRST)


def _rank(name: str) -> tuple[int, str]:
    def fits(pattern: str) -> bool:
        head = name.partition("(")[0]
        return head == pattern or (pattern.endswith("_") and name.startswith(pattern) and name != "c_bar")

    for rank, pattern in enumerate(_FIRST):
        if fits(pattern):
            return rank, name
    for rank, pattern in enumerate(_LAST):
        if fits(pattern):
            return _MIDDLE + 1 + rank, name
    return _MIDDLE, name


def product(term: Term) -> str:
    """The text of a term's size: `a*b**2/(c*d)`, without its sign; a bracket h_*^i stands last."""
    bracket = next((n for n, k in term.monomial if k == 1 and n.startswith("h_") and n.endswith("_i")), None)
    if bracket is not None and len(term.monomial) > 1:
        return f"{product(term.times(Term(Fraction(1), (), (bracket,))))}*{bracket}"
    above = _factors([n for n, k in term.monomial for _ in range(k)])
    below = _factors([n for n, k in term.monomial for _ in range(-k)])
    number = abs(term.number)
    if number.numerator != 1:
        above.insert(0, str(number.numerator))
    if number.denominator != 1:
        below.insert(0, str(number.denominator))
    text = "*".join(above) or "1"
    if not below:
        return text
    return f"{text}/{below[0]}" if len(below) == 1 else f"{text}/({'*'.join(below)})"


def _factors(names: list[str]) -> list[str]:
    counted = Counter(names)
    return [n if counted[n] == 1 else f"{n}**{counted[n]}" for n in sorted(counted, key=_rank)]


def signed(parts: Iterable[tuple[bool, str]]) -> str:
    """A sum of texts, each with whether it is subtracted."""
    text = ""
    for minus, part in parts:
        text += (" - " if minus else " + ") if text else ("-" if minus else "")
        text += part
    return text or "0"


def total(terms: Iterable[Term]) -> str:
    """The sum of terms as text, in their order."""
    return signed((t.number < 0, product(t)) for t in terms)


# A common factor of these stands before a bracket, as the paper has it.
_PREFACTOR = ("dynamic_pressure", "s", "m", "velocity", "i_yy")
_SHARED = ("cos(alpha)", "sin(alpha)", "z_t", "c_bar")


def compact(terms: list[Term]) -> str:
    """The sum of terms as text, with common factors before brackets; the order is that of the first terms."""
    return _grouped(terms, lambda t: _only(t, lambda name: name in _PREFACTOR or name.startswith("exp(")), _bracket)


def summed(terms: list[Term]) -> str:
    """The sum of terms over the modes, as the paper has f_*^η: `prefactor*modes((...)*(n/omega**2))`."""
    common = _common(terms)
    before = _only(common, lambda name: name in _PREFACTOR)
    behind = _only(common, lambda name: name not in _PREFACTOR)
    minus = all(t.number < 0 for t in terms)
    divisor = common.inverse().times(Term(Fraction(-1 if minus else 1)))
    inner = _bracket([t.times(divisor) for t in terms])
    return f"{'-' if minus else ''}{product(before)}*modes(({inner})*({product(behind)}))"


def _bracket(terms: list[Term]) -> str:
    return _grouped(terms, _shared_factor, total)


def _shared_factor(term: Term) -> Term:
    powers = term.powers
    first = next((name for name in _SHARED if powers.get(name, 0) > 0), None)
    return Term(Fraction(1), (first,) if first else ())


def _only(term: Term, wanted: Callable[[str], bool]) -> Term:
    return of_monomial(Fraction(1), tuple((name, power) for name, power in term.monomial if wanted(name)))


def _grouped(terms: list[Term], factor: Callable[[Term], Term], inner: Callable[[list[Term]], str]) -> str:
    """`factor*(...) + ...`: terms of one factor in one bracket, the factor 1 without any."""
    groups: dict[Monomial, list[Term]] = {}
    for term in terms:
        groups.setdefault(factor(term).monomial, []).append(term)
    parts: list[tuple[bool, str]] = []
    for monomial, group in groups.items():
        if len(group) == 1 or not monomial:
            parts += [(t.number < 0, product(t)) for t in group]
            continue
        common = _common(group) if inner is not total else of_monomial(Fraction(1), monomial)
        minus = all(t.number < 0 for t in group)
        divisor = common.inverse().times(Term(Fraction(-1 if minus else 1)))
        parts.append((minus, f"{product(common)}*({inner([t.times(divisor) for t in group])})"))
    return signed(parts)


def _common(terms: list[Term]) -> Term:
    """The factors that all terms share."""
    first, *others = [t.powers for t in terms]
    shared: dict[str, int] = {}
    for name, power in first.items():
        powers = [power, *(other.get(name, 0) for other in others)]
        if all(p > 0 for p in powers):
            shared[name] = min(powers)
        elif all(p < 0 for p in powers):
            shared[name] = max(powers)
    return of_monomial(Fraction(1), tuple(sorted(shared.items())))
