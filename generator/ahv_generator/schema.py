"""What a table may hold: sections, parameters, quantities with their monomials, choices, and rules."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

STATUSES = ("published", "derived", "unverified", "assumed")

POSITIVE, NOT_NEGATIVE, NOT_ZERO = "positive", "not_negative", "not_zero"
_IN_WORDS = {POSITIVE: "must be positive", NOT_NEGATIVE: "must not be negative", NOT_ZERO: "must not be zero"}


@dataclass(frozen=True)
class Rule:
    """What the parameters must keep: a polynomial in them is positive, not negative or not zero.

    A term is a factor and the names of parameters that multiply it. A fault is told at the first of them.
    """

    name: str
    terms: tuple[tuple[float, tuple[str, ...]], ...]
    must: str
    reason: str

    def holds(self, values: Mapping[str, float]) -> bool:
        """Whether parameters of these values keep the rule; one that is not a number does not."""
        # A product overflows to infinity, a power to an exception.
        value = sum(factor * math.prod(values[name] for name in names) for factor, names in self.terms)
        return {POSITIVE: value > 0, NOT_NEGATIVE: value >= 0, NOT_ZERO: abs(value) > 0}[self.must]

    def parameters(self) -> tuple[str, ...]:
        """The parameters that it is about, the one at which a fault is told first."""
        return tuple(dict.fromkeys(name for _, names in self.terms for name in names))


@dataclass(frozen=True)
class ParameterSpec:
    """A parameter that a model needs, by its key in the table; `must` is its range."""

    key: str
    symbol: str
    unit: str
    doc: str
    must: str | None = None

    @property
    def name(self) -> str:
        """Its name in the generated code."""
        return self.key.lower()

    def rules(self) -> tuple[Rule, ...]:
        """Its range."""
        if self.must is None:
            return ()
        reason = f"`{self.key}` ({self.doc}) {_IN_WORDS[self.must]}"
        return (Rule(self.must.replace("_", "-"), ((1.0, (self.name,)),), self.must, reason),)


@dataclass(frozen=True)
class QuantitySpec:
    """A curve-fitted quantity: its unit, and the variables that it may depend on.

    `required` are variables whose linear coefficient it must have, for the reason `required_by`; in the variables
    `affine` together it is of degree one at most, for the reason `affine_by`.
    """

    key: str
    symbol: str
    unit: str
    doc: str
    variables: tuple[str, ...]
    required: tuple[str, ...] = ()
    required_by: str = ""
    affine: tuple[str, ...] = ()
    affine_by: str = ""


@dataclass(frozen=True)
class VariableSpec:
    """A state, an input, a Wiener increment or another component of a basis."""

    name: str
    symbol: str
    unit: str
    doc: str
    validity: str | None = None


@dataclass(frozen=True)
class Option:
    """One way to choose, and the values of the switches that it sets."""

    name: str
    doc: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class Choice:
    """A key of `[choices]`, its type in the generated code, its switches and its options."""

    name: str
    type_name: str
    doc: str
    switches: tuple[ParameterSpec, ...]
    options: tuple[Option, ...]


def switch(key: str, symbol: str, doc: str) -> ParameterSpec:
    """A parameter that a choice sets."""
    return ParameterSpec(key, symbol, "1", doc)


@dataclass(frozen=True)
class Schema:
    """What the table of some models of a family holds.

    `variables` are those of the monomials; `laws` are the rules that are about more than one parameter's range.
    """

    parameters: Mapping[str, tuple[ParameterSpec, ...]]
    validity: tuple[VariableSpec, ...]
    choices: tuple[Choice, ...] = ()
    quantities: tuple[QuantitySpec, ...] = ()
    variables: tuple[VariableSpec, ...] = ()
    laws: tuple[Rule, ...] = ()

    def holds(self, section: str, key: str) -> bool:
        """Whether a table has an entry of this key in this section, or may have it in the polynomial of a quantity."""
        keys = {
            "choices": [choice.name for choice in self.choices],
            "validity": [variable.name for variable in self.validity],
        } | {name: [spec.key for spec in specs] for name, specs in self.parameters.items()}
        return key in keys.get(section, ()) or any(section == quantity.key for quantity in self.quantities)

    def rules(self) -> tuple[Rule, ...]:
        """The ranges of the parameters, then the laws."""
        ranges = (rule for group in self.parameters.values() for spec in group for rule in spec.rules())
        return (*ranges, *self.laws)
