"""Polynomials whose monomials are the keys of a table."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import casadi as ca

from .diagnostics import shortened

_FACTOR = re.compile(r"([A-Za-z]\w*)(?:\^([1-9][0-9]*))?")
# Of a monomial; derivatives multiply its variables by others.
HIGHEST_DEGREE = 9

Powers = tuple[tuple[str, int], ...]


class MonomialError(Exception):
    """A key that is not a monomial; `word` is the variable at fault where there is one, else `advice` may help."""

    def __init__(self, message: str, word: str | None = None, advice: str | None = None) -> None:
        super().__init__(message)
        self.word = word
        self.advice = advice


def parse_monomial(key: str, allowed: Iterable[str]) -> Powers:
    """Read `"1"`, `"alpha"`, `"phi*alpha^3"` into powers, in the order of `allowed`.

    Raises:
        MonomialError: when the key is malformed or names a variable that is not allowed.
    """
    order = list(allowed)
    powers: dict[str, int] = {}
    if key == "1":
        return ()
    for part in key.split("*"):
        match = _FACTOR.fullmatch(part.strip(" "))
        if match is None:
            message = f"`{shortened(key)}` is not a monomial; write it like `alpha`, `alpha^2` or `phi*alpha^3`"
            raise MonomialError(message, advice="the key of the constant part is `1`" if key == "0" else None)
        name = match[1]
        if name not in order:
            raise MonomialError(f"`{shortened(name)}` is not a variable of this quantity", name)
        # Of a number with many digits its size is enough.
        powers[name] = powers.get(name, 0) + int((match[2] or "1")[:4])
    degree = sum(powers.values())
    if degree > HIGHEST_DEGREE:
        shown = degree if degree < 1000 else "1000 or more"
        raise MonomialError(f"`{shortened(key)}` is of degree {shown}; the highest is {HIGHEST_DEGREE}")
    return tuple((name, powers[name]) for name in order if name in powers)


def monomial_name(powers: Powers) -> str:
    """The monomial as a part of a Rust name: `phi_alpha_3`, `0` for the constant."""
    return "_".join(n if k == 1 else f"{n}_{k}" for n, k in powers) or "0"


def powers_of_name(name: str, variables: Sequence[str]) -> Powers | None:
    """The monomial of which a text is the name, in variables of this order; None if it is that of none.

    >>> powers_of_name("phi_alpha_3", ("phi", "alpha"))
    (('phi', 1), ('alpha', 3))
    """
    if name == "0":
        return ()
    pattern = "".join(rf"(?:_({re.escape(variable)})(?:_([1-9]))?)?" for variable in variables)
    match = re.fullmatch(pattern, f"_{name}")
    if match is None:
        return None
    found = zip(match.groups()[::2], match.groups()[1::2], strict=True)
    return tuple((variable, int(exponent or 1)) for variable, exponent in found if variable is not None)


@dataclass(frozen=True)
class Term:
    """A coefficient, by its parameter name, times a monomial and a whole number."""

    coefficient: str
    powers: Powers
    scale: int = 1

    def degree(self, variables: Iterable[str]) -> int:
        """The sum of the exponents of `variables`."""
        chosen = set(variables)
        return sum(k for n, k in self.powers if n in chosen)


@dataclass(frozen=True)
class Polynomial:
    """A sum of terms, in the order of the table."""

    terms: tuple[Term, ...]

    def expression(self, symbols: Mapping[str, ca.SX]) -> ca.SX:
        """The polynomial over `symbols`, which hold variables and coefficients."""
        total = ca.SX(0)
        for term in self.terms:
            product = term.scale * symbols[term.coefficient]
            for name, exponent in term.powers:
                product = product * symbols[name] ** exponent
            total = total + product
        return total

    def linear_part(self, variable: str) -> Polynomial:
        """The coefficient of `variable` to the first power."""
        return Polynomial(
            tuple(
                Term(t.coefficient, tuple(p for p in t.powers if p[0] != variable), t.scale)
                for t in self.terms
                if t.degree([variable]) == 1
            )
        )

    def where(self, keep: Callable[[Term], bool]) -> Polynomial:
        """The terms that `keep` accepts."""
        return Polynomial(tuple(t for t in self.terms if keep(t)))

    def without_linear(self, variable: str) -> Polynomial:
        """What is left without the terms of degree one in `variable`."""
        return self.where(lambda t: t.degree([variable]) != 1)

    def substituted(self, variable: str, gain: str, other: str) -> Polynomial:
        """The polynomial with `variable` replaced by `variable + gain * other`, multiplied out."""
        terms: list[Term] = []
        for term in self.terms:
            powers = dict(term.powers)
            degree = powers.pop(variable, 0)
            for taken in range(degree + 1):
                split = powers | {gain: taken, variable: degree - taken, other: powers.get(other, 0) + taken}
                kept = tuple((name, exponent) for name, exponent in split.items() if exponent)
                terms.append(Term(term.coefficient, kept, term.scale * math.comb(degree, taken)))
        return Polynomial(tuple(terms))
