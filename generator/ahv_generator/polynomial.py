"""Polynomials whose monomials are the keys of a table."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import casadi as ca

from .diagnostics import shortened

_FACTOR = re.compile(r"([A-Za-z]\w*)(?:\^([1-9]))?")
# Of a monomial; derivatives multiply its variables by others.
HIGHEST_DEGREE = 9

Powers = tuple[tuple[str, int], ...]


class MonomialError(Exception):
    """A key that is not a monomial; `word` is the variable at fault where there is one."""

    def __init__(self, message: str, word: str | None = None) -> None:
        super().__init__(message)
        self.word = word


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
            if re.fullmatch(r"[A-Za-z]\w*\^[0-9]+", part.strip(" ")):
                message = (
                    f"`{shortened(key)}`: an exponent is a number from 1 to {HIGHEST_DEGREE}, without zeros before it"
                )
            elif key == "0":
                message = "`0` is not a monomial; the constant part of a quantity has the key `1`"
            raise MonomialError(message)
        name = match[1]
        if name not in order:
            raise MonomialError(f"`{shortened(name)}` is not a variable of this quantity", name)
        powers[name] = powers.get(name, 0) + int(match[2] or 1)
    degree = sum(powers.values())
    if degree > HIGHEST_DEGREE:
        raise MonomialError(f"`{shortened(key)}` is of degree {degree}; the highest is {HIGHEST_DEGREE}")
    return tuple((name, powers[name]) for name in order if name in powers)


def monomial_name(powers: Powers) -> str:
    """The monomial as a part of a Rust name: `phi_alpha_3`, `0` for the constant."""
    return "_".join(n if k == 1 else f"{n}_{k}" for n, k in powers) or "0"


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
